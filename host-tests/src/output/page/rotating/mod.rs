//! The page of an alignment on a turning platform.

mod figures;

pub use figures::{plane, platform, profile, residuals, spectra};

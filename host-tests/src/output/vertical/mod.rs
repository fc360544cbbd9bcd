//! What the user sees of an attitude that was kept.

pub mod json;
pub mod text;

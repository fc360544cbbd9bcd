//! Attitude and heading after the alignment: pitch, roll and azimuth through any motion.
//!
//! ```text
//!  coarse IMU, or three precise gyros ─▶ vertical ─pitch, roll, σ──────────┐
//!  precise gyro, vertical ─────────────▲    └─turn about the vertical─▶ azimuth ± σ(t) ─▶ link
//!                     alignment, or azimuth from outside ─hand over─▲   └─at rest─▶ remembered
//! ```

pub(crate) mod heading;
pub(crate) mod keeper;
mod report;
pub mod restart;
mod setting;
pub(crate) mod vertical;

pub use heading::Realigned;
pub use keeper::Keeper;
pub use report::{Report, State};
pub use setting::{Gyro, Setting};
pub use vertical::Trust;

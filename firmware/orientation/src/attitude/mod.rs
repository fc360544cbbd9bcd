//! Attitude and heading after the alignment: pitch, roll and azimuth through any motion.
//!
//! ```text
//!  coarse IMU, or three precise gyros ─▶ vertical ─pitch, roll, σ──────────┐
//!  precise gyro, vertical ─────────────▲    └─turn about the vertical─▶ azimuth ± σ(t) ─▶ link
//!                     alignment, or azimuth from outside ─hand over─▲   └─at rest─▶ remembered
//! ```
//!
//! Gyros carry the attitude from sample to sample, less the Earth rate and their biases. The
//! accelerometers show where down is, once gravity is separated from acceleration; at rest the
//! velocity is zero (zero-velocity update), and the rates that are left are the biases. Nothing of
//! that shows the azimuth, which is only held (heading hold; Burov's storage of azimuth):
//!
//! ```text
//! A(t) = A₀ + ∫ (ω_down + Ω_v) dt,   Ω_v = Ω sin φ
//! ```
//!
//! Its standard deviation grows: by N √t from the angle random walk, by b t from an error b of the
//! bias, by K √(t³/3) from the rate random walk, and by the scale error times the net turn.
//!
//! Over a restart the azimuth is recalled where the vehicle has not moved, as far as its gyros can
//! tell, and σ contains the turn that they would not show ([`restart`]). Where nothing is measured
//! for seconds, the azimuth is withdrawn.

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

//! Multi-position static alignment: the gyro dwells at several positions, and its mean rates there
//! show the horizontal Earth rate (Sokolov 2019, Burov).
//!
//! ```text
//!  sample ─▶ session ─dwells─▶ conclusion: quality ─▶ level ─▶ fit, etalon ─▶ azimuth ± σ, or why none
//!              └─▶ schedule, survey ─▶ planner
//! ```
//!
//! A level gyro on a body at azimuth A, its stage at the angle `θ_i`, measures
//!
//! ```text
//!  north             Z_i = Ω_h cos(A + θ_i) + S + W_i
//!    ▲     ↗ body x
//!    │ A ↗           Ω_h = Ω cos φ, the horizontal Earth rate at latitude φ
//!    │ ↗   θ_i       S     the gyro's bias, constant or slowly drifting
//!    ●┄┄┄┄┄▶ axis    W_i   its noise, averaged over the dwell
//! ```
//!
//! Over the positions the rates lie on a cosine: its phase is the azimuth, its mean the bias, its
//! amplitude a check of latitude and scale. On a full circle, with white noise of an angle random
//! walk N in a total time T, no unbiased estimator has a standard deviation below `√2 N/(Ω_h √T)`.
//!
//! A sensitive axis with the parts (`s_x`, `s_y`, `s_z`) forward, right and down of a level body also
//! measures the vertical Earth rate `Ω_v` = Ω sin φ, and by its g-sensitivities `k_s` and `k_o` the
//! forces along itself and 90° clockwise of itself:
//!
//! ```text
//! rate = Ω_h (cos A s_x − sin A s_y) − Ω_v s_z + k_s f_x/g + k_o f_y/g + S
//! ```
//!
//! Both turn with the stage as the Earth rate does, and no residual shows them. So the level is
//! measured by the accelerometer beside the gyro, and what is not known of it enters σ.

mod cause;
pub mod conclusion;
pub mod criterion;
pub mod direction;
pub mod etalon;
pub mod fit;
pub mod level;
pub mod mount;
pub(crate) mod progress;
pub mod quality;
pub(crate) mod refusal;
pub mod session;
pub mod setting;
pub mod tilt;

pub use progress::Progress;
pub use refusal::Refusal;
pub use session::Session;

use crate::planner::POSITIONS;
use crate::signal::Dwell;

/// Greatest number of dwells of an alignment: that of the board, or with the feature `recordings`
/// as many as a long recording has.
pub const CAPACITY: usize = if cfg!(feature = "recordings") { 1024 } else { POSITIONS };

/// Angle below which two positions count as the same, rad.
const SAME_POSITION: f64 = 1e-3;

/// Number of different stage angles among the dwells.
pub(crate) fn different_positions(kept: &[&Dwell]) -> usize {
    let is_new = |index: usize| {
        kept[..index]
            .iter()
            .all(|other| (kept[index].stage - other.stage).signed_rad().abs() > SAME_POSITION)
    };
    (0..kept.len()).filter(|&index| is_new(index)).count()
}

//! Multi-position static alignment: the gyro dwells at several positions, and its mean rates there
//! show the horizontal Earth rate (Sokolov 2019, Burov).
//!
//! ```text
//!  sample ─▶ session ─dwells─▶ conclusion: quality ─▶ level ─▶ fit, etalon ─▶ azimuth ± σ, or why none
//!              └─▶ schedule, survey ─▶ planner
//! ```

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

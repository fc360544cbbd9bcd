//! From dwell averages, or the turns of a platform, to an azimuth with its standard deviation.

pub mod budget;
pub mod cause;
pub mod conclusion;
pub mod criterion;
pub mod direction;
pub mod etalon;
pub mod level;
pub mod mount;
pub mod quality;
pub mod regression;
pub mod rotating;
pub mod setting;
pub mod slow;
pub mod stepwise;
pub mod stops;

use crate::signal::dwell::Dwell;

/// Most positions of a plan, and of an alignment on the board.
pub const POSITIONS: usize = 64;
/// Most dwells that an alignment can hold: those of the board, or with the feature `recordings` as many as a long
/// recording has.
pub const CAPACITY: usize = if cfg!(feature = "recordings") { 1024 } else { POSITIONS };

/// Angles closer than this are the same position, rad.
const SAME_POSITION: f64 = 1e-3;

/// How many of the dwells stand at angles of their own.
pub(crate) fn different_positions(kept: &[&Dwell]) -> usize {
    let is_new = |index: usize| {
        kept[..index]
            .iter()
            .all(|other| (kept[index].stage - other.stage).signed_rad().abs() > SAME_POSITION)
    };
    (0..kept.len()).filter(|&index| is_new(index)).count()
}

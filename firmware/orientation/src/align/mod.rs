//! Alignment methods: from dwell averages, the turns of a platform or the stops of a vehicle to an
//! azimuth with its standard deviation.

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

/// Greatest number of positions of a plan, and of an alignment on the board.
pub const POSITIONS: usize = 64;
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

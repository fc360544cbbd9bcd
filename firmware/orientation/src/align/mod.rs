//! From dwell averages to an azimuth with its standard deviation.

pub mod budget;
pub mod conclusion;
pub mod criterion;
pub mod direction;
pub mod etalon;
pub mod level;
pub mod mount;
pub mod quality;
pub mod regression;
pub mod setting;
pub mod stepwise;

/// Most positions that one alignment can hold.
pub const POSITIONS: usize = 64;

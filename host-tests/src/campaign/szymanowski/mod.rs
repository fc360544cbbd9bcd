//! Azimuth from stops by simulation: Szymanowski's Table 1 over many drives, and vehicles that stand and
//! sway.

pub mod drives;
pub mod parked;
pub(super) mod report;
mod world;

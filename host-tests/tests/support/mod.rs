//! What the tests share: the built program, stored recordings, files of their own, campaigns, and small oracles.
#![allow(
    dead_code,
    unused_imports,
    unused_macros,
    reason = "every binary includes all of it and uses a part"
)]

pub mod campaign;
pub mod files;
pub mod inputs;
pub mod link;
pub mod pages;
pub mod program;
pub mod rig;
pub mod sentences;

use embassy_time::Instant;

#[track_caller]
pub fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
}

/// A moment in seconds, to the nearest microsecond.
pub fn at(seconds: f64) -> Instant {
    Instant::from_micros((seconds * 1e6).round() as u64)
}

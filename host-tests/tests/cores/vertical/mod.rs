//! Holds pitch, roll and the kept azimuth (equations.md §3, §7) to closed forms and to what may go wrong.

mod attitude;
mod faults;
mod honesty;
mod rest;
mod world;

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
}

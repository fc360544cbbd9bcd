//! Holds azimuth from stops (equations.md §5) to closed forms, to scipy, and to simulated vehicles.
#![allow(missing_docs)]

mod inclination;
mod increments;
mod minimum;
mod place;
#[cfg(test)]
mod probe;
mod rotations;
mod strapdown;
mod world;

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
}

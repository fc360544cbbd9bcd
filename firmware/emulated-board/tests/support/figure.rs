//! Figures that are as they should be.

use std::ops::RangeInclusive;

/// Holds a figure to what it should be.
#[track_caller]
pub fn within(figure: f64, should: RangeInclusive<f64>, words: &str) {
    let (least, most) = should.into_inner();
    assert!((least..=most).contains(&figure), "{figure} {words}: not {least} to {most}");
}

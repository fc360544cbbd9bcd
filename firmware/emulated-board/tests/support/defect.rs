//! Defects that are known, as tests that are expected to fail.
//!
//! A defect is a test that says how the image should behave, with `#[should_panic(expected = "…")]` for as long as it
//! does not. The expected text has the reason and the band in which the figure lies, and [`hold`] says it only where
//! that very figure lies in that very band. So the test turns red
//!
//! - when the image is mended: nothing panics. Then the attribute goes, and the row in `DEFECTS.md`;
//! - when the figure leaves its band, for better or worse: the panic names it without the words that are expected;
//! - when something else fails first.

use std::ops::RangeInclusive;

/// Holds a figure to what it should be. Where it is not, but within the band that is known, panics with
/// "between … and …", or "exactly …" where the band is one number, and the words; anywhere else with other words.
#[track_caller]
pub fn hold(figure: f64, should: RangeInclusive<f64>, known: RangeInclusive<f64>, words: &str) {
    if should.contains(&figure) {
        return;
    }
    let (least, most) = known.into_inner();
    let band = if least < most {
        format!("between {least} and {most}")
    } else {
        format!("exactly {least}")
    };
    let should = format!("not {} to {}", should.start(), should.end());
    assert!(!(least..=most).contains(&figure), "{band} {words}: {figure}, {should}");
    panic!("{figure} {words}: neither as it should be nor as it is known");
}

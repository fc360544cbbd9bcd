//! Where sensors were at their limits. A recording does not say what its sensors can measure, but one at its limit
//! shows the same greatest value, or least, again and again.

use orientation::signal::Sample;
use orientation::units::AngularRate;

use crate::median::extremes;

/// How much longer than any other a standstill at the greatest value must be: where a smooth signal is
/// coarsely written, its top is the longest by three.
const LONGER: usize = 4;

/// Between which values a column is not cut; infinite where it is not cut at all. A limit that no more than this part
/// of the values stands at is none.
pub(crate) fn limits(values: &(impl Iterator<Item = f64> + Clone), few: f64) -> [f64; 2] {
    let is_limit = |limit: f64| {
        let stands = values.clone().filter(|value| *value == limit).count();
        stands as f64 > few * values.clone().count() as f64 && is_cut(values.clone(), limit)
    };
    let [least, greatest] = extremes(values.clone());
    [
        if is_limit(least) { least } else { f64::NEG_INFINITY },
        if is_limit(greatest) { greatest } else { f64::INFINITY },
    ]
}

/// A sample whose rate is reported as saturated where its column stands at one of these limits.
pub(crate) fn saturated(limits: [f64; 2], column: f64, sample: Sample) -> Sample {
    let is_cut = column <= limits[0] || column >= limits[1];
    if is_cut { Sample { rate: AngularRate(i32::MAX), ..sample } } else { sample }
}

/// Where each channel of so many is cut, whatever its sign; infinite where it is not.
pub(crate) fn of_channels<R, const N: usize>(rows: &[R], channels: fn(&R) -> [f64; N]) -> [f64; N] {
    std::array::from_fn(|channel| {
        let values = || rows.iter().map(|row| channels(row)[channel].abs());
        let greatest = values().fold(0.0, f64::max);
        if greatest > 0.0 && is_cut(values(), greatest) { greatest } else { f64::INFINITY }
    })
}

/// Whether a signal stands at its greatest value for far more samples on end than at any other. One that
/// stands there most of the time is steady.
fn is_cut(values: impl Iterator<Item = f64>, greatest: f64) -> bool {
    let (mut run, mut before) = (0, f64::NAN);
    let (mut at_greatest, mut elsewhere, mut count) = (0, 0, 0);
    for value in values {
        run = if value == before { run + 1 } else { 1 };
        before = value;
        let longest = if value == greatest { &mut at_greatest } else { &mut elsewhere };
        *longest = run.max(*longest);
        count += 1;
    }
    at_greatest > LONGER * elsewhere && 2 * at_greatest < count
}

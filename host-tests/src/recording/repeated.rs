//! Columns that repeat one value, as no sensor with noise does.

use std::ops::Range;

/// How much longer than any other such a run is: where noise is hardly written, many are long.
const ALONE: usize = 4;

/// The rows in which a value repeats itself for longest, if there are so many, and far more than anywhere else.
pub fn alone<R>(rows: &[R], fewest: usize, value: impl Fn(&R) -> f64) -> Option<&[R]> {
    let [first, second] = longest(rows, value);
    (first.len() >= fewest && first.len() >= ALONE * second.len()).then(|| &rows[first])
}

/// Where a value repeats itself for longest, and for second longest.
pub(crate) fn longest<R>(rows: &[R], value: impl Fn(&R) -> f64) -> [Range<usize>; 2] {
    let mut end = 0;
    let runs = rows.chunk_by(|a, b| value(a) == value(b)).map(|run| {
        let begin = end;
        end += run.len();
        begin..end
    });
    runs.fold([0..0, 0..0], |[first, second], run| {
        if run.len() > first.len() {
            [run, first]
        } else {
            [first, if run.len() > second.len() { run } else { second }]
        }
    })
}

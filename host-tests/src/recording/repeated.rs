//! Columns that repeat one value, as no sensor with noise does.

/// How much longer than any other such a run is: where noise is hardly written, many are long.
const ALONE: usize = 4;

/// The rows in which a value repeats itself for longest, if there are so many, and far more than anywhere else.
pub fn alone<R>(rows: &[R], fewest: usize, value: impl Fn(&R) -> f64) -> Option<&[R]> {
    let runs = rows.chunk_by(|a, b| value(a) == value(b));
    let [longest, next] = runs.fold([&rows[..0]; 2], |[longest, next], run| {
        if run.len() > longest.len() {
            [run, longest]
        } else {
            [longest, if run.len() > next.len() { run } else { next }]
        }
    });
    (longest.len() >= fewest && longest.len() >= ALONE * next.len()).then_some(longest)
}

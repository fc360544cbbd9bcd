//! Recordings with faults of any severity: what must not get past, and what must not be refused. `.ci/full` draws
//! ten times as many by `meridian campaign disturbed` besides.

mod spin;
mod stage;
mod turning;
mod vehicle;

use host::campaign::statistics::NORMAL_COVERAGE;

use crate::support::campaign::Extent;

/// Runs of each class: eight still have harmless ones and harmful ones.
fn runs(extent: Extent) -> usize {
    match extent {
        Extent::Whole => 20,
        Extent::Tenth => 8,
    }
}

/// Healthy ones, of so many: of sixty or more, a σ that is too wide shows, for few enough lie within it by chance.
fn healthy(extent: Extent, whole: usize) -> usize {
    extent.of(whole).max(60)
}

/// Whether no fewer errors are within 1, 2 and 3 σ than normal ones, but for so many points of all the runs.
fn covered(extent: Extent, points: [f64; 3], runs: usize) -> impl Fn([f64; 3]) -> bool {
    move |percent| {
        let mut each = percent.into_iter().zip(NORMAL_COVERAGE).zip(points);
        each.all(|((found, normal), points)| found > normal - extent.share(points, normal, runs))
    }
}

//! The report of `campaign instrument`.

use super::{normal, precisions, reasons};
use crate::campaign::instrument::Runs;
use crate::report::{Lines, Report};

/// What many runs of the whole instrument amount to.
#[must_use]
pub fn report(runs: &Runs) -> Report {
    let mut lines = Lines::default();
    lines.add("measured again", format!("{} dwells", runs.repeated));
    lines.add("FORBIDDEN", format!("{} accesses that a data sheet forbids", runs.violations));
    let table = precisions("Azimuths", "board", [("whole instrument".to_owned(), &runs.precision)]);
    let what = "24 positions of 10 s and the first once more, latitudes ±70°, tilts to 5°";
    let mut subtitle = vec![what.to_owned(), normal()];
    subtitle.extend(reasons([&runs.precision]));
    let title = "The whole instrument on simulated chips".to_owned();
    Report { title, subtitle, parts: vec![table.into(), lines.into()] }
}

//! The report of `campaign instrument`.

use super::{Columns, normal, reasons};
use crate::campaign::instrument::Runs;
use crate::report::{Lines, Report};

/// What many runs of the whole instrument amount to.
pub(crate) fn report(runs: &Runs) -> Report {
    let mut lines = Lines::default();
    lines.add("measured again", format!("{} dwells", runs.repeated));
    lines.add("FORBIDDEN", format!("{} accesses that a data sheet forbids", runs.violations));
    let table = Columns::of("Azimuths", std::slice::from_ref(runs))
        .column("board", |_| "whole instrument")
        .precision(|runs| &runs.precision);
    let what = "24 positions of 10 s and the first once more, latitudes ±70°, tilts to 5°";
    let subtitle = [what.to_owned(), normal()].into_iter().chain(reasons([&runs.precision]));
    Report {
        title: "The whole instrument on simulated chips".to_owned(),
        subtitle: subtitle.collect(),
        parts: vec![table.into(), lines.into()],
    }
}

//! `campaign instrument`: its entry in the registry, and its report.

use serde_json::json;

use super::{Runs, precision};
use crate::campaign::columns::{Columns, normal, reasons};
use crate::campaign::{Asked, Campaign, Done, Tick, unless};
use crate::report::{Lines, Report};

/// The whole instrument over many seeds.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "instrument",
    meaning: "The whole instrument on simulated chips, over drawn sites and attitudes",
    runs: 500,
    steps: "alignments",
    count: |asked| asked.runs,
    run,
};

/// A result where none was refused.
fn run(asked: &Asked, tick: Tick<'_>) -> Result<Done, String> {
    let runs = precision(asked.runs, tick).map_err(|error| error.to_string())?;
    let refusal = unless(runs.precision.is_complete(), "a healthy board was refused");
    let report = report(&runs);
    Ok(Done { report, refusal, object: json!({ "precision": runs }) })
}

/// What many runs of the whole instrument amount to.
fn report(runs: &Runs) -> Report {
    let lines = Lines::default()
        .with("measured again", format!("{} dwells", runs.repeated))
        .with("forbidden", format!("{} accesses that a data sheet forbids", runs.violations));
    let table = Columns::of("Azimuths", std::slice::from_ref(runs))
        .column("board", |_| "whole instrument")
        .precision(|runs| &runs.precision);
    let what = "24 positions of 10 s and the first once more, latitudes ±70°, tilts to 5°";
    let subtitle = [what.to_owned(), normal()].into_iter().chain(reasons([&runs.precision]));
    let title = "The whole instrument on simulated chips";
    Report::new(title, [table.into(), lines.into()]).below(subtitle)
}

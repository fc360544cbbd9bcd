//! `campaign spin`: its entry in the registry, and its report: Figs. 7 and 8 of Nekrasova 2017, and the tables.

use serde_json::json;

use super::cases::{self, Row, Spot};
use super::paper::{self, FRAGMENT_S, Paper, TURNS_PER_S};
use super::world::{RATE_HZ, SCALE_ERROR};
use crate::campaign::columns::{Columns, normal};
use crate::campaign::{Asked, Campaign, Done, Tick, one_by_one, unless};
use crate::methods::spin::{METHODS, name};
use crate::report::{Figure, Lines, Part, Report, Series, Style};

/// The paper's second, and flights with noise.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "spin",
    meaning: "The roll of a spinning body: the figures of Nekrasova 2017, then noise, and a lift that fades",
    runs: 500,
    steps: "flights",
    count: |asked| cases::COUNT * asked.runs,
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where no roll was lost and no turn miscounted.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let rows = one_by_one(0..cases::COUNT, tick, |case| cases::row(case, asked.runs, tick));
    let paper = paper::paper();
    let found = rows.iter().all(|row| row.lost == 0 && row.miscounted == 0);
    Done {
        report: report(&paper, &rows),
        refusal: unless(found, "a roll was lost, or a turn miscounted"),
        object: json!({ "paper": paper, "flights": rows }),
    }
}

/// The page for a campaign.
fn report(paper: &Paper, rows: &[Row]) -> Report {
    let [uncorrected, extrema, interpolated, locked] = &paper.curves;
    let methods = [extrema, interpolated, locked];
    let whole: Vec<(&str, &[(f64, f64)])> =
        vec![("1: without correction", uncorrected), ("2: with correction at extrema", extrema)];
    let named_methods = || METHODS.map(name).into_iter().zip(methods);
    let end_s = extrema.last().map_or(0.0, |(time_s, _)| *time_s);
    let fragment: Vec<_> =
        named_methods().map(|(name, curve)| (name, from(curve, end_s - FRAGMENT_S))).collect();
    let beside: Vec<_> = named_methods().skip(1).map(|(name, curve)| (name, &curve[..])).collect();
    let parts = [
        of_paper(paper).into(),
        over_time("Error of the roll over a second (Fig. 7)", &whole),
        over_time("A fragment of it between corrections (Fig. 8)", &fragment),
        over_time("Interpolated extrema and phase lock on the same samples", &beside),
        of_rows(rows),
        of_spots(rows),
    ];
    let percent = 100.0 * SCALE_ERROR;
    Report::new("Roll of a spinning body", parts).below([
        &format!("Nekrasova 2017, section 5: {TURNS_PER_S} turns a second, gyro {percent} % too fast, {RATE_HZ} Hz"),
        "with noise: 60 to 100 turns a second, changing by up to 5 % a second, a lift of 30 m/s²",
        &normal(),
    ])
}

/// The paper's second, without noise.
fn of_paper(paper: &Paper) -> Lines {
    let lines = Lines::new("The paper's second, without noise")
        .with("uncorrected", format!("{:.4}° after a second (Fig. 7)", paper.uncorrected_deg))
        .with("growth", format!("{:.4}° between corrections (Fig. 8)", paper.growth_deg))
        .with("corrections", format!("{:.2} a turn", paper.corrections_per_turn));
    let methods = paper.methods.iter();
    methods
        .fold(lines, |lines, (name, rms)| lines.with(name, format!("{rms:.5}° RMS error")))
        .with("scale error", format!("found by phase lock, off by {:.1e}", paper.scale_miss))
}

/// The end of a curve.
fn from(curve: &[(f64, f64)], from_s: f64) -> &[(f64, f64)] {
    &curve[curve.partition_point(|(time_s, _)| *time_s < from_s)..]
}

fn over_time(title: &str, curves: &[(&str, &[(f64, f64)])]) -> Part {
    let of = |(name, curve): &(&str, &[(f64, f64)])| {
        Series::of(name, Style::Line, curve, |point| *point)
    };
    Figure::over_time(title, ["roll error", "°"], curves.iter().map(of)).into()
}

fn of_rows(rows: &[Row]) -> Part {
    let table = Columns::of("RMS errors after the first 0.1 s, °", rows);
    let methods = METHODS.iter().enumerate();
    methods
        .fold(table.column("flights", |row| row.case), |table, (index, method)| {
            table.fixed(name(*method), 4, |row| row.rms_deg[index])
        })
        .fixed("limit", 4, |row| row.limit_deg)
        .column("turns miscounted", |row| row.miscounted)
        .column("roll lost", |row| row.lost)
        .column("runs", |row| row.runs)
        .scientific("scale error, RMS", 1, |row| row.scale_rms)
        .scientific("its σ", 1, |row| row.scale_sigma)
        .into()
}

fn of_spots(rows: &[Row]) -> Part {
    let both = rows.iter().flat_map(|row| {
        let held = row.held.as_ref().map(|held| (row.case, "before the lift comes back", held));
        [Some((row.case, "at the end", &row.end)), held]
    });
    let spots: Vec<(&str, &str, &Spot)> = both.flatten().collect();
    Columns::of("The phase lock at a moment", &spots)
        .column("flights", |(case, ..)| case)
        .column("when", |(_, when, _)| when)
        .fixed("RMS error, °", 4, |(.., spot)| spot.spread.rms_deg)
        .fixed("σ, °", 4, |(.., spot)| spot.spread.sigma_deg)
        .fixed("limit, °", 4, |(.., spot)| spot.limit_deg)
        .covered(|(.., spot)| spot.spread.coverage_percent)
        .into()
}

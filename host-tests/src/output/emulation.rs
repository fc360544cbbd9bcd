//! The tables of an emulation.

use std::iter::once;

use serde_json::{Value, json};

use crate::emulate::Emulation;
use crate::emulate::checks::Check;
use crate::emulate::collect::Figures;
use crate::emulate::cost::Row;
use crate::emulate::outcome::{DWELL, Outcome};
use crate::report::{Columns, Lines, Part, Report, Table};

/// What the images found, took and hold.
#[must_use]
pub fn report(emulation: &Emulation) -> Report {
    let costs = emulation.cost.chunk_by(|one, other| one.heading == other.heading).map(of_cost);
    let rest = [of_tasks(emulation), of_runs(emulation).into(), of_memory(emulation)];
    let parts = once(of_outcome(emulation).into()).chain(costs).chain(rest);
    let verdict = if emulation.is_right() { "All as it must be" } else { "FAILED" };
    let title = format!("{verdict}: the firmware on an emulated Cortex-M4F");
    Report::new(title, parts.chain([of_checks(&emulation.checks)]))
}

/// The azimuth, and whether it is the host's.
fn of_outcome(Emulation { emulated, comparison, .. }: &Emulation) -> Lines {
    let Outcome { seed, reason, azimuth_bits, sigma_bits, .. } = emulated;
    let degrees = |bits| f64::from_bits(bits).to_degrees();
    let mut lines = Lines::default();
    lines.add("seed", format!("{seed}, {} dwells", emulated.rows_of(&DWELL).count()));
    let azimuth = match (reason, azimuth_bits.zip(*sigma_bits)) {
        (None, Some((azimuth, sigma))) => {
            format!("{:.4}° ± {:.4}° (1σ)", degrees(azimuth), degrees(sigma))
        }
        (reason, _) => format!("none: {}", reason.as_deref().unwrap_or("")),
    };
    lines.add("azimuth", azimuth);
    let same = match comparison {
        Ok(()) => "the same in its run of this seed, bit for bit".to_owned(),
        Err(difference) => format!("NOT THE SAME: {difference}"),
    };
    lines.add("on the host", same);
    lines
}

/// What the cores take, under one heading.
fn of_cost(rows: &[Row]) -> Part {
    let heading = rows.first().map_or("", |row| &row.heading);
    Columns::of(heading, rows)
        .column("what", |row| &row.what)
        .column("count", |row| row.count)
        .column("budget", |row| row.budget.map_or("-".to_owned(), |budget| budget.to_string()))
        .column("", |row| &row.verdict)
        .into()
}

fn of_tasks(emulation: &Emulation) -> Part {
    Columns::of("Tasks, without bus drivers and interrupts", &emulation.runs.figures.tasks)
        .column("task", |task| &task.name)
        .column("polls", |task| task.polls)
        .column("instructions", |task| task.instructions)
        .column("longest", |task| task.worst)
        .into()
}

/// What each run took with the executor, and more of the simulated chips and world.
fn of_runs(Emulation { runs, .. }: &Emulation) -> Table {
    let row = |(run, figures): (&str, &Figures)| {
        let seconds = format!("{:.1}", figures.microseconds as f64 / 1e6);
        let [samples, instructions, simulation] =
            [figures.samples, figures.instructions, figures.simulation].map(|n| n.to_string());
        [run.to_owned(), samples, seconds, instructions, simulation]
    };
    let all = [
        ("from the first dwell to the last", &runs.figures),
        ("the same at 2400 Hz, in a brief run", &runs.brief),
        ("the same at 100 Hz, after a survey of two minutes", &runs.survey),
        ("from turn to turn at 2400 Hz, on a turning platform", &runs.turning),
        ("from stop to stop at 50 Hz, three gyros in a vehicle", &runs.stops),
    ];
    let head = ["run", "samples", "seconds", "instructions", "of the simulation"];
    Table::new("Runs, with the executor", &head, all.map(row))
}

fn of_memory(Emulation { memory, .. }: &Emulation) -> Part {
    let all = vec![
        "all but the simulation".to_owned(),
        memory.flash_bytes().to_string(),
        memory.ram_bytes().to_string(),
    ];
    Columns::of("Memory, bytes", &memory.sections)
        .column("section", |section| &section.name)
        .column("flash", |section| section.flash_bytes)
        .column("RAM", |section| section.ram_bytes)
        .table(Some(all))
        .into()
}

fn of_checks(checks: &[Check]) -> Part {
    Columns::of("The whole instrument: INSTRUCTIONS (not cycles) and bytes", checks)
        .column("what", |check| check.what)
        .column("count", |check| check.count)
        .column("budget", |check| check.budget)
        .column("", |check| match (check.is_kept(), check.at_least) {
            (true, _) => "ok",
            (false, true) => "UNDER",
            (false, false) => "OVER",
        })
        .into()
}

/// The emulation as one JSON object.
#[must_use]
pub fn object(emulation: &Emulation) -> Value {
    let outcome = &emulation.emulated;
    let degrees = |bits: Option<u64>| bits.map(|bits| f64::from_bits(bits).to_degrees());
    let runs = &emulation.runs;
    let figures = &runs.figures;
    json!({
        "status": if emulation.is_right() { "ok" } else { "failed" },
        "seed": outcome.seed,
        "azimuth_deg": degrees(outcome.azimuth_bits),
        "sigma_deg": degrees(outcome.sigma_bits),
        "reason": outcome.reason,
        "dwells": outcome.rows_of(&DWELL).count(),
        "difference": emulation.comparison.as_ref().err().map(ToString::to_string),
        "instructions": figures.instructions,
        "simulation_instructions": figures.simulation,
        "samples": figures.samples,
        "seconds": figures.microseconds as f64 / 1e6,
        "instructions_per_sample_at_2400_hz":
            runs.brief.instructions / runs.brief.samples.max(1),
        "tasks": figures.tasks,
        "memory": emulation.memory,
        "cores": emulation.cost,
        "checks": emulation.checks,
    })
}

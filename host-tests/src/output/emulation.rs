//! The tables of an emulation.

use std::iter::once;

use serde_json::{Value, json};
use simulated::trace::DWELL;

use crate::emulate::checks::{Check, per_sample};
use crate::emulate::cost::Row;
use crate::emulate::{Emulation, Run};
use crate::output::azimuth as in_circle;
use crate::report::{Columns, Lines, Part, Report};

/// What the images found, took and hold.
pub fn report(emulation: &Emulation) -> Report {
    let costs = emulation.cost.chunk_by(|one, other| one.heading == other.heading).map(of_cost);
    let rest = [of_runs(emulation), of_memory(emulation)];
    let parts = once(of_outcome(emulation).into()).chain(costs).chain(rest);
    let verdict = if emulation.is_right() { "All as it must be" } else { "FAILED" };
    let title = format!("{verdict}: the firmware on an emulated Cortex-M4F");
    Report::new(title, parts.chain([of_checks(&emulation.checks)]))
}

/// The azimuth, and whether it is the host's.
fn of_outcome(Emulation { seed, emulated, comparison, .. }: &Emulation) -> Lines {
    let azimuth = match emulated.azimuth() {
        Some(found) => {
            let [azimuth, sigma] = found.map(f64::to_degrees);
            format!("{}° ± {sigma:.4}° (1σ)", in_circle(azimuth, 4))
        }
        None => format!("none: {}", emulated.reason.as_deref().unwrap_or("")),
    };
    let same = match comparison {
        Ok(()) => "the same in every run, bit for bit".to_owned(),
        Err(difference) => format!("NOT THE SAME: {difference}"),
    };
    Lines::default()
        .with("seed", format!("{seed}, {} dwells", emulated.count(DWELL)))
        .with("azimuth", azimuth)
        .with("on the host", same)
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

/// What each run took with the executor, and more of the simulated chips and world.
fn of_runs(Emulation { runs, .. }: &Emulation) -> Part {
    let heading = "Runs, with executor and a time driver that stands in for the board's, without \
                   bus drivers and interrupts";
    Columns::of(heading, runs)
        .column("run", |run| run.job.word)
        .column("samples", |run| run.figures.samples)
        .column("seconds", |run| format!("{:.1}", run.figures.microseconds as f64 / 1e6))
        .column("a sample", |run| per_sample(&run.figures))
        .column("of it time driver", |run| run.figures.of_a_sample(run.figures.stand_ins))
        .column("instructions", |run| run.figures.instructions)
        .column("longest poll", |run| run.figures.longest_poll())
        .column("stack", |run| run.figures.stack_bytes)
        .column("of the simulation", |run| run.figures.simulation)
        .column("", |run| run.job.title)
        .into()
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
        .column("what", |check| &check.what)
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
    let found = outcome.azimuth().map(|found| found.map(f64::to_degrees));
    let runs = emulation.runs.iter().map(|Run { job, figures }| {
        json!({
            "run": job.word,
            "instructions": figures.instructions,
            "instructions_per_sample": per_sample(figures),
            "stand_in_instructions": figures.stand_ins,
            "simulation_instructions": figures.simulation,
            "samples": figures.samples,
            "seconds": figures.microseconds as f64 / 1e6,
            "stack_bytes": figures.stack_bytes,
            "tasks": figures.tasks,
        })
    });
    json!({
        "status": if emulation.is_right() { "ok" } else { "failed" },
        "seed": emulation.seed,
        "azimuth_deg": found.map(|[azimuth, _]| azimuth),
        "sigma_deg": found.map(|[_, sigma]| sigma),
        "reason": outcome.reason,
        "dwells": outcome.count(DWELL),
        "difference": emulation.comparison.as_ref().err().map(ToString::to_string),
        "runs": runs.collect::<Vec<_>>(),
        "memory": emulation.memory,
        "cores": emulation.cost,
        "checks": emulation.checks,
    })
}

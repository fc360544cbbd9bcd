//! The tables of an emulation.

use std::fmt::{self, Write};

use serde_json::{Value, json};

use crate::emulate::Emulation;
use crate::emulate::checks::Check;
use crate::emulate::collect::Figures;
use crate::emulate::cost::Row;
use crate::emulate::outcome::{DWELL, Outcome};

/// What the emulated instrument found, whether the host found the same, and all figures.
#[must_use]
pub fn tables(emulation: &Emulation) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, emulation);
    text
}

fn write(out: &mut String, emulation: &Emulation) -> fmt::Result {
    found(out, &emulation.emulated)?;
    match &emulation.comparison {
        Ok(()) => writeln!(out, "the host's run of this seed is the same, bit for bit")?,
        Err(difference) => writeln!(out, "NOT THE SAME ON THE HOST: {difference}")?,
    }
    cores(out, &emulation.cost)?;
    tasks(out, emulation)?;
    sections(out, emulation)?;
    heading(out, "the whole instrument: INSTRUCTIONS (not cycles) and bytes")?;
    emulation.checks.iter().try_for_each(|check| row(out, check))?;
    let verdict = if emulation.is_right() { "all as it must be" } else { "FAILED" };
    writeln!(out, "\n{verdict}")
}

fn found(out: &mut impl Write, outcome: &Outcome) -> fmt::Result {
    let degrees = |bits| f64::from_bits(bits).to_degrees();
    write!(out, "\nseed {}, {} dwells: ", outcome.seed, outcome.rows_of(&DWELL).count())?;
    match (&outcome.reason, outcome.azimuth_bits.zip(outcome.sigma_bits)) {
        (None, Some((azimuth, sigma))) => {
            writeln!(out, "azimuth {:.4}° ± {:.4}° (1σ)", degrees(azimuth), degrees(sigma))
        }
        (reason, _) => writeln!(out, "no azimuth: {}", reason.as_deref().unwrap_or("")),
    }
}

/// The heading of a table of this quantity.
fn heading(out: &mut impl Write, quantity: &str) -> fmt::Result {
    writeln!(out, "\n{:>10} {:>10} {:5} {quantity}", "count", "budget", "")
}

/// The image `cost`'s table as it printed it.
fn cores(out: &mut impl Write, rows: &[Row]) -> fmt::Result {
    let mut last = "";
    for row in rows {
        if row.heading != last {
            heading(out, &row.heading)?;
            last = &row.heading;
        }
        let budget = row.budget.map_or_else(|| "-".to_owned(), |budget| budget.to_string());
        writeln!(out, "{:>10} {budget:>10} {:5} {}", row.count, row.verdict, row.what)?;
    }
    Ok(())
}

fn tasks(out: &mut impl Write, emulation: &Emulation) -> fmt::Result {
    let runs = &emulation.runs;
    let figures = &runs.figures;
    writeln!(out, "\n{:>10} {:>12} {:>10} task", "polls", "instructions", "longest")?;
    for task in &figures.tasks {
        writeln!(
            out,
            "{:>10} {:>12} {:>10} {}",
            task.polls, task.instructions, task.worst, task.name
        )?;
    }
    effort(out, "from the first dwell to the last", figures)?;
    effort(out, "the same at 2400 Hz, in a brief run", &runs.brief)?;
    effort(out, "the same at 100 Hz, after a survey of two minutes", &runs.survey)?;
    effort(out, "from turn to turn at 2400 Hz, on a turning platform", &runs.turning)?;
    effort(out, "from stop to stop at 50 Hz, three gyros in a vehicle", &runs.stops)?;
    writeln!(out, "(without bus drivers and interrupts, which are the board's own)")
}

fn effort(out: &mut impl Write, when: &str, figures: &Figures) -> fmt::Result {
    let seconds = figures.microseconds as f64 / 1e6;
    writeln!(
        out,
        "{when}: {} samples in {seconds:.1} s of virtual time, {} instructions with the executor, \
         {} more of the simulated chips and world",
        figures.samples, figures.instructions, figures.simulation
    )
}

fn sections(out: &mut impl Write, emulation: &Emulation) -> fmt::Result {
    writeln!(out, "\n{:>10} {:>10} section", "flash", "RAM")?;
    for section in &emulation.memory.sections {
        writeln!(out, "{:>10} {:>10} {}", section.flash_bytes, section.ram_bytes, section.name)?;
    }
    let memory = &emulation.memory;
    writeln!(out, "{:>10} {:>10} all but the simulation", memory.flash_bytes(), memory.ram_bytes())
}

fn row(out: &mut impl Write, check: &Check) -> fmt::Result {
    let bad = if check.at_least { "UNDER" } else { "OVER" };
    let verdict = if check.is_kept() { "ok" } else { bad };
    writeln!(out, "{:>10} {:>10} {verdict:5} {}", check.count, check.budget, check.what)
}

/// The same as one object.
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

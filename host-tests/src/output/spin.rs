//! The tables of `campaign spin`.

use std::fmt::{self, Write};

use crate::campaign::spin::cases::{Row, Spot};
use crate::campaign::spin::paper::{Paper, TURNS_PER_S};
use crate::campaign::spin::world::{RATE_HZ, SCALE_ERROR};
use crate::campaign::statistics::NORMAL_COVERAGE;
use crate::spin::{METHODS, name};

/// Writes the paper's second.
///
/// # Errors
/// Those of the writer.
pub fn paper(out: &mut impl Write, paper: &Paper) -> fmt::Result {
    let percent = 100.0 * SCALE_ERROR;
    writeln!(
        out,
        "\nNekrasova 2017, section 5: {TURNS_PER_S} turns a second, gyro {percent} % too fast, {RATE_HZ} Hz, no noise"
    )?;
    let Paper { uncorrected_deg, growth_deg, corrections_per_turn, methods, scale_miss, .. } =
        paper;
    writeln!(
        out,
        "  {:<44} {uncorrected_deg:>10.4}°",
        "Fig. 7: error after a second, uncorrected"
    )?;
    writeln!(out, "  {:<44} {growth_deg:>10.4}°", "Fig. 8: growth between corrections")?;
    writeln!(out, "  {:<44} {corrections_per_turn:>10.2}", "corrections a turn")?;
    for (name, rms) in methods {
        writeln!(out, "  {:<44} {rms:>10.5}°", format!("RMS error, {name}"))?;
    }
    writeln!(out, "  {:<44} {scale_miss:>10.1e}", "scale error found by phase lock, off by")
}

/// Writes what many flights gave.
///
/// # Errors
/// Those of the writer.
pub fn cases(out: &mut impl Write, rows: &[Row]) -> fmt::Result {
    writeln!(
        out,
        "\nFlights with 60 to 100 turns a second, changing by up to 5 % a second, a lift of 30 m/s²"
    )?;
    for row in rows {
        of_row(out, row)?;
    }
    let [one, two, three] = NORMAL_COVERAGE;
    writeln!(out, "\nA normal distribution has {one}, {two}, {three} % within 1, 2, 3 σ.")
}

fn of_row(out: &mut impl Write, row: &Row) -> fmt::Result {
    let Row { case, runs, lost, miscounted, scale_rms, scale_sigma, .. } = row;
    writeln!(
        out,
        "\n{case}: {runs} flights, roll lost in {lost}, turns miscounted in {miscounted}"
    )?;
    for (method, rms) in METHODS.into_iter().zip(row.rms_deg) {
        writeln!(out, "  {:<44} {rms:>10.4}°", format!("RMS error, {}", name(method)))?;
    }
    writeln!(out, "  {:<44} {:>10.4}°", "limit (Cramér–Rao)", row.limit_deg)?;
    spot(out, "at the end", &row.end)?;
    if let Some(held) = &row.held {
        spot(out, "held, before the lift comes back", held)?;
    }
    writeln!(out, "  {:<44} {scale_rms:>10.1e}  (σ {scale_sigma:.1e})", "scale error, RMS error")
}

fn spot(out: &mut impl Write, when: &str, spot: &Spot) -> fmt::Result {
    let Spot { rms_deg, sigma_deg, limit_deg, coverage_percent: [one, two, three] } = spot;
    writeln!(
        out,
        "  {when:<44} {rms_deg:>10.4}°  (σ {sigma_deg:.4}°, limit {limit_deg:.4}°; within 1, 2, 3 σ {one:.1}, {two:.1}, {three:.1} %)"
    )
}

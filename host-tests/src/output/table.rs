//! The campaign's tables.

use std::fmt::{self, Write};

use super::positive_zero;
use crate::campaign::sokolov::{AlphaRow, Precision, Table};
use crate::campaign::statistics::{NORMAL_COVERAGE, Precision as Errors};
use crate::campaign::{faults, instrument};

/// Writes the tables of Sokolov's experiment.
///
/// # Errors
/// Those of the writer.
pub fn sokolov(out: &mut impl Write, tables: &[Table], precisions: &[Precision]) -> fmt::Result {
    writeln!(
        out,
        "\nSokolov 2019, Table 1: 60 dwells of 1 s, 0.15 °/h per sample at 100 Hz, 47°35′"
    )?;
    writeln!(out, "three azimuths (28°10′, 28°30′, 28°50′, off the grid); errors in arc seconds")?;
    for table in tables {
        of_turn(out, table)?;
    }
    writeln!(out, "\nMaximum likelihood through fixed point, azimuths off the grid")?;
    for precision in precisions {
        of_precision(out, precision)?;
    }
    Ok(())
}

fn of_turn(out: &mut impl Write, table: &Table) -> fmt::Result {
    writeln!(out, "\n{}", table.schedule)?;
    writeln!(
        out,
        "  {:<16} {:>5} {:>8} {:>9} {:>9} {:>9} {:>11} {:>8}   {:<24} paper's least",
        "criterion",
        "runs",
        "refused",
        "RMS",
        "stated σ",
        "limit",
        "Ω_h free",
        "ratio",
        "least of 90 each"
    )?;
    for row in &table.rows {
        writeln!(
            out,
            "  {:<16} {:>5} {:>8} {:>9.1} {:>9.1} {:>9.1} {:>11.1} {:>8.2}   {:<24} {}",
            row.criterion,
            row.runs,
            row.refused,
            row.rms_arcsec,
            row.sigma_arcsec,
            row.limit_arcsec,
            row.limit_free_arcsec,
            row.ratio,
            list(&row.least_arcsec),
            list(&table.paper_least_arcsec),
        )?;
    }
    for rule in &table.stop_rules {
        writeln!(
            out,
            "  stop rule, {}: median step {}, all 60 reached in {} of {}",
            rule.rule, rule.median_step, rule.all_positions, rule.runs
        )?;
    }
    for row in &table.paper_alpha {
        let AlphaRow { alpha_deg_h, runs, nothing, whole_range, mean_width_deg } = row;
        writeln!(
            out,
            "  the paper's α as {alpha_deg_h:.4} °/h accepts nothing in {nothing} of {runs} runs, all of \
             0…90° in {whole_range}; mean width {mean_width_deg:.1}° of the circle"
        )?;
    }
    Ok(())
}

fn list(values: &[f64; 3]) -> String {
    values.map(|value| format!("{value:.1}")).join(", ")
}

fn of_precision(out: &mut impl Write, row: &Precision) -> fmt::Result {
    writeln!(out, "\n{}: {} runs, {} refused", row.schedule, row.runs, row.refused)?;
    writeln!(
        out,
        "  RMS {:.2}, limit {:.2}, ratio {:.4}; in f64 {:.2}, fixed point adds {:+.3} %",
        row.rms_arcsec,
        row.limit_arcsec,
        row.ratio,
        row.rms_floating_point_arcsec,
        positive_zero(100.0 * (row.fixed_point_ratio - 1.0), 5e-4)
    )?;
    let [one, two, three] = row.coverage_percent;
    let [a, b, c] = NORMAL_COVERAGE;
    writeln!(
        out,
        "  within 1, 2, 3 σ: {one:.1}, {two:.1}, {three:.1} % (normal: {a:.1}, {b:.1}, {c:.1} %)"
    )
}

/// Writes what many runs of the whole instrument amount to.
///
/// # Errors
/// Those of the writer.
pub fn instrument(out: &mut impl Write, runs: &instrument::Runs) -> fmt::Result {
    writeln!(
        out,
        "\nThe whole instrument on simulated chips: 24 positions of 10 s and the first once more, latitudes ±70°, tilts to 5°"
    )?;
    errors(out, &runs.precision)?;
    writeln!(
        out,
        "  {} dwells measured again, {} accesses that a data sheet forbids",
        runs.repeated, runs.violations
    )
}

/// Writes what many alignments amount to.
///
/// # Errors
/// Those of the writer.
pub fn errors(out: &mut impl Write, row: &Errors) -> fmt::Result {
    let [one, two, three] = row.coverage_percent;
    let [a, b, c] = NORMAL_COVERAGE;
    writeln!(out, "  {} runs, {} refused", row.runs, row.refused)?;
    if let Some(reason) = &row.first_reason {
        writeln!(out, "  first refusal: {reason}")?;
    }
    writeln!(
        out,
        "  RMS error {:.4}°, RMS limit {:.4}°; RMS of error over limit {:.3}",
        row.rms_deg, row.limit_deg, row.ratio
    )?;
    writeln!(
        out,
        "  within 1, 2, 3 σ: {one:.1}, {two:.1}, {three:.1} % (normal: {a:.1}, {b:.1}, {c:.1} %); \
         worst {:.2} σ",
        row.worst_sigmas
    )
}

/// Writes what came of every fault.
///
/// # Errors
/// Those of the writer.
pub fn faults(out: &mut impl Write, rows: &[faults::Row]) -> fmt::Result {
    writeln!(
        out,
        "\n{:<10} {:<35} {:<8} {:>7} {:>6} {:>8} {:>8} {:>8} {:>7}  what the board noticed first → why it refused",
        "platform",
        "fault",
        "outcome",
        "error σ",
        "faults",
        "repeated",
        "left out",
        "after s",
        "noticed"
    )?;
    for row in rows {
        let error = row.error_sigmas.map_or_else(|| "-".to_owned(), |e| format!("{e:+.2}"));
        let [repeated, left_out] = [row.repeated, row.left_out]
            .map(|count| count.map_or_else(|| "-".to_owned(), |count| count.to_string()));
        let is_noticed = match row.is_noticed {
            None => "-",
            Some(true) => "yes",
            Some(false) => "NO",
        };
        write!(
            out,
            "{:<10} {:<35} {:<8} {error:>7} {:>6} {repeated:>8} {left_out:>8} {:>8.1} {is_noticed:>7}  {}",
            row.platform,
            row.fault,
            row.outcome,
            row.faults,
            row.seconds,
            row.noticed.as_deref().unwrap_or("nothing")
        )?;
        match &row.reason {
            Some(reason) => writeln!(out, " → {reason}")?,
            None => writeln!(out)?,
        }
    }
    Ok(())
}

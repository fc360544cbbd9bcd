//! The table of `campaign disturbed`.

use std::fmt::{self, Write};

use crate::campaign::disturbed::{HealthyRow, Row, WRONG_SIGMAS};

/// Writes what healthy recordings gave.
///
/// # Errors
/// Those of the writer.
pub fn healthy(out: &mut impl Write, rows: &[HealthyRow]) -> fmt::Result {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nHealthy recordings: RMS of error over limit, and errors within 1, 2, 3 σ")?;
    writeln!(
        out,
        "  {:<20} {:>5} {:>8} {:>12} {:>22} {:>9}",
        "method", "runs", "refused", "RMS / limit", "within 1, 2, 3 σ", "worst"
    )?;
    for HealthyRow { method, precision } in rows {
        let [one, two, three] = precision.coverage_percent;
        writeln!(
            out,
            "  {method:<20} {:>5} {:>8} {:>12.3} {:>22} {:>7.1} σ",
            precision.runs,
            precision.refused,
            precision.ratio,
            format!("{one:.1}, {two:.1}, {three:.1} %"),
            precision.worst_sigmas,
        )?;
        if let Some(reason) = &precision.first_reason {
            writeln!(out, "      {reason}")?;
        }
    }
    Ok(())
}

/// Writes what became of each class.
///
/// # Errors
/// Those of the writer.
pub fn rows(out: &mut impl Write, rows: &[Row]) -> fmt::Result {
    writeln!(
        out,
        "\nRecordings with faults of any severity: an answer is wrong beyond {WRONG_SIGMAS} of its σ; a fault is \
         harmless where it moves the answer by less than the healthy σ"
    )?;
    writeln!(
        out,
        "  {:<28} {:>5} {:>8} {:>17} {:>9} {:>20} {:>14}  severity",
        "class",
        "runs",
        "answered",
        "wrong (few, told)",
        "worst",
        "harmless answered",
        "healthy refused"
    )?;
    for row in rows {
        let [low, high] = row.severity;
        writeln!(
            out,
            "  {:<28} {:>5} {:>8} {:>17} {:>7.1} σ {:>20} {:>14}  {low} to {high} {}{}",
            row.class,
            row.runs,
            row.answered,
            format!("{} ({}, {})", row.wrong, row.wrong_of_few, row.wrong_told),
            row.worst_sigmas,
            format!("{} of {}", row.harmless_answered, row.harmless),
            row.healthy_refused,
            row.unit,
            if row.is_met { "" } else { "   NOT MET" },
        )?;
        for (reason, count) in row.reasons.iter().take(4) {
            writeln!(out, "      {count:>4} × {reason}")?;
        }
    }
    Ok(())
}

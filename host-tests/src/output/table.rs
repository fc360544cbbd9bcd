//! The table of `campaign faults`.

use std::fmt::{self, Write};

use crate::campaign::faults;

/// Writes what came of every fault.
///
/// # Errors
/// Those of the writer.
pub fn faults(out: &mut impl Write, rows: &[faults::Row]) -> fmt::Result {
    writeln!(
        out,
        "\n{:<30} {:<8} {:>7} {:>6} {:>8} {:>8} {:>8}  what the board noticed first → why it refused",
        "fault", "outcome", "error σ", "faults", "repeated", "left out", "after s"
    )?;
    for row in rows {
        let error = row.error_sigmas.map_or_else(|| "-".to_owned(), |e| format!("{e:+.2}"));
        write!(
            out,
            "{:<30} {:<8} {error:>7} {:>6} {:>8} {:>8} {:>8.1}  {}",
            row.fault,
            row.outcome,
            row.faults,
            row.repeated,
            row.left_out,
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

//! The tables of `campaign szymanowski`.

use std::fmt::{self, Write};

use crate::campaign::szymanowski::drives::{self, DRIVE_S, GYRO, LATITUDE_DEG, STOP_S};
use crate::campaign::szymanowski::parked::{self, GOOD, PARKED_S};
use crate::output::table::errors;

/// Writes what drives between stops gave, before and after.
///
/// # Errors
/// Those of the writer.
pub fn drives(out: &mut impl Write, rows: &[drives::Row]) -> fmt::Result {
    let [walk, bias] = GYRO;
    let minutes = DRIVE_S / 60.0;
    writeln!(
        out,
        "\nSzymanowski 2003: stops of {STOP_S} s, {minutes} min from the first to the last, {LATITUDE_DEG}°; gyros \
         of N {walk} °/√h and {bias} °/h (1σ)"
    )?;
    writeln!(
        out,
        "Table 1 in his: 1.302° before, 0.390° after; 6.592° before, 3.195° after (one drive each)"
    )?;
    for row in rows {
        writeln!(out, "\n{}: RMS error, °", row.case)?;
        let averaging = row.averaging_rms_deg;
        writeln!(out, "  {:<44} {averaging:>10.4}", "before: averaging over the first stop")?;
        let (plain, sigma) = (row.plain_rms_deg, row.plain_sigma_deg);
        writeln!(out, "  {:<44} {plain:>10.4} (σ {sigma:.4})", "the paper's method")?;
        writeln!(out, "  {:<44} {:>10.4}", "everything that is known", row.precision.rms_deg)?;
        let (brent, euler) = (row.brent_difference_deg, row.euler_difference_deg);
        writeln!(
            out,
            "  closed form less Brent's search, greatest: {brent:.1e}°; less that in Euler form {euler:.1e}°"
        )?;
        if let Some((ratio, sigma)) = row.bias_ratio.zip(row.bias_sigma_dph) {
            writeln!(out, "  gyro biases: σ {sigma:.3} °/h, RMS error over σ {ratio:.3}")?;
        }
        errors(out, &row.precision)?;
    }
    Ok(())
}

/// Writes what parked vehicles gave.
///
/// # Errors
/// Those of the writer.
pub fn parked(out: &mut impl Write, rows: &[parked::Row]) -> fmt::Result {
    let [walk, bias] = GOOD;
    writeln!(
        out,
        "\nParked for {PARKED_S} s with gyros of N {walk} °/√h and {bias} °/h (1σ); sway of 0.5° at 0.1 Hz to 2 Hz"
    )?;
    for row in rows {
        writeln!(out, "\n{}: RMS error, °", row.case)?;
        let averaging = row.averaging_rms_deg;
        writeln!(out, "  {:<44} {averaging:>10.4}", "averaging")?;
        writeln!(out, "  {:<44} {:>10.4}", "seen from inertial space", row.precision.rms_deg)?;
        errors(out, &row.precision)?;
    }
    Ok(())
}

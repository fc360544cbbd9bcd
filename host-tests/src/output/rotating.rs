//! The tables of `campaign rotating`.

use std::fmt::{self, Write};

use crate::campaign::rotating::molecular::{self, PHASES_DEG, SPEEDS_HZ};
use crate::campaign::rotating::world::{COUPLING_DEG, LATITUDE_DEG, TILT_DEG, UNEVENNESS};
use crate::campaign::rotating::{refusals, stages};
use crate::output::table::errors;

/// Writes what each stage of compensation leaves, and what noise makes of the last.
///
/// # Errors
/// Those of the writer.
pub fn stages(out: &mut impl Write, rows: &[stages::Row]) -> fmt::Result {
    writeln!(
        out,
        "\nA flat gyro at {LATITUDE_DEG}°, {} Hz, {} s each way: coupling {COUPLING_DEG}°, tilt {TILT_DEG}°, \
         unevenness {} % once per turn",
        stages::TURN_HZ,
        stages::SECONDS,
        100.0 * UNEVENNESS
    )?;
    for row in rows {
        writeln!(out, "\nN = {} °/√h: error after each stage, °", row.n_deg_sqrt_h)?;
        writeln!(out, "  {:<24} {:>10} {:>10}", "stage", "RMS", "greatest")?;
        for stage in &row.stages {
            let stages::Stage { stage, rms_deg, greatest_deg } = stage;
            writeln!(out, "  {stage:<24} {rms_deg:>10.4} {greatest_deg:>10.4}")?;
        }
        errors(out, &row.precision)?;
    }
    Ok(())
}

/// Writes what one and two speeds leave of a molecular-electronic sensor's g-sensitivity.
///
/// # Errors
/// Those of the writer.
pub fn molecular(out: &mut impl Write, rows: &[molecular::Row]) -> fmt::Result {
    let [slow, fast] = SPEEDS_HZ;
    let [least, most] = PHASES_DEG;
    writeln!(
        out,
        "\nA molecular-electronic sensor that lags by {least}° to {most}°, gain and g-sensitivity unknown, at \
         {slow} Hz and {fast} Hz, {} s each way in all, N = {} °/√h",
        molecular::SECONDS,
        molecular::WALK
    )?;
    writeln!(
        out,
        "\n  without noise, °: one speed (RMS, greatest, as predicted, off that, bound ρ²/2), two speeds"
    )?;
    writeln!(
        out,
        "  {:>9} {:>5} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>9}",
        "coupling",
        "ρ",
        "RMS",
        "greatest",
        "predicted",
        "off that",
        "bound",
        "two: RMS",
        "greatest"
    )?;
    for row in rows {
        writeln!(
            out,
            "  {:>8}° {:>5} {:>9.4} {:>9.4} {:>9.4} {:>9.4} {:>9.4} {:>12.5} {:>9.5}",
            row.coupling_deg,
            row.ratio,
            row.one_speed_rms_deg,
            row.one_speed_greatest_deg,
            row.predicted_rms_deg,
            row.off_prediction_deg,
            row.bound_deg,
            row.two_speeds_rms_deg,
            row.two_speeds_greatest_deg
        )?;
    }
    for row in rows {
        writeln!(
            out,
            "\n  coupling {}°, ρ {}, with noise, two speeds: RMS {:.2} times the limit without G and H, {:.4}°",
            row.coupling_deg, row.ratio, row.noise_ratio, row.plain_limit_deg
        )?;
        errors(out, &row.precision)?;
    }
    Ok(())
}

/// Writes what came of platforms and sensors that went wrong.
///
/// # Errors
/// Those of the writer.
pub fn refusals(out: &mut impl Write, rows: &[refusals::Row]) -> fmt::Result {
    writeln!(
        out,
        "\n{:<42} {:>5} {:>8} {:>6}  most often because",
        "what went wrong", "runs", "refused", "wrong"
    )?;
    for row in rows {
        let refusals::Row { case, runs, refused, wrong, reason, .. } = row;
        let reason = reason.as_deref().unwrap_or("-");
        writeln!(out, "{case:<42} {runs:>5} {refused:>8} {wrong:>6}  {reason}")?;
    }
    Ok(())
}

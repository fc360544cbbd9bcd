//! The result block of the roll of a spinning body.

use std::fmt::{self, Write};

use orientation::units::TURN;

use super::json::{MethodObject, Object, object};
use crate::output::degrees;
use crate::output::text::line;
use crate::recording::Truth;
use crate::spin::Replay;

/// Writes the block for a replay of `name`; the truth is for its errors alone.
///
/// # Errors
/// Those of the writer.
pub fn block(out: &mut impl Write, name: &str, replay: &Replay, truth: &Truth) -> fmt::Result {
    let object = object(replay, truth);
    if let Some((roll, sigma)) = object.roll_rad_end.zip(object.sigma_deg) {
        found(out, name, &object, roll, sigma)?;
    } else {
        writeln!(out, "\nNo roll at the end of {name}\n")?;
        line(out, "reason", format_args!("{}", object.reason.as_deref().unwrap_or_default()))?;
    }
    line(out, "state", format_args!("{}", object.state))?;
    if let Some(lift) = object.lift {
        line(out, "lift", format_args!("{lift:.3} m/s²"))?;
    }
    if let Some((scale, sigma)) = object.scale_error.zip(object.scale_sigma) {
        line(out, "gyro's scale error", format_args!("{scale:+.4e} ± {sigma:.1e} (1σ)"))?;
    }
    let noise = object.force_noise_m_s2;
    line(out, "force noise", format_args!("{noise:.2e} m/s² a sample, as the turns show it"))?;
    line(out, "assumed", format_args!("{}", object.assumed.join("; ")))?;
    methods(out, &object)
}

/// The roll at the end.
fn found(out: &mut impl Write, name: &str, object: &Object, roll: f64, sigma: f64) -> fmt::Result {
    writeln!(out, "\nRoll of the spinning body in {name}\n")?;
    let turns = (roll / TURN).floor();
    let angle = degrees(roll - turns * TURN);
    line(
        out,
        "roll at the end",
        format_args!("{turns} turns and {angle:.5}° ± {sigma:.5}° (1σ); {roll:.6} rad"),
    )?;
    if let Some(limit) = object.limit_deg {
        line(out, "limit", format_args!("{limit:.5}° (Cramér–Rao)"))?;
    }
    let Some(error) = object.error_deg else { return Ok(()) };
    let sigmas = error / sigma;
    line(out, "truth", format_args!("the error is {error:+.5}°, {sigmas:+.2} σ"))
}

/// How each method did; only corrections where there is no truth.
fn methods(out: &mut impl Write, object: &Object) -> fmt::Result {
    writeln!(
        out,
        "\n  {:<14} {:>11} {:>14} {:>11}",
        "method", "corrections", "RMS error °", "turns lost"
    )?;
    for MethodObject { name, rms_deg, turns_lost, corrections, .. } in &object.methods {
        let rms = rms_deg.map_or_else(|| "-".to_owned(), |rms| format!("{rms:.5}"));
        let lost = turns_lost.map_or_else(|| "-".to_owned(), |turns| turns.to_string());
        writeln!(out, "  {name:<14} {corrections:>11} {rms:>14} {lost:>11}")?;
    }
    let Some(limit) = object.limit_rms_deg else { return Ok(()) };
    writeln!(out, "  {:<14} {:>11} {limit:>14.5}", "limit", "")?;
    if object.rms_deg.is_some() {
        writeln!(out, "  errors within half a turn, after the first 0.1 s")?;
    }
    Ok(())
}

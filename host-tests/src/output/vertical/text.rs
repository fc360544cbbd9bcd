//! The result block of an attitude that was kept.

use std::fmt::{self, Write};

use super::json::{ErrorObject, Object};
use crate::output::positive_zero;
use crate::output::text::line;

/// Writes the block for a replay of `name`.
///
/// # Errors
/// Those of the writer.
pub fn block(out: &mut impl Write, name: &str, object: &Object) -> fmt::Result {
    let sigma = object.sigma_deg;
    if let (Some(pitch), Some(roll)) = (object.pitch_deg, object.roll_deg) {
        let [pitch, roll] = [pitch, roll].map(|angle| positive_zero(angle, 5e-5));
        writeln!(out, "\nPitch and roll kept in {name}\n")?;
        line(out, "pitch, roll", format_args!("{pitch:.4}°, {roll:.4}° ± {sigma:.4}° (1σ)"))?;
    } else {
        writeln!(out, "\nNo pitch and roll from {name}\n")?;
        let reason = object.reason.as_deref().unwrap_or_default();
        line(out, "reason", format_args!("{reason}"))?;
    }
    let turned = positive_zero(object.turned_deg, 5e-5);
    line(out, "turned", format_args!("{turned:+.4}° about the vertical since the beginning"))?;
    biases(out, object)?;
    if object.bias_beyond_stated {
        line(
            out,
            "  beyond",
            format_args!("five of the 1σ stated or assumed, which are not believed any more"),
        )?;
    }
    line(out, "state at the end", format_args!("{}", object.state))?;
    for met in &object.states {
        line(out, "  met", format_args!("{}, {:.2} s in all", met.state, met.seconds))?;
    }
    if let Some(found) = &object.errors {
        errors(out, found)?;
    }
    line(out, "assumed", format_args!("{}", object.assumed.join("; ")))
}

fn biases(out: &mut impl Write, object: &Object) -> fmt::Result {
    let both = object.bias_dph.iter().zip(object.bias_sigma_dph);
    let all: Vec<String> = both.map(|(bias, sigma)| format!("{bias:+.1} ± {sigma:.1}")).collect();
    line(out, "gyro biases", format_args!("{} °/h forward, right, down", all.join(", ")))
}

fn errors(out: &mut impl Write, errors: &ErrorObject) -> fmt::Result {
    let ErrorObject { inclination_rmse_deg, heading_rmse_deg, coverage_percent, samples } = *errors;
    let [one, two, three] = coverage_percent;
    writeln!(out, "  against the truth, in {samples} samples")?;
    line(out, "  inclination", format_args!("{inclination_rmse_deg:.4}° RMS"))?;
    line(out, "  heading", format_args!("{heading_rmse_deg:.4}° RMS after one constant offset"))?;
    line(out, "  within 1, 2, 3 σ", format_args!("{one:.1}, {two:.1}, {three:.1} % of the tilts"))
}

//! The result block of an alignment from stops.

use std::fmt::{self, Write};

use super::columns;
use super::json::{Plain, Stop};
use crate::output::text::{budget, headline, line};
use crate::output::{azimuth_error, degrees, degrees_per_hour, positive_zero};
use crate::recording::Truth;
use crate::stops::Replay;
use crate::stops::core::Conclusion;

/// Writes the block for a replay of `name`; the truth is for its errors alone.
///
/// # Errors
/// Those of the writer.
pub fn block(
    out: &mut impl Write,
    name: &str,
    replay: &Replay,
    conclusion: &Conclusion,
    truth: &Truth,
) -> fmt::Result {
    headline(out, name, &conclusion.verdict, truth.azimuth_deg, |out| {
        if !replay.noise_is_known() {
            return line(out, "limit", format_args!("none: the noise is estimated from it"));
        }
        let limit = degrees(conclusion.limit);
        line(out, "limit", format_args!("{limit:.4}° (Cramér–Rao for the stated noise)"))
    })?;
    if conclusion.verdict.is_ok() {
        start(out, conclusion, truth)?;
        found(out, conclusion)?;
        budget(out, &conclusion.budget)?;
    }
    if let Some(plain) = Plain::of(conclusion) {
        papers(out, &plain)?;
    }
    line(out, "assumed", format_args!("{}", replay.assumed.join("; ")))?;
    stops(out, replay)
}

/// The azimuth at the beginning.
fn start(out: &mut impl Write, conclusion: &Conclusion, truth: &Truth) -> fmt::Result {
    let Some(start) = conclusion.start else { return Ok(()) };
    let [angle, sigma] = [start.angle, start.sigma].map(degrees);
    line(out, "at the start", format_args!("{angle:.4}° ± {sigma:.4}° (1σ)"))?;
    let Some(truth) = truth.start_azimuth_deg else { return Ok(()) };
    let error = azimuth_error(angle, truth);
    line(out, "  truth", format_args!("{truth:.4}°: the error is {error:+.4}°"))
}

/// What else the solution found.
fn found(out: &mut impl Write, conclusion: &Conclusion) -> fmt::Result {
    let (ratio, sigma) = (conclusion.ratio, conclusion.ratio_sigma);
    line(out, "Earth rate", format_args!("{ratio:.4} ± {sigma:.4} of that expected"))?;
    if let Some((biases, sigmas)) = conclusion.biases {
        let both = biases.into_iter().zip(sigmas).map(|(bias, sigma)| {
            format!("{:+.4} ± {:.4}", degrees_per_hour(bias), degrees_per_hour(sigma))
        });
        let all: Vec<String> = both.collect();
        line(out, "gyro biases", format_args!("{} °/h forward, right, down", all.join(", ")))?;
    }
    line(out, "model", format_args!("{}", columns(conclusion).join(", ")))
}

/// The paper's method beside it.
fn papers(out: &mut impl Write, plain: &Plain) -> fmt::Result {
    let Plain { sigma_deg, start_azimuth_deg, brent_deg, euler_deg, .. } = *plain;
    writeln!(out, "  the paper's method, first stop and last, gyros taken as free of bias")?;
    if let Some(azimuth) = plain.azimuth_deg {
        line(out, "  azimuth", format_args!("{azimuth:.4}° ± {sigma_deg:.4}° (1σ)"))?;
    }
    line(out, "  at the start", format_args!("{start_azimuth_deg:.4}° in closed form"))?;
    let [brent, euler] =
        [brent_deg, euler_deg].map(|angle| azimuth_error(angle, start_azimuth_deg));
    line(out, "  least angle", format_args!("{brent:+.2e}° from that, by Brent's search"))?;
    line(out, "  √(ΔΘ² + ΔΦ²)", format_args!("least {euler:+.2e}° from that"))?;
    line(out, "  U there", format_args!("{:.5}°\n", plain.inclination_deg))
}

fn stops(out: &mut impl Write, replay: &Replay) -> fmt::Result {
    writeln!(
        out,
        "\n  {:>4} {:>9} {:>9} {:>10} {:>10} {:>18}",
        "stop", "from s", "to s", "pitch °", "roll °", "north, east m"
    )?;
    for (index, stop) in replay.session.stops().iter().enumerate() {
        let Stop { from_s, to_s, pitch_deg, roll_deg, displacement_m } =
            Stop::of(stop, replay.zero_s);
        let [pitch, roll] = [pitch_deg, roll_deg].map(|angle| positive_zero(angle, 5e-5));
        let displaced = displacement_m.map_or_else(
            || "not known".to_owned(),
            |[north, east]| format!("{north:.1}, {east:.1}"),
        );
        let number = index + 1;
        writeln!(
            out,
            "  {number:>4} {from_s:>9.2} {to_s:>9.2} {pitch:>10.4} {roll:>10.4} {displaced:>18}"
        )?;
    }
    Ok(())
}

//! The result block of an alignment from stops.

use std::fmt::{self, Write};

use orientation::align::stops::conclusion::{Conclusion, Found};

use super::columns;
use super::json::{Excluded, Plain, Stop, object};
use crate::output::text::{budget, headline, line};
use crate::output::{azimuth_error, degrees, degrees_per_hour, positive_zero};
use crate::recording::Truth;
use crate::stops::Replay;

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
    let object = object(replay, conclusion, truth);
    headline(out, name, &conclusion.verdict, truth.azimuth_deg, |out| match object.limit_deg {
        None => line(out, "limit", format_args!("none: the noise is estimated from it")),
        Some(limit) => {
            line(out, "limit", format_args!("{limit:.4}° (Cramér–Rao for the stated noise)"))
        }
    })?;
    if let (Some(found), true) = (&conclusion.found, conclusion.verdict.is_ok()) {
        start(out, found, truth)?;
        details(out, replay, found)?;
        budget(out, &found.budget)?;
    }
    if let Some(plain) = &object.plain {
        papers(out, plain)?;
    }
    line(out, "assumed", format_args!("{}", replay.assumed.join("; ")))?;
    for Excluded { stop, reason } in &object.excluded {
        let place = stop.map_or_else(String::new, |stop| format!("at stop {stop}, "));
        line(out, "left out", format_args!("{place}{reason}"))?;
    }
    stops(out, replay)
}

/// The azimuth at the beginning.
fn start(out: &mut impl Write, found: &Found, truth: &Truth) -> fmt::Result {
    let [angle, sigma] = [found.start.angle, found.start.sigma].map(degrees);
    line(out, "at the start", format_args!("{angle:.4}° ± {sigma:.4}° (1σ)"))?;
    let Some(truth) = truth.start_azimuth_deg else { return Ok(()) };
    let error = azimuth_error(angle, truth);
    line(out, "  truth", format_args!("{truth:.4}°: the error is {error:+.4}°"))
}

/// What else the solution found.
fn details(out: &mut impl Write, replay: &Replay, found: &Found) -> fmt::Result {
    let [pitch, roll] = found.level.map(|angle| positive_zero(degrees(angle), 5e-5));
    line(out, "pitch, roll", format_args!("{pitch:.4}°, {roll:.4}°"))?;
    let (ratio, sigma) = (found.plain.ratio, found.plain.ratio_sigma);
    line(out, "Earth's turn", format_args!("{ratio:.4} ± {sigma:.4} of that expected"))?;
    if found.are_biases_observed {
        let both = found.biases.into_iter().zip(found.bias_sigmas).map(|(bias, sigma)| {
            format!("{:+.4} ± {:.4}", degrees_per_hour(bias), degrees_per_hour(sigma))
        });
        let all: Vec<String> = both.collect();
        line(out, "gyro biases", format_args!("{} °/h forward, right, down", all.join(", ")))?;
    }
    line(out, "model", format_args!("{}", columns(replay).join(", ")))
}

/// The paper's method beside it.
fn papers(out: &mut impl Write, plain: &Plain) -> fmt::Result {
    let Plain { azimuth_deg, sigma_deg, start_azimuth_deg, brent_deg, euler_deg, .. } = *plain;
    writeln!(out, "  the paper's method, first stop and last, gyros taken as free of bias")?;
    line(out, "  azimuth", format_args!("{azimuth_deg:.4}° ± {sigma_deg:.4}° (1σ)"))?;
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

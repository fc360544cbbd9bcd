//! The result block that a person reads.

use std::fmt::{self, Write};

use firmware::simulated::scenario::Scenario;
use orientation::align::budget::Budget;
use orientation::align::conclusion::{Azimuth, Conclusion};
use orientation::align::stepwise::Fit;
use orientation::error::Refusal;

use super::json::{Excluded, earth_rate, excluded};
use super::{azimuth_error, columns, degrees, degrees_per_hour, parts, positive_zero};
use crate::instrument::Run;
use crate::positions::autocompensation;
use crate::replay::{Method, Replay};

/// Writes the block for a replay of `name`; `truth_deg` is for its error alone.
///
/// # Errors
/// Those of the writer.
pub fn block(
    out: &mut impl Write,
    name: &str,
    replay: &Replay,
    conclusion: &Conclusion,
    truth_deg: Option<f64>,
) -> fmt::Result {
    headline(out, name, &conclusion.verdict, truth_deg, |out| match &conclusion.fit {
        Some(fit) => limit(out, replay, fit),
        None => Ok(()),
    })?;
    if conclusion.tilt.measured {
        let tilt = &conclusion.tilt;
        let [pitch, roll] = [tilt.pitch(), tilt.roll()].map(|a| positive_zero(degrees(a), 5e-5));
        line(out, "pitch, roll", format_args!("{pitch:.4}°, {roll:.4}°"))?;
    } else {
        line(out, "pitch, roll", format_args!("not measured: taken as level"))?;
    }
    if let Some(fit) = &conclusion.fit {
        of_fit(out, replay, conclusion, fit)?;
    }
    if replay.method == Method::Positions {
        positions(out, replay, conclusion)?;
    }
    line(out, "assumed", format_args!("{}", replay.assumed.join("; ")))?;
    left_out(out, replay, conclusion)?;
    dwells(out, replay, conclusion)
}

/// Writes what belongs to a label.
///
/// # Errors
/// Those of the writer.
pub fn line(out: &mut impl Write, label: &str, value: fmt::Arguments<'_>) -> fmt::Result {
    writeln!(out, "  {label:<18} {value}")
}

/// Writes the azimuth, or why there is none; `more` follows an azimuth, then its error.
pub(super) fn headline<W: Write>(
    out: &mut W,
    name: &str,
    verdict: &Result<Azimuth, Refusal>,
    truth_deg: Option<f64>,
    more: impl FnOnce(&mut W) -> fmt::Result,
) -> fmt::Result {
    let azimuth = match verdict {
        Ok(azimuth) => azimuth,
        Err(reason) => {
            writeln!(out, "\nNo azimuth from {name}\n")?;
            return line(out, "reason", format_args!("{reason}"));
        }
    };
    writeln!(out, "\nTrue north found in {name}\n")?;
    let [angle, sigma] = [azimuth.angle, azimuth.sigma].map(degrees);
    line(out, "azimuth of body x", format_args!("{angle:.4}° ± {sigma:.4}° (1σ)"))?;
    more(out)?;
    let Some(truth) = truth_deg else { return Ok(()) };
    let error = azimuth_error(angle, truth);
    let sigmas = error / sigma;
    line(out, "truth", format_args!("{truth:.4}°: the error is {error:+.4}°, {sigmas:+.2} σ"))
}

fn limit(out: &mut impl Write, replay: &Replay, fit: &Fit) -> fmt::Result {
    let limit = degrees(fit.limit);
    let source = if replay.noise_is_known() { "stated noise" } else { "noise estimated from it" };
    line(out, "limit", format_args!("{limit:.4}° (Cramér–Rao for the {source})"))
}

fn of_fit(
    out: &mut impl Write,
    replay: &Replay,
    conclusion: &Conclusion,
    fit: &Fit,
) -> fmt::Result {
    let (ratio, sigma) = (fit.ratio, fit.ratio_sigma);
    if fit.model.is_single_axis {
        line(out, "Earth rate", format_args!("taken for granted: two positions do not show it"))?;
    } else {
        line(out, "Earth rate", format_args!("{ratio:.4} ± {sigma:.4} of that expected"))?;
    }
    let names = columns(fit).join(", ");
    line(out, "model", format_args!("{names}; Earth rate {}", earth_rate(fit)))?;
    line(out, "criterion", format_args!("{}", replay.criterion_name()))?;
    let noise = degrees(conclusion.angle_random_walk) * 60.0;
    let how = match (replay.session.surveyed(), replay.noise_is_known()) {
        (Some(_), _) => "surveyed",
        (None, true) => "stated",
        (None, false) => "estimated",
    };
    line(out, "gyro noise N", format_args!("{noise:.6} °/√h ({how})"))?;
    let (chi, degrees) = (fit.chi_square, fit.degrees);
    line(out, "residuals", format_args!("χ² {chi:.1} for {degrees} degrees of freedom"))?;
    budget(out, &fit.budget)
}

/// How often each position was visited, and what plain autocompensation gives.
fn positions(out: &mut impl Write, replay: &Replay, conclusion: &Conclusion) -> fmt::Result {
    let found = autocompensation(&replay.session, conclusion);
    let visited = found.angles_deg.iter().zip(&found.visits);
    let list: Vec<String> =
        visited.map(|(angle, times)| format!("{angle:.1}° × {times}")).collect();
    line(out, "positions", format_args!("{}", list.join(", ")))?;
    let (Some(azimuth), Some(off)) = (found.plain_azimuth_deg, found.plain_off_sigmas) else {
        return Ok(());
    };
    line(
        out,
        "without weights",
        format_args!("{azimuth:.4}° by plain least squares, {off:+.2} σ from the azimuth"),
    )
}

/// The budget with each part's share of the variance.
pub(super) fn budget(out: &mut impl Write, budget: &Budget) -> fmt::Result {
    let sigma = budget.sigma();
    writeln!(out, "\n  error budget (1σ of the azimuth)")?;
    for (source, part) in parts(budget) {
        let share = 100.0 * (part / sigma) * (part / sigma);
        writeln!(out, "    {:<28} {:>9.4}°  {share:>5.1} %", source.to_string(), degrees(part))?;
    }
    writeln!(out, "    {:<28} {:>9.4}°", "root sum of squares", degrees(sigma))?;
    if let Some(source) = budget.dominant() {
        writeln!(out, "    {source} dominates{}", remedy(source))?;
    }
    writeln!(out)
}

/// What helps against a part that dominates.
fn remedy(source: orientation::error::Source) -> &'static str {
    use orientation::error::Source;
    match source {
        Source::GSensitivity => ": level the platform mechanically, or calibrate κ at two tilts",
        Source::Accelerometer => ": turn a full circle, or calibrate the accelerometer",
        Source::Scale => ": turn a longer arc, or calibrate the scale factor",
        Source::Drift | Source::Temperature => ": let the gyro settle, or repeat the circle faster",
        _ => "",
    }
}

/// What the board went through, after the block of a simulated run that took `wall` seconds.
///
/// # Errors
/// Those of the writer.
pub fn run<R>(out: &mut impl Write, run: &Run<R>, scenario: &Scenario, wall: f64) -> fmt::Result {
    let Run { seconds, health, .. } = run;
    let ratio = seconds / wall;
    writeln!(out)?;
    line(
        out,
        "simulated",
        format_args!(
            "{seconds:.1} s at {} Hz in {wall:.2} s: {ratio:.0} times real time",
            scenario.sample_rate_hz
        ),
    )?;
    line(
        out,
        "samples",
        format_args!(
            "{} taken, {} missing, {} late, {} overflowed",
            health.samples, health.missing, health.late, health.overflowed
        ),
    )?;
    let [lost, restarts]: [u32; 2] =
        [health.lost, health.restarts].map(|counts| counts.iter().map(|n| u32::from(*n)).sum());
    line(out, "devices", format_args!("{lost} readings lost, {restarts} restarts"))?;
    for violation in &run.violations {
        line(out, "FORBIDDEN", format_args!("{violation}"))?;
    }
    Ok(())
}

/// Where a two-frame mount has left the gyro, after [`run`].
///
/// # Errors
/// Those of the writer.
pub fn stored(out: &mut impl Write, is_stored: bool, off_vertical_deg: f64) -> fmt::Result {
    let what = if is_stored { "vertical, to store the azimuth" } else { "not stored" };
    line(out, "gyro", format_args!("{what}: truly {off_vertical_deg:.4}° off the base's vertical"))
}

/// Names the dwells that take no part.
fn left_out(out: &mut impl Write, replay: &Replay, conclusion: &Conclusion) -> fmt::Result {
    for Excluded { dwell, stage_deg, from_s, to_s, reason } in excluded(replay, conclusion) {
        let place = format_args!("dwell {dwell}, {stage_deg:.2}°, {from_s:.1}…{to_s:.1} s");
        line(out, "left out", format_args!("{place}: {reason}"))?;
    }
    Ok(())
}

fn dwells(out: &mut impl Write, replay: &Replay, conclusion: &Conclusion) -> fmt::Result {
    writeln!(
        out,
        "\n  {:>3} {:>9} {:>8} {:>7} {:>13} {:>12} {:>6}",
        "#", "stage °", "from s", "for s", "rate °/h", "residual °/h", "σ"
    )?;
    let found = conclusion.disturbances.iter().zip(&conclusion.residuals);
    for (index, (dwell, (why, residual))) in replay.session.dwells().iter().zip(found).enumerate() {
        write!(
            out,
            "  {:>3} {:>9.4} {:>8.2} {:>7.2} {:>13.5} ",
            index + 1,
            degrees(dwell.stage.rad()),
            dwell.start().max(0.0),
            dwell.seconds,
            degrees_per_hour(dwell.rate),
        )?;
        match why {
            Some(why) => writeln!(out, "left out: {why}")?,
            None => writeln!(
                out,
                "{:>12.5} {:>6.2}",
                degrees_per_hour(residual.rate),
                residual.studentised
            )?,
        }
    }
    Ok(())
}

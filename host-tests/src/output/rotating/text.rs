//! The result block of an alignment on a turning platform.

use std::fmt::{self, Write};

use orientation::align::rotating::conclusion::Conclusion;
use orientation::align::rotating::solution::Fit;

use super::json::{DISTURBED, Stages, Stretch, one_speed};
use super::{averages, columns, is_molecular, pitch_and_roll, tilt};
use crate::output::text::{budget, headline, line};
use crate::output::{degrees, positive_zero};
use crate::rotating::Replay;

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
    headline(out, name, &conclusion.verdict, truth_deg, |_| Ok(()))?;
    if let Some(fit) = &conclusion.fit {
        limits(out, replay, fit)?;
        attitude(out, fit)?;
    }
    of_sensor(out, replay, conclusion)?;
    if let Some(fit) = &conclusion.fit {
        stages(out, &fit.into())?;
        budget(out, &fit.budget)?;
    }
    line(out, "assumed", format_args!("{}", replay.assumed.join("; ")))?;
    stretches(out, conclusion)
}

fn limits(out: &mut impl Write, replay: &Replay, fit: &Fit) -> fmt::Result {
    if !replay.noise_is_known() {
        return line(out, "limit", format_args!("none: the noise is estimated from the turns"));
    }
    let [limit, plain] = [fit.limit, fit.plain_limit].map(degrees);
    line(out, "limit", format_args!("{limit:.4}° (Cramér–Rao for the stated noise)"))?;
    if replay.session.setting().sensor.is_flat {
        return Ok(());
    }
    let label = "  were all known";
    line(out, label, format_args!("{plain:.4}° with the sensor's gain, lag and g-sensitivity"))
}

fn attitude(out: &mut impl Write, fit: &Fit) -> fmt::Result {
    let [pitch, roll] = pitch_and_roll(fit).map(|angle| positive_zero(degrees(angle), 5e-5));
    line(out, "pitch, roll", format_args!("{pitch:.4}°, {roll:.4}°"))?;
    line(out, "tilt", format_args!("{:.4}° of the platform", degrees(tilt(fit))))?;
    if fit.ratio_sigma.is_finite() {
        let (ratio, sigma) = (fit.ratio, fit.ratio_sigma);
        return line(out, "Earth rate", format_args!("{ratio:.4} ± {sigma:.4} of that expected"));
    }
    line(out, "Earth rate", format_args!("taken for granted: the sensor's gain is not known"))
}

/// What turned: the coupling, the g-sensitivity, the columns.
fn of_sensor(out: &mut impl Write, replay: &Replay, conclusion: &Conclusion) -> fmt::Result {
    for coupling in &conclusion.couplings {
        let [angle, sigma] = [coupling.angle(), coupling.sine_sigma].map(degrees);
        let (lag, turn) = (1e3 * coupling.lag(), coupling.frequency / std::f64::consts::TAU);
        let behind = format_args!("{angle:.5}° ± {sigma:.5}°, {lag:.2} ms late, at {turn:.3} Hz");
        line(out, "coupling", behind)?;
    }
    if let Some(fit) = conclusion.fit.as_ref().filter(|_| is_molecular(replay)) {
        molecular(out, replay, conclusion, fit)?;
    }
    line(out, "model", format_args!("{}", columns(replay, conclusion).join(", ")))
}

/// The g-sensitivity of a molecular-electronic sensor, and what one speed leaves of it.
fn molecular(
    out: &mut impl Write,
    replay: &Replay,
    conclusion: &Conclusion,
    fit: &Fit,
) -> fmt::Result {
    let (ratio, is_one) = (fit.molecular.size(), conclusion.pairs.len() < 2);
    let bias = degrees(one_speed(replay, conclusion, fit).unwrap_or_default());
    let seen = if is_one { "of which one speed shows a part alone" } else { "at the slower speed" };
    line(out, "g-sensitivity", format_args!("{ratio:.4} of the Earth rate, {seen}"))?;
    let what = if is_one {
        format!("the g-sensitivity turns the azimuth, by {bias:.4}° (1σ): turn at a second speed")
    } else {
        format!("would be off by {bias:+.4}° for the g-sensitivity")
    };
    line(out, "one speed alone", format_args!("{what}"))
}

fn stages(out: &mut impl Write, stages: &Stages) -> fmt::Result {
    writeln!(out, "\n  azimuth after each stage of compensation")?;
    for (stage, azimuth) in stages.named() {
        writeln!(out, "    {stage:<28} {azimuth:>9.4}°")?;
    }
    Ok(())
}

fn stretches(out: &mut impl Write, conclusion: &Conclusion) -> fmt::Result {
    writeln!(
        out,
        "\n  {:<18} {:>9} {:>6} {:>9} {:>9} {:>12}",
        "sense", "speed Hz", "turns", "left out", "for s", "uneven by %"
    )?;
    let mut is_complete = true;
    for stretch in averages(conclusion).map(Stretch::from) {
        let Stretch { sense, speed_hz, turns, left_out, seconds, unevenness } = stretch;
        let percent = 100.0 * unevenness;
        writeln!(
            out,
            "  {sense:<18} {speed_hz:>9.5} {turns:>6} {left_out:>9} {seconds:>9.2} {percent:>12.4}"
        )?;
        is_complete &= left_out == 0;
    }
    if is_complete { Ok(()) } else { writeln!(out, "  left out: {DISTURBED}") }
}

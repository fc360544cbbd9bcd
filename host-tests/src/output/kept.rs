//! What was kept after an alignment, in words, as JSON and as figures.

use std::fmt::{self, Write};

use firmware::event::Event;
use orientation::keep::Realigned;
use serde::Serialize;

use super::text::line;
use super::{degrees, positive_zero};
use crate::instrument::Run;
use crate::instrument::kept::{Kept, Point};
use crate::report::{Axis, Figure, Part, Series, Style};

/// What was kept at last, and how well on the way.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// For how long the azimuth was kept, s.
    pub seconds: f64,
    /// Azimuth of body x; none where it was lost, or never known.
    pub azimuth_deg: Option<f64>,
    /// Its 1σ.
    pub sigma_deg: Option<f64>,
    /// Its error.
    pub error_deg: Option<f64>,
    /// The greatest error on the way, in its σ of the moment.
    pub greatest_sigmas: Option<f64>,
    /// Pitch.
    pub pitch_deg: f64,
    /// Roll.
    pub roll_deg: f64,
    /// 1σ of either.
    pub level_sigma_deg: f64,
    /// Errors of pitch and roll.
    pub level_error_deg: [f64; 2],
    /// RMS of the errors of pitch and roll, since an azimuth was kept.
    pub level_rms_deg: [f64; 2],
    /// What the keeper was about.
    pub state: String,
    /// How often a later azimuth agreed with what was kept.
    pub realigned: usize,
}

/// The object of a run that kept something; none of one that did not.
#[must_use]
pub fn object<R>(run: &Run<R>, kept: &Kept) -> Option<Object> {
    let last = kept.last()?;
    let errors = last.azimuth_error();
    let greatest = kept.with_azimuth().map(|(_, [error, sigma])| error.abs() / sigma);
    let fused = |event: &Event| matches!(event, Event::HandedOver(_, _, Realigned::Fused { .. }));
    Some(Object {
        seconds: last.report.seconds,
        azimuth_deg: last.report.azimuth.map(|azimuth| degrees(azimuth.angle)),
        sigma_deg: errors.map(|[_, sigma]| degrees(sigma)),
        error_deg: errors.map(|[error, _]| degrees(error)),
        greatest_sigmas: greatest.reduce(f64::max),
        pitch_deg: degrees(last.report.pitch),
        roll_deg: degrees(last.report.roll),
        level_sigma_deg: degrees(last.report.level_sigma),
        level_error_deg: last.level_error().map(degrees),
        level_rms_deg: level_rms(kept).map(degrees),
        state: last.report.state.to_string(),
        realigned: run.events.iter().filter(|(_, event)| fused(event)).count(),
    })
}

/// RMS of the errors of pitch and roll while an azimuth was kept, rad.
fn level_rms(kept: &Kept) -> [f64; 2] {
    let (mut squares, mut count) = ([0.0; 2], 0.0_f64);
    for (point, _) in kept.with_azimuth() {
        for (sum, error) in squares.iter_mut().zip(point.level_error()) {
            *sum += error * error;
        }
        count += 1.0;
    }
    squares.map(|sum| (sum / count.max(1.0)).sqrt())
}

/// Writes the block.
///
/// # Errors
/// Those of the writer.
pub fn block(out: &mut impl Write, object: &Object) -> fmt::Result {
    writeln!(out, "\n  kept for {:.0} s", object.seconds)?;
    match (object.azimuth_deg, object.sigma_deg, object.error_deg) {
        (Some(azimuth), Some(sigma), Some(error)) => {
            line(out, "azimuth of body x", format_args!("{azimuth:.4}° ± {sigma:.4}° (1σ)"))?;
            let greatest = object.greatest_sigmas.unwrap_or(0.0);
            let sigmas = error / sigma;
            line(
                out,
                "its error",
                format_args!("{error:+.4}°, {sigmas:+.2} σ; {greatest:.2} σ at most on the way"),
            )?;
        }
        _ => line(out, "azimuth of body x", format_args!("not known any more"))?,
    }
    let [pitch, roll] = [object.pitch_deg, object.roll_deg].map(|angle| positive_zero(angle, 5e-4));
    let sigma = object.level_sigma_deg;
    line(out, "pitch, roll", format_args!("{pitch:.3}°, {roll:.3}°, each ± {sigma:.3}° (1σ)"))?;
    let [pitch, roll] = object.level_rms_deg;
    line(out, "their errors", format_args!("{pitch:.3}°, {roll:.3}° RMS on the way"))?;
    line(out, "state", format_args!("{}", object.state))?;
    match object.realigned {
        0 => Ok(()),
        times => line(out, "realigned", format_args!("{times} time(s)")),
    }
}

/// The figures: the azimuth's error against its σ, and pitch and roll.
#[must_use]
pub fn figures(kept: &Kept) -> Vec<Part> {
    if kept.with_azimuth().next().is_none() {
        return Vec::new();
    }
    [heading(kept), level(kept)].into_iter().map(Part::from).collect()
}

fn heading(kept: &Kept) -> Figure {
    let all =
        || kept.with_azimuth().map(|(point, [e, s])| (point.seconds(), degrees(e), degrees(s)));
    let band =
        |times: f64| all().map(move |(at, _, sigma)| (at, 0.0, [-times * sigma, times * sigma]));
    Figure {
        title: "Error of the kept azimuth, and its stated 1σ and 3σ".to_owned(),
        x: Axis::linear("time from power-on", "s"),
        y: Axis::linear("error", "°"),
        series: vec![
            Series::new("±3σ", Style::Band, band(3.0)),
            Series::new("±1σ", Style::Band, band(1.0)),
            Series::new("error", Style::Line, all().map(|(at, error, _)| (at, error))),
        ],
    }
}

fn level(kept: &Kept) -> Figure {
    let curve = |name: &str, of: &dyn Fn(&Point) -> f64| {
        let points = kept.with_azimuth().map(|(point, _)| (point.seconds(), degrees(of(point))));
        Series::new(name, Style::Line, points)
    };
    Figure {
        title: "Pitch and roll while the azimuth was kept".to_owned(),
        x: Axis::linear("time from power-on", "s"),
        y: Axis::linear("angle", "°"),
        series: vec![
            curve("true pitch", &|point| point.truth.pitch_rad),
            curve("true roll", &|point| point.truth.roll_rad),
            curve("error of pitch", &|point| point.level_error()[0]),
            curve("error of roll", &|point| point.level_error()[1]),
        ],
    }
}

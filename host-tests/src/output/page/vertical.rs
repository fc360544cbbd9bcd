//! The page of an attitude that was kept: errors beside their σ, the angles, the gyros' biases.

use crate::output::vertical::json::Object;
use crate::output::{degrees, degrees_per_hour, named};
use crate::report::{Axis, Figure, Part, Point, Report, Series, Style, Table};
use crate::vertical::errors::{Errors, Off};
use crate::vertical::{Moment, Replay};
use orientation::keep::attitude::angles;

/// Most points of a curve.
const POINTS: usize = 1500;

/// The page for a replay of `name`.
#[must_use]
pub fn report(name: &str, replay: &Replay, errors: Option<&Errors>, object: &Object) -> Report {
    let mut parts: Vec<Part> = Vec::new();
    if let Some(errors) = errors {
        parts.push(inclination(&errors.off).into());
        parts.push(heading(&errors.off).into());
    } else {
        parts.push(sigma(&replay.moments).into());
    }
    parts.push(level(&replay.moments).into());
    parts.push(biases(&replay.moments).into());
    parts.push(states(object).into());
    Report { title: format!("Pitch and roll: {name}"), subtitle: subtitle(object), parts }
}

fn subtitle(object: &Object) -> Vec<String> {
    let mut lines = vec![match (object.pitch_deg, object.roll_deg, &object.reason) {
        (Some(pitch), Some(roll), _) => {
            let sigma = object.sigma_deg;
            format!("at the end pitch {pitch:.4}°, roll {roll:.4}° ± {sigma:.4}° (1σ)")
        }
        (_, _, reason) => format!("no level: {}", reason.as_deref().unwrap_or_default()),
    }];
    lines.extend(object.errors.map(|errors| {
        let (inclination, heading) = (errors.inclination_rmse_deg, errors.heading_rmse_deg);
        format!("RMS error: inclination {inclination:.4}°, heading {heading:.4}°")
    }));
    lines
}

/// A curve over the time with no more points than can be seen.
fn curve<T, P: Into<Point>>(name: &str, style: Style, all: &[T], of: impl Fn(&T) -> P) -> Series {
    Series::new(name, style, all.iter().step_by(1 + all.len() / POINTS).map(of))
}

fn over_time(title: &str, label: &str, unit: &str, series: Vec<Series>) -> Figure {
    let (x, y) = (Axis::linear("time", "s"), Axis::linear(label, unit));
    Figure { title: title.to_owned(), x, y, series }
}

fn inclination(off: &[Off]) -> Figure {
    let tilt = |axis: usize| move |off: &Off| (off.time_s, off.tilts_deg[axis]);
    let limits = |off: &Off| (off.time_s, 0.0, [-off.sigma_deg, off.sigma_deg]);
    let series = vec![
        curve("±σ", Style::Band, off, limits),
        curve("about north of the level frame", Style::Line, off, tilt(1)),
        curve("about east of the level frame", Style::Line, off, tilt(0)),
        curve("inclination", Style::Dashed, off, |off| (off.time_s, off.inclination_deg)),
    ];
    over_time("Error of the vertical, where the truth counts", "tilt", "°", series)
}

fn heading(off: &[Off]) -> Figure {
    let series = vec![curve("heading", Style::Line, off, |off| (off.time_s, off.heading_deg))];
    over_time("Error of the heading after one constant offset", "heading", "°", series)
}

fn sigma(moments: &[Moment]) -> Figure {
    let of = |moment: &Moment| (moment.time_s, degrees(moment.level_sigma));
    let series = vec![curve("1σ of pitch and of roll", Style::Line, moments, of)];
    over_time("How good pitch and roll are", "1σ", "°", series)
}

fn level(moments: &[Moment]) -> Figure {
    let of = |index: usize| {
        move |moment: &Moment| (moment.time_s, degrees(angles(moment.attitude)[index]))
    };
    let series = vec![
        curve("pitch", Style::Line, moments, of(1)),
        curve("roll", Style::Line, moments, of(2)),
    ];
    over_time("Pitch and roll", "angle", "°", series)
}

fn biases(moments: &[Moment]) -> Figure {
    let axes = ["forward", "right", "down"].into_iter().enumerate();
    let series = axes.flat_map(|(axis, name)| {
        let bias = move |moment: &Moment| degrees_per_hour(moment.biases[axis]);
        let sigma = move |moment: &Moment| degrees_per_hour(moment.bias_sigmas[axis]);
        let limits = move |moment: &Moment| {
            let (bias, sigma) = (bias(moment), sigma(moment));
            (moment.time_s, bias, [bias - sigma, bias + sigma])
        };
        [
            curve(&format!("{name} ±σ"), Style::Band, moments, limits),
            curve(name, Style::Line, moments, move |moment| (moment.time_s, bias(moment))),
        ]
    });
    over_time("Biases of the gyros as they were learnt", "bias", "°/h", series.collect())
}

fn states(object: &Object) -> Table {
    let row = |met: &crate::output::vertical::json::State| {
        vec![met.state.to_owned(), format!("{:.2}", met.seconds)]
    };
    Table {
        title: "States that were met".to_owned(),
        head: named(&["state", "time, s"]),
        rows: object.states.iter().map(row).collect(),
    }
}

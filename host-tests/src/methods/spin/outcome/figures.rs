//! Figures of a spinning body over the time.

use orientation::roll::{Condition, State};

use crate::methods::spin::errors::Errors;
use crate::methods::spin::track::{Point, Track};
use crate::methods::spin::{Replay, name};
use crate::output::degrees;
use crate::recording::Truth;
use crate::report::{self, Axis, Figure, Kind, Lane, Series, Stretch, Style, Timeline};

/// Length of the fragment between corrections, s: the paper's Fig. 8.
const FRAGMENT_S: f64 = 0.03;

/// What a lock takes to settle, s: errors before are not counted.
const SETTLED_S: f64 = 0.1;

/// Roll errors of the methods over the time, then a fragment at the end; none without the truth.
pub(crate) fn errors(replay: &Replay, truth: &Truth) -> Vec<Figure> {
    let end_s = replay.answer().end.time_s;
    let whole = figure(replay, truth, "Roll error of the methods over the time", 0.0);
    let fragment = figure(
        replay,
        truth,
        "The same between corrections (Nekrasova 2017, Fig. 8)",
        (end_s - FRAGMENT_S).max(0.0),
    );
    [whole, fragment].into_iter().flatten().collect()
}

/// Error of the answer within its σ, after the first tenth of a second; none without the truth.
pub(crate) fn error(replay: &Replay, truth: &Truth) -> Option<Figure> {
    let answer = replay.answer();
    let errors = Errors::of(answer, &truth.roll_rad)?;
    let all: Vec<(f64, f64, f64)> = answer
        .over_time(&errors.wrapped_rad)
        .into_iter()
        .zip(&answer.sigmas_rad)
        .map(|((time_s, error), sigma)| (time_s, error, degrees(*sigma)))
        .filter(|(time_s, _, sigma)| *time_s >= SETTLED_S && sigma.is_finite())
        .collect();
    let band = |(time_s, _, sigma): &(f64, f64, f64)| report::Point::within(*time_s, 0.0, *sigma);
    let series = [
        Series::of("±1σ", Style::Band, &all, band),
        Series::of("error", Style::Line, &all, |(time_s, error, _)| (*time_s, *error)),
    ];
    let title = "Error of the roll by phase lock, and its stated 1σ";
    Some(Figure::over_time(title, ["roll error", "°"], series))
}

fn figure(replay: &Replay, truth: &Truth, title: &str, from_s: f64) -> Option<Figure> {
    let series: Vec<Series> =
        replay.tracks.iter().filter_map(|track| curve(track, truth, from_s)).collect();
    (!series.is_empty()).then(|| Figure::over_time(title, ["roll error", "°"], series))
}

fn curve(track: &Track, truth: &Truth, from_s: f64) -> Option<Series> {
    let errors = Errors::of(track, &truth.roll_rad)?;
    let all = track.over_time(&errors.wrapped_rad);
    let from = all.partition_point(|(time_s, _)| *time_s < from_s);
    Some(Series::of(name(track.method), Style::Line, &all[from..], |point| *point))
}

/// σ of the answer, the bound, and the size of the error where the truth is there.
pub(crate) fn sigmas(replay: &Replay, truth: &Truth) -> Figure {
    let answer = replay.answer();
    let stated = answer.points.iter().filter_map(|p| Some((p.time_s, degrees(p.sigma_rad?))));
    let mut series = vec![Series::new("σ of the phase lock", Style::Line, stated)];
    if let Some(errors) = Errors::of(answer, &truth.roll_rad) {
        let all = answer.over_time(&errors.wrapped_rad);
        let size = |(time_s, error): &(f64, f64)| (*time_s, error.abs());
        series.insert(0, Series::of("size of the error", Style::Line, &all, size));
    }
    if let Some(bounds) = &replay.bounds {
        let all = answer.over_time(bounds);
        series.push(Series::of("limit (Cramér–Rao)", Style::Dashed, &all, |point| *point));
    }
    Figure::over_time("σ of the roll", Axis::logarithmic("roll", "°"), series)
}

/// The lift over the time.
pub(crate) fn lift(replay: &Replay) -> Figure {
    let points = replay.answer().points.iter();
    let lifts = points.filter_map(|point| Some((point.time_s, point.lift?)));
    Figure::over_time("Lift", ["lift", "m/s²"], [Series::new("lift", Style::Line, lifts)])
}

/// The scale error over the time, within its σ.
pub(crate) fn scale(replay: &Replay) -> Figure {
    let found = |point: &Point| {
        let [scale, sigma] = point.scale?;
        Some(report::Point::within(point.time_s, scale, sigma))
    };
    let points: Vec<_> = replay.answer().points.iter().filter_map(found).collect();
    // What is not known yet would hide what is found.
    let settled = points.len() / 20;
    let shown = points.iter().skip(settled).copied();
    let series = [
        Series::new("within 1σ", Style::Band, shown.clone()),
        Series::new("scale error", Style::Line, shown.map(|point| (point.x, point.y))),
    ];
    let title = "Scale error of the gyro, after the first twentieth";
    Figure::over_time(title, ["gyro/true − 1", ""], series)
}

/// What the phase lock did when.
pub(crate) fn timeline(answer: &Track) -> Timeline {
    let ends = answer.states.iter().skip(1).map(|(from_s, _)| *from_s);
    let ends = ends.chain([answer.end.time_s]);
    let stretch = |((from_s, state), to_s): (&(f64, State), f64)| Stretch {
        from_s: *from_s,
        to_s,
        kind: kind(state.condition),
        words: state.to_string(),
    };
    let spans = answer.states.iter().zip(ends).map(stretch);
    Timeline::of(vec![Lane::new("phase lock", spans)])
}

fn kind(condition: Condition) -> Kind {
    match condition {
        Condition::Locked => Kind::Used,
        Condition::Searching | Condition::NotSpinning => Kind::Searching,
        Condition::Holding => Kind::Coasting,
        _ => Kind::Wrong,
    }
}

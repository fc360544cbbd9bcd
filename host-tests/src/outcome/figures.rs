//! Figures of what was kept after an alignment, and when what went wrong.

use std::mem::discriminant;

use embassy_time::Instant;
use firmware::event::Event;
use orientation::alignment::Azimuth;
use orientation::attitude::Trust;
use orientation::units::{self, Radians};

use crate::campaign::faults::notice;
use crate::instrument::kept::{Kept, Point};
use crate::output::{azimuth as in_circle, azimuth_error, degrees, seconds};
use crate::report::{self, Axis, Figure, Kind, Lane, Series, Shape, Stretch, Style};

/// The name of a true angle, and the angle, °.
type Truth = (&'static str, fn(&Point) -> f64);

/// A point with an azimuth: when, s; azimuth, its 1σ and its error, °.
type Moment<'a> = (&'a Point, f64, [f64; 3]);

/// The azimuth within its σ and its error, pitch and roll; errors only where the truth is known.
pub(super) fn all(kept: &Kept) -> Vec<Figure> {
    let moments: Vec<Moment<'_>> = kept
        .points
        .iter()
        .filter_map(|point| Some((point, point.seconds(), point.azimuth_deg()?)))
        .collect();
    if moments.is_empty() {
        return Vec::new();
    }
    let is_true = moments.iter().any(|(.., [_, _, error])| !error.is_nan());
    let mut page = vec![azimuth(&moments, is_true)];
    page.extend(is_true.then(|| error(&moments)));
    page.push(level(&moments, is_true));
    page.extend(is_true.then(|| level_errors(&moments)));
    page
}

fn over_time(title: &str, axis: impl Into<Axis>, series: Vec<Series>) -> Figure {
    Figure::new(title, ["time from power-on", "s"], axis, series)
}

/// Azimuths one after the other, without the step at north.
fn unwrapped(moments: &[Moment<'_>]) -> Vec<(f64, f64, f64, f64)> {
    let mut before = moments[0].2[0];
    let near = |&(_, at, [azimuth, sigma, error]): &Moment<'_>| {
        before += azimuth_error(azimuth, before);
        (at, before, sigma, before - error)
    };
    moments.iter().map(near).collect()
}

fn azimuth(moments: &[Moment<'_>], is_true: bool) -> Figure {
    let all = unwrapped(moments);
    let mut series = vec![
        Series::of("kept ±1σ", Style::Band, &all, |&(at, azimuth, sigma, _)| {
            report::Point::within(at, azimuth, sigma)
        }),
        Series::of("kept", Style::Line, &all, |&(at, azimuth, ..)| (at, azimuth)),
    ];
    let truth = || Series::of("truth", Style::Dashed, &all, |&(at, _, _, truth)| (at, truth));
    series.extend(is_true.then(truth));
    over_time("Azimuth as it was kept", Axis::circle("azimuth"), series)
}

fn error(moments: &[Moment<'_>]) -> Figure {
    let band = |times: f64| {
        move |&(_, at, [_, sigma, _]): &Moment<'_>| report::Point::within(at, 0.0, times * sigma)
    };
    let series = vec![
        Series::of("error ±3σ", Style::WideBand, moments, band(3.0)),
        Series::of("error ±1σ", Style::Band, moments, band(1.0)),
        Series::of("error", Style::Line, moments, |&(_, at, [.., error])| (at, error)),
    ];
    let title = "Error of the kept azimuth, and its stated 1σ and 3σ";
    over_time(title, ["error", "°"], series).shaped(Shape::Low)
}

fn level(moments: &[Moment<'_>], is_true: bool) -> Figure {
    let band = |of: fn(&Point) -> f64| {
        move |&(point, at, _): &Moment<'_>| {
            report::Point::within(at, of(point), point.report.level_sigma.degrees())
        }
    };
    let curve = |of: fn(&Point) -> f64| move |&(point, at, _): &Moment<'_>| (at, of(point));
    let [pitch, roll]: [fn(&Point) -> f64; 2] =
        [|point| point.report.pitch.degrees(), |point| point.report.roll.degrees()];
    let mut series = vec![
        Series::of("pitch ±1σ", Style::Band, moments, band(pitch)),
        Series::of("roll ±1σ", Style::Band, moments, band(roll)),
        Series::of("pitch", Style::Line, moments, curve(pitch)),
        Series::of("roll", Style::Line, moments, curve(roll)),
    ];
    let truths: [Truth; 2] = [
        ("true pitch", |point| degrees(point.truth.pitch_rad)),
        ("true roll", |point| degrees(point.truth.roll_rad)),
    ];
    let truths = truths.map(|(name, of)| Series::of(name, Style::Dashed, moments, curve(of)));
    series.extend(truths.into_iter().filter(|_| is_true));
    over_time("Pitch and roll as they were kept", ["angle", "°"], series)
}

fn level_errors(moments: &[Moment<'_>]) -> Figure {
    let off =
        |axis: usize| move |&(point, at, _): &Moment<'_>| (at, degrees(point.level_error()[axis]));
    let band = |&(point, at, _): &Moment<'_>| {
        report::Point::within(at, 0.0, point.report.level_sigma.degrees())
    };
    let series = vec![
        Series::of("±1σ", Style::Band, moments, band),
        Series::of("pitch", Style::Line, moments, off(0)),
        Series::of("roll", Style::Line, moments, off(1)),
    ];
    over_time("Errors of pitch and roll", ["error", "°"], series).shaped(Shape::Low)
}

/// When each of several alignments found which azimuth.
pub(super) fn alignments(found: &[(units::Instant, Azimuth)]) -> Option<Lane> {
    let mark = |(index, (at, azimuth)): (usize, &(units::Instant, Azimuth))| {
        let [angle, sigma] = [azimuth.angle, azimuth.sigma].map(Radians::degrees);
        let (number, angle) = (index + 1, in_circle(angle, 4));
        let at_s = at.seconds();
        let words = format!("alignment {number}, {at_s:.1} s: {angle}° ± {sigma:.4}° (1σ)");
        Stretch { from_s: at_s, to_s: at_s, kind: Kind::Used, words }
    };
    (found.len() > 1).then(|| Lane::new("azimuth found", found.iter().enumerate().map(mark)))
}

/// What alignments did before the latest one that found an azimuth.
pub(super) fn earlier(stretches: &[Stretch]) -> Option<Lane> {
    let lane = || Lane::new("alignments before", stretches.iter().cloned());
    (!stretches.is_empty()).then(lane)
}

/// How far the level could be relied on while something was kept.
pub(super) fn lanes(kept: &Kept) -> Vec<Lane> {
    let same = |a: &Point, b: &Point| {
        let [a, b] = [a, b].map(|point| point.report);
        discriminant(&a.state.trust) == discriminant(&b.state.trust) && a.is_at_rest == b.is_at_rest
    };
    let stretch = |points: &[Point]| {
        let (first, last) = (points.first()?, points.last()?);
        let words = if last.report.is_at_rest {
            "at rest".to_owned()
        } else {
            format!("in motion, {}", last.report.state)
        };
        let kind = kind(last);
        Some(Stretch { from_s: first.seconds(), to_s: last.seconds() + 1.0, kind, words })
    };
    // Before there is an azimuth nothing is kept.
    let begun = kept.points.iter().position(|point| point.report.azimuth.is_some());
    let points = begun.map_or(&[][..], |begun| &kept.points[begun..]);
    let spans: Vec<Stretch> = points.chunk_by(same).filter_map(stretch).collect();
    if spans.is_empty() { Vec::new() } else { vec![Lane::new("keeping", spans)] }
}

/// At rest a keeper measures; in motion its accelerometers correct the level, or the gyros carry it alone.
fn kind(point: &Point) -> Kind {
    match (point.report.is_at_rest, point.report.state.trust) {
        (true, _) => Kind::Used,
        (false, Trust::Coasting) => Kind::Coasting,
        (false, _) => Kind::Between,
    }
}

/// When a board reported that something is wrong.
pub(super) fn faults(events: &[(Instant, Event)]) -> Vec<Lane> {
    let wrong = events.iter().filter(|(_, event)| notice::is_wrong(event));
    let mark = |(at, event): &(Instant, Event)| {
        let at_s = seconds(*at);
        Stretch {
            from_s: at_s,
            to_s: at_s,
            kind: Kind::Wrong,
            words: format!("{at_s:.3} s: {event}"),
        }
    };
    let spans: Vec<Stretch> = wrong.take(report::POINTS).map(mark).collect();
    if spans.is_empty() { Vec::new() } else { vec![Lane::new("faults", spans)] }
}

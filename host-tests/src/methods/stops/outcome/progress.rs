//! Where a vehicle went, what the solution leaves of its stops, how the azimuth converged, and what was done when.

use orientation::alignment::stops::conclusion::Found;
use orientation::alignment::stops::session::Session;
use orientation::alignment::stops::stop_detector::Rests;
use orientation::units::{Radians, Seconds, wrapped};

use super::{BLOWN, StopDetails};
use crate::methods::stops::Replay;
use crate::output::degrees;
use crate::recording::ImuRow;
use crate::report::{
    Axis, Figure, Kind, Lane, Milestone, Note, POINTS, Point, Series, Shape, Stretch, Style,
    Timeline, convergence as figures,
};

/// How many conclusions are drawn at most.
const CONCLUSIONS: usize = 16;
/// How many times as great σ is at least after a drive that is told, and the words.
const DRIVEN: f64 = 1.01;
const DROVE_ON: &str = "the drive after the last stop";
/// Why σ grows although the vehicle stands on.
const DOUBTED: &str = "biases beyond stated";

/// The way as the forces have it, fitted to the stops; none where no place but the first is known.
pub(super) fn track(replay: &Replay, rows: &[ImuRow], found: &Found) -> Option<Figure> {
    let stops = replay.session.stops().iter().map_while(|stop| stop.displacement);
    let stops: Vec<[f64; 2]> = stops.map(|place| place.map(|part| part.0)).collect();
    if stops.len() < 2 {
        return None;
    }
    let drives = replay.drives(rows, found.start.angle);
    let path = drives.iter().zip(&stops).flat_map(|(driven, from)| {
        let step = driven.path_m.len().div_ceil(POINTS).max(1);
        let places = driven.path_m.iter().step_by(step).chain(driven.path_m.last());
        places.map(|place| (from[1] + place[1], from[0] + place[0]))
    });
    let at = |place: &[f64; 2]| (place[1], place[0]);
    let series = [
        Series::new("way by the forces, fitted to the stops", Style::Line, path),
        Series::new("stops", Style::Points, stops.iter().map(at)),
    ];
    let notes = stops.iter().enumerate().map(|(index, place)| Note {
        x: place[1],
        y: place[0],
        text: format!("stop {}", index + 1),
    });
    let [east, north] = [["east", "m"], ["north", "m"]].map(Axis::from);
    let figure = Figure::new("Where the vehicle went", east, north, series);
    Some(figure.noted(notes).shaped(Shape::Map))
}

/// What the solution leaves of the vertical at each stop; none where it says nothing of any. The biases of the
/// accelerometers tilt it, too.
pub(super) fn residuals(replay: &Replay, stops: &[StopDetails]) -> Option<Figure> {
    let site = &replay.session.setting.site;
    let biased = degrees(site.accelerometer_bias_sigma.0 / site.latitude.gravity().0);
    let of = |axis: usize| {
        let points = stops.iter().filter_map(move |stop| {
            let middle = 0.5 * (stop.from_s + stop.to_s);
            let sigma = stop.residual_sigma_deg?.hypot(biased);
            Some(Point::within(middle, stop.residual_deg?[axis], sigma))
        });
        points.collect::<Vec<_>>()
    };
    let series =
        [("north", 0), ("east", 1)].map(|(name, axis)| Series::new(name, Style::Points, of(axis)));
    let title = "What the solution leaves of the vertical at each stop, with 1σ of noise and accelerometers";
    let is_there = !of(0).is_empty();
    is_there.then(|| Figure::over_time(title, ["tilt", "°"], series).shaped(Shape::Low))
}

/// The azimuth at the end as more and more of each further stop, or of a single one, shows it.
pub(super) fn convergence(
    replay: &Replay,
    rows: &[ImuRow],
    found: &Found,
    truth_deg: Option<f64>,
) -> Vec<Figure> {
    let stops = replay.session.stops();
    let first = usize::from(replay.session.procedure.rests != Rests::Whole);
    let after = stops.get(first..).unwrap_or_default();
    let parts = (CONCLUSIONS / after.len().max(1)).max(1);
    let ends = after.iter().flat_map(|stop| {
        let part = move |part: usize| stop.seconds().0 * part as f64 / parts as f64;
        (1..=parts).map(move |index| Seconds(stop.from.0 + part(index)))
    });
    let known: Vec<(Seconds, Found)> =
        ends.filter_map(|end| Some((end, known(replay, rows, end)?))).collect();
    // By what the vehicle turned since the start, the last of them is carried to what was found.
    let Some((_, last)) = known.last() else { return Vec::new() };
    let turned = found.azimuth.angle.0 - last.start.angle.0;
    let milestone = |(end, known): &(Seconds, Found)| {
        let carried = Radians(wrapped(known.start.angle.0 + turned));
        Milestone::new(replay.zero_s + end.0, [carried, known.azimuth.sigma, known.limit])
    };
    let mut all: Vec<Milestone> = known.iter().map(milestone).collect();
    for (index, pair) in known.windows(2).enumerate() {
        let [before, after] = [&pair[0].1, &pair[1].1].map(|found| found.widening);
        all[index + 1].remark = (after > 1.0 && before <= 1.0).then_some(DOUBTED);
    }
    if let Some(last) = all.last_mut() {
        drive_on(last, found);
    }
    figures("Azimuth at the end", &all, truth_deg)
}

/// What was found at last knows the drive after the last stop, too.
fn drive_on(last: &mut Milestone, found: &Found) {
    let before = last.sigma_deg;
    [last.sigma_deg, last.limit_deg] = [found.azimuth.sigma, found.limit].map(Radians::degrees);
    last.remark = (last.sigma_deg > DRIVEN * before).then_some(DROVE_ON);
}

/// What is known at a time; none where that is nothing.
fn known(replay: &Replay, rows: &[ImuRow], end: Seconds) -> Option<Found> {
    let session = replay.until(rows, end)?;
    let conclusion = session.conclusion()?;
    conclusion.found.filter(|_| conclusion.verdict.is_ok())
}

/// When the vehicle stood and when it drove, and which seconds of its stops were left out.
pub(super) fn timeline(replay: &Replay) -> Timeline {
    let stood = stretches(&replay.session, replay.zero_s);
    let is_in = |[from, to]: &&[f64; 2]| {
        replay.session.stops().iter().any(|stop| stop.from.0 <= *from && *to <= stop.to.0)
    };
    let left_out = replay.left_out.iter().filter(is_in).map(|span| {
        let [from_s, to_s] = span.map(|time| replay.zero_s + time);
        let words = format!("left out from {from_s:.1} s to {to_s:.1} s: {BLOWN}");
        Stretch { from_s, to_s, kind: Kind::LeftOut, words }
    });
    Timeline::of(vec![Lane::new("vehicle", stood.into_iter().chain(left_out))])
}

/// The stops of a session that began at a time, s, and the drives between them.
pub(super) fn stretches(session: &Session, zero_s: f64) -> Vec<Stretch> {
    let stops = session.stops();
    let at = |time: Seconds| zero_s + time.0;
    let stood = stops.iter().enumerate().map(|(index, stop)| Stretch {
        from_s: at(stop.from),
        to_s: at(stop.to),
        kind: Kind::Used,
        words: format!("stop {}: {:.0} s", index + 1, stop.seconds().0),
    });
    let drove = stops.windows(2).map(|pair| Stretch {
        from_s: at(pair[0].to),
        to_s: at(pair[1].from),
        kind: Kind::Between,
        words: format!("drive of {:.0} s", pair[1].from.0 - pair[0].to.0),
    });
    let mut spans: Vec<Stretch> = stood.chain(drove).collect();
    spans.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    spans
}

//! Figures of an alignment at standstills: the fit with all that it knows, what it leaves, and how the azimuth came to
//! stand.

use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::fit::{Fit, Prediction};
use orientation::alignment::stepwise::session::Session;
use orientation::signal::dwell::Dwell;

use super::{predicted, unexplained_deg_h};
use crate::methods::stepwise::subtracts_sway;
use crate::output::{azimuth_error, degrees, degrees_per_hour};
use crate::report::{
    Axis, BREAK, Figure, Kind, Lane, Milestone, POINTS, Point, Series, Shape, Stretch, Style,
    Timeline, convergence as figures,
};

/// A dwell as figures show it.
struct Shown<'a> {
    dwell: &'a Dwell,
    /// What the fit says of it; none of a dwell that was left out.
    prediction: Option<Prediction>,
    /// Where the axis of the figures begins, °.
    zero_deg: f64,
}

impl Shown<'_> {
    /// The stage angle on the figures' axis, °.
    fn stage_deg(&self) -> f64 {
        around(self.zero_deg, degrees(self.dwell.stage.rad()))
    }

    /// The mean rate with the 1σ of its own noise, as it is where the dwell was left out, °/h.
    fn measured(&self) -> Point {
        let (x, y) = (self.stage_deg(), degrees_per_hour(self.dwell.rate.0));
        match self.prediction {
            Some(prediction) => Point::within(x, y, degrees_per_hour(prediction.sigma.0)),
            None => (x, y).into(),
        }
    }

    /// What the whole model does not explain of the rate, with its 1σ, °/h.
    fn unexplained(&self) -> Option<Point> {
        let [rate, sigma] = unexplained_deg_h(self.dwell, &self.prediction?);
        Some(Point::within(self.stage_deg(), rate, sigma))
    }
}

/// The fit over the stage angle, and what it leaves of each dwell.
pub(super) fn fit(session: &Session, conclusion: &Conclusion, fit: &Fit) -> [Figure; 2] {
    let dwells = shown(session, conclusion);
    let kept = || dwells.iter().filter(|shown| shown.prediction.is_some());
    let left_out: Vec<Point> =
        dwells.iter().filter(|shown| shown.prediction.is_none()).map(Shown::measured).collect();
    let path = path(&kept().collect::<Vec<_>>(), zero_deg(session), |angle| {
        let direction = &fit.direction;
        let latitude = session.setting.site.latitude;
        let rate = latitude.horizontal_rate().0 * direction.amplitude;
        degrees_per_hour(rate * (direction.azimuth + angle.to_radians()).cos())
    });
    let mut series = vec![
        Series::new("the whole model", Style::Line, path),
        Series::new("dwells, each with its 1σ", Style::Points, kept().map(Shown::measured)),
    ];
    if !left_out.is_empty() {
        series.push(Series::new("left out", Style::Hollow, left_out));
    }
    let unexplained = kept().filter_map(Shown::unexplained);
    let left = [Series::new("measured less the whole model", Style::Points, unexplained)];
    let angle = || axis(&dwells);
    let also = if subtracts_sway(session) {
        ", which follows the noise of the sway from dwell to dwell"
    } else if fit.budget.drift.0 > 0.0 {
        ", which follows the gyro's drift from dwell to dwell"
    } else {
        ""
    };
    let title = format!("Mean rate of each dwell, and the fit{also}");
    [
        Figure::new(title, angle(), ["rate", "°/h"], series),
        Figure::new("Residuals of the fit", angle(), ["unexplained", "°/h"], left)
            .shaped(Shape::Low),
    ]
}

/// The dwells with what the fit says of each.
fn shown<'a>(session: &'a Session, conclusion: &Conclusion) -> Vec<Shown<'a>> {
    let zero_deg = zero_deg(session);
    let both = session.dwells().iter().zip(predicted(session, conclusion));
    both.map(|(dwell, prediction)| Shown { dwell, prediction, zero_deg }).collect()
}

/// Angles between neighbours of a curve at most, °.
const STEP: f64 = 2.0;
/// Angles that differ by no more are the same, °.
const SAME: f64 = 1e-6;
/// An arc without dwells of this length makes the others one arc instead of a circle, °.
const OPEN: f64 = 100.0;
/// What the axis of a circle shows beyond its ends, °.
const BEYOND: f64 = 4.0;

/// An angle from `zero` on, within a turn, °.
fn around(zero: f64, angle: f64) -> f64 {
    zero + (angle - zero).rem_euclid(360.0)
}

/// Where the axis of the stage angle begins, °: behind the longest arc without dwells, or at zero of a circle.
fn zero_deg(session: &Session) -> f64 {
    let angles = session.dwells().iter().map(|dwell| degrees(dwell.stage.rad()).rem_euclid(360.0));
    let mut angles: Vec<f64> = angles.collect();
    angles.sort_unstable_by(f64::total_cmp);
    let following = angles.iter().skip(1).copied().chain(angles.first().map(|first| first + 360.0));
    let gaps = angles.iter().zip(following).map(|(from, to)| (to - from, to));
    let longest = gaps.max_by(|a, b| a.0.total_cmp(&b.0));
    let end = longest.filter(|(length, _)| *length >= OPEN).map(|(_, end)| end.rem_euclid(360.0));
    end.map_or(0.0, |end| if end > 180.0 { end - 360.0 } else { end })
}

/// The axis of the stage angle.
fn axis(dwells: &[Shown]) -> Axis {
    let angles = || dwells.iter().map(Shown::stage_deg);
    let reach = angles().fold(f64::MIN, f64::max) - angles().fold(f64::MAX, f64::min);
    let axis = Axis::from(["stage angle", "°"]);
    if reach > 360.0 - OPEN { axis.between([-BEYOND, 360.0 + BEYOND]) } else { axis }
}

/// A stage angle, °, with the rate that the model gives there, °/h.
type Place = (f64, f64);

/// What the model gives along the way of the stage, and between neighbouring dwells on arcs where it never goes: the
/// horizontal Earth rate of each angle, and all else as it changes evenly from dwell to dwell.
fn path(dwells: &[&Shown], zero: f64, earth_rate: impl Fn(f64) -> f64) -> Vec<Place> {
    let at = |shown: &Shown| Some((shown.stage_deg(), degrees_per_hour(shown.prediction?.rate.0)));
    let all: Vec<Place> = dwells.iter().filter_map(|shown| at(shown)).collect();
    let turned: f64 = all.windows(2).map(|pair| azimuth_error(pair[1].0, pair[0].0).abs()).sum();
    // A stage that goes to and fro has a longer way, of which fewer places can be drawn.
    let ends = (3 * all.len()).min(POINTS / 2);
    let step_deg = STEP.max((turned + 360.0) / (POINTS - ends) as f64);
    let mut path = Vec::new();
    let mut leg = |[(from, before), (to, after)]: [Place; 2]| {
        let way = azimuth_error(to, from);
        let beside = [before - earth_rate(from), after - earth_rate(to)];
        let steps = (way.abs() / step_deg).round().max(1.0);
        for step in 0..=steps as u32 {
            let part = f64::from(step) / steps;
            let angle = from + way * part;
            let rate = earth_rate(angle) + beside[0] + (beside[1] - beside[0]) * part;
            // Where it does not begin at the end of the one before, a leg stands alone.
            let most_deg = if step == 0 { SAME } else { 180.0 };
            push_within(&mut path, (around(zero, angle), rate), most_deg);
        }
    };
    all.windows(2).for_each(|pair| leg([pair[0], pair[1]]));
    unturned(&all).into_iter().for_each(leg);
    path
}

/// Neighbouring dwells of a circle between which the stage never turned.
fn unturned(all: &[Place]) -> Vec<[Place; 2]> {
    let mut places = all.to_vec();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let neighbours = places.iter().zip(places.iter().cycle().skip(1));
    let is_unturned = |(from, to): &(&Place, &Place)| {
        let arc = (to.0 - from.0).rem_euclid(360.0);
        let middle = from.0 + 0.5 * arc;
        let passes = |pair: &[Place]| {
            let way = azimuth_error(pair[1].0, pair[0].0);
            (way.signum() * (middle - pair[0].0)).rem_euclid(360.0) < way.abs()
        };
        (STEP..OPEN).contains(&arc) && !all.windows(2).any(passes)
    };
    neighbours.filter(is_unturned).map(|(from, to)| [*from, *to]).collect()
}

/// Adds a place to a path, which is interrupted where that lies farther off than this, as over the end of the axis.
fn push_within(path: &mut Vec<Place>, point: Place, most_deg: f64) {
    if path.last().is_some_and(|last| (last.0 - point.0).abs() > most_deg) {
        path.push(BREAK);
    }
    path.push(point);
}

/// How many conclusions a figure of their convergence draws at most.
const CONCLUSIONS: usize = 40;
/// Fewest dwells of which one is drawn.
const FEWEST: usize = 3;

/// How azimuth, σ and limit went with each further dwell.
pub(super) fn convergence(session: &Session, truth_deg: Option<f64>) -> Vec<Figure> {
    figures("Azimuth", &milestones(session), truth_deg)
}

/// What the first dwells give, of as many numbers of them as are drawn.
fn milestones(session: &Session) -> Vec<Milestone> {
    let dwells = session.dwells();
    let step = dwells.len().saturating_sub(FEWEST).div_ceil(CONCLUSIONS).max(1);
    let mut numbers: Vec<usize> = (FEWEST..=dwells.len()).rev().step_by(step).collect();
    numbers.reverse();
    numbers.into_iter().filter_map(|number| milestone(session, &dwells[..number])).collect()
}

/// What these dwells give; none where they give no azimuth.
fn milestone(session: &Session, dwells: &[Dwell]) -> Option<Milestone> {
    let conclusion = Conclusion::of(&session.setting, dwells, session.procedure.criterion);
    let (fit, found) = (conclusion.fit.as_ref()?, conclusion.verdict.as_ref().ok()?);
    Some(Milestone::new(dwells.last()?.end().0, [found.angle, found.sigma, fit.limit]))
}

/// Why a dwell was measured again, in words behind those of what it came to; nothing where it was not.
fn again(session: &Session, index: usize) -> String {
    let of_it = session.repetitions.iter().filter(|repetition| repetition.position == index);
    let each = of_it.map(|repetition| format!(", measured again: {}", repetition.why));
    each.collect::<Vec<_>>().concat()
}

/// When the stage stood and when it turned.
pub(super) fn timeline(session: &Session, conclusion: &Conclusion) -> Timeline {
    Timeline::of(vec![Lane::new("dwells", stretches(session, conclusion))])
}

/// Every dwell when it was, and whether it took part.
pub(super) fn stretches(session: &Session, conclusion: &Conclusion) -> Vec<Stretch> {
    let both = session.dwells().iter().zip(&conclusion.disturbances).enumerate();
    let dwells = both.map(|(index, (dwell, why))| {
        let (number, angle) = (index + 1, degrees(dwell.stage.rad()));
        let rate = degrees_per_hour(dwell.rate.0);
        let words = format!("dwell {number} at {angle:.2}°: {rate:.4} °/h");
        let (kind, words) = match why {
            None => (Kind::Used, format!("{words}{}", again(session, index))),
            Some(why) => (Kind::LeftOut, format!("{words}, left out: {why}")),
        };
        Stretch { from_s: dwell.start().0.max(0.0), to_s: dwell.end().0, kind, words }
    });
    dwells.collect()
}

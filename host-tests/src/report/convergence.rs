//! How an azimuth converged, with its σ against the limit.

use orientation::units::Radians;

use crate::output::azimuth_error;

use super::{Axis, BREAK, Figure, Note, Point, Series, Shape, Style};

/// An azimuth on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Milestone {
    /// When, s.
    pub time_s: f64,
    /// What was found until then, °.
    pub azimuth_deg: f64,
    /// 1σ of it, °.
    pub sigma_deg: f64,
    /// Its Cramér–Rao bound for the data until then, °.
    pub limit_deg: f64,
    /// Why σ is not less than before, where that is so.
    pub remark: Option<&'static str>,
}

impl Milestone {
    /// An azimuth that was found until a time, s, its 1σ and its limit.
    #[must_use]
    pub fn new(time_s: f64, found: [Radians; 3]) -> Self {
        let [azimuth_deg, sigma_deg, limit_deg] = found.map(Radians::degrees);
        Self { time_s, azimuth_deg, sigma_deg, limit_deg, remark: None }
    }
}

/// Multiples of the last σ up to which an azimuth is shown: before, it says nothing yet.
const SHOWN: f64 = 12.0;

/// The azimuth over the time, and its σ beside the limit; none of fewer than two milestones. `what` names the azimuth.
#[must_use]
pub fn convergence(what: &str, all: &[Milestone], truth_deg: Option<f64>) -> Vec<Figure> {
    let [_, .., last] = all else { return Vec::new() };
    vec![azimuths(what, all, last, truth_deg), sigmas(all)]
}

fn azimuths(what: &str, all: &[Milestone], last: &Milestone, truth_deg: Option<f64>) -> Figure {
    let shown = || all.iter().filter(|at| at.sigma_deg <= SHOWN * last.sigma_deg);
    let near = |azimuth: f64| last.azimuth_deg + azimuth_error(azimuth, last.azimuth_deg);
    let band = shown().map(|at| Point::within(at.time_s, near(at.azimuth_deg), at.sigma_deg));
    let limit =
        |sign: f64| shown().map(move |at| (at.time_s, last.azimuth_deg + sign * at.limit_deg));
    let limits = limit(1.0).chain([BREAK]).chain(limit(-1.0));
    let curve = shown().map(|at| (at.time_s, near(at.azimuth_deg)));
    let ends = [shown().next().map_or(0.0, |at| at.time_s), last.time_s];
    let mut series = vec![
        Series::new("±1σ", Style::Band, band),
        Series::new("what is known by then", Style::LineAndPoints, curve),
        Series::new("the final one ± the limit", Style::Dotted, limits),
    ];
    series
        .extend(truth_deg.map(|truth| {
            Series::new("truth", Style::Dashed, ends.map(|time| (time, near(truth))))
        }));
    Figure::over_time(format!("{what} as it converged"), ["azimuth", "°"], series)
}

fn sigmas(all: &[Milestone]) -> Figure {
    let curve = |name: &str, style, of: fn(&Milestone) -> f64| {
        Series::new(name, style, all.iter().map(|at| (at.time_s, of(at))))
    };
    let series = [
        curve("σ", Style::LineAndPoints, |at| at.sigma_deg),
        curve("limit (Cramér–Rao)", Style::Dashed, |at| at.limit_deg),
    ];
    let notes = all
        .iter()
        .filter_map(|at| Some(Note { x: at.time_s, y: at.sigma_deg, text: at.remark?.to_owned() }));
    let axis = Axis::logarithmic("1σ of the azimuth", "°");
    Figure::over_time("σ and its limit", axis, series).shaped(Shape::Low).noted(notes)
}

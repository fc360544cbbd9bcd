//! The paper's figures: rate errors and W over the heading error (Figs. 4 and 5), both stop criteria over
//! time (Figs. 6 and 7), the inclination U over the azimuth (Fig. 9).

use orientation::alignment::stops::plain::Plain;
use orientation::earth::Latitude;
use orientation::signal::rest::{Criteria, Limits};
use orientation::units::{Seconds, wrapped};

use crate::methods::stops::Replay;
use crate::output::{degrees, degrees_per_hour};
use crate::report::{Axis, Figure, Point, Series, Style};

/// Places along a curve.
const PLACES: i32 = 240;
/// How far around the minimum the narrow figure of U reaches, in σ of the paper's method, and at least, °.
const REACH_SIGMAS: f64 = 4.0;
const LEAST_REACH_DEG: f64 = 0.02;

/// The inclination U over the whole circle, and near its minimum.
pub(crate) fn inclinations(plain: &Plain) -> [Figure; 2] {
    let reach = (REACH_SIGMAS * plain.sigma.degrees()).clamp(LEAST_REACH_DEG, 90.0);
    let minimum = plain.azimuth.degrees();
    let part = |i| f64::from(i) / f64::from(PLACES);
    let near: Vec<f64> = (-PLACES..=PLACES).map(|i| minimum + reach * part(i)).collect();
    let circle: Vec<f64> = (0..=PLACES).map(|i| 360.0 * part(i)).collect();
    [
        inclination(
            plain,
            "Inclination U over the azimuth at the start (Szymanowski 2003, Fig. 9)",
            &circle,
        ),
        inclination(plain, "Inclination U near its minimum", &near),
    ]
}

fn inclination(plain: &Plain, title: &str, azimuths_deg: &[f64]) -> Figure {
    let curve = |of: &dyn Fn(f64) -> f64| {
        let at = |azimuth: &f64| (*azimuth, degrees(of(wrapped(azimuth.to_radians()))));
        azimuths_deg.iter().map(at).collect::<Vec<_>>()
    };
    let inclination = &plain.inclination;
    let least = (plain.azimuth.degrees(), degrees(inclination.angle(plain.azimuth.0)));
    let series = [
        Series::new("angle between the verticals", Style::Line, curve(&|a| inclination.angle(a))),
        Series::new("√(ΔΘ² + ΔΦ²)", Style::Dashed, curve(&|a| inclination.euler(a))),
        Series::new("closed form", Style::Points, [least]),
    ];
    Figure::new(title, ["azimuth at the start, as assumed", "°"], ["inclination U", "°"], series)
}

/// The stop criteria of rate and force over time (Kryt1 and Kryt2 of Szymanowski 2003), with their thresholds and the stops; none where the session never had them.
pub(crate) fn criteria(replay: &Replay) -> Vec<Figure> {
    if replay.criteria.is_empty() {
        return Vec::new();
    }
    let rate = |criteria: &Criteria, limits: &Limits| {
        [criteria.rate.0, limits.rate.0].map(degrees_per_hour)
    };
    let force = |criteria: &Criteria, limits: &Limits| [criteria.force.0, limits.force.0];
    vec![
        criterion(replay, [STOP_BY_RATE, "Earth's rate less that measured, size", "°/h"], rate),
        criterion(replay, [STOP_BY_FORCE, "gravity less the force measured, size", "m/s²"], force),
    ]
}

/// The criteria by which a vehicle stands, with their formulas.
const STOP_BY_RATE: &str = "Stop criterion of the rates, Ω − |ω|: the Earth's less that measured (Szymanowski 2003, Fig. 6)";
const STOP_BY_FORCE: &str = "Stop criterion of the forces, g − |f|: gravity less the force measured (Szymanowski 2003, Fig. 7)";

/// One criterion: its size and its threshold. On a logarithmic axis: while driving it is a thousand times
/// as great as at rest.
fn criterion(
    replay: &Replay,
    [title, label, unit]: [&str; 3],
    of: impl Fn(&Criteria, &Limits) -> [f64; 2],
) -> Figure {
    let values: Vec<(f64, [f64; 2])> = replay
        .criteria
        .iter()
        .map(|(time, criteria, limits)| (replay.zero_s + time, of(criteria, limits).map(f64::abs)))
        .collect();
    let sizes = || values.iter().map(|(_, [size, _])| *size).filter(|size| *size > 0.0);
    let [low, high] = [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)];
    let mut series = vec![
        Series::of(label, Style::Line, &values, |(time, [size, _])| (*time, *size)),
        Series::of("threshold", Style::Dashed, &values, |(time, [_, limit])| (*time, *limit)),
    ];
    series.extend(replay.session.stops().iter().enumerate().map(|(index, stop)| {
        let edge =
            |time: Seconds| Point { x: replay.zero_s + time.0, y: high, limits: Some([low, high]) };
        let name = format!("stop {}", index + 1);
        Series::new(&name, Style::Band, [edge(stop.from), edge(stop.to)])
    }));
    Figure::over_time(title, Axis::logarithmic(label, unit), series)
}

/// What a wrong azimuth makes of level rates at a latitude: the paper's p′ and q′, and
/// `W = 2 Ω_h |sin(δ/2)|`; beside it U of a drive over its seconds.
pub(crate) fn heading_error(latitude: Latitude, drive: Option<(&Plain, f64)>) -> Figure {
    let horizontal = degrees_per_hour(latitude.horizontal_rate().0);
    let over = |of: &dyn Fn(f64) -> f64| {
        let at = |i| 180.0 * f64::from(i) / f64::from(PLACES);
        (-PLACES..=PLACES).map(at).map(|error| (error, of(error.to_radians()))).collect::<Vec<_>>()
    };
    let line = |name: &str, of: &dyn Fn(f64) -> f64| Series::new(name, Style::Line, over(of));
    let mut series = vec![
        line("p′ = Ω_h (1 − cos δ)", &|error| horizontal * (1.0 - error.cos())),
        line("q′ = Ω_h sin δ", &|error| horizontal * error.sin()),
        line("W = 2 Ω_h |sin(δ/2)|", &|error| 2.0 * horizontal * (0.5 * error).sin().abs()),
    ];
    series.extend(drive.map(|(plain, seconds)| {
        let at = |error: f64| plain.inclination.angle(wrapped(plain.azimuth.0 + error));
        let of = |error: f64| degrees_per_hour(at(error) / seconds);
        Series::new("inclination U of this drive over its time", Style::Dashed, over(&of))
    }));
    let title = "Rate errors of a wrong heading, and their geometric sum W (Szymanowski 2003, Figs. 4 and 5)";
    Figure::new(title, ["heading error δ", "°"], ["rate", "°/h"], series)
}

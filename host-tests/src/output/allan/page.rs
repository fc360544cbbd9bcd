//! What `meridian allan` finds: the curve with its limits, fit and asymptotes, and all numbers.

use orientation::noise::allan::{terms, variance};
use orientation::noise::fit::Estimate;

use super::super::degrees_per_hour;
use super::{Coefficient, coefficients, short};
use crate::allan::analysis::{Analysis, Confident};
use crate::report::{Axis, Columns, Figure, Part, Point, Series, Style};

/// Beyond so many times the least and the greatest deviation no asymptote is drawn.
const HEADROOM: f64 = 2.0;
/// Places along a curve.
const PLACES: u32 = 100;

/// The curve, then all numbers.
pub(super) fn parts(analysis: &Analysis) -> [Part; 3] {
    [figure(analysis).into(), coefficient_table(analysis), point_table(analysis)]
}

fn figure(analysis: &Analysis) -> Figure {
    let points = || analysis.points.iter();
    let measured = || points().map(|point| (point.seconds, degrees_per_hour(point.deviation)));
    let limits = points().map(|point| point.limits.map(degrees_per_hour));
    let band = measured().zip(limits).map(|((x, y), limits)| Point { x, y, limits: Some(limits) });
    let noise = analysis.fit.noise();
    let fitted = times(analysis).map(|tau| (tau, degrees_per_hour(variance(&noise, tau).sqrt())));
    let mut series = vec![
        Series::new("limits of 68.3 %", Style::Band, band),
        Series::new("overlapping Allan deviation", Style::Points, measured()),
        Series::new("fit", Style::Line, fitted),
    ];
    series.extend(asymptotes(analysis));
    let title = "Allan deviation";
    let (x, y) =
        (Axis::logarithmic("averaging time τ", "s"), Axis::logarithmic("Allan deviation σ", "°/h"));
    Figure::new(title, x, y, series)
}

/// Averaging times, equally far apart in ratio, over all of the record.
fn times(analysis: &Analysis) -> impl Iterator<Item = f64> {
    let end = |point: Option<&Confident>| point.map_or(1.0, |p| p.seconds);
    let (first, last) = (end(analysis.points.first()), end(analysis.points.last()));
    (0..=PLACES).map(move |i| first * (last / first).powf(f64::from(i) / f64::from(PLACES)))
}

/// What each coefficient alone would give, within the figure.
fn asymptotes(analysis: &Analysis) -> impl Iterator<Item = Series> {
    let deviations = analysis.points.iter().map(|point| degrees_per_hour(point.deviation));
    let low = deviations.clone().fold(f64::INFINITY, f64::min) / HEADROOM;
    let high = deviations.fold(0.0, f64::max) * HEADROOM;
    coefficients(&analysis.fit).into_iter().enumerate().map(move |(index, coefficient)| {
        let (Estimate::Found { value, .. } | Estimate::NotObservable { at_most: value }) =
            coefficient.si;
        let curve = times(analysis)
            .map(|tau| (tau, degrees_per_hour(value * terms(tau)[index].sqrt())))
            .filter(|(_, deviation)| (low..high).contains(deviation));
        let name = format!("{}: {}", coefficient.name, coefficient.text());
        Series::new(&name, Style::Dashed, curve)
    })
}

fn coefficient_table(analysis: &Analysis) -> Part {
    Columns::of("Coefficients (± 1σ)", &coefficients(&analysis.fit))
        .column("coefficient", |coefficient| coefficient.name)
        .column("value", Coefficient::text)
        .into()
}

fn point_table(analysis: &Analysis) -> Part {
    let in_words = |rate: f64| {
        let rate = degrees_per_hour(rate);
        let decimals = (4.0 - rate.log10().floor()).clamp(0.0, 9.0) as usize;
        format!("{rate:.decimals$}")
    };
    let title = "Overlapping Allan deviation with its limits of 68.3 %";
    Columns::of(title, &analysis.points)
        .column("τ, s", |point| short(point.seconds))
        .column("σ, °/h", |point| in_words(point.deviation))
        .column("lower limit, °/h", |point| in_words(point.limits[0]))
        .column("upper limit, °/h", |point| in_words(point.limits[1]))
        .fixed("degrees of freedom", 1, |point| point.degrees)
        .into()
}

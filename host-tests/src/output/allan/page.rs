//! What `meridian allan` finds: the curve with its limits, fit and asymptotes, and all numbers.

use orientation::noise::allan::{terms, variance};
use orientation::noise::fit::Estimate;

use super::super::degrees_per_hour;
use super::{Coefficient, coefficients, rows};
use crate::allan::analysis::{Analysis, Confident};
use crate::report::{Axis, Figure, Part, Point, Series, Style, Table};

/// Beyond so many times the least and the greatest deviation no asymptote is drawn.
const HEADROOM: f64 = 2.0;
/// Places along a curve.
const PLACES: u32 = 100;

/// The curve, then all numbers.
pub(super) fn parts(analysis: &Analysis) -> [Part; 3] {
    [figure(analysis).into(), coefficient_table(analysis).into(), point_table(analysis).into()]
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

fn coefficient_table(analysis: &Analysis) -> Table {
    let row = |coefficient: Coefficient| [coefficient.name.to_owned(), coefficient.text()];
    let rows = coefficients(&analysis.fit).map(row);
    Table::new("Coefficients (± 1σ)", &["coefficient", "value"], rows)
}

fn point_table(analysis: &Analysis) -> Table {
    let head = ["τ, s", "σ, °/h", "lower limit, °/h", "upper limit, °/h", "degrees of freedom"];
    Table::new("Overlapping Allan deviation with its limits of 68.3 %", &head, rows(analysis))
}

//! What `meridian allan` finds: the curve with its limits, fit and asymptotes, and all numbers.

use orientation::noise::allan::{terms, variance};
use orientation::noise::fit::Estimate;

use super::super::degrees_per_hour;
use super::{Coefficient, coefficients, short};
use crate::allan::analysis::{Analysis, Confident};
use crate::report::{Axis, Columns, Figure, Note, Part, Point, Series, Style};

/// Beyond so many times the least and the greatest deviation no asymptote is drawn.
const HEADROOM: f64 = 2.0;
/// Places along a curve.
const PLACES: u32 = 100;

/// Degrees of freedom below which a point says little.
const FEW_DEGREES: f64 = 8.0;

/// The curve; all its numbers where everything is asked for.
pub(super) fn parts(analysis: &Analysis) -> [Part; 2] {
    [figure(analysis).into(), point_table(analysis).detail()]
}

fn figure(analysis: &Analysis) -> Figure {
    let noise = analysis.fit.noise();
    let fitted = times(analysis).map(|tau| (tau, degrees_per_hour(variance(&noise, tau).sqrt())));
    let mut series = vec![
        Series::new("limits of 68.3 %", Style::Band, analysis.points.iter().map(point)),
        Series::new("overlapping Allan deviation", Style::Points, known(analysis, true)),
        Series::new("fewer than 8 degrees of freedom", Style::Pale, known(analysis, false)),
        Series::new("fit", Style::Line, fitted),
    ];
    series.retain(|series| !series.points.is_empty());
    let asymptotes: Vec<Asymptote> = asymptotes(analysis).collect();
    series.extend(asymptotes.iter().map(Asymptote::series));
    let notes = asymptotes.iter().filter_map(Asymptote::note);
    let (x, y) =
        (Axis::logarithmic("averaging time τ", "s"), Axis::logarithmic("Allan deviation σ", "°/h"));
    Figure::new("Allan deviation", x, y, series).noted(notes)
}

/// A point with its limits, °/h.
fn point(point: &Confident) -> Point {
    let limits = Some(point.limits.map(degrees_per_hour));
    Point { x: point.seconds, y: degrees_per_hour(point.deviation), limits }
}

/// The points that are well known, or the others.
fn known(analysis: &Analysis, is_well: bool) -> impl Iterator<Item = (f64, f64)> {
    let chosen = analysis.points.iter().filter(move |at| (at.degrees >= FEW_DEGREES) == is_well);
    chosen.map(|at| (at.seconds, degrees_per_hour(at.deviation)))
}

/// Averaging times, equally far apart in ratio, over all of the record.
fn times(analysis: &Analysis) -> impl Iterator<Item = f64> {
    let end = |point: Option<&Confident>| point.map_or(1.0, |p| p.seconds);
    let (first, last) = (end(analysis.points.first()), end(analysis.points.last()));
    (0..=PLACES).map(move |i| first * (last / first).powf(f64::from(i) / f64::from(PLACES)))
}

/// What a coefficient alone would give, within the figure.
struct Asymptote {
    coefficient: Coefficient,
    curve: Vec<(f64, f64)>,
}

/// Slopes of Q, N, B, K and R in both logarithms (IEEE Std 952-1997, annex C).
const SLOPES: [&str; 5] = ["−1", "−½", "0", "+½", "+1"];

impl Asymptote {
    /// Broken where the record shows the coefficient, dotted where it is only an upper limit.
    fn series(&self) -> Series {
        let is_found = matches!(self.coefficient.si, Estimate::Found { .. });
        let style = if is_found { Style::Dashed } else { Style::Dotted };
        let name = format!("{}: {}", self.coefficient.name, self.coefficient.text());
        Series::new(&name, style, self.curve.iter().copied())
    }

    /// The coefficient's letter and its slope at a place of the line.
    fn note(&self) -> Option<Note> {
        let letter = self.coefficient.name.chars().next()?;
        let slope =
            SLOPES[["Q", "N", "B", "K", "R"].iter().position(|it| it.starts_with(letter))?];
        let place = if letter == 'N' || letter == 'Q' { 1 } else { self.curve.len() * 4 / 5 };
        let (x, y) = *self.curve.get(place)?;
        let most =
            if matches!(self.coefficient.si, Estimate::Found { .. }) { "" } else { " at most" };
        Some(Note { x, y, text: format!("{letter}{most}, slope {slope}") })
    }
}

fn asymptotes(analysis: &Analysis) -> impl Iterator<Item = Asymptote> {
    let deviations = analysis.points.iter().map(|point| degrees_per_hour(point.deviation));
    let low = deviations.clone().fold(f64::INFINITY, f64::min) / HEADROOM;
    let high = deviations.fold(0.0, f64::max) * HEADROOM;
    coefficients(&analysis.fit).into_iter().enumerate().map(move |(index, coefficient)| {
        let (Estimate::Found { value, .. } | Estimate::NotObservable { at_most: value }) =
            coefficient.si;
        let curve = times(analysis)
            .map(|tau| (tau, degrees_per_hour(value * terms(tau)[index].sqrt())))
            .filter(|(_, deviation)| (low..high).contains(deviation))
            .collect();
        Asymptote { coefficient, curve }
    })
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

//! What `meridian allan` finds: the curve with its limits, fit and asymptotes, and all numbers.

use orientation::noise::allan::{terms, variance};
use orientation::noise::fit::Estimate;
use orientation::noise::model::GyroNoise;

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
    let notes = notes(&asymptotes, &noise);
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

/// Letters of the coefficients, and the slopes of what each gives in both logarithms (IEEE Std 952-1997, annex C).
const SLOPES: [[&str; 2]; 5] = [["Q", "−1"], ["N", "−½"], ["B", "0"], ["K", "+½"], ["R", "+1"]];
/// Where the curve of B lies, which is the only one that does not lie at its coefficient: at √(2 ln 2/π) B.
const BELOW: &str = ", at 0.664 B";

impl Asymptote {
    /// Broken where the record shows the coefficient, dotted where it is only an upper limit.
    fn series(&self) -> Series {
        let is_found = matches!(self.coefficient.si, Estimate::Found { .. });
        let style = if is_found { Style::Dashed } else { Style::Dotted };
        let (Coefficient { name, .. }, [_, slope]) = (&self.coefficient, self.slope());
        let below = if name.starts_with('B') { BELOW } else { "" };
        let name = format!("{name}, slope {slope}{below}: {}", self.coefficient.text());
        Series::new(&name, style, self.curve.iter().copied())
    }

    /// The coefficient's letter, and the slope of what it gives in both logarithms.
    fn slope(&self) -> [&'static str; 2] {
        let is_its = |slope: &&[&str; 2]| self.coefficient.name.starts_with(slope[0]);
        SLOPES.iter().find(is_its).copied().unwrap_or_default()
    }

    /// Where the asymptote may be named: the places of its curve, those first that lie farthest from the fit.
    fn places(&self, noise: &GyroNoise) -> Vec<[f64; 2]> {
        let from_fit = |[tau, deviation]: &[f64; 2]| {
            (deviation / degrees_per_hour(variance(noise, *tau).sqrt())).ln().abs()
        };
        let mut places: Vec<[f64; 2]> = self.curve.iter().map(|&(x, y)| [x, y]).collect();
        places.sort_by(|a, b| from_fit(b).total_cmp(&from_fit(a)));
        places
    }
}

/// Ratios of averaging times, and of deviations, from which names in the figure do not touch each other on a phone.
const APART: [f64; 2] = [5.0, 1.5];

/// The asymptotes' letters with their slopes, none over another.
fn notes(asymptotes: &[Asymptote], noise: &GyroNoise) -> Vec<Note> {
    let mut notes: Vec<Note> = Vec::new();
    for asymptote in asymptotes {
        let touches = |[x, y]: [f64; 2], note: &Note| {
            let ratios = [x / note.x, y / note.y].map(|ratio| ratio.max(1.0 / ratio));
            ratios[0] < APART[0] && ratios[1] < APART[1]
        };
        let is_free = |place: &[f64; 2]| !notes.iter().any(|note| touches(*place, note));
        let Some([x, y]) = asymptote.places(noise).into_iter().find(is_free) else { continue };
        notes.push(Note { x, y, text: asymptote.slope().join(" ") });
    }
    notes
}

fn asymptotes(analysis: &Analysis) -> impl Iterator<Item = Asymptote> {
    let deviations = analysis.points.iter().map(|point| degrees_per_hour(point.deviation));
    let low = deviations.clone().fold(f64::INFINITY, f64::min) / HEADROOM;
    let high = deviations.fold(0.0, f64::max) * HEADROOM;
    coefficients(&analysis.fit).into_iter().map(move |coefficient| {
        let (Estimate::Found { value, .. } | Estimate::NotObservable { at_most: value }) =
            coefficient.si;
        let curve = times(analysis)
            .map(|tau| (tau, degrees_per_hour(value * terms(tau)[coefficient.term].sqrt())))
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

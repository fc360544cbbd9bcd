//! Draws an azimuth as a compass shows it, with the wedge in which it lies.

use std::fmt::Write as _;

use super::markup::escaped;
use crate::output::azimuth_error;
use crate::report::Rose;

/// Radius of the ring with the degrees, in units of the drawing.
const RING: f64 = 118.0;
/// Where the wedge begins and ends.
const WEDGE: [f64; 2] = [18.0, 108.0];
/// How wide the wedge of ±3σ is drawn at most, ° on either side.
const WIDE: f64 = 40.0;
/// Narrower than this it is drawn wider than it is.
const NARROW: f64 = 5.0;
/// How far aside of the azimuth the truth is drawn at most where it is magnified, °.
const ASIDE: f64 = 85.0;
/// How far a wedge reaches at most, °: an arc that ended where it began would not be drawn.
const ROUND: f64 = 179.9;

/// The rose with its words.
pub(super) fn rose(rose: &Rose) -> String {
    let times = magnification(3.0 * rose.sigma_deg);
    let azimuth = rose.azimuth_deg;
    let aside = |off: f64| azimuth + (times * off).clamp(-ROUND, ROUND);
    let wedge = |class: &str, sigmas: f64| {
        let half = sigmas * rose.sigma_deg;
        sector(class, [aside(-half), aside(half)])
    };
    let limits =
        rose.limit_deg.map(|limit| ray("limit", aside(-limit)) + &ray("limit", aside(limit)));
    let truth = Truth::of(rose, times);
    let label = escaped(&format!("azimuth {azimuth:.2}°"));
    let mut svg = format!(
        "<svg class=\"rose\" viewBox=\"-150 -150 300 300\" role=\"img\" aria-label=\"{label}\">\n"
    );
    svg += &ring();
    svg += &wedge("three", 3.0);
    svg += &wedge("one", 1.0);
    svg.extend(limits);
    svg.extend(truth.as_ref().map(|truth| ray("truth", truth.drawn_deg)));
    svg += &ray("needle", azimuth);
    format!(
        "<figure class=\"compass\">{svg}<circle class=\"hub\" r=\"4\"/>\n</svg>\n{}</figure>\n",
        words(rose, times, truth.as_ref())
    )
}

/// Where the truth is drawn.
struct Truth {
    drawn_deg: f64,
    /// How many times as far off the azimuth as it is.
    times: f64,
}

impl Truth {
    /// The truth as many times as far off as a wedge is wide, or where it is if that would be beyond what can be told.
    fn of(rose: &Rose, times: f64) -> Option<Self> {
        let off = azimuth_error(rose.truth_deg?, rose.azimuth_deg);
        let times = if times * off.abs() <= ASIDE { times } else { 1.0 };
        Some(Self { drawn_deg: rose.azimuth_deg + times * off, times })
    }

    /// How it is drawn beside a wedge that is so many times as wide as it is.
    fn words(&self, wide: f64) -> String {
        let how = match self.times {
            times if times > 1.0 => format!(", {times} times as far off"),
            _ if wide > 1.0 => ", where it is".to_owned(),
            _ => String::new(),
        };
        format!("; dashed: the truth{how}")
    }
}

/// What is drawn, in words.
fn words(rose: &Rose, times: f64, truth: Option<&Truth>) -> String {
    let scale = if times > 1.0 { format!(", drawn {times} times as wide") } else { String::new() };
    let limit = rose.limit_deg.map_or("", |_| "; dotted: the limit of 1σ");
    let truth = truth.map(|truth| truth.words(times)).unwrap_or_default();
    format!("<figcaption>±1σ and ±3σ{scale}{limit}{truth}</figcaption>\n")
}

/// How many times as wide a wedge is drawn, which is so wide on either side, °: a round number.
fn magnification(half: f64) -> f64 {
    if half >= NARROW || half <= 0.0 {
        return 1.0;
    }
    let power = 10_f64.powf((WIDE / half).log10().floor());
    let fits = |factor: &f64| factor * power * half <= WIDE;
    [5.0, 2.0, 1.0].into_iter().find(fits).unwrap_or(1.0) * power
}

/// A point at a radius in a direction.
fn point(radius: f64, degrees: f64) -> [f64; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    [radius * sine, -radius * cosine]
}

/// A line outward from the middle.
fn ray(class: &str, degrees: f64) -> String {
    let [[x0, y0], [x1, y1]] = WEDGE.map(|radius| point(radius, degrees));
    format!("<path class=\"{class}\" d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\"/>\n")
}

/// A wedge between two directions.
fn sector(class: &str, [from, to]: [f64; 2]) -> String {
    let large = u8::from(to - from > 180.0);
    let [inner, outer] = WEDGE;
    let [[a, b], [c, d]] = [from, to].map(|degrees| point(outer, degrees));
    let [[e, f], [g, h]] = [to, from].map(|degrees| point(inner, degrees));
    format!(
        "<path class=\"{class}\" d=\"M{a:.1} {b:.1}A{outer} {outer} 0 {large} 1 {c:.1} {d:.1}\
         L{e:.1} {f:.1}A{inner} {inner} 0 {large} 0 {g:.1} {h:.1}Z\"/>\n"
    )
}

/// The ring: a tick every ten degrees, a number every thirty, and the four quarters.
fn ring() -> String {
    let mut ring = format!("<circle class=\"ring\" r=\"{RING}\"/>\n");
    for degrees in (0..360).step_by(10) {
        let is_named = degrees % 30 == 0;
        let length = if is_named { 9.0 } else { 5.0 };
        let [[x0, y0], [x1, y1]] =
            [RING, RING - length].map(|radius| point(radius, f64::from(degrees)));
        let _ = writeln!(ring, "<path class=\"tick\" d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\"/>");
        if is_named {
            ring += &name(degrees);
        }
    }
    ring
}

/// What stands at a direction of the ring.
fn name(degrees: i32) -> String {
    let [x, y] = point(RING + 17.0, f64::from(degrees));
    let (class, name) = match degrees {
        0 => ("quarter", "N".to_owned()),
        90 => ("quarter", "E".to_owned()),
        180 => ("quarter", "S".to_owned()),
        270 => ("quarter", "W".to_owned()),
        other => ("degrees", other.to_string()),
    };
    format!("<text class=\"{class}\" x=\"{x:.1}\" y=\"{:.1}\">{name}</text>\n", y + 4.5)
}

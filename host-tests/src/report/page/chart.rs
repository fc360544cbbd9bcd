//! Draws a figure: the curves as SVG that fills whatever width there is, the words around them as text of the page,
//! which keeps its size on a phone, and the numbers for the script that shows them under the pointer.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::markup::{element, escaped, script};
use super::palette::Palette;
use super::span::{Span, place};
use crate::report::{Figure, Point, Scale, Series, Shape, Style};

/// Width and height of the drawing in its own units, whatever the page makes of it.
const SIZE: f64 = 10_000.0;
/// Half the width of an error bar's ends.
const BAR: i64 = 40;
/// Numbers that an axis bears at most, and that of a low figure.
pub(super) const TICKS: f64 = 8.0;
const LOW_TICKS: f64 = 4.0;
/// Where the right end of an axis begins, %.
const END: f64 = 97.0;
/// Digits of a value under the pointer.
const DIGITS: usize = 6;

/// The reach of both axes.
struct Frame {
    x: Span,
    y: Span,
}

/// A point in places, with its limits.
#[derive(Clone, Copy)]
struct Placed {
    x: f64,
    y: f64,
    limits: Option<[f64; 2]>,
}

/// The figure with its heading, its legend and the numbers behind it; nothing where no point can be drawn.
pub(super) fn figure(figure: &Figure, palette: &mut Palette) -> String {
    let thinned = |series: &Series| Series { points: series.distinguished(), ..series.clone() };
    let series = figure.series.iter().filter(|series| figure.draws(series)).map(thinned).collect();
    let figure = &Figure { series, ..figure.clone() };
    let classes = palette.classes(figure);
    let heading = element("figcaption", &figure.title);
    let Some(frame) = Frame::around(figure) else { return String::new() };
    let class = match figure.shape {
        Shape::Usual => "chart",
        Shape::Low => "chart low",
        Shape::Map => "chart map",
    };
    let (legend, plot) = (legend(figure, &classes), frame.plot(figure, &classes));
    let data = script("application/json", &frame.data(figure, &classes).to_string());
    format!("<figure class=\"{class}\">{heading}{legend}{plot}{data}</figure>\n")
}

impl Frame {
    /// The axes that hold every point, or reach as far as they are told to.
    fn around(figure: &Figure) -> Option<Self> {
        let points = || figure.series.iter().flat_map(|series| placed(figure, series)).flatten();
        let heights = points().flat_map(|Placed { y, limits, .. }| {
            let [low, high] = limits.unwrap_or([y; 2]);
            [y, low, high]
        });
        let ticks = if figure.shape == Shape::Low { LOW_TICKS } else { TICKS };
        let mut frame = Self {
            x: Span::of(&figure.x, TICKS, points().map(|point| point.x))?,
            y: Span::of(&figure.y, ticks, heights)?,
        };
        if figure.shape == Shape::Map {
            Span::match_units(&mut frame.x, &mut frame.y);
        }
        Some(frame)
    }

    /// Where a place stands in the drawing.
    fn at(&self, x: f64, y: f64) -> [i64; 2] {
        // What lies far outside is cut by the drawing's edge all the same.
        let parts = [self.x.part(x), 1.0 - self.y.part(y)];
        parts.map(|part| (SIZE * part.clamp(-10.0, 10.0)).round() as i64)
    }

    /// The limits, cut at the figure's edges.
    fn cut(&self, limits: [f64; 2]) -> [f64; 2] {
        limits.map(|limit| limit.clamp(self.y.low, self.y.high))
    }

    /// The drawing between its axes.
    fn plot(&self, figure: &Figure, classes: &[String]) -> String {
        let titles = [&figure.y, &figure.x].map(|axis| escaped(&axis.title()));
        let [y_title, x_title] = titles;
        let (y_labels, x_labels) = (self.y_labels(), self.x_labels());
        let (drawing, notes) = (self.drawing(figure, classes), self.notes(figure));
        format!(
            "<div class=\"y-title\">{y_title}</div>\n<div class=\"plot\">\n\
             <div class=\"y-labels\">{y_labels}</div>\n\
             <div class=\"area\">{drawing}{notes}</div>\n\
             <div class=\"x-labels\">{x_labels}</div>\n</div>\n\
             <div class=\"x-title\">{x_title}</div>\n"
        )
    }

    /// The numbers beside the vertical axis; the longest of them once more, unseen, makes the column wide enough.
    fn y_labels(&self) -> String {
        let labels = || self.y.major.iter().map(|place| (place, self.y.label(*place)));
        let longest = labels().map(|(_, label)| label).max_by_key(|label| label.chars().count());
        let wide = element("span class=\"wide\"", &longest.unwrap_or_default());
        let each = labels().map(|(place, label)| {
            let top = 100.0 * (1.0 - self.y.part(*place));
            format!("<span style=\"top:{top:.2}%\">{}</span>", escaped(&label))
        });
        wide + &each.collect::<String>()
    }

    /// The numbers below the horizontal axis; a phone leaves out every other one.
    fn x_labels(&self) -> String {
        let labels =
            self.x.major.iter().enumerate().map(|(index, place)| {
                tick(index, 100.0 * self.x.part(*place), &self.x.label(*place))
            });
        labels.collect()
    }

    /// Words at places of the drawing.
    fn notes(&self, figure: &Figure) -> String {
        let each = figure.notes.iter().filter_map(|note| {
            let [x, y] = [place(figure.x.scale, note.x), place(figure.y.scale, note.y)];
            let [left, top] = self.at(x, y).map(|at| at as f64 / SIZE * 100.0);
            let is_inside = (0.0..=100.0).contains(&left) && (0.0..=100.0).contains(&top);
            let class = if left > 50.0 { "note left" } else { "note" };
            let text = escaped(&note.text);
            is_inside.then(|| {
                format!(
                    "<span class=\"{class}\" style=\"left:{left:.1}%;top:{top:.1}%\">{text}</span>"
                )
            })
        });
        each.collect()
    }

    /// Grid and curves.
    fn drawing(&self, figure: &Figure, classes: &[String]) -> String {
        let mut svg = format!(
            "<svg viewBox=\"0 0 {SIZE} {SIZE}\" preserveAspectRatio=\"none\" aria-hidden=\"true\">\n"
        );
        svg += &self.grid();
        for (class, series) in classes.iter().zip(&figure.series) {
            let points: Vec<Option<Placed>> = placed(figure, series).collect();
            let _ = writeln!(svg, "<g class=\"{class}\">{}</g>", self.curve(series.style, &points));
        }
        svg + "</svg>"
    }

    /// Lines at the ticks, faint ones between them, and one at zero.
    fn grid(&self) -> String {
        let upright = |x: &f64| format!("M{:.0} 0V{SIZE}", SIZE * self.x.part(*x));
        let level = |y: &f64| format!("M0 {:.0}H{SIZE}", SIZE * (1.0 - self.y.part(*y)));
        let lines = |x: &[f64], y: &[f64]| {
            x.iter().map(upright).chain(y.iter().map(level)).collect::<String>()
        };
        let path = |class: &str, d: String| match d.as_str() {
            "" => String::new(),
            d => format!("<path class=\"{class}\" d=\"{d}\"/>\n"),
        };
        let zero: &[f64] = if self.y.crosses_zero() { &[0.0] } else { &[] };
        path("minor", lines(&self.x.minor, &self.y.minor))
            + &path("major", lines(&self.x.major, &self.y.major))
            + &path("zero", lines(&[], zero))
    }

    /// One series.
    fn curve(&self, style: Style, points: &[Option<Placed>]) -> String {
        let line = |class: &str| format!("<path class=\"{class}\" d=\"{}\"/>", self.line(points));
        let dots = |class: &str| format!("<path class=\"{class}\" d=\"{}\"/>", self.dots(points));
        match style {
            Style::Band => self.band("band", points),
            Style::WideBand => self.band("band wide", points),
            Style::Line => line("line"),
            Style::Dashed => line("line dashed"),
            Style::Dotted => line("line dotted"),
            Style::Points => self.bars(points) + &dots("dots"),
            Style::Hollow => self.bars(points) + &dots("dots") + &dots("dots inner"),
            Style::Pale => format!("<g class=\"pale\">{}{}</g>", self.bars(points), dots("dots")),
            Style::LineAndPoints => line("line") + &self.bars(points) + &dots("dots"),
        }
    }

    /// A line through the points, broken where one is missing.
    fn line(&self, points: &[Option<Placed>]) -> String {
        let all: Vec<Option<[i64; 2]>> =
            points.iter().map(|point| point.map(|point| self.at(point.x, point.y))).collect();
        all.split(Option::is_none).map(|line| path(line.iter().flatten().copied())).collect()
    }

    /// A dot at every point: a line of no length with round ends, which stays round when the drawing is stretched.
    fn dots(&self, points: &[Option<Placed>]) -> String {
        let dot = |point: &Placed| {
            let [x, y] = self.at(point.x, point.y);
            format!("M{x} {y}h0")
        };
        points.iter().flatten().map(dot).collect()
    }

    /// The area between the limits.
    fn band(&self, class: &str, points: &[Option<Placed>]) -> String {
        let limits = points.iter().flatten().filter_map(|point| Some((point.x, point.limits?)));
        let side = |which: usize| {
            limits.clone().map(move |(x, limits)| self.at(x, self.cut(limits)[which]))
        };
        format!("<path class=\"{class}\" d=\"{}Z\"/>", path(side(0).chain(side(1).rev())))
    }

    /// A bar with ends through every point that has limits.
    fn bars(&self, points: &[Option<Placed>]) -> String {
        let bar = |point: &Placed| {
            let [low, high] = self.cut(point.limits?);
            let [[x, low], [_, high]] = [low, high].map(|y| self.at(point.x, y));
            let (left, wide) = (x - BAR, 2 * BAR);
            Some(format!("M{x} {low}V{high}M{left} {low}h{wide}M{left} {high}h{wide}"))
        };
        let bars: String = points.iter().flatten().filter_map(bar).collect();
        if bars.is_empty() { bars } else { format!("<path class=\"bars\" d=\"{bars}\"/>") }
    }

    /// The numbers of the figure.
    fn data(&self, figure: &Figure, classes: &[String]) -> Value {
        let axis = |axis: &crate::report::Axis, span: &Span| {
            let is_logarithmic = axis.scale == Scale::Logarithmic;
            let [low, high] = [span.low, span.high].map(significant);
            json!({
                "label": axis.label, "unit": axis.unit, "logarithmic": is_logarithmic,
                "circle": axis.scale == Scale::Circle, "low": low, "high": high,
            })
        };
        let series: Vec<Value> = classes.iter().zip(&figure.series).map(numbers).collect();
        json!({
            "title": figure.title,
            "x": axis(&figure.x, &self.x),
            "y": axis(&figure.y, &self.y),
            "series": series,
        })
    }
}

/// A number below an axis, at so many per cent of its length. At the right end it stands left of its place.
pub(super) fn tick(index: usize, left: f64, label: &str) -> String {
    let odd = if index % 2 == 1 { "odd " } else { "" };
    let end = if left > END { "end" } else { "" };
    format!("<span class=\"{odd}{end}\" style=\"left:{left:.2}%\">{}</span>", escaped(label))
}

/// A line through these corners, each from the one before.
fn path(corners: impl Iterator<Item = [i64; 2]>) -> String {
    let mut path = String::new();
    let mut before: Option<[i64; 2]> = None;
    for [x, y] in corners {
        let _ = match before {
            None => write!(path, "M{x} {y}l"),
            Some([from_x, from_y]) => write!(path, "{} {} ", x - from_x, y - from_y),
        };
        before = Some([x, y]);
    }
    // A corner alone is a line of no length.
    if path.ends_with('l') { path + "0 0" } else { path.trim_end().to_owned() }
}

/// The numbers of a series: `[x, y]` of each point, and its limits where it has them.
fn numbers((class, series): (&String, &Series)) -> Value {
    let point = |Point { x, y, limits }: &Point| {
        let all = [*x, *y].into_iter().chain(limits.iter().flatten().copied());
        json!(all.map(significant).collect::<Vec<_>>())
    };
    let is_there = |point: &&Point| point.x.is_finite() && point.y.is_finite();
    let points: Vec<Value> = series.points.iter().filter(is_there).map(point).collect();
    let style = format!("{:?}", series.style).to_lowercase();
    json!({ "name": series.name, "class": class, "style": style, "points": points })
}

/// A number in as many digits as are shown, zero without a sign; JSON has none for what is not finite.
fn significant(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value) + 0.0
}

/// The points of a series, none in the place of one that cannot be drawn.
fn placed<'a>(figure: &'a Figure, series: &'a Series) -> impl Iterator<Item = Option<Placed>> + 'a {
    let [horizontal, vertical] = [figure.x.scale, figure.y.scale];
    series.points.iter().map(move |point| {
        let limits = point.limits.filter(|limits| !limits.iter().any(|limit| limit.is_nan()));
        let limits = limits.map(|limits| limits.map(|limit| place(vertical, limit)));
        let (x, y) = (place(horizontal, point.x), place(vertical, point.y));
        (x.is_finite() && y.is_finite()).then_some(Placed { x, y, limits })
    })
}

/// A sample of each series with its name.
fn legend(figure: &Figure, classes: &[String]) -> String {
    let entry = |(class, series): (&String, &Series)| {
        let name = escaped(&series.name);
        let sample = sample(series.style);
        format!(
            "<li><svg class=\"{class}\" viewBox=\"0 0 30 14\" aria-hidden=\"true\">{sample}</svg>{name}</li>\n"
        )
    };
    let entries: String = classes.iter().zip(&figure.series).map(entry).collect();
    format!("<ul class=\"legend\">\n{entries}</ul>\n")
}

/// How a series is drawn, in small.
fn sample(style: Style) -> &'static str {
    match style {
        Style::Line => "<path class=\"line\" d=\"M0 7H30\"/>",
        Style::Dashed => "<path class=\"line dashed\" d=\"M0 7H30\"/>",
        Style::Dotted => "<path class=\"line dotted\" d=\"M0 7H30\"/>",
        Style::Points => "<path class=\"dots\" d=\"M15 7h0\"/>",
        Style::Hollow => {
            "<path class=\"dots\" d=\"M15 7h0\"/><path class=\"dots inner\" d=\"M15 7h0\"/>"
        }
        Style::Pale => "<g class=\"pale\"><path class=\"dots\" d=\"M15 7h0\"/></g>",
        Style::LineAndPoints => {
            "<path class=\"line\" d=\"M0 7H30\"/><path class=\"dots\" d=\"M15 7h0\"/>"
        }
        Style::Band => "<path class=\"band\" d=\"M0 1H30V13H0Z\"/>",
        Style::WideBand => "<path class=\"band wide\" d=\"M0 1H30V13H0Z\"/>",
    }
}

//! Reports: figures and tables in one HTML file that needs nothing beside it, for `--report`.
//!
//! A [`Report`] is data; [`Report::write`] draws every figure as inline SVG, so that the file works
//! in any browser without a network. A point that is not finite, or not above zero on a logarithmic
//! axis, is left out; a figure without any point says so. Every axis names its unit.

mod chart;
mod columns;
mod html;
mod span;
mod text;

use std::io;
use std::path::Path;

use crate::unwritten;

pub use self::columns::Columns;

/// A whole report.
#[must_use]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// The heading, and the title of the browser's window.
    pub title: String,
    /// Lines below it: what was measured, with what, how.
    pub subtitle: Vec<String>,
    /// Figures and tables, in their order.
    pub parts: Vec<Part>,
}

/// A part of a report.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// Curves over an axis.
    Figure(Figure),
    /// Rows of text.
    Table(Table),
    /// Labelled lines.
    Lines(Lines),
}

/// Labelled lines under a heading.
#[must_use]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// The heading; empty for lines that follow the report's own.
    pub title: String,
    /// Label and value of each line.
    pub lines: Vec<[String; 2]>,
}

impl Lines {
    /// Lines under a heading, none yet.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), lines: Vec::new() }
    }

    /// The lines with one more.
    pub fn with(self, label: &str, value: impl Into<String>) -> Self {
        self.with_found(label, [value])
    }

    /// The lines with one for each value that there is.
    pub fn with_found<V: Into<String>>(
        mut self,
        label: &str,
        values: impl IntoIterator<Item = V>,
    ) -> Self {
        self.lines.extend(values.into_iter().map(|value| [label.to_owned(), value.into()]));
        self
    }
}

/// Curves over common axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The heading.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves; later ones are drawn over earlier ones.
    pub series: Vec<Series>,
}

/// An axis of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub label: String,
    /// Unit of the axis; empty where it has none.
    pub unit: String,
    /// How values are laid along it.
    pub scale: Scale,
}

/// How values are laid along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally long.
    Linear,
    /// Equal ratios are equally long; values must be above zero.
    Logarithmic,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name of the series in the legend.
    pub name: String,
    /// How it is drawn.
    pub style: Style,
    /// Points of the series, in the order in which a line joins them.
    pub points: Vec<Point>,
}

/// How a curve is drawn. Limits are error bars, but in [`Style::Band`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line through the points.
    Line,
    /// A thin broken line through the points, for what only guides the eye.
    Dashed,
    /// Dots.
    Points,
    /// Dots with a line through them.
    LineAndPoints,
    /// The area between the limits; the points themselves are not drawn.
    Band,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// On the horizontal axis.
    pub x: f64,
    /// On the vertical axis.
    pub y: f64,
    /// Lower and upper limit on the vertical axis; what leaves the figure is cut at its edge.
    pub limits: Option<[f64; 2]>,
}

/// Rows of text under column names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The heading.
    pub title: String,
    /// The names of the columns, with units.
    pub head: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

impl Figure {
    /// Curves over two axes.
    pub fn new(
        title: impl Into<String>,
        x: impl Into<Axis>,
        y: impl Into<Axis>,
        series: impl IntoIterator<Item = Series>,
    ) -> Self {
        let series = series.into_iter().collect();
        Self { title: title.into(), x: x.into(), y: y.into(), series }
    }

    /// Curves over the time in seconds.
    pub fn over_time(
        title: impl Into<String>,
        y: impl Into<Axis>,
        series: impl IntoIterator<Item = Series>,
    ) -> Self {
        Self::new(title, ["time", "s"], y, series)
    }
}

impl From<[&str; 2]> for Axis {
    /// An axis of a quantity and its unit, empty for a plain number, on which equal differences are equally long.
    fn from([label, unit]: [&str; 2]) -> Self {
        Self { label: label.to_owned(), unit: unit.to_owned(), scale: Scale::Linear }
    }
}

impl Point {
    /// A point with limits of one σ on either side.
    #[must_use]
    pub fn within(x: f64, y: f64, sigma: f64) -> Self {
        Self { x, y, limits: Some([y - sigma, y + sigma]) }
    }
}

impl Axis {
    /// An axis on which equal ratios are equally long; `unit` is empty for a plain number.
    #[must_use]
    pub fn logarithmic(label: &str, unit: &str) -> Self {
        Self { scale: Scale::Logarithmic, ..[label, unit].into() }
    }

    /// What stands beside the axis.
    fn title(&self) -> String {
        let Self { label, unit, .. } = self;
        if unit.is_empty() { label.clone() } else { format!("{label}, {unit}") }
    }
}

/// Most points of a curve of which more could not be distinguished.
pub const POINTS: usize = 2000;

impl Series {
    /// A curve through (x, y).
    pub fn new(
        name: &str,
        style: Style,
        points: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        let points = points.into_iter().map(Into::into).collect();
        Self { name: name.to_owned(), style, points }
    }

    /// A curve of as many points as can be distinguished, evenly taken from all.
    pub fn thinned<T, P: Into<Point>>(
        name: &str,
        style: Style,
        all: &[T],
        of: impl FnMut(&T) -> P,
    ) -> Self {
        Self::new(name, style, all.iter().step_by(all.len().div_ceil(POINTS).max(1)).map(of))
    }
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self { x, y, limits: None }
    }
}

impl From<Figure> for Part {
    fn from(figure: Figure) -> Self {
        Self::Figure(figure)
    }
}

impl From<Lines> for Part {
    fn from(lines: Lines) -> Self {
        Self::Lines(lines)
    }
}

impl From<Table> for Part {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}

impl Report {
    /// A report of these parts, without labelled lines and rows of which there are none.
    pub fn new(title: impl Into<String>, parts: impl IntoIterator<Item = Part>) -> Self {
        let is_empty = |part: &Part| match part {
            Part::Lines(lines) => lines.lines.is_empty(),
            Part::Table(table) => table.rows.is_empty(),
            Part::Figure(_) => false,
        };
        let parts = parts.into_iter().filter(|part| !is_empty(part)).collect();
        Self { title: title.into(), subtitle: Vec::new(), parts }
    }

    /// This report with lines below its heading.
    pub fn below(self, subtitle: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { subtitle: subtitle.into_iter().map(Into::into).collect(), ..self }
    }

    /// The report for a terminal: its lines and tables; figures are for a page.
    #[must_use]
    pub fn text(&self) -> String {
        text::document(self)
    }

    /// Writes the report to a file, over one that is there.
    ///
    /// # Errors
    /// The file and what the system says.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let page = html::document(self).map_err(io::Error::other);
        page.and_then(|page| std::fs::write(path, page))
            .map_err(|error| unwritten::message("the report", path, &error))
    }
}

//! Reports: what a command says, as data, from which text for a terminal and a page for a browser are made.
//!
//! A [`Report`] is data. [`Report::text`] makes text of it; [`Report::write`], for `--report`, makes one HTML file that
//! loads nothing: figures are inline SVG, and a script shows their values under the pointer. A point that is not finite,
//! or not above zero on a logarithmic axis, is left out, and so is a figure without any point. Every axis names its unit.

mod columns;
mod convergence;
mod figure;
mod page;
mod parts;
mod summary;
mod text;

use std::path::Path;

use crate::refused;

pub use self::columns::Columns;
pub use self::convergence::{Milestone, convergence};
pub use self::figure::{Axis, BREAK, Figure, Note, POINTS, Point, Scale, Series, Shape, Style};
pub use self::parts::{Kind, Lane, Lines, Share, Shares, Stretch, Table, Timeline};
pub use self::summary::{Grade, Rose, Summary};

/// A whole report.
#[must_use]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// The heading, and the title of the browser's window.
    pub title: String,
    /// Lines below it: what was measured, with what, how.
    pub subtitle: Vec<String>,
    /// What was found, where one thing was looked for.
    pub summary: Option<Summary>,
    /// Figures and tables, in their order.
    pub parts: Vec<Part>,
}

/// A part of a report.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// Curves over an axis; of a page alone.
    Figure(Figure),
    /// Rows of text.
    Table(Table),
    /// Labelled lines.
    Lines(Lines),
    /// Shares of a whole.
    Shares(Shares),
    /// What was done when; of a page alone.
    Timeline(Timeline),
    /// What is shown where everything is asked for; a page folds it away.
    Detail(Box<Part>),
}

/// Remarks on a result that are shown at once; more are folded away, or told where everything is asked for.
const REMARKS: usize = 4;

/// How much is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verbosity {
    /// Errors, and what was found.
    Quiet,
    /// Progress, warnings, and what a reader needs who does not look for a fault.
    #[default]
    Usual,
    /// Everything, with the log of a run.
    Verbose,
}

/// How a report looks on a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// How much of it is shown.
    pub verbosity: Verbosity,
    /// Whether colours show what came of it.
    pub is_coloured: bool,
}

impl Look {
    /// Without colours.
    #[must_use]
    pub fn plain(verbosity: Verbosity) -> Self {
        Self { verbosity, is_coloured: false }
    }
}

impl Part {
    /// The part, as one that is shown only where everything is asked for.
    #[must_use]
    pub fn detail(self) -> Self {
        Self::Detail(Box::new(self))
    }

    /// The heading of what a terminal shows.
    fn title(&self) -> Option<&str> {
        match self {
            Self::Lines(lines) => Some(&lines.title),
            Self::Table(table) => Some(&table.title),
            Self::Shares(shares) => Some(&shares.title),
            Self::Detail(part) => part.title(),
            Self::Figure(_) | Self::Timeline(_) => None,
        }
    }

    /// Whether there is nothing in it.
    fn is_empty(&self) -> bool {
        match self {
            Self::Lines(lines) => lines.lines.is_empty(),
            Self::Timeline(timeline) => timeline.is_empty(),
            Self::Detail(part) => part.is_empty(),
            Self::Table(table) => table.rows.is_empty(),
            Self::Figure(figure) => figure.is_empty(),
            Self::Shares(_) => false,
        }
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

impl From<Shares> for Part {
    fn from(shares: Shares) -> Self {
        Self::Shares(shares)
    }
}

impl From<Timeline> for Part {
    fn from(timeline: Timeline) -> Self {
        Self::Timeline(timeline)
    }
}

impl Report {
    /// A report of these parts, without labelled lines, rows and points of which there are none.
    pub fn new(title: impl Into<String>, parts: impl IntoIterator<Item = Part>) -> Self {
        let parts = parts.into_iter().filter(|part| !part.is_empty()).collect();
        Self { title: title.into(), parts, ..Self::default() }
    }

    /// This report with lines below its heading.
    pub fn below(self, subtitle: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { subtitle: subtitle.into_iter().map(Into::into).collect(), ..self }
    }

    /// This report with what was found at its head.
    pub fn headed(self, summary: Summary) -> Self {
        Self { summary: Some(summary), ..self }
    }

    /// The report for a terminal: its lines and tables; figures are for a page.
    #[must_use]
    pub fn text(&self, look: Look) -> String {
        text::document(self, look)
    }

    /// Writes the report to a file, over one that is there.
    ///
    /// # Errors
    /// The file and what the system says.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        std::fs::write(path, page::document(self))
            .map_err(|error| refused::unwritten("the report", path, &error))
    }
}

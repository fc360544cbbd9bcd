//! Parts of a report beside figures: labelled lines, tables, shares of a whole, and what was done when.

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

/// Shares of a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shares {
    /// The heading.
    pub title: String,
    /// Names of the columns: what has a share, how much it is with its unit, and the share in per cent.
    pub head: [String; 3],
    /// What has a share.
    pub rows: Vec<Share>,
    /// All of them together: what stands in the first two columns.
    pub sum: [String; 2],
}

/// A share of a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Share {
    /// What it is.
    pub name: String,
    /// How much it is.
    pub value: String,
    /// How much of the whole, %.
    pub percent: f64,
}

impl Share {
    /// Whether it shows in the digits that are printed.
    pub(super) fn is_seen(&self) -> bool {
        self.percent >= 0.05
    }

    /// The share as it is printed.
    pub(super) fn in_percent(&self) -> String {
        format!("{:.1}", self.percent)
    }
}

/// What was done when.
#[must_use]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The heading.
    pub title: String,
    /// Rows, one below the other over the same time.
    pub lanes: Vec<Lane>,
}

impl Timeline {
    /// What was done when, in these rows.
    pub fn of(lanes: Vec<Lane>) -> Self {
        Self { title: "What was done when".to_owned(), lanes }
    }

    /// The rows in which there is something.
    pub(super) fn filled(&self) -> impl Iterator<Item = &Lane> {
        self.lanes.iter().filter(|lane| !lane.spans.is_empty())
    }

    /// Whether no time passes in it.
    pub(super) fn is_empty(&self) -> bool {
        let spans = || self.filled().flat_map(|lane| &lane.spans);
        let begin = spans().map(|span| span.from_s).fold(f64::INFINITY, f64::min);
        spans().all(|span| span.to_s <= begin)
    }
}

/// A row of a timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// What the row shows.
    pub name: String,
    /// Stretches of time, in their order.
    pub spans: Vec<Stretch>,
}

impl Lane {
    /// A row of a name.
    #[must_use]
    pub fn new(name: &str, spans: impl IntoIterator<Item = Stretch>) -> Self {
        Self { name: name.to_owned(), spans: spans.into_iter().collect() }
    }
}

/// A stretch of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Where it begins, s.
    pub from_s: f64,
    /// Where it ends, s; a moment where it is no later.
    pub to_s: f64,
    /// What kind of stretch it is.
    pub kind: Kind,
    /// What it is.
    pub words: String,
}

/// What kind of stretch of time something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// What counts: a dwell, turns, a stop.
    Used,
    /// What goes on between.
    Between,
    /// What is searched for and not found yet.
    Searching,
    /// What the gyros carry alone, nothing being measured beside them.
    Coasting,
    /// What took no part.
    LeftOut,
    /// What went wrong.
    Wrong,
}

impl Kind {
    /// Name of the kind in legends.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Used => "measured",
            Self::Between => "in motion",
            Self::Searching => "not found yet",
            Self::Coasting => "by the gyros alone",
            Self::LeftOut => "left out",
            Self::Wrong => "went wrong",
        }
    }
}

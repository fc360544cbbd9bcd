//! Columns: which of a line's fields are needed, and their numbers.
//!
//! Fields are plain numbers between commas, so a line is split at its commas and nothing is ever
//! quoted. A column that the kind does not know is never parsed; a kind that knows a `truth_*` column
//! keeps it from the rows.

use std::collections::HashSet;

use memchr::memchr_iter;

use super::error::Fault;
use super::lines::Line;
use super::number::number;
use super::problem::Problem;
use super::range::Range;
use super::resemblance::resembled;
use super::warning::{About, Warning};

/// Most columns that a kind can know.
const MAX_COLUMNS: usize = 15;

/// What the names of columns begin with that only a check may know; they may hold `nan`.
const TRUTH: &str = "truth_";
/// The columns of a true attitude, which come together.
pub(super) const TRUE_ATTITUDE: [&str; 4] = ["truth_qw", "truth_qx", "truth_qy", "truth_qz"];

/// When a column must be there.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Need {
    /// In every recording.
    Always,
    /// In no recording: the column may be there.
    Optional,
    /// In no recording: the column may be there, and its fields may be empty.
    Sometimes,
    /// When any of these is: they come together.
    AnyOf(&'static [&'static str]),
    /// When none of these is: they stand in for it.
    NoneOf(&'static [&'static str]),
}

/// A column that a kind knows.
pub(super) struct Column {
    /// Name of the column.
    pub name: &'static str,
    /// When it must be there.
    pub need: Need,
    /// The range of its numbers.
    pub range: &'static Range,
}

/// How the fields of this file's rows map to the kind's columns.
pub(super) struct Layout {
    columns: Vec<Column>,
    /// For each field, the place of its column in `columns`.
    fields: Vec<Option<usize>>,
    present: [bool; MAX_COLUMNS],
    /// Columns of a truth that the kind does not know: their fields and names.
    truths: Vec<(usize, String)>,
}

/// The numbers of one row.
#[derive(Default)]
pub(super) struct Values {
    /// The row's line.
    pub line: u64,
    numbers: [f64; MAX_COLUMNS],
    present: [bool; MAX_COLUMNS],
}

impl Values {
    /// The number in a column, when it is there.
    pub fn optional(&self, column: usize) -> Option<f64> {
        self.present[column].then_some(self.numbers[column])
    }
}

impl Layout {
    /// Reads the line of column names. `columns` has no more than [`MAX_COLUMNS`].
    pub fn new(columns: Vec<Column>, line: u64, names: &str) -> Result<Self, Fault> {
        let present = [false; MAX_COLUMNS];
        let mut layout = Self { columns, fields: Vec::new(), present, truths: Vec::new() };
        let other = [';', '\t'].into_iter().find(|other| names.contains(*other));
        if let Some(other) = other.filter(|_| !names.contains(',')) {
            return Err(Fault::line(line, Problem::Separator(other)));
        }
        let mut seen = HashSet::new();
        for (index, name) in names.split(',').map(str::trim_ascii).enumerate() {
            check_name(line, index, name, seen.insert(name))?;
            let place = layout.place(name);
            layout.fields.push(place);
            match place {
                Some(place) => layout.present[place] = true,
                None if name.starts_with(TRUTH) => layout.truths.push((index, name.to_owned())),
                None => {}
            }
        }
        layout.check_needs(line)?;
        Ok(layout)
    }

    /// Warns of unknown columns that resemble one that is not there, and of a true attitude in parts.
    pub fn warn(&self, line: u64, names: &str, warnings: &mut Vec<Warning>) {
        let absent = self.columns.iter().filter(|column| !self.has(column.name));
        let absent = absent.map(|column| column.name);
        for name in names.split(',').map(str::trim_ascii) {
            let is_known = self.place(name).is_some();
            if let Some(known) = resembled(name, absent.clone()).filter(|_| !is_known) {
                let about = About::Column(name.to_owned(), known);
                warnings.push(Warning { line, about });
            }
        }
        let missing = TRUE_ATTITUDE.into_iter().find(|name| !self.has(name));
        if let Some(missing) = missing.filter(|_| TRUE_ATTITUDE.iter().any(|name| self.has(name))) {
            warnings.push(Warning { line, about: About::PartOfTruth(missing) });
        }
    }

    /// Warns of the first field of each unknown truth that is no number.
    pub fn warn_of_truth(&mut self, line: &Line<'_>, warnings: &mut Vec<Warning>) {
        if self.truths.is_empty() {
            return;
        }
        self.truths.retain(|(index, name)| {
            let field = line.text.split(',').nth(*index).unwrap_or_default().trim_ascii();
            let is_number = field.parse::<f64>().is_ok();
            if !is_number {
                let about = About::NoTruth(name.clone(), field.to_owned());
                warnings.push(Warning { line: line.number, about });
            }
            is_number
        });
    }

    /// Whether every needed column is there.
    fn check_needs(&self, line: u64) -> Result<(), Fault> {
        let Some(missing) = self.needed().find(|column| !self.has(column.name)) else {
            return Ok(());
        };
        let all = self.needed().map(|column| column.name).collect::<Vec<_>>().join(",");
        Err(Fault::column(line, missing.name, Problem::MissingColumn(all)))
    }

    /// The place of the column of this name among those that the kind knows.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// Whether the column of this name is there.
    fn has(&self, name: &str) -> bool {
        self.place(name).is_some_and(|place| self.present[place])
    }

    /// The columns that must be there, given which optional ones are.
    fn needed(&self) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(|column| match column.need {
            Need::Always => true,
            Need::Optional | Need::Sometimes => false,
            Need::AnyOf(group) => group.iter().any(|name| self.has(name)),
            Need::NoneOf(group) => !group.iter().any(|name| self.has(name)),
        })
    }

    /// Reads the numbers of a row into those of the row before.
    pub fn read(&self, line: &Line<'_>, values: &mut Values) -> Result<(), Fault> {
        self.check_count(line)?;
        *values = Values { line: line.number, present: self.present, ..*values };
        for (field, place) in fields(line.text).zip(&self.fields) {
            let (Some(place), field) = (*place, field.trim_ascii()) else { continue };
            let Column { name, need, range } = &self.columns[place];
            if field.is_empty() && *need == Need::Sometimes {
                values.present[place] = false;
                continue;
            }
            values.numbers[place] = match number(field, range) {
                Err(Problem::Nan(_)) if name.starts_with(TRUTH) => f64::NAN,
                read => read.map_err(|problem| Fault::column(line.number, name, problem))?,
            };
        }
        Ok(())
    }

    /// A wrong count is reported before a wrong number: a cut line has both.
    fn check_count(&self, line: &Line<'_>) -> Result<(), Fault> {
        let found = 1 + memchr_iter(b',', line.text.as_bytes()).count();
        let columns = self.fields.len();
        if found == columns {
            return Ok(());
        }
        let cut = !line.ended && found < columns;
        let problem = if cut { Problem::CutShort } else { Problem::FieldCount };
        Err(Fault::line(line.number, problem(found, columns)))
    }
}

/// What stands between the commas of a row.
fn fields(text: &str) -> impl Iterator<Item = &str> {
    let mut start = 0;
    memchr_iter(b',', text.as_bytes()).chain([text.len()]).map(move |end| {
        let field = &text[start..end];
        start = end + 1;
        field
    })
}

/// Refuses a column without a name or with a name that another has.
fn check_name(line: u64, index: usize, name: &str, is_new: bool) -> Result<(), Fault> {
    if name.is_empty() {
        return Err(Fault::line(line, Problem::UnnamedColumn(index + 1)));
    }
    if is_new { Ok(()) } else { Err(Fault::column(line, name, Problem::DuplicateColumn)) }
}

//! A recording of kind `static`, read row by row, so that its length costs no memory.

use std::io::Read;

use super::Kind;
use super::begun::Begun;
use super::error::{Fault, ReadError};
use super::header::{Collector, Header};
use super::lines::{Lines, MAX_STREAMED_ROWS};
use super::problem::Problem;
use super::rows::{Row as _, Rows, StaticRow};
use super::warning::{MOST, Warning};

/// A recording of kind `static` whose header is read and whose rows are not.
pub struct RestRows<'r> {
    file: String,
    lines: Lines<'r>,
    rows: Rows<StaticRow>,
    /// The header's lines; they are checked once more behind the last row.
    entries: Collector,
    /// Line of the column names.
    line: u64,
    /// What the header says.
    pub header: Header,
    /// What was passed over so far.
    pub warnings: Vec<Warning>,
    /// The column whose rate is read alone, where one is named.
    column: Option<String>,
}

/// The column that holds the rate of a single gyro.
const RATE: &str = "g_rad_s";

/// A recording that was asked for its rows at rest.
pub enum Opened<'r> {
    /// It is of kind `static`.
    AtRest(Box<RestRows<'r>>),
    /// It is of another kind; what was passed over in its header.
    Other(Kind, Vec<Warning>),
}

impl<'r> RestRows<'r> {
    /// Reads the header of a recording from any reader, plain or gzip-compressed; `name` stands in the errors. Where a
    /// column is named, rows have its numbers as the rate of a single gyro, and no other column but the time is read.
    ///
    /// # Errors
    /// As [`super::read`]; and there is no rate in the column.
    pub fn open(
        name: &str,
        reader: impl Read + 'r,
        column: Option<&str>,
    ) -> Result<Opened<'r>, ReadError> {
        let begun = Lines::within(reader, MAX_STREAMED_ROWS).and_then(Begun::new);
        let begun = begun.and_then(|begun| Self::begin(name, begun, column));
        begun.map_err(|fault| fault.in_file(name))
    }

    fn begin(name: &str, begun: Begun<'r>, column: Option<&str>) -> Result<Opened<'r>, Fault> {
        let Begun { lines, entries, kind, header, names: (line, names), mut warnings } = begun;
        if kind != Kind::Static {
            return Ok(Opened::Other(kind, warnings));
        }
        let rows = match column {
            // What other columns are called is of no account.
            Some(column) => Rows::new(line, &alone(line, &names, column)?, &mut Vec::new()),
            None => Rows::new(line, &names, &mut warnings),
        };
        let (file, column) = (name.to_owned(), column.map(str::to_owned));
        let rows = rows.map_err(|fault| of_column(fault, column.as_deref()))?;
        let begun = Self { file, lines, rows, entries, line, header, warnings, column };
        Ok(Opened::AtRest(Box::new(begun)))
    }

    /// The column that was named, where one was.
    #[must_use]
    pub fn column(&self) -> Option<&str> {
        self.column.as_deref()
    }

    /// Reads so many rows, or what is left of them, of which a recording has one at least; whether there may be more.
    ///
    /// # Errors
    /// As [`super::read`].
    pub fn read(&mut self, most: usize, take: impl FnMut(StaticRow)) -> Result<bool, ReadError> {
        let read = self.rows(most, take);
        read.map_err(|fault| of_column(fault, self.column.as_deref()).in_file(&self.file))
    }

    fn rows(&mut self, most: usize, mut take: impl FnMut(StaticRow)) -> Result<bool, Fault> {
        for _ in 0..most {
            match self.rows.next(&mut self.lines, &mut self.warnings)? {
                Some(row) => take(row),
                None => return self.end().map(|()| false),
            }
        }
        Ok(true)
    }

    /// Checks what can be said only behind the last row.
    fn end(&mut self) -> Result<(), Fault> {
        if self.rows.is_empty() {
            return Err(Fault::line(self.line, Problem::NoRows));
        }
        self.warnings.truncate(MOST);
        std::mem::take(&mut self.entries).truth().map(drop)
    }
}

/// Whether a column can hold a rate by its name: the time and the forces do not.
fn may_be_rate(name: &str) -> bool {
    name != StaticRow::TIME && !name.ends_with("_m_s2")
}

/// The column names, of which one that may have any name has that of a single gyro's rate, and no other but the time is
/// known.
///
/// # Errors
/// There is no such column with a rate.
fn alone(line: u64, names: &str, column: &str) -> Result<String, Fault> {
    let all: Vec<&str> = names.split(',').map(str::trim_ascii).collect();
    if !all.contains(&column) || !may_be_rate(column) {
        let there: Vec<&str> = all.into_iter().filter(|name| may_be_rate(name)).collect();
        return Err(Fault::line(line, Problem::NoRate(column.to_owned(), there.join(", "))));
    }
    let known = |(index, name): (usize, &str)| match name {
        StaticRow::TIME | "" => name.to_owned(),
        name if name == column => RATE.to_owned(),
        _ => format!("column {}", index + 1),
    };
    let known: Vec<String> = all.into_iter().enumerate().map(known).collect();
    Ok(known.join(","))
}

/// A fault, which names the column as the file does.
fn of_column(fault: Fault, column: Option<&str>) -> Fault {
    match column {
        Some(column) => fault.renamed(RATE, column),
        None => fault,
    }
}

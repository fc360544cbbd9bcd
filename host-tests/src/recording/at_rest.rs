//! A recording of kind `static`, read row by row, so that its length costs no memory.

use std::io::Read;

use super::Kind;
use super::begun::Begun;
use super::error::{Fault, ReadError};
use super::header::{Collector, Header};
use super::lines::{Lines, MAX_STREAMED_ROWS};
use super::problem::Problem;
use super::rows::{Rows, StaticRow};
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
}

/// A recording that was asked for its rows at rest.
pub enum Opened<'r> {
    /// It is of kind `static`.
    AtRest(Box<RestRows<'r>>),
    /// It is of another kind; what was passed over in its header.
    Other(Kind, Vec<Warning>),
}

impl<'r> RestRows<'r> {
    /// Reads the header of a recording from any reader, plain or gzip-compressed; `name` stands in the errors.
    ///
    /// # Errors
    /// As [`super::read`].
    pub fn open(name: &str, reader: impl Read + 'r) -> Result<Opened<'r>, ReadError> {
        let begun = Lines::within(reader, MAX_STREAMED_ROWS).and_then(Begun::new);
        begun.and_then(|begun| Self::begin(name, begun)).map_err(|fault| fault.in_file(name))
    }

    fn begin(name: &str, begun: Begun<'r>) -> Result<Opened<'r>, Fault> {
        let Begun { lines, entries, kind, header, names: (line, names), mut warnings } = begun;
        if kind != Kind::Static {
            return Ok(Opened::Other(kind, warnings));
        }
        let rows = Rows::new(line, &names, &mut warnings)?;
        let file = name.to_owned();
        let begun = Self { file, lines, rows, entries, line, header, warnings };
        Ok(Opened::AtRest(Box::new(begun)))
    }

    /// Reads so many rows, or what is left of them, of which a recording has one at least; whether there may be more.
    ///
    /// # Errors
    /// As [`super::read`].
    pub fn read(&mut self, most: usize, take: impl FnMut(StaticRow)) -> Result<bool, ReadError> {
        self.rows(most, take).map_err(|fault| fault.in_file(&self.file))
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

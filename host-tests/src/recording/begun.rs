//! A recording whose header is read and whose rows are not: what all kinds begin with.

use super::error::{Fault, Place};
use super::header::{Collector, Header};
use super::lines::Lines;
use super::problem::Problem;
use super::warning::Warning;
use super::{Kind, stops};

/// A header, the line of column names, and the input that stands before the first row.
pub(super) struct Begun<'r> {
    /// The lines behind the column names.
    pub lines: Lines<'r>,
    /// The header's lines.
    pub entries: Collector,
    /// The kind that it names.
    pub kind: Kind,
    /// What a solver may know.
    pub header: Header,
    /// The line of column names: its number and text.
    pub names: (u64, String),
    /// What was passed over so far.
    pub warnings: Vec<Warning>,
}

impl<'r> Begun<'r> {
    /// Reads the header and the line of column names.
    pub fn new(mut lines: Lines<'r>) -> Result<Self, Fault> {
        let (entries, names) = preamble(&mut lines)?;
        let kind = kind(&entries)?;
        let mut header = entries.header()?;
        if kind == Kind::Imu {
            stops::read(&entries, &mut header)?;
        }
        let names = names.ok_or_else(|| Fault::line(lines.number(), Problem::NoColumnNames))?;
        let warnings = entries.warnings();
        Ok(Self { lines, entries, kind, header, names, warnings })
    }
}

/// The line of column names: its number and text.
type Names = Option<(u64, String)>;

/// Reads the header and the line of column names, which is the first that is no comment.
fn preamble(lines: &mut Lines<'_>) -> Result<(Collector, Names), Fault> {
    let mut entries = Collector::default();
    let mut is_empty = true;
    while let Some(line) = lines.next()? {
        is_empty = false;
        if line.text.starts_with('{') {
            return Err(Fault::line(line.number, Problem::Inputs));
        }
        if !line.text.starts_with('#') {
            return Ok((entries, Some((line.number, line.text.to_owned()))));
        }
        entries.add(line.number, line.text)?;
    }
    if is_empty { Err(Fault::new(Place::Whole, Problem::Empty)) } else { Ok((entries, None)) }
}

/// The kind that the header names.
fn kind(entries: &Collector) -> Result<Kind, Fault> {
    let missing = || match entries.resembling("kind") {
        Some((line, name)) => Fault::key(line, name, Problem::NoKind),
        None => Fault::new(Place::Whole, Problem::NoKind),
    };
    let (line, text) = entries.get("kind").ok_or_else(missing)?;
    let unknown = || Fault::key(line, "kind", Problem::UnknownKind(text.to_owned()));
    Kind::ALL.into_iter().find(|kind| kind.name() == text).ok_or_else(unknown)
}

//! Reads inputs line by line.

use std::fs::File;
use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;

use orientation::navigation::{Input, Motion, aligner};
use orientation::signal::Timed;
use orientation::units::Instant;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{Header, Line, VERSION};
use crate::output::printable;
use crate::recording::checksum::Checksum;
use crate::recording::error::Fault;
use crate::recording::lines::{self, Lines};
use crate::recording::problem::Problem;
use crate::recording::{Place, ReadError};

/// Latest time that is believed, µs: 35 years, which leaves room for what is reckoned with times.
const LATEST: u64 = 1 << 50;

/// Sample periods of a keeper that may be, s.
const PERIODS: RangeInclusive<f64> = 1e-6..=10.0;

/// Reads the lines below the header.
pub struct Reader<'r> {
    file: String,
    lines: Lines<'r>,
    /// Time and line of the latest sample, increment, and time that passed without one.
    latest: [(Instant, u64); 3],
    /// Checksum of the lines so far.
    sum: Checksum,
    /// Whether the end was read.
    has_ended: bool,
}

impl Reader<'static> {
    /// Opens a file, plain or gzip-compressed, and reads its header.
    ///
    /// # Errors
    /// It cannot be read, or has no header of this version; the words name file and line.
    pub fn open(path: &Path) -> Result<(Header, Self), ReadError> {
        let name = path.display().to_string();
        let refused = |error| lines::refused(Place::Whole, &error).in_file(&name);
        Self::new(&name, File::open(path).map_err(refused)?)
    }
}

impl<'r> Reader<'r> {
    /// Reads the header from any reader; `name` stands in the errors.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn new(name: &str, reader: impl Read + 'r) -> Result<(Header, Self), ReadError> {
        let mut sum = Checksum::default();
        let begun =
            Lines::new(reader).and_then(|mut lines| Ok((header(&mut lines, &mut sum)?, lines)));
        let (header, lines) = begun.map_err(|fault| fault.in_file(name))?;
        let (file, latest, has_ended) = (name.to_owned(), Default::default(), false);
        Ok((header, Self { file, lines, latest, sum, has_ended }))
    }

    /// The next line; none at the end, and where the file breaks off: there a line that is cut short is none.
    ///
    /// # Errors
    /// A line that is none, or a time that runs backwards; the words name file and line.
    pub fn read<S: DeserializeOwned + Timed>(&mut self) -> Result<Option<Line<S>>, ReadError> {
        self.line().map_err(|fault| fault.in_file(&self.file))
    }

    fn line<S: DeserializeOwned + Timed>(&mut self) -> Result<Option<Line<S>>, Fault> {
        let read = match self.lines.next() {
            Err(fault) if fault.is_cut_short() && !self.has_ended => return Ok(None),
            read => read?,
        };
        let Some(read) = read else { return Ok(None) };
        let number = read.number;
        if self.has_ended {
            return Err(Fault::line(number, Problem::AfterEnd));
        }
        let line = match serde_json::from_str(read.text) {
            Err(_) if !read.ended => return Ok(None),
            Err(error) => return Err(Fault::line(number, Problem::NoInput(words(&error)))),
            Ok(line) => line,
        };
        match &line {
            Line::End(end) if end.checksum == self.sum.digits() => self.has_ended = true,
            Line::End(_) => return Err(Fault::line(number, Problem::InputsChanged)),
            _ => self.sum.add(read.text),
        }
        self.check_time(&line, number)?;
        Ok(Some(line))
    }

    /// Refuses a time before the latest of its sort, or beyond what is believed.
    fn check_time<S: Timed>(&mut self, line: &Line<S>, number: u64) -> Result<(), Fault> {
        let (sort, time) = match line {
            Line::Sample(sample) => (0, sample.time()),
            Line::Aligner(aligner::Input::Passed(time)) => (0, *time),
            Line::Navigator(Input::Motion(Motion::Moved(sample))) => (1, sample.time),
            Line::Navigator(Input::Passed(time)) => (2, *time),
            _ => return Ok(()),
        };
        let (before, before_line) = std::mem::replace(&mut self.latest[sort], (time, number));
        if time.0 > LATEST {
            let late = "its time lies more than 35 years after power-on".to_owned();
            return Err(Fault::line(number, Problem::NoInput(late)));
        }
        if time < before {
            let (time_s, before_s) = (time.seconds(), before.seconds());
            let problem = Problem::NotLater { time_s, before_s, before_line };
            return Err(Fault::line(number, problem));
        }
        Ok(())
    }

    /// An error of the latest line.
    pub(crate) fn error(&self, problem: Problem) -> ReadError {
        Fault::line(self.lines.number(), problem).in_file(&self.file)
    }

    /// Whether what was read is not followed by the end of a run.
    pub(crate) fn breaks_off(&self) -> bool {
        !self.has_ended
    }

    /// What there is to be said where the file breaks off.
    pub(crate) fn warning(&self) -> Option<String> {
        self.breaks_off().then(|| self.error(Problem::BrokenOff).to_string())
    }
}

/// Reads the first line.
fn header(lines: &mut Lines<'_>, sum: &mut Checksum) -> Result<Header, Fault> {
    let Some(line) = lines.next()? else {
        return Err(Fault::new(Place::Whole, Problem::Empty));
    };
    sum.add(line.text);
    let wrong = |problem| Fault::line(line.number, problem);
    let text: Value = serde_json::from_str(line.text).unwrap_or_default();
    let version = text["inputs"].as_u64().ok_or_else(|| wrong(Problem::NoInputs))?;
    if version != u64::from(VERSION) {
        let program = text["program"].as_str().unwrap_or("another program").to_owned();
        return Err(wrong(Problem::InputsVersion(version, program)));
    }
    let read = serde_json::from_str::<Header>(line.text);
    let header = read.map_err(|error| wrong(Problem::InputsHeader(words(&error))))?;
    // Any other number of it is the keeper's to bear, or is judged with the procedure.
    if !PERIODS.contains(&header.given.attitude.sample_seconds.0) {
        let period = "the attitude's `sample_seconds` is no sample period".to_owned();
        return Err(wrong(Problem::InputsHeader(period)));
    }
    Ok(header)
}

/// Longest words of what is wrong with a line's JSON, in characters: they may quote the line.
const WORDS: usize = 160;

/// What is wrong with a line's JSON, and in which column.
fn words(error: &serde_json::Error) -> String {
    let text = printable(&error.to_string());
    let (what, _) = text.rsplit_once(" at line ").unwrap_or((&text, ""));
    let what: String = what.chars().take(WORDS).collect();
    format!("{what} (column {})", error.column())
}

//! Lines of a file of any size and content, in bounded time and memory.
//!
//! A line is held whole, nothing else is; every count has a limit, so that an endless or a
//! maliciously compressed input ends in an error and not in a full memory.

use std::io::{self, BufRead, BufReader, Cursor, Read};

use flate2::read::MultiGzDecoder;
use memchr::memchr;

use super::error::{Fault, Place};
use super::problem::Problem;
use crate::interrupt;

/// Longest line, in bytes without its line end. A row has some hundred.
pub const MAX_LINE_BYTES: u64 = 64 * 1024;

/// Most rows that are held at once: over an hour at 2 kHz, 800 MB in memory.
pub const MAX_ROWS: u64 = 8_000_000;

/// Most rows that are read one after the other: over five days at 2 kHz.
pub const MAX_STREAMED_ROWS: u64 = 1_000_000_000;

/// What a gzip stream starts with (RFC 1952, section 2.3.1), and no text does.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Bytes asked of the input at once: small, so that little is read past a line that is too long.
const BUFFER_BYTES: usize = 32 * 1024;

/// How much an input may hold.
#[derive(Clone, Copy, Debug)]
struct Limits {
    /// Most rows.
    rows: u64,
    /// Most lines of any sort, blank ones and comments too.
    lines: u64,
    /// Most bytes, compressed or not.
    bytes: u64,
}

impl Limits {
    /// Limits of an input of so many rows at most: 200 bytes for each, and a million other lines.
    const fn of(rows: u64) -> Self {
        Self { rows, lines: rows + 1_000_000, bytes: 200 * rows }
    }
}

/// One line that is not blank, without spaces around it and without its line end.
pub(super) struct Line<'a> {
    /// Number of the line in the file, from 1.
    pub number: u64,
    /// Text of the line.
    pub text: &'a str,
    /// Whether it had a line end: a last line without one may be cut short.
    pub ended: bool,
}

/// The lines of an input.
pub(super) struct Lines<'r> {
    input: BufReader<Box<dyn Read + 'r>>,
    /// Bytes of the line that lie in the input's own buffer; none where `parts` has it.
    whole: usize,
    /// The line, where it came in more than one read.
    parts: Vec<u8>,
    number: u64,
    bytes: u64,
    limits: Limits,
}

impl<'r> Lines<'r> {
    /// Starts reading what is held whole; a gzip stream is known by its first bytes, whatever the file's name.
    pub fn new(reader: impl Read + 'r) -> Result<Self, Fault> {
        Self::within(reader, MAX_ROWS)
    }

    /// Starts reading no more than so many rows.
    pub fn within(reader: impl Read + 'r, rows: u64) -> Result<Self, Fault> {
        let limits = Limits::of(rows);
        let input =
            decompressed(reader, limits.bytes).map_err(|error| refused(Place::Whole, &error))?;
        let input = BufReader::with_capacity(BUFFER_BYTES, input);
        Ok(Self { input, whole: 0, parts: Vec::new(), number: 0, bytes: 0, limits })
    }

    /// Most rows that this input may have.
    pub fn most_rows(&self) -> u64 {
        self.limits.rows
    }

    /// The next line that is not blank, or `None` at the end, or where the program is interrupted.
    pub fn next(&mut self) -> Result<Option<Line<'_>>, Fault> {
        while !interrupt::ends_input() {
            let filled = self.fill();
            // What an interruption has left of a line, or of a compressed stream, is none.
            if !self.bytes().ends_with(b"\n") && interrupt::ends_input() {
                break;
            }
            if !filled? {
                return Ok(None);
            }
            if !self.content().is_empty() {
                return self.line().map(Some);
            }
        }
        interrupt::note(&format!("line {}", self.number));
        Ok(None)
    }

    /// The number of the last line read; 0 before the first.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Reads one line; `false` at the end.
    fn fill(&mut self) -> Result<bool, Fault> {
        let result = self.read();
        self.number += 1;
        let length = result.map_err(|error| refused(Place::Line(self.number), &error))? as u64;
        self.bytes += length;
        self.check_limits(length)?;
        self.number -= u64::from(length == 0);
        Ok(length > 0)
    }

    /// Reads one line where it lies, or what one read has no end of into a buffer; how many bytes it has.
    fn read(&mut self) -> io::Result<usize> {
        self.input.consume(self.whole);
        self.whole = 0;
        self.parts.clear();
        if let Some(end) = memchr(b'\n', self.input.buffer()) {
            self.whole = end + 1;
            return Ok(self.whole);
        }
        let most = MAX_LINE_BYTES + 1;
        self.input.by_ref().take(most).read_until(b'\n', &mut self.parts)
    }

    /// The line with its end.
    fn bytes(&self) -> &[u8] {
        if self.whole > 0 { &self.input.buffer()[..self.whole] } else { &self.parts }
    }

    /// Refuses what is longer than a recording can be.
    fn check_limits(&self, length: u64) -> Result<(), Fault> {
        let problem = if length > MAX_LINE_BYTES && !self.bytes().ends_with(b"\n") {
            Problem::LongLine(MAX_LINE_BYTES)
        } else if self.number > self.limits.lines && length > 0 {
            Problem::TooMany(self.limits.lines, "lines")
        } else if self.bytes > self.limits.bytes {
            Problem::TooMany(self.limits.bytes, "bytes")
        } else {
            return Ok(());
        };
        Err(Fault::line(self.number, problem))
    }

    /// The line without the space around its text, nor the byte order mark that some editors put
    /// first in a file.
    fn content(&self) -> &[u8] {
        let bytes = self.bytes();
        let first = if self.number == 1 { bytes.strip_prefix("\u{feff}".as_bytes()) } else { None };
        first.unwrap_or(bytes).trim_ascii()
    }

    /// The line as text.
    fn line(&self) -> Result<Line<'_>, Fault> {
        let text = std::str::from_utf8(self.content())
            .map_err(|_| Fault::line(self.number, Problem::NotUtf8))?;
        Ok(Line { number: self.number, text, ended: self.bytes().ends_with(b"\n") })
    }
}

/// The input itself, or what its gzip stream holds.
fn decompressed<'r>(mut reader: impl Read + 'r, most_bytes: u64) -> io::Result<Box<dyn Read + 'r>> {
    let mut magic = Vec::new();
    reader.by_ref().take(2).read_to_end(&mut magic)?;
    let is_gzip = magic == GZIP_MAGIC;
    let input = Cursor::new(magic).chain(reader);
    // Empty members give no bytes to count, so the compressed side has a limit of its own.
    Ok(if is_gzip {
        Box::new(MultiGzDecoder::new(input.take(most_bytes)))
    } else {
        Box::new(input)
    })
}

/// An error of the system.
pub(super) fn refused(place: Place, error: &io::Error) -> Fault {
    Fault::new(place, Problem::Io(error.kind(), error.to_string()))
}

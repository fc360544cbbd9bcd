//! Lines of a file of any size and content, in bounded time and memory.
//!
//! A line is held whole, nothing else is; every count has a limit, so that an endless or a
//! maliciously compressed input ends in an error and not in a full memory.

use std::io::{self, BufRead, BufReader, Cursor, Read};

use flate2::read::MultiGzDecoder;

use super::error::{Fault, Place};
use super::problem::Problem;

/// Longest line, in bytes without its line end. A row has some hundred.
pub const MAX_LINE_BYTES: u64 = 64 * 1024;

/// Most rows: over an hour at 2 kHz, 800 MB in memory.
pub const MAX_ROWS: u64 = 8_000_000;

/// Most lines of any sort, blank ones and comments too.
const MAX_LINES: u64 = MAX_ROWS + 1_000_000;

/// Most bytes, compressed or not: 200 for each row.
const MAX_BYTES: u64 = 200 * MAX_ROWS;

/// What a gzip stream starts with (RFC 1952, section 2.3.1), and no text does.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Bytes asked of the input at once: small, so that little is read past a line that is too long.
const BUFFER_BYTES: usize = 32 * 1024;

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
    buffer: Vec<u8>,
    number: u64,
    bytes: u64,
}

impl<'r> Lines<'r> {
    /// Starts reading; a gzip stream is known by its first bytes, whatever the file's name.
    pub fn new(reader: impl Read + 'r) -> Result<Self, Fault> {
        let input = decompressed(reader).map_err(|error| refused(Place::Whole, &error))?;
        let input = BufReader::with_capacity(BUFFER_BYTES, input);
        Ok(Self { input, buffer: Vec::new(), number: 0, bytes: 0 })
    }

    /// The next line that is not blank, or `None` at the end.
    pub fn next(&mut self) -> Result<Option<Line<'_>>, Fault> {
        while self.fill()? {
            if !self.content().is_empty() {
                return self.line().map(Some);
            }
        }
        Ok(None)
    }

    /// The number of the last line read; 0 before the first.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Reads one line into the buffer; `false` at the end.
    fn fill(&mut self) -> Result<bool, Fault> {
        self.buffer.clear();
        let most = MAX_LINE_BYTES + 1;
        let result = self.input.by_ref().take(most).read_until(b'\n', &mut self.buffer);
        self.number += 1;
        let length = result.map_err(|error| refused(Place::Line(self.number), &error))? as u64;
        self.bytes += length;
        self.check_limits(length)?;
        self.number -= u64::from(length == 0);
        Ok(length > 0)
    }

    /// Refuses what is longer than a recording can be.
    fn check_limits(&self, length: u64) -> Result<(), Fault> {
        let problem = if length > MAX_LINE_BYTES && !self.buffer.ends_with(b"\n") {
            Problem::LongLine(MAX_LINE_BYTES)
        } else if self.number > MAX_LINES && length > 0 {
            Problem::TooMany(MAX_LINES, "lines")
        } else if self.bytes > MAX_BYTES {
            Problem::TooMany(MAX_BYTES, "bytes")
        } else {
            return Ok(());
        };
        Err(Fault::line(self.number, problem))
    }

    /// The buffer without the space around its text, nor the byte order mark that some editors put
    /// first in a file.
    fn content(&self) -> &[u8] {
        let first =
            if self.number == 1 { self.buffer.strip_prefix("\u{feff}".as_bytes()) } else { None };
        first.unwrap_or(&self.buffer).trim_ascii()
    }

    /// The buffer as a line.
    fn line(&self) -> Result<Line<'_>, Fault> {
        let text = std::str::from_utf8(self.content())
            .map_err(|_| Fault::line(self.number, Problem::NotUtf8))?;
        Ok(Line { number: self.number, text, ended: self.buffer.ends_with(b"\n") })
    }
}

/// The input itself, or what its gzip stream holds.
fn decompressed<'r>(mut reader: impl Read + 'r) -> io::Result<Box<dyn Read + 'r>> {
    let mut magic = Vec::new();
    reader.by_ref().take(2).read_to_end(&mut magic)?;
    let is_gzip = magic == GZIP_MAGIC;
    let input = Cursor::new(magic).chain(reader);
    // Empty members give no bytes to count, so the compressed side has a limit of its own.
    Ok(if is_gzip { Box::new(MultiGzDecoder::new(input.take(MAX_BYTES))) } else { Box::new(input) })
}

/// An error of the system.
pub(super) fn refused(place: Place, error: &io::Error) -> Fault {
    Fault::new(place, Problem::Io(error.kind(), error.to_string()))
}

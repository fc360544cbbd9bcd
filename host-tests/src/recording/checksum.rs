//! Checksum of the lines that a run wrote, by which a change of them shows.

use flate2::Crc;

/// CRC-32 of gzip (RFC 1952, section 8) over lines, each with its line feed.
#[derive(Debug, Default)]
pub(super) struct Checksum(Crc);

impl Checksum {
    /// Adds a line, given without its line feed.
    pub(super) fn add(&mut self, line: &str) {
        self.0.update(line.as_bytes());
        self.0.update(b"\n");
    }

    /// The checksum of the lines so far, in hexadecimal digits.
    pub(super) fn digits(&self) -> String {
        format!("{:08x}", self.0.sum())
    }
}

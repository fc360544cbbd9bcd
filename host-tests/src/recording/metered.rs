//! How far an input is read.

use std::io::{self, Read};

/// Bytes of a mebibyte.
const MEBIBYTE: u64 = 1 << 20;

/// A reader that tells of each mebibyte which it has given.
pub struct Metered<R, F> {
    reader: R,
    bytes: u64,
    tell: F,
}

impl<R: Read, F: FnMut(u64)> Metered<R, F> {
    /// Reads from `reader`; `tell` is given how many whole mebibytes it was so far.
    pub const fn new(reader: R, tell: F) -> Self {
        Self { reader, bytes: 0, tell }
    }
}

impl<R: Read, F: FnMut(u64)> Read for Metered<R, F> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.reader.read(buffer)?;
        let before = self.bytes / MEBIBYTE;
        self.bytes += length as u64;
        let now = self.bytes / MEBIBYTE;
        if now > before {
            (self.tell)(now);
        }
        Ok(length)
    }
}

//! A simulated flash in a file, so that what a board keeps outlives its run.
//!
//! The file is the flash's bytes as gzip, whose checksum reveals a damaged one.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use simulated::flash::{BYTES, Flash};

use crate::refused;

/// The flash in a file; an erased one where there is no such file yet.
///
/// # Errors
/// A file that cannot be read, is damaged, or holds something else; the words name it.
pub fn load(path: &Path) -> Result<Flash, String> {
    match File::open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Flash::default()),
        Err(error) => Err(refused::named(path.display(), &error)),
        Ok(file) => read(file).map(Flash::holding).map_err(|error| {
            format!(
                "{}: no flash of a board, or damaged ({})",
                path.display(),
                refused::cause(&error)
            )
        }),
    }
}

fn read(file: File) -> io::Result<[u8; BYTES]> {
    let mut bytes = Vec::new();
    // One byte more than there may be reveals a longer one, and the checksum comes behind the last.
    GzDecoder::new(file).take(BYTES as u64 + 1).read_to_end(&mut bytes)?;
    let wrong = |bytes: Vec<u8>| io::Error::other(format!("{} bytes, not {BYTES}", bytes.len()));
    bytes.try_into().map_err(wrong)
}

/// The file beside a flash in which it is written first.
#[must_use]
pub fn beside(path: &Path) -> PathBuf {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".new");
    beside.into()
}

/// Writes a flash to a file, beside the old one until it is whole.
///
/// # Errors
/// A file that cannot be written; the words name it.
pub fn save(path: &Path, flash: &Flash) -> Result<(), String> {
    let beside = beside(path);
    let write = || {
        let mut file = GzEncoder::new(File::create(&beside)?, Compression::best());
        file.write_all(flash.bytes())?;
        file.finish()?.sync_all()?;
        fs::rename(&beside, path)
    };
    write().map_err(|error| refused::unwritten("the flash", path, &error))
}

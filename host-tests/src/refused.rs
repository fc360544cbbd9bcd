//! Why the system refuses to read, to write or to start something: sentences for its kinds of errors, which have numbers
//! alone.

use std::fmt::Display;
use std::io::{self, ErrorKind};
use std::path::Path;

/// The cause of an error of this kind in words; of a kind that has no sentence here, the system's own `text` without the
/// number behind it.
#[must_use]
pub fn words(kind: ErrorKind, text: &str) -> String {
    let known = match kind {
        ErrorKind::NotFound => "there is no such file or folder",
        ErrorKind::PermissionDenied => "the permission is missing",
        ErrorKind::NotADirectory => "a part of its path is a file, not a folder",
        ErrorKind::IsADirectory => "it is a directory; name a file in it",
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only",
        ErrorKind::StorageFull => "the disk is full",
        ErrorKind::QuotaExceeded => "all that the user may have on the disk is taken",
        ErrorKind::FileTooLarge => "the file would be larger than the system lets it be",
        ErrorKind::InvalidFilename => {
            "the name is too long, or has characters that the disk does not take"
        }
        ErrorKind::ResourceBusy | ErrorKind::ExecutableFileBusy => "another program has it in use",
        ErrorKind::BrokenPipe => "what should read it has ended",
        ErrorKind::OutOfMemory => "the memory is full",
        _ => return without_number(text).to_owned(),
    };
    known.to_owned()
}

/// The words of the system, without `(os error 5)` behind them.
fn without_number(text: &str) -> &str {
    text.rsplit_once(" (os error ").map_or(text, |(words, _)| words)
}

/// The cause of an error in words.
#[must_use]
pub fn cause(error: &io::Error) -> String {
    words(error.kind(), &error.to_string())
}

/// Why nothing could be written to a path.
fn at(path: &Path, error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => {
            let folder = path.parent().unwrap_or(path);
            format!("there is no such folder: {}", folder.display())
        }
        ErrorKind::PermissionDenied => "the folder or file is protected".to_owned(),
        _ => cause(error),
    }
}

/// That `what` could not be written to a file, and why.
#[must_use]
pub fn unwritten(what: &str, path: &Path, error: &io::Error) -> String {
    format!("{}: {what} cannot be written: {}", path.display(), at(path, error))
}

/// That something of this name, a file, a folder or a program, was refused, and why.
#[must_use]
pub fn named(name: impl Display, error: &io::Error) -> String {
    format!("{name}: {}", cause(error))
}

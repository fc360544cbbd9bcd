//! Why a file was not written, in words: the system's refusals that a user meets.

use std::io::{self, ErrorKind};
use std::path::Path;

/// Why nothing could be written there.
fn words(path: &Path, error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => {
            let folder = path.parent().unwrap_or(path);
            format!("there is no such folder: {}", folder.display())
        }
        ErrorKind::NotADirectory => "a part of its path is a file, not a folder".to_owned(),
        ErrorKind::PermissionDenied => "the folder or file is protected".to_owned(),
        ErrorKind::IsADirectory => "it is a directory; name a file in it".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only".to_owned(),
        ErrorKind::StorageFull => "the disk is full".to_owned(),
        _ => error.to_string(),
    }
}

/// The words with the file, and with what was to be in it.
#[must_use]
pub fn message(what: &str, path: &Path, error: &io::Error) -> String {
    format!("{}: {what} cannot be written: {}", path.display(), words(path, error))
}

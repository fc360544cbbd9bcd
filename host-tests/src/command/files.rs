//! The files of a command: what it writes must be neither what it reads nor what else it writes.
//!
//! Two names are one file where the system says so: by another path, a symbolic or a hard link.

use std::fs::{self, Metadata};
use std::path::{Path, PathBuf};

/// Links that are followed to a file that is not there yet.
const LINKS: u32 = 40;

/// A file that a command may write: the option that names it, what is written, and its path where the option is given.
pub type Written = (&'static str, &'static str, Option<PathBuf>);

/// Refuses an output that is the recording, another output, or no file.
///
/// # Errors
/// The option, and why it cannot be written there.
pub fn check(recording: Option<&Path>, outputs: &[Written]) -> Result<(), String> {
    if let Some(path) = recording.filter(|path| path.is_dir()) {
        return Err(format!("FILE: {} is a directory; name a file in it", path.display()));
    }
    let read = recording.and_then(Identity::of);
    let mut taken: Vec<(Identity, &str)> = Vec::new();
    for (option, what, path) in outputs {
        let Some(path) = path else { continue };
        let shown = path.display();
        if path.as_os_str().is_empty() {
            return Err(format!("{option}: the name of the file is empty"));
        }
        if path.is_dir() {
            return Err(format!("{option}: {shown} is a directory; name a file in it"));
        }
        let Some(place) = Identity::of(path) else { continue };
        if read.as_ref() == Some(&place) {
            return Err(format!("{option}: {shown} is the recording itself; name another file"));
        }
        if let Some((_, what)) = taken.iter().find(|(other, _)| *other == place) {
            return Err(format!("{option}: {shown} takes {what} already; name another file"));
        }
        taken.push((place, what));
    }
    Ok(())
}

/// What makes a file the same under all its names.
#[derive(Debug, PartialEq, Eq)]
enum Identity {
    /// Place of an existing file on its device.
    #[cfg(unix)]
    Node(u64, u64),
    /// Path of the file without links.
    Path(PathBuf),
}

impl Identity {
    /// Identity of the file at a path; none where the path holds nothing that can be overwritten, as a terminal.
    fn of(path: &Path) -> Option<Self> {
        match fs::metadata(path) {
            Ok(there) if there.is_file() => Some(Self::there(path, &there)),
            Ok(_) => None,
            Err(_) => Some(Self::Path(to_be(path))),
        }
    }

    #[cfg(unix)]
    fn there(_: &Path, there: &Metadata) -> Self {
        use std::os::unix::fs::MetadataExt;
        Self::Node(there.dev(), there.ino())
    }

    #[cfg(not(unix))]
    fn there(path: &Path, _: &Metadata) -> Self {
        Self::Path(path.canonicalize().unwrap_or_else(|_| path.to_path_buf()))
    }
}

/// Where a file will be that is not there yet.
fn to_be(path: &Path) -> PathBuf {
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        let Ok(target) = fs::read_link(&path) else { break };
        path = folder(&path).join(target);
    }
    let name = path.file_name().unwrap_or_default();
    folder(&path).canonicalize().map_or_else(|_| path.clone(), |folder| folder.join(name))
}

/// The folder of a file.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

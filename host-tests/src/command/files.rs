//! The files of a command: what it writes must be neither what it reads nor what else it writes.
//!
//! Two names are one file where the system says so: by another path, a symbolic or a hard link.

use std::fs::{self, Metadata};
use std::path::{Path, PathBuf};

use host::new_file::{NewFile, folder, linked};

/// A file that a command may write.
pub struct Written {
    /// The option that names it.
    option: &'static str,
    /// What is written.
    what: &'static str,
    /// How its name may end; any name does where there is none.
    endings: &'static [&'static str],
    /// Its path, where the option is given.
    path: Option<PathBuf>,
}

impl Written {
    /// A page for `--report`.
    pub fn page(path: Option<&PathBuf>) -> Self {
        Self::of("--report", "the page", &[".html", ".htm"], path)
    }

    /// A recording of a run.
    pub fn recording(path: Option<&PathBuf>) -> Self {
        Self::of("--record", "the recording", &[".csv", ".csv.gz", ".jsonl", ".jsonl.gz"], path)
    }

    /// The attitude after each sample.
    pub fn attitude(path: Option<&PathBuf>) -> Self {
        Self::of("--attitude-out", "the attitude", &[".csv"], path)
    }

    /// A board's flash.
    pub fn flash(path: Option<&PathBuf>) -> Self {
        Self::of("--flash", "the flash", &[], path)
    }

    /// The settings of an instrument.
    pub fn settings(path: &Path) -> Self {
        Self::of("FILE.toml", "the settings", &[".toml"], Some(&path.to_path_buf()))
    }

    fn of(
        option: &'static str,
        what: &'static str,
        endings: &'static [&'static str],
        path: Option<&PathBuf>,
    ) -> Self {
        Self { option, what, endings, path: path.cloned() }
    }

    /// Refuses a name that ends otherwise than it may; a terminal and the like have any.
    fn check_ending(&self, path: &Path) -> Result<(), String> {
        let name = path.to_string_lossy().to_lowercase();
        let ends = self.endings.is_empty() || self.endings.iter().any(|end| name.ends_with(end));
        let is_special = fs::metadata(path).is_ok_and(|there| !there.is_file());
        if ends || is_special {
            return Ok(());
        }
        let Self { option, what, endings, .. } = self;
        let (shown, endings) = (path.display(), endings.join(", "));
        Err(format!("{option}: {shown}: the name of {what} ends in {endings}"))
    }
}

/// Makes the file of what is written beside its place, where a path is given.
///
/// # Errors
/// Nothing can be written there; the words name it and say why.
pub fn opened(what: &'static str, path: Option<&PathBuf>) -> Result<Option<NewFile>, String> {
    path.map(|path| NewFile::open(what, path)).transpose()
}

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
    for written in outputs {
        let Written { option, what, path: Some(path), .. } = written else { continue };
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
        written.check_ending(path)?;
    }
    Ok(())
}

/// Whether two paths are those of one file.
pub fn are_one(one: &Path, other: &Path) -> bool {
    Identity::of(one).is_some_and(|place| Identity::of(other).as_ref() == Some(&place))
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
    let path = linked(path);
    let name = path.file_name().unwrap_or_default();
    folder(&path).canonicalize().map_or_else(|_| path.clone(), |folder| folder.join(name))
}

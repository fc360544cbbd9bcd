//! A file that is written beside its place until it is whole, so that what is there before is lost only to something better.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::refused;

/// The files beside their places, which go with the program.
static BESIDE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file that is to be written, and can be as far as is known before the work begins.
#[derive(Debug)]
pub struct NewFile {
    what: &'static str,
    named: PathBuf,
    /// The file itself, and the one beside it; none where the file is written at once, as a terminal is.
    beside: Option<[PathBuf; 2]>,
}

impl NewFile {
    /// Makes the file beside its place, for `what`.
    ///
    /// # Errors
    /// Nothing can be written there; the words name it and say why.
    pub fn open(what: &'static str, path: &Path) -> Result<Self, String> {
        let beside = beside(path).map_err(|error| refused::unwritten(what, path, &error))?;
        if let (Some([_, beside]), Ok(mut all)) = (&beside, BESIDE.lock()) {
            all.push(beside.clone());
        }
        Ok(Self { what, named: path.to_path_buf(), beside })
    }

    /// The file that is written to.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.beside.as_ref().map_or(&self.named, |[_, beside]| beside)
    }

    /// Why the file was not written, in words.
    #[must_use]
    pub fn unwritten(&self, error: &io::Error) -> String {
        refused::unwritten(self.what, &self.named, error)
    }

    /// Puts the file, which is whole, into its place.
    ///
    /// # Errors
    /// The system does not let it; the words say why.
    pub fn keep(mut self) -> Result<(), String> {
        let Some([file, beside]) = self.beside.take() else { return Ok(()) };
        let kept = fs::rename(&beside, file);
        forget(&beside);
        kept.map_err(|error| self.unwritten(&error))
    }

    /// Writes the file, and puts it into its place.
    ///
    /// # Errors
    /// What `by` says, or what keeps it from its place.
    pub fn write(self, by: impl FnOnce(&Path) -> Result<(), String>) -> Result<(), String> {
        let [path, named] = [self.path(), &self.named].map(|path| path.display().to_string());
        by(self.path()).map_err(|words| words.replace(&path, &named))?;
        self.keep()
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if let Some([_, beside]) = &self.beside {
            forget(beside);
        }
    }
}

/// Removes a file beside its place, where it is still there.
fn forget(beside: &Path) {
    // One that is left behind does no harm.
    let _ = fs::remove_file(beside);
    if let Ok(mut all) = BESIDE.lock() {
        all.retain(|other| other != beside);
    }
}

/// Removes all files that are not in their places: the program ends.
pub fn clear() {
    let all = BESIDE.lock().map(|all| all.clone()).unwrap_or_default();
    for beside in &all {
        forget(beside);
    }
}

/// Makes the file beside its place.
fn beside(path: &Path) -> io::Result<Option<[PathBuf; 2]>> {
    let there = fs::metadata(path);
    if there.as_ref().is_ok_and(|there| !there.is_file()) || is_of_system(path) {
        return Ok(None);
    }
    if there.is_ok() {
        // What is protected stays as it is.
        OpenOptions::new().append(true).open(path)?;
    }
    let file = linked(path);
    let beside = unused(&file);
    match File::create_new(&beside) {
        // A file in a protected folder is written at once.
        Err(_) if there.is_ok() => return Ok(None),
        made => made.map(drop)?,
    }
    if let Ok(there) = there {
        fs::set_permissions(&beside, there.permissions())?;
    }
    Ok(Some([file, beside]))
}

/// Whether a path leads to something that the system keeps, as an open file of this program.
fn is_of_system(path: &Path) -> bool {
    ["/dev", "/proc"].iter().any(|folder| path.starts_with(folder))
}

/// Links that are followed to a file that is not there yet.
const LINKS: u32 = 40;

/// The file to which symbolic links lead, be it there or not.
#[must_use]
pub fn linked(path: &Path) -> PathBuf {
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        let Ok(target) = fs::read_link(&path) else { break };
        path = folder(&path).join(target);
    }
    path
}

/// The folder of a file.
#[must_use]
pub fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A name beside a file that no other file has; its end is the file's, which says what is in it.
fn unused(file: &Path) -> PathBuf {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!(".new-{}-{number}-{name}", std::process::id()))
}

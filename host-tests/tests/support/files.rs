//! Stored recordings, and files of a test's own.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use flate2::read::MultiGzDecoder;
use host::recording::{Recording, read};

/// The folder of the stored recordings.
pub fn recordings() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/recordings")
}

/// The path of a stored recording.
pub fn stored(name: &str) -> String {
    recordings().join(name).with_extension("csv.gz").display().to_string()
}

/// A stored recording.
#[track_caller]
pub fn recording(name: &str) -> Recording {
    read(Path::new(&stored(name))).unwrap_or_else(|error| panic!("{error}"))
}

/// A stored recording as text.
pub fn unpacked(name: &str) -> String {
    let file = File::open(stored(name)).expect("it is there");
    let mut text = String::new();
    MultiGzDecoder::new(file).read_to_string(&mut text).expect("it is text in gzip");
    text
}

/// A folder of its own for one test, gone with it.
pub struct Scratch(PathBuf);

impl Scratch {
    pub fn new(name: &str) -> Self {
        // Tests of one process run side by side, and may give the same name.
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let name = format!("{name}-{}-{number}", std::process::id());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::create_dir_all(&path).expect("the folder is ours");
        Self(path)
    }

    pub fn folder(&self) -> &Path {
        &self.0
    }

    /// The path of a file in it.
    pub fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    /// The path of a file in it that holds this.
    pub fn with(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        fs::write(self.0.join(name), content).expect("the folder is ours");
        self.path(name)
    }

    /// What a file in it holds.
    #[track_caller]
    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("it was written")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A folder that is left behind does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

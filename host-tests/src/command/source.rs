//! Where recordings come from: files, all recordings of a folder, standard input.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Cursor, Read, stdin};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use flate2::read::MultiGzDecoder;
use host::interrupt;
use host::output::printable;
use host::output::progress::Progress;
use host::recording::inputs;
use host::refused;

/// The name of standard input on the command line.
const INPUT: &str = "-";
/// How the names of recordings end, by which they are found in a folder.
const ENDINGS: [&str; 4] = [".csv", ".csv.gz", ".jsonl", ".jsonl.gz"];
/// What a gzip stream starts with (RFC 1952, section 2.3.1), and no text does.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];
/// Files below this, bytes, are read before anybody would look for progress.
const SMALL: u64 = 32 << 20;

/// A recording that is to be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// Standard input.
    Input,
    /// A file.
    File(PathBuf),
}

/// What is read, and whether it is the inputs of a run.
pub type Opened<'p> = (Box<dyn Read + 'p>, bool);

impl Source {
    /// What an argument names, which is no folder.
    pub fn of(argument: &Path) -> Self {
        if argument.as_os_str() == INPUT { Self::Input } else { Self::File(argument.to_owned()) }
    }

    /// The recordings that the arguments name, those of a folder sorted by their names.
    ///
    /// # Errors
    /// A folder without recordings, or one that cannot be read; standard input twice.
    pub fn all(arguments: &[PathBuf]) -> Result<Vec<Self>, String> {
        let mut all = Vec::new();
        for path in arguments {
            match Self::of(path) {
                Self::File(path) if path.is_dir() => all.extend(in_folder(&path)?),
                source => all.push(source),
            }
        }
        if all.iter().filter(|source| **source == Self::Input).count() > 1 {
            return Err("FILE: standard input can be read once".to_owned());
        }
        Ok(all)
    }

    /// What texts call it: its name, which may hold anything, as a terminal can show it.
    pub fn shown(&self) -> String {
        printable(&self.name())
    }

    /// What objects call it.
    pub fn name(&self) -> String {
        match self {
            Self::Input => "standard input".to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }

    /// The file, where it is one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Input => None,
            Self::File(path) => Some(path),
        }
    }

    /// Whether its name says that it holds the inputs of a run.
    pub fn is_named_inputs(&self) -> bool {
        self.path().is_some_and(inputs::is_named)
    }

    /// Opens it. A file tells by its name whether it holds the inputs of a run, standard input by its first character.
    ///
    /// # Errors
    /// The system's.
    pub fn open<'p>(&self, progress: Option<&'p Progress>) -> io::Result<Opened<'p>> {
        let Self::File(path) = self else {
            let mut reader = unpacked(Awaited::input())?;
            let is_inputs = reader.fill_buf()?.first() == Some(&b'{');
            return Ok((Box::new(reader), is_inputs));
        };
        let (file, is_inputs) = (File::open(path)?, inputs::is_named(path));
        let all = file.metadata().map_or(0, |there| there.len());
        match progress.filter(|_| all > SMALL) {
            Some(progress) => {
                Ok((Box::new(Counted { inner: file, done: 0, all, progress }), is_inputs))
            }
            None => Ok((Box::new(file), is_inputs)),
        }
    }
}

/// The recordings of a folder, but not of those in it.
fn in_folder(folder: &Path) -> Result<Vec<Source>, String> {
    let failed = |error: io::Error| refused::named(folder.display(), &error);
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    paths.retain(|path| is_recording(path));
    paths.sort();
    if paths.is_empty() {
        let (shown, endings) = (folder.display(), ENDINGS.join(", "));
        return Err(format!("FILE: {shown}: no recording is in this folder ({endings})"));
    }
    Ok(paths.into_iter().map(Source::File).collect())
}

/// Whether a file is a recording by its name; a hidden one is not.
fn is_recording(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    !name.starts_with('.') && ENDINGS.iter().any(|end| name.ends_with(end)) && path.is_file()
}

/// The input itself, or what its gzip stream holds.
fn unpacked(mut reader: impl Read + 'static) -> io::Result<BufReader<Box<dyn Read>>> {
    let mut magic = Vec::new();
    reader.by_ref().take(2).read_to_end(&mut magic)?;
    let is_gzip = magic == GZIP_MAGIC;
    let input = Cursor::new(magic).chain(reader);
    Ok(BufReader::new(if is_gzip { Box::new(MultiGzDecoder::new(input)) } else { Box::new(input) }))
}

/// Bytes that are read of standard input at once.
const CHUNK: usize = 64 << 10;
/// Chunks that wait to be taken.
const WAITING: usize = 4;
/// Time after which it is looked whether an end is asked for, where nothing comes.
const PATIENCE: Duration = Duration::from_millis(50);

/// Standard input, read by a thread of its own: it ends where an end is asked for, although whatever feeds it goes on.
struct Awaited {
    chunks: Receiver<io::Result<Vec<u8>>>,
    chunk: Cursor<Vec<u8>>,
}

impl Awaited {
    /// Begins to read standard input.
    fn input() -> Self {
        let (sender, chunks) = sync_channel(WAITING);
        thread::spawn(move || hand_over(&sender));
        Self { chunks, chunk: Cursor::default() }
    }

    /// The next chunk; none at the end, and where an end is asked for.
    fn next(&self) -> io::Result<Option<Vec<u8>>> {
        loop {
            match self.chunks.recv_timeout(PATIENCE) {
                Ok(chunk) => return chunk.map(Some),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) if interrupt::ends_input() => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }
}

impl Read for Awaited {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.chunk.fill_buf()?.is_empty() {
            self.chunk = Cursor::new(self.next()?.unwrap_or_default());
        }
        self.chunk.read(buffer)
    }
}

/// Hands standard input over chunk by chunk, until it ends or no more of it is wanted.
fn hand_over(to: &SyncSender<io::Result<Vec<u8>>>) {
    let mut input = stdin().lock();
    let mut chunk = vec![0; CHUNK];
    loop {
        let read = match input.read(&mut chunk) {
            Ok(0) => return,
            read => read.map(|length| chunk[..length].to_vec()),
        };
        let is_last = read.is_err();
        if to.send(read).is_err() || is_last {
            return;
        }
    }
}

/// A file whose reading is shown.
struct Counted<'p> {
    inner: File,
    done: u64,
    all: u64,
    progress: &'p Progress,
}

impl Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.inner.read(buffer)?;
        let before = self.done >> 20;
        self.done += length as u64;
        let [done, all] = [self.done, self.all].map(|bytes| bytes >> 20);
        if done > before {
            self.progress.reached((self.done, self.all), &format!("reading, {done} of {all} MiB"));
        }
        Ok(length)
    }
}

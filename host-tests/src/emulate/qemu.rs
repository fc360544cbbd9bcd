//! Runs an image in QEMU for a bounded time.

use std::io::{ErrorKind, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use crate::refused;

/// The emulator.
pub const PROGRAM: &str = "qemu-system-arm";

/// Options of the emulator before the image, as the runner in `.cargo/config.toml` has them: flash and RAM where
/// the board has them, semihosting to standard output, 2⁵ ns of virtual time for each instruction.
pub const OPTIONS: &str = "-machine netduinoplus2 -nographic -monitor none -serial none \
    -semihosting-config enable=on,target=native -icount shift=5,align=off,sleep=off -kernel";

/// Bytes that are read at once.
const CHUNK: usize = 4096;

/// Makes sure that there is an emulator.
///
/// # Errors
/// What to install.
pub fn require() -> Result<(), String> {
    let mut command = Command::new(PROGRAM);
    let quiet = command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null());
    match quiet.stderr(Stdio::null()).status() {
        Ok(status) if status.success() => Ok(()),
        Err(error) if error.kind() != ErrorKind::NotFound => Err(refused::named(PROGRAM, &error)),
        _ => Err(format!(
            "{PROGRAM} is not installed: install the package qemu-system-arm (Debian, Ubuntu) or qemu"
        )),
    }
}

/// Runs `image` with further options and hands over what it prints; how it ended.
///
/// # Errors
/// An error of `take`, or an emulator that does not start or does not end within `limit`; it is
/// stopped then.
pub fn run(
    image: &Path,
    options: &[&str],
    limit: Duration,
    take: impl FnMut(&[u8]) -> Result<(), String>,
) -> Result<ExitStatus, String> {
    let mut command = Command::new(PROGRAM);
    command.args(OPTIONS.split_whitespace()).arg(image).args(options);
    watch(command, limit, take)
}

/// Runs a command, hands over what it prints, and stops it when its time is over.
///
/// # Errors
/// As [`run`].
pub fn watch(
    mut command: Command,
    limit: Duration,
    mut take: impl FnMut(&[u8]) -> Result<(), String>,
) -> Result<ExitStatus, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let failed = |error| refused::named(&name, &error);
    let end = Instant::now() + limit;
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().map_err(failed)?;
    let mut running = Running(child);
    let chunks = running.0.stdout.take().map(chunks).ok_or("no output to read")?;
    loop {
        match chunks.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(chunk) => take(&chunk)?,
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                return Err(format!("{name} did not end within {limit:?} and was stopped"));
            }
        }
    }
    running.0.wait().map_err(failed)
}

/// A process that does not outlive its owner.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // Both fail only where it has ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What a pipe brings, read by a thread of its own so that waiting for it can end.
fn chunks(mut pipe: impl Read + Send + 'static) -> Receiver<Vec<u8>> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut chunk = [0; CHUNK];
        while let Ok(count @ 1..) = pipe.read(&mut chunk) {
            if sender.send(chunk[..count].to_vec()).is_err() {
                break;
            }
        }
    });
    receiver
}

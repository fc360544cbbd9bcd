//! Images and programs of the workspace, built by cargo.

use std::env;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

use firmware::platform::Platform;
use serde_json::Value;

use crate::carrier;

/// The Cortex-M4F with its floating-point unit.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// What a build may lack, beside the words by which the crates that look for it say so.
const LACKING: [[&str; 2]; 2] = [
    ["is `cmake` not installed?", "cmake is missing (Debian: apt-get install cmake)"],
    ["find libclang", "libclang is missing (Debian: apt-get install libclang-dev)"],
];

/// The workspace that this program was built from.
#[must_use]
pub fn root() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().nth(2).unwrap_or(own)
}

/// Builds the image of a carrier, as `cargo board` flashes it, as a file of its own, which later builds replace only as
/// a whole.
///
/// # Errors
/// One line: what is missing, that cargo said what is wrong, or that something else built another image meanwhile.
pub fn image(carrier: Platform) -> Result<PathBuf, String> {
    image_with(carrier, None)
}

/// Name of the file of a carrier's image, with a further feature of the board's crate or without one.
#[must_use]
pub fn name(carrier: Platform, feature: Option<&str>) -> String {
    format!("board-{}.elf", features(carrier, feature).join("-"))
}

/// Features of the board's crate for an image.
fn features(carrier: Platform, feature: Option<&str>) -> Vec<&str> {
    [Some(carrier.name()), feature].into_iter().flatten().collect()
}

/// As [`image`], with a further feature of the board's crate.
///
/// # Errors
/// As there.
pub fn image_with(carrier: Platform, feature: Option<&str>) -> Result<PathBuf, String> {
    let _others_wait = lock()?;
    let features = features(carrier, feature).join(",");
    let package = ["--package", "board-b-l475e-iot01a", "--features", &features];
    let elf = executable(&of_firmware(&package)?, "board")?;
    let own = elf.with_file_name(name(carrier, feature));
    let new = own.with_extension("new");
    let failed = |error: io::Error| format!("{}: {error}", own.display());
    fs::copy(&elf, &new).map_err(failed)?;
    let bytes = fs::read(&new).map_err(failed)?;
    carrier::require(&bytes, carrier).map_err(|error| format!("{}: {error}", new.display()))?;
    fs::rename(&new, &own).map_err(failed)?;
    Ok(own)
}

/// Makes all others that build images in this target folder wait for as long as it lives: cargo gives the image of each
/// carrier the same name.
fn lock() -> Result<File, String> {
    let metadata = cargo(&["metadata", "--no-deps", "--format-version", "1"])?;
    let metadata: Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let folder = metadata["target_directory"].as_str().ok_or("cargo metadata: no target folder")?;
    let path = Path::new(folder).join("images.lock");
    let failed = |error: io::Error| format!("{}: {error}", path.display());
    fs::create_dir_all(folder).map_err(failed)?;
    let file = File::create(&path).map_err(failed)?;
    file.lock().map_err(failed)?;
    Ok(file)
}

/// Has cargo build something for the microcontroller, in the profile of what is flashed; its messages.
///
/// # Errors
/// One line: what is missing, or that cargo said what is wrong.
pub fn of_firmware(arguments: &[&str]) -> Result<String, String> {
    require_target()?;
    of(&[arguments, &["--profile", "firmware", "--target", TARGET]].concat())
}

/// Has cargo build something; its messages, one JSON object in a line. Its progress goes to standard error.
///
/// # Errors
/// One line: what is missing, or that cargo said what is wrong.
pub fn of(arguments: &[&str]) -> Result<String, String> {
    cargo(&[&["build", "--message-format", "json-render-diagnostics"], arguments].concat())
}

/// What a run of cargo's prints: of the one that runs this program, or of the one there is.
fn cargo(arguments: &[&str]) -> Result<String, String> {
    let program = env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = in_workspace(&program)?;
    command.args(arguments).arg("--locked");
    if io::stderr().is_terminal() {
        command.env("CARGO_TERM_COLOR", "always");
    }
    let failed = |error: io::Error| format!("cargo: {error}");
    let mut child =
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(failed)?;
    let progress = child.stderr.take().map(|pipe| thread::spawn(move || shown(pipe)));
    let output = child.wait_with_output().map_err(failed)?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let progress = progress.and_then(|thread| thread.join().ok()).unwrap_or_default();
    let lacking = LACKING.iter().find(|[words, _]| progress.contains(words));
    let lacking = lacking.map_or(String::new(), |[_, remedy]| format!("; {remedy}"));
    Err(format!("the firmware does not build: cargo says why{lacking}"))
}

/// A program that is to run in the folder of the sources.
fn in_workspace(program: &OsStr) -> Result<Command, String> {
    if !root().join("memory.x").is_file() {
        return Err(format!("the firmware's sources are not at {}", root().display()));
    }
    let mut command = Command::new(program);
    command.current_dir(root());
    Ok(command)
}

/// Hands what a pipe brings on to standard error, and returns all of it.
fn shown(mut pipe: impl Read) -> String {
    let (mut all, mut chunk) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = pipe.read(&mut chunk) {
        // The build goes on even where standard error is closed.
        let _ = io::stderr().write_all(&chunk[..count]);
        all.extend_from_slice(&chunk[..count]);
    }
    String::from_utf8_lossy(&all).into_owned()
}

/// Makes sure that the compiler has the target's libraries.
fn require_target() -> Result<(), String> {
    let mut command = in_workspace("rustc".as_ref())?;
    let output = command
        .args(["--print", "target-libdir", "--target", TARGET])
        .output()
        .map_err(|error| format!("rustc: {error}"))?;
    let folder = String::from_utf8_lossy(&output.stdout);
    if Path::new(folder.trim()).is_dir() {
        return Ok(());
    }
    Err(format!("Rust's target {TARGET} is not installed: rustup target add {TARGET}"))
}

/// An executable in cargo's messages, one JSON object in a line.
///
/// # Errors
/// It is not there.
pub fn executable(messages: &str, name: &str) -> Result<PathBuf, String> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let named = messages.filter(|message| message["target"]["name"] == name);
    let mut paths = named.filter_map(|message| message["executable"].as_str().map(PathBuf::from));
    paths.next_back().ok_or_else(|| format!("cargo built no image `{name}`"))
}

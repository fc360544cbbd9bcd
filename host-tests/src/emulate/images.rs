//! Builds the firmware's images for the emulator by cargo.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

/// The Cortex-M4F with its floating-point unit.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The images, as files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Images {
    /// The instrument on simulated chips.
    pub emulator: PathBuf,
    /// The count of the cores' instructions.
    pub cost: PathBuf,
}

/// The workspace that this program was built from.
#[must_use]
pub fn root() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own)
}

/// Builds both images; cargo's progress goes to standard error.
///
/// # Errors
/// One line: what is missing, or that cargo said what is wrong.
pub fn build() -> Result<Images, String> {
    artifacts(&built(&["--package", "emulator", "--profile", "firmware", "--target", TARGET])?)
}

/// Has cargo build something; its messages, one JSON object in a line. Its progress goes to standard error.
///
/// # Errors
/// One line: what is missing, or that cargo said what is wrong.
pub fn built(arguments: &[&str]) -> Result<String, String> {
    if !root().join("memory.x").is_file() {
        return Err(format!("the firmware's sources are not at {}", root().display()));
    }
    require_target()?;
    let mut command = Command::new(cargo());
    command.current_dir(root()).arg("build").args(arguments);
    command.args(["--message-format", "json-render-diagnostics"]);
    let output = command.stderr(Stdio::inherit()).output().map_err(|e| format!("cargo: {e}"))?;
    if !output.status.success() {
        return Err("the firmware does not build: cargo says why".to_owned());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The cargo that runs this program, or the one there is.
fn cargo() -> OsString {
    env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Makes sure that the compiler has the target's libraries.
fn require_target() -> Result<(), String> {
    let mut command = Command::new("rustc");
    command.current_dir(root()).args(["--print", "target-libdir", "--target", TARGET]);
    let output = command.output().map_err(|error| format!("rustc: {error}"))?;
    let folder = String::from_utf8_lossy(&output.stdout);
    if Path::new(folder.trim()).is_dir() {
        return Ok(());
    }
    Err(format!("Rust's target {TARGET} is not installed: rustup target add {TARGET}"))
}

/// The executables in cargo's messages, one JSON object in a line.
///
/// # Errors
/// Which is not there.
pub fn artifacts(messages: &str) -> Result<Images, String> {
    Ok(Images { emulator: executable(messages, "emulator")?, cost: executable(messages, "cost")? })
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

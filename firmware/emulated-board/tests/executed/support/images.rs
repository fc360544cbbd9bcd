//! The images of all carriers, built once.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::rc::Rc;
use std::sync::OnceLock;

use emulated_board::image::Image;
use firmware::platform::Platform;
use serde_json::Value;

/// The folder of the workspace.
pub fn root() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().nth(2).expect("the crate lies in the workspace's folder `firmware`")
}

/// The image of a carrier.
pub fn image(carrier: Platform) -> Rc<Image> {
    let path = folder().join(carrier.name());
    Rc::new(Image::read(&path).unwrap_or_else(|error| panic!("the image of {carrier}: {error}")))
}

/// The folder with a file for each carrier: that of the variable `MERIDIAN_IMAGES`, or one with images that are
/// built now.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| env::var_os("MERIDIAN_IMAGES").map_or_else(build_all, PathBuf::from))
}

/// Builds the images one after the other: each has the name of the one before.
fn build_all() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("images");
    fs::create_dir_all(&folder).expect("cargo's folder for tests takes another");
    for carrier in Platform::ALL {
        fs::copy(build(carrier), folder.join(carrier.name())).expect("an image can be copied");
    }
    folder
}

/// Builds the image of a carrier, as `cargo board` does.
fn build(carrier: Platform) -> PathBuf {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo")));
    command.current_dir(root()).args(["build", "--locked", "--package", "board-b-l475e-iot01a"]);
    command.args([
        "--target",
        "thumbv7em-none-eabihf",
        "--profile",
        "firmware",
        "--features",
        carrier.name(),
    ]);
    command.args(["--message-format", "json-render-diagnostics"]).stderr(Stdio::inherit());
    let output = command.output().expect("cargo can be started");
    assert!(output.status.success(), "the image of {carrier} does not build: cargo says why");
    let messages = String::from_utf8_lossy(&output.stdout);
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let mut built =
        messages.filter_map(|message| message["executable"].as_str().map(PathBuf::from));
    built.next_back().unwrap_or_else(|| panic!("cargo built no image of {carrier}"))
}

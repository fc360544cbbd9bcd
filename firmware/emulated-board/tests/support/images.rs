//! The images of the carriers, each built once.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::rc::Rc;
use std::sync::Mutex;

use emulated_board::image::Image;
use firmware::platform::Platform;
use serde_json::Value;

/// The folder of the workspace.
pub fn root() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().nth(2).expect("the crate lies in the workspace's folder `firmware`")
}

/// Carriers whose images were built; one after the other, since each has the name of the one before.
static BUILT: Mutex<Vec<Platform>> = Mutex::new(Vec::new());

/// The image of a carrier, `board-NAME.elf`: of the folder that the environment variable `MERIDIAN_IMAGES` names, or
/// built.
pub fn image(carrier: Platform) -> Rc<Image> {
    let folder = env::var_os("MERIDIAN_IMAGES").map_or_else(|| built(carrier), PathBuf::from);
    let image = Image::read(&folder.join(name(carrier)));
    Rc::new(image.unwrap_or_else(|error| panic!("the image of {carrier}: {error}")))
}

/// The file of a carrier's image.
fn name(carrier: Platform) -> String {
    format!("board-{}.elf", carrier.name())
}

/// The folder into which the image of a carrier has been built.
fn built(carrier: Platform) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("images");
    let mut all = BUILT.lock().expect("no build has panicked");
    if !all.contains(&carrier) {
        fs::create_dir_all(&folder).expect("cargo's folder for tests takes another");
        fs::copy(build(carrier), folder.join(name(carrier))).expect("an image can be copied");
        all.push(carrier);
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

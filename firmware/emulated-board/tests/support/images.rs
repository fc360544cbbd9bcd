//! The images of the carriers, each built once.

use std::env;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::OnceLock;

use emulated_board::image::Image;
use execution::{built, carrier};
use firmware::platform::Platform;

/// The images that were built, by their carriers.
static BUILT: [OnceLock<PathBuf>; Platform::ALL.len()] = [const { OnceLock::new() }; _];

/// The image of a carrier.
pub fn image(of: Platform) -> Rc<Image> {
    read(path(of), of)
}

/// The image of a carrier in a file.
pub fn read(path: &Path, of: Platform) -> Rc<Image> {
    let image = Image::read(path).unwrap_or_else(|error| panic!("{error}"));
    carrier::require(&image.elf, of).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Rc::new(image)
}

/// The file of a carrier's image, `board-NAME.elf`: in the folder that the environment variable `MERIDIAN_IMAGES` names,
/// or built.
pub fn path(carrier: Platform) -> &'static Path {
    BUILT[carrier as usize].get_or_init(|| found(carrier, None))
}

/// The file of an image with a further feature or without one, found there or built.
pub fn found(carrier: Platform, feature: Option<&str>) -> PathBuf {
    match env::var_os("MERIDIAN_IMAGES") {
        Some(folder) => Path::new(&folder).join(built::name(carrier, feature)),
        None => built::image_with(carrier, feature).unwrap_or_else(|error| panic!("{error}")),
    }
}

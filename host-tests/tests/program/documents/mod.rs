//! The pages beside the crates are true: commands and options exist, figures are computed anew, outputs are verbatim, and
//! links lead to something.

mod command_line;
mod links;
mod readme;
mod ten_minutes;
mod wiring;

use std::fs;
use std::path::{Path, PathBuf};

/// A file of the project, by its path from the top.
fn place(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The text of a file.
fn page(path: &str) -> String {
    fs::read_to_string(place(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The lines of a page behind a mark, up to an empty one.
fn marked(page: &str, mark: &str) -> Vec<String> {
    let (_, behind) = page.split_once(&format!("<!-- {mark} -->\n")).expect("the mark is there");
    behind.lines().take_while(|line| !line.is_empty()).map(str::to_owned).collect()
}

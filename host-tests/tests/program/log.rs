//! `meridian log`: what it refuses. What it prints is held to executed images by the tests of `emulated-board`.

use crate::support::files::Scratch;
use crate::support::program::{assert_misuse, code, meridian, reason};

#[test]
fn a_file_that_is_no_image_is_named_with_what_it_lacks() {
    let scratch = Scratch::new("log");
    let (image, pages) =
        (scratch.with("board.elf", "no image"), scratch.with("pages", [0xFF; 2048]));
    let output = meridian(&["log", &image, &pages]);
    assert_eq!(code(&output), 1);
    let reason = reason(&output);
    assert!(reason.contains("board.elf: the image's strings cannot be read"), "{reason}");
}

#[test]
fn a_dump_that_is_not_there_is_named() {
    let scratch = Scratch::new("log");
    let image = scratch.with("board.elf", "no image");
    let output = meridian(&["log", &image, &scratch.path("pages")]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).ends_with("pages: there is no such file"), "{}", reason(&output));
}

#[test]
fn without_a_dump_the_command_says_that_it_needs_one() {
    assert_misuse(&["log"], "FILE");
}

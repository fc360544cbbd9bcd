//! The wiring that `firmware/README.md` shows has the pins that the image of the board takes.

use std::collections::BTreeSet;

use super::{marked, page};

/// The pins of the controller that a text names, as `PA5`.
fn pins(text: &str) -> BTreeSet<String> {
    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric());
    let is_pin = |word: &&str| {
        let mut letters = word.chars();
        letters.next() == Some('P')
            && letters.next().is_some_and(|port| ('A'..='H').contains(&port))
            && word.len() > 2
            && letters.all(|digit| digit.is_ascii_digit())
    };
    words.filter(is_pin).map(str::to_owned).collect()
}

#[test]
fn the_wiring_has_every_pin_that_the_image_takes_and_no_other() {
    let shown = pins(&marked(&page("firmware/README.md"), "the wiring").join("\n"));
    let taken = pins(&page("firmware/board-b-l475e-iot01a/src/pins.rs"));
    assert!(shown.len() > 20);
    assert_eq!(shown, taken);
}

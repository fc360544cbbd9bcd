//! Words that are no command: they are refused before anything is sent.

use crate::support::program::assert_misuse;

/// An address at which nothing is opened in these tests.
const PORT: &str = "tcp:127.0.0.1:9";

#[test]
fn what_no_sentence_may_have_is_refused_with_the_word_and_the_character() {
    for (word, letter) in [
        ("4,7", ","),
        ("a*b", "*"),
        ("$x", "$"),
        ("a\\b", "\\"),
        ("^", "^"),
        ("!", "!"),
        ("47°", "°"),
    ] {
        let words = format!("{word}: a sentence may not have the character `{letter}`");
        assert_misuse(&["send", PORT, "set", "latitude", word], &words);
        assert_misuse(&["settings", PORT, "set", "latitude", word], &words);
    }
    assert_misuse(&["send", PORT, "set", "latitude", "4\u{7}7"], "may not have the character");
}

#[test]
fn a_command_that_does_not_exist_is_refused_with_the_one_that_resembles_it() {
    assert_misuse(&["send", PORT, "strat"], "there is no command strat; did you mean `start`?");
    assert_misuse(
        &["send", PORT, "xyz"],
        "there is no command xyz; there are start, stop, realign",
    );
}

#[test]
fn a_command_with_too_few_or_too_many_words_says_how_many_it_takes() {
    assert_misuse(&["send", PORT, "azimuth", "12"], "azimuth takes an azimuth and its 1σ");
    assert_misuse(&["send", PORT, "save", "now"], "save takes no further word");
    assert_misuse(
        &["send", PORT, "set", "latitude"],
        "set takes the name of a setting and its value",
    );
    assert_misuse(&["send", PORT, "azimuth", "12", "x"], "azimuth 12 x: not a number");
    assert_misuse(&["settings", PORT, "set", "latitude"], "latitude has no value");
}

#[test]
fn a_command_that_is_longer_than_a_sentence_is_refused() {
    let value = "9".repeat(80);
    assert_misuse(&["send", PORT, "set", "latitude", &value], "longer than 82 characters");
}

#[test]
fn an_address_that_is_none_says_what_is_meant() {
    for address in ["tcp:", "tcp:x", "tcp::5", "tcp:0", "tcp:70000", "tcp:bench:"] {
        assert_misuse(&["send", address, "start"], "tcp: and a port, or a computer and a port");
    }
    assert_misuse(&["send", "", "start"], "the name of the port is empty");
    assert_misuse(&["send", PORT, "start", "--wait", "0"], "--wait");
    assert_misuse(&["send", PORT, "start", "--baud", "12"], "--baud");
}

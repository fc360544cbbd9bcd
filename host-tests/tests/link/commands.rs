//! Commands as people and programs write them.

use proptest::prelude::*;
use protocol::command::{Command, NoCommand, WORDS, number, parse};

/// A line of these words as a sentence.
fn sentence(words: &str) -> String {
    let content = format!("PMRDC,{}", words.replace(' ', ","));
    format!("${content}*{:02X}", content.bytes().fold(0, |sum, byte| sum ^ byte))
}

#[test]
fn a_command_is_the_same_as_words_and_as_a_sentence() {
    let commands = [
        ("start", Command::Start),
        ("stop", Command::Stop),
        ("realign", Command::Realign),
        ("azimuth 213.7 0.5", Command::Azimuth(213.7, 0.5)),
        ("get", Command::Get(None)),
        ("get latitude", Command::Get(Some("latitude"))),
        ("set latitude -47.58", Command::Set("latitude", "-47.58")),
        ("save", Command::Save),
        ("restore", Command::Restore),
        ("test", Command::Test),
        ("log", Command::Log),
        ("reboot", Command::Reboot),
    ];
    for (words, command) in commands {
        assert_eq!(parse(words), Some(Ok(command)), "{words}");
        assert_eq!(parse(&sentence(words)), Some(Ok(command)), "{words}");
        assert_eq!(parse(&format!("{words} ")), Some(Ok(command)), "{words} with a blank");
    }
    let first = |(words, _): &(&'static str, _)| words.split(' ').next().expect("it has a word");
    assert!(WORDS.iter().all(|word| commands.iter().map(first).any(|first| first == *word)));
}

#[test]
fn what_is_wrong_with_a_line_is_said() {
    let cases = [
        ("align", NoCommand::Unknown),
        ("Start", NoCommand::Unknown),
        ("start now", NoCommand::Words),
        ("azimuth 10", NoCommand::Words),
        ("azimuth 10 0.5 1", NoCommand::Words),
        ("azimuth north 0.5", NoCommand::Number),
        ("set latitude", NoCommand::Words),
        ("get a b", NoCommand::Words),
        ("$PMRDC,start*00", NoCommand::Checksum),
        ("$PMRDC,start", NoCommand::Checksum),
        ("$PMRDC,start*6", NoCommand::Checksum),
        ("$PMRDC,start*+6", NoCommand::Checksum),
    ];
    for (line, reason) in cases {
        assert_eq!(parse(line), Some(Err(reason)), "{line}");
    }
}

#[test]
fn sentences_for_others_are_none_of_ours() {
    let others = [
        "$GPGGA,,,,,,0,00,20.0,,,,,,*7A",
        "!AIVDM,1,1,,A,x,0*00",
        "$PMRDS,ready,0.039*00",
        "$PMRDCX,start*00",
    ];
    for line in others {
        assert_eq!(parse(line), None, "{line}");
    }
}

#[test]
fn a_sentence_with_any_character_changed_is_no_command() {
    let sound = sentence("set latitude 47.58");
    for place in 0..sound.len() {
        for other in (b' '..=b'~').filter(|other| *other != sound.as_bytes()[place]) {
            let mut bytes = sound.clone().into_bytes();
            bytes[place] = other;
            let line = String::from_utf8(bytes).expect("it is ASCII");
            let is_same_digit = line.eq_ignore_ascii_case(&sound);
            assert!(is_same_digit || !matches!(parse(&line), Some(Ok(_))), "{line}");
        }
    }
}

proptest! {
    /// The standard library's parser is the oracle.
    #[test]
    fn a_number_is_the_nearest_to_its_digits(text in "-?[0-9]{1,8}(\\.[0-9]{1,7})?") {
        prop_assert_eq!(number(&text), Ok(text.parse::<f64>().expect("it is a number")));
    }

    #[test]
    fn what_is_not_a_plain_decimal_is_no_number(text in "[ -~]{0,20}") {
        if let Ok(found) = number(&text) {
            prop_assert_eq!(Ok(found), text.parse::<f64>());
        }
    }

    #[test]
    fn no_line_of_other_words_is_a_command(line in "[ -~]{0,80}") {
        if let Some(Ok(_)) = parse(&line) {
            let first = line.split([' ', ',']).find(|word| !word.is_empty());
            prop_assert!(first.is_some_and(|word| WORDS.contains(&word)), "{}", line);
        }
    }
}

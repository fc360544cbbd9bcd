//! Answers to commands as the instrument writes them and as the other side reads them.

use proptest::prelude::*;
use protocol::answer::{
    Answer, Content, NoAnswer, PART, Part, done, is_name, is_value, parse, record, refused, value,
};
use protocol::command;
use protocol::nmea::LONGEST;

/// A sentence of this content, without the end of its line, as another program would make it.
fn sentence(content: &str) -> String {
    format!("${content}*{:02X}", content.bytes().fold(0, |sum, byte| sum ^ byte))
}

/// What the sentence of this content says.
#[track_caller]
fn read(content: &str) -> Result<(String, String), NoAnswer> {
    let line = sentence(content);
    let answer = parse(&line).expect("it is meant as an answer")?;
    let says = match answer.content {
        Content::Done => "done".to_owned(),
        Content::Refused(reason) => format!("refused: {reason}"),
        Content::Value(name, value) => format!("{name} = {value}"),
        Content::Part(part) => {
            format!("{} {} {:?}", part.record, part.number, part.bytes().collect::<Vec<_>>())
        }
    };
    Ok((answer.command.to_owned(), says))
}

#[test]
fn each_kind_of_answer_is_told_from_the_others() {
    for (content, command, says) in [
        ("PMRDR,save,ok", "save", "done"),
        ("PMRDR,get,ok", "get", "done"),
        ("PMRDR,save,refused,the flash is worn", "save", "refused: the flash is worn"),
        ("PMRDR,save,refused", "save", "refused: "),
        ("PMRDR,log,refused,no room", "log", "refused: no room"),
        ("PMRDR,get,latitude,47.58", "get", "latitude = 47.58"),
        ("PMRDR,set,g_2_x,-0.5", "set", "g_2_x = -0.5"),
        ("PMRDR,get,firmware,0.1.0 (ab12)", "get", "firmware = 0.1.0 (ab12)"),
        ("PMRDR,log,412,2,00fFA0", "log", "412 2 [0, 255, 160]"),
        ("PMRDR,azimuth,ok", "azimuth", "done"),
    ] {
        assert_eq!(read(content), Ok((command.to_owned(), says.to_owned())), "{content}");
    }
}

#[test]
fn what_is_meant_as_an_answer_and_is_none_is_told_from_the_sentences_of_others() {
    for content in [
        "PMRDR,",
        "PMRDR,save",
        "PMRDR,save,done",
        "PMRDR,get,latitude,",
        "PMRDR,get,latitude,4,7",
        "PMRDR,get,Latitude,47",
        "PMRDR,get,a_name_of_25_characters_a,1",
        "PMRDR,get,ok,1",
        "PMRDR,log,1,0,0",
        "PMRDR,log,1,0,",
        "PMRDR,log,1,0,0G",
        "PMRDR,log,-1,0,00",
        "PMRDR,log,4294967296,0,00",
        "PMRDR,log,1,00",
        "PMRDR,save,refused,why!",
    ] {
        assert_eq!(read(content), Err(NoAnswer::Fields), "{content}");
    }
    for line in ["$PMRDR,save,ok", "$PMRDR,save,ok*00", "$PMRDR,save,ok*1", "$PMRDR,sa"] {
        assert_eq!(parse(line), Some(Err(NoAnswer::Checksum)), "{line}");
    }
    for line in ["$PMRDS,ready*00", "$PMRDC,save*00", "$PMRDRX,save,ok*00", "save", "", "$PMRDR"] {
        assert_eq!(parse(line), None, "{line}");
    }
}

#[test]
fn a_reason_is_cut_and_freed_of_what_a_sentence_may_not_have() {
    let line = refused("realign", format_args!("a*b,c{}", "x".repeat(200))).expect("it is cut");
    assert_eq!(line.len(), LONGEST);
    let answer = parse(line.trim_end()).expect("an answer").expect("a sound one");
    assert!(matches!(answer.content, Content::Refused(reason) if reason.starts_with("a b;cxxx")));
}

#[test]
fn a_value_that_no_sentence_can_carry_is_not_written_as_another_one() {
    for wrong in ["4,7", "a*b", "", "°", &"9".repeat(70)] {
        assert_eq!(value("get", "latitude", wrong), None, "{wrong}");
    }
    for wrong in ["Latitude", "a,b", "", "ok", "twenty_five_letters_abcde"] {
        assert_eq!(value("get", wrong, 1), None, "{wrong}");
    }
    assert_eq!(record(1, 0, &[]), None);
    assert_eq!(record(1, 0, &[0; PART + 1]), None);
    assert!(record(u32::MAX, u8::MAX, &[0xAB; PART]).is_some());
}

#[test]
fn a_command_as_a_sentence_is_the_command_and_one_that_is_too_long_is_none() {
    let line = command::sentence(["set", "latitude", "47.58"]).expect("it is short");
    assert_eq!(&*line, format!("{}\r\n", sentence("PMRDC,set,latitude,47.58")));
    let parsed = command::parse(line.trim_end()).expect("it is one");
    assert_eq!(parsed, Ok(command::Command::Set("latitude", "47.58")));
    let longest = "9".repeat(LONGEST - "$PMRDC,set,a,*hh\r\n".len());
    assert_eq!(command::sentence(["set", "a", &longest]).expect("it fits").len(), LONGEST);
    assert_eq!(command::sentence(["set", "a", &format!("{longest}9")]), None);
}

proptest! {
    #[test]
    fn no_line_makes_the_reader_of_answers_panic(
        line in prop_oneof![any::<String>(), "\\$PMRDR,[a-z]{0,5},[ -~]{0,40}", "[$PMRD,*0-9a-f]{0,82}"],
    ) {
        let _ = parse(&line);
        let _ = parse(&sentence(line.trim_start_matches('$')));
    }

    #[test]
    fn a_value_that_was_written_is_read_again(name in "[a-z0-9_]{1,24}", text in "[ -~]{1,40}") {
        let line = value("get", &name, &text);
        prop_assert_eq!(line.is_some(), is_name(&name) && is_value(&text), "{}", text);
        if let Some(line) = line {
            let content = Content::Value(&name, &text);
            prop_assert_eq!(parse(line.trim_end()), Some(Ok(Answer { command: "get", content })));
        }
    }

    #[test]
    fn a_reason_that_was_written_is_read_again(reason in "[ -)+-\\[\\]_-}&&[^!,$]]{0,40}") {
        let line = refused("set", &reason).expect("it is short");
        let content = Content::Refused(&reason);
        prop_assert_eq!(parse(line.trim_end()), Some(Ok(Answer { command: "set", content })));
    }

    #[test]
    fn a_part_that_was_written_is_read_again(
        number: u32, part: u8, bytes in proptest::collection::vec(any::<u8>(), 1..=PART),
    ) {
        let line = record(number, part, &bytes).expect("it fits");
        let found = parse(line.trim_end()).and_then(Result::ok).map(|answer| answer.content);
        let Some(Content::Part(found)) = found else { panic!("{line}") };
        prop_assert_eq!((found.record, found.number), (number, u32::from(part)));
        prop_assert_eq!(found.bytes().collect::<Vec<_>>(), bytes);
    }

    #[test]
    fn an_answer_with_any_character_changed_is_none(place in 0..60_usize, other in b' '..=b'~') {
        let sound = done("realign").expect("it is short");
        let mut bytes = sound.trim_end().as_bytes().to_vec();
        let place = place % bytes.len();
        bytes[place] = other;
        let line = String::from_utf8(bytes).expect("it is ASCII");
        let is_same = line.eq_ignore_ascii_case(sound.trim_end());
        prop_assert!(is_same || !matches!(parse(&line), Some(Ok(_))), "{}", line);
    }
}

#[test]
fn the_bytes_of_a_part_are_those_of_its_digits() {
    let line = sentence("PMRDR,log,7,0,0aB1");
    let Some(Ok(Answer { content: Content::Part(part), .. })) = parse(&line) else {
        panic!("it is a part")
    };
    let Part { record, number, .. } = part;
    assert_eq!((record, number, part.bytes().collect::<Vec<_>>()), (7, 0, vec![0x0A, 0xB1]));
}

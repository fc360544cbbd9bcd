//! `meridian log` over the link.

use super::fake::{Answering, Instrument, chatter, digits, over_tcp, say, served};
use crate::emulate::handmade::{ABSOLUTE, PROGBITS, Section, elf};
use crate::support::files::Scratch;
use crate::support::program::{code, meridian, object, reason, text};

/// Identity of the image that is made here.
const IDENTITY: [u8; 4] = [0xDE, 0xAD, 0xBE, 0xEF];

/// An image with one line of a log, `hello`, at level info, as number one.
fn image() -> Vec<u8> {
    let hello =
        r#"{"package":"p","disambiguator":"1","tag":"defmt_info","data":"hello","crate_name":"c"}"#;
    let mut identity = Section::new(".build_id", PROGBITS, 0, 0, 36);
    identity.content[16..20].copy_from_slice(&IDENTITY);
    let sections = [Section::new(".defmt", PROGBITS, 0, 0, 16), identity];
    let symbols =
        [("_defmt_version_ = 4", 0, ABSOLUTE), ("_defmt_encoding_ = rzcobs", 0, 1), (hello, 1, 1)];
    elf(&sections, &symbols)
}

/// The content of a record with that line: the image's identity, then the line's number in two bytes, little-endian, of
/// which reversed zero-compressing COBS writes 01 7E, and the zero at its end.
fn content() -> Vec<u8> {
    let mut content = [&IDENTITY[..], &[0x01, 0x7E, 0x00]].concat();
    content.resize(60, 0);
    content
}

/// The log of one record, in parts of 25, 25 and 10 bytes, of which the last one comes first.
fn logging() -> Answering {
    Box::new(|_| {
        let content = content();
        let part = |number: usize| {
            let bytes = content.chunks(25).nth(number).expect("there are three");
            say(format!("PMRDR,log,412,{number},{}", digits(bytes).to_lowercase()))
        };
        vec![part(2), part(0), part(1), part(0), say("PMRDR,log,ok")]
    })
}

#[test]
fn a_log_that_came_over_the_link_has_the_words_of_the_image() {
    let scratch = Scratch::new("log");
    let port = over_tcp(chatter(), logging());
    let image = scratch.with("board.elf", image());
    let output = meridian(&["log", &image, &port]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout).trim(), "info  hello");
    let object = object(&meridian(&["log", &image, &port, "--json"]));
    assert_eq!(object["lines"][0]["record"], serde_json::json!(412));
}

#[test]
fn the_log_is_asked_for_where_the_second_name_is_a_port() {
    let instrument = Instrument::new().shared();
    let port = served(&instrument);
    let scratch = Scratch::new("log");
    let output = meridian(&["log", &scratch.with("board.elf", "no image"), &port]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).contains("board.elf: the image's strings cannot be read"));
    assert_eq!(instrument.lock().expect("it is ours").got, ["log"]);
}

#[test]
fn an_instrument_that_refuses_its_log_is_told_with_the_reason() {
    let refusing: Answering = Box::new(|_| vec![say("PMRDR,log,refused,an alignment runs")]);
    let scratch = Scratch::new("log");
    let image = scratch.with("board.elf", "no image");
    let output = meridian(&["log", &image, &over_tcp(Vec::new(), refusing)]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).ends_with("refuses `log`: an alignment runs"), "{}", reason(&output));
}

#[test]
fn a_serial_port_that_is_not_there_is_no_file_that_is_not_there() {
    let scratch = Scratch::new("log");
    let image = scratch.with("board.elf", "no image");
    for (name, words) in [
        ("/dev/ttyNONE0", "there is no such port"),
        ("ttyNONE0", "there is no such file"),
        ("tcp:127.0.0.1:1", "nothing is served there"),
    ] {
        let output = meridian(&["log", &image, name]);
        assert_eq!(code(&output), 1);
        assert!(reason(&output).contains(words), "{}", reason(&output));
    }
}

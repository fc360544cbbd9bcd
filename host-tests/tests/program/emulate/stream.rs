//! The defmt stream of a handmade image.

use host::emulate::decode::{self, Line};
use host::emulate::sections::Memory;

use super::handmade::{self, ABSOLUTE, PROGBITS};

const TIMESTAMP: &str = r#"{"package":"p","tag":"defmt_timestamp","data":"{=u64:us}","disambiguator":"1","crate_name":"c"}"#;
const SENTENCE: &str = r#"{"package":"p","tag":"defmt_info","data":"σ {=u8} of {=str} °","disambiguator":"2","crate_name":"c"}"#;

/// An image with one sentence, whose frames are sent as they are.
fn image_with_a_sentence() -> Vec<u8> {
    let section = handmade::Section::new(".defmt", PROGBITS, 0, 0, 8);
    let symbols = [
        (TIMESTAMP, 1, 1),
        (SENTENCE, 2, 1),
        ("_defmt_version_ = 4", 0, ABSOLUTE),
        ("_defmt_encoding_ = raw", 3, 1),
    ];
    handmade::elf(&[section], &symbols)
}

/// The frame: index, µs, an u8, and a text with its length.
fn frame() -> Vec<u8> {
    let mut bytes = vec![2, 0];
    bytes.extend_from_slice(&1_500_000_u64.to_le_bytes());
    bytes.push(3);
    bytes.extend_from_slice(&4_u32.to_le_bytes());
    bytes.extend_from_slice("north".get(..4).unwrap_or_default().as_bytes());
    bytes
}

#[test]
fn a_stream_is_decoded_wherever_it_is_cut() {
    let image = image_with_a_sentence();
    let table = decode::table(&image).expect("strings");
    let stream = [frame(), frame()].concat();
    for cut in 0..=stream.len() {
        let mut decoder = table.new_stream_decoder();
        let mut lines = Vec::new();
        for part in [&stream[..cut], &stream[cut..]] {
            let keep = |line: &Line| {
                lines.push(line.clone());
                Ok(())
            };
            decode::take(&mut *decoder, part, keep).expect("whole frames");
        }
        let line = Line {
            time: "1.500000".to_owned(),
            level: Some("info"),
            words: "σ 3 of nort °".to_owned(),
        };
        assert_eq!(lines, [line.clone(), line], "cut at {cut}");
    }
}

#[test]
fn bytes_that_are_no_frame_are_an_error() {
    let image = image_with_a_sentence();
    let table = decode::table(&image).expect("strings");
    let bytes = b"printed by something else";
    assert!(decode::take(&mut *table.new_stream_decoder(), bytes, |_| Ok(())).is_err());
}

#[test]
fn what_is_no_image_is_said_to_be_none() {
    for bytes in [&b""[..], b"not an image", &image_with_a_sentence()[..60]] {
        assert!(decode::table(bytes).is_err() && Memory::of(bytes).is_err());
    }
    let silent = handmade::elf(&[], &[]);
    assert_eq!(decode::table(&silent).err().as_deref(), Some("the image has no defmt strings"));
}

//! What an instrument has sent over its link: sentences, or messages.

use mavlink::dialects::common::MavMessage;
use mavlink::{MAVLinkV2MessageRaw, MavlinkVersion, Message};

use super::sentences as of_lines;

/// The lines of what was sent, each of which must have its end.
#[track_caller]
fn lines(sent: &str) -> impl Iterator<Item = &str> {
    sent.split_inclusive('\n').map(|line| line.strip_suffix("\r\n").expect("a line has its end"))
}

/// The fields of the sentences of an address, in the order in which they were sent.
#[track_caller]
pub fn sentences<'l>(sent: &'l str, address: &str) -> Vec<Vec<&'l str>> {
    of_lines::sentences(lines(sent), address)
}

/// The words for people that were sent, one text after the other.
#[track_caller]
pub fn words(sent: &str) -> Vec<String> {
    of_lines::words(lines(sent))
}

/// The instrument's states that were sent.
#[track_caller]
pub fn states(sent: &str) -> Vec<[&str; 9]> {
    of_lines::states(lines(sent))
}

/// The messages that were sent, of which each frame must follow the one before, be whole, and have the next number.
#[track_caller]
pub fn messages(mut sent: &[u8]) -> Vec<MavMessage> {
    let mut messages = Vec::new();
    while !sent.is_empty() {
        let (bytes, rest) = sent.split_at(usize::from(sent[1]) + 12);
        let mut frame = MAVLinkV2MessageRaw::new();
        frame.as_mut_slice()[..bytes.len()].copy_from_slice(bytes);
        assert!(bytes[0] == 0xFD && frame.has_valid_crc::<MavMessage>(), "{bytes:?}");
        assert_eq!(usize::from(frame.sequence()), messages.len() % 256, "none is lost");
        let parsed = MavMessage::parse(MavlinkVersion::V2, frame.message_id(), frame.payload());
        messages.push(parsed.expect("the dialect has it"));
        sent = rest;
    }
    messages
}

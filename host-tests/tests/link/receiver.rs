//! Lines and frames among whatever bytes come.

use mavlink::dialects::common::{COMMAND_LONG_DATA, HEARTBEAT_DATA, STATUSTEXT_DATA};
use mavlink::{MAVLinkV2MessageRaw, MavHeader, MessageData};
use proptest::prelude::*;
use protocol::receiver::{LONGEST_LINE, Received, Receiver};

/// What was received, as its own.
#[derive(Clone, Debug, PartialEq)]
enum Item {
    Line(String),
    Frame(Vec<u8>),
}

/// All that a receiver finds in bytes that come in pieces of these lengths, in turn.
fn found(bytes: &[u8], pieces: &[usize]) -> Vec<Item> {
    let (mut receiver, mut found, mut rest) = (Receiver::default(), Vec::new(), bytes);
    let mut pieces = pieces.iter().cycle();
    while !rest.is_empty() {
        let piece = rest.len().min(*pieces.next().expect("there is a length"));
        let taken = receiver.take(&rest[..piece]);
        assert!(taken > 0, "a byte is taken");
        rest = &rest[taken..];
        while let Some(item) = receiver.next() {
            found.push(match item {
                Received::Line(line) => Item::Line(line.to_owned()),
                Received::Frame(frame) => Item::Frame(frame.raw_bytes().to_vec()),
            });
        }
    }
    found
}

/// A line.
fn line(text: &str) -> Item {
    Item::Line(text.to_owned())
}

/// A frame with a message, as a ground station sends it.
fn frame<M: MessageData>(message: &M) -> Vec<u8> {
    let mut frame = MAVLinkV2MessageRaw::new();
    frame.serialize_message_data(
        MavHeader { system_id: 255, component_id: 190, sequence: 9 },
        message,
    );
    frame.raw_bytes().to_vec()
}

#[test]
fn lines_end_with_either_end_and_empty_ones_are_none() {
    let expected = [line("start"), line("$PMRDC,stop*00"), line("get latitude")];
    assert_eq!(found(b"start\r\n$PMRDC,stop*00\n\n\rget latitude\r", &[usize::MAX]), expected);
}

#[test]
fn a_sentence_begins_amid_anything_and_a_plain_line_only_at_the_start_of_one() {
    assert_eq!(found(b"\x00noise$PMRDC,stop*00\r\n", &[7]), [line("$PMRDC,stop*00")]);
    assert_eq!(found(b"\x00stop\r\nstart\r\n", &[3]), [line("start")]);
    assert_eq!(found(b"start$\x80\r\n", &[1]), []);
}

#[test]
fn a_line_that_is_too_long_is_none_and_the_next_is_one() {
    let longest = "x".repeat(LONGEST_LINE);
    let text = format!("{longest}\n{longest}x\nstart\n");
    assert_eq!(found(text.as_bytes(), &[50]), [line(&longest), line("start")]);
}

#[test]
fn frames_stand_beside_lines_and_those_that_are_not_taken_are_passed_by() {
    let command = frame(&COMMAND_LONG_DATA::default());
    let other = frame(&STATUSTEXT_DATA { text: "\nstop\n".into(), ..STATUSTEXT_DATA::default() });
    let bytes =
        [b"start\r\n", &command[..], &frame(&HEARTBEAT_DATA::default()), b"stop\n"].concat();
    let expected = [
        line("start"),
        Item::Frame(command.clone()),
        Item::Frame(frame(&HEARTBEAT_DATA::default())),
        line("stop"),
    ];
    assert_eq!(found(&bytes, &[usize::MAX]), expected);
    assert!(!found(&other, &[5]).iter().any(|item| matches!(item, Item::Frame(_))));
}

/// Each bit of a frame that is taken, one after the other.
#[test]
fn a_frame_with_a_wrong_bit_is_none_and_what_follows_is_found() {
    let (command, next) = (frame(&COMMAND_LONG_DATA::default()), b"\nstart\n$PMRDC,stop*00\n");
    for bit in 0..8 * command.len() {
        let mut bytes = command.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        // A frame whose length has become greater waits for as many bytes more.
        bytes.extend_from_slice(next);
        bytes.extend_from_slice(&[0; 280]);
        let found = found(&bytes, &[1]);
        assert_eq!(found, [line("start"), line("$PMRDC,stop*00")], "bit {bit}");
    }
}

#[test]
fn a_frame_whose_end_does_not_come_is_given_up_after_a_pause() {
    let command = frame(&COMMAND_LONG_DATA::default());
    let mut receiver = Receiver::default();
    receiver.take(&command[..20]);
    assert_eq!(receiver.next(), None);
    receiver.pause();
    receiver.take(b"\nstart\n");
    assert_eq!(receiver.next(), Some(Received::Line("start")));
    receiver.take(b"sto");
    assert_eq!(receiver.next(), None);
    receiver.pause();
    receiver.take(b"p\n");
    assert_eq!(receiver.next(), Some(Received::Line("stop")));
}

/// What is left of a line might be another command.
#[test]
fn a_line_of_which_bytes_were_lost_is_none() {
    let mut receiver = Receiver::default();
    receiver.take(b"set dwell 5; re");
    assert_eq!(receiver.next(), None);
    receiver.lose();
    receiver.take(b"stop\nstart\n");
    assert_eq!(receiver.next(), Some(Received::Line("start")));
    assert_eq!(receiver.next(), None);
}

proptest! {
    #[test]
    fn however_the_bytes_are_cut_the_same_is_found(
        bytes in proptest::collection::vec(prop_oneof![any::<u8>(), Just(0xFD), Just(b'\n'), Just(b'$'), 0..3_u8], 0..2000),
        pieces in proptest::collection::vec(1..400_usize, 1..10),
    ) {
        prop_assert_eq!(found(&bytes, &pieces), found(&bytes, &[1]));
    }

    #[test]
    fn a_frame_is_found_whole_after_any_noise_and_a_pause(
        noise in proptest::collection::vec(prop_oneof![any::<u8>(), Just(0xFD)], 0..300),
    ) {
        let command = frame(&COMMAND_LONG_DATA::default());
        let bytes = [&noise[..], &command, &[0; 300]].concat();
        prop_assert!(found(&bytes, &[64]).contains(&Item::Frame(command)));
    }
}

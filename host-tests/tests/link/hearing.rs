//! What the other side of the link hears among all that may come.

use host::link::hearing::{Hearing, Line};
use proptest::prelude::*;
use protocol::answer::done;

/// All answers in bytes that come in pieces of a length.
fn heard(bytes: &[u8], piece: usize) -> Vec<Line> {
    let mut hearing = Hearing::default();
    let mut lines: Vec<_> = bytes.chunks(piece).flat_map(|piece| hearing.take(piece)).collect();
    // A frame that waits for its end is none.
    let paused = std::iter::repeat_with(|| hearing.pause()).take(bytes.len()).flatten();
    lines.extend(paused);
    lines
}

/// An answer.
fn answer() -> String {
    done("realign").expect("it is short").to_string()
}

/// Bytes of which many begin or end something.
fn noise(most: usize) -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![any::<u8>(), Just(0xFD), Just(b'\n'), Just(b'$'), 0..3_u8];
    proptest::collection::vec(byte, 0..most)
}

proptest! {
    #[test]
    fn however_the_bytes_are_cut_the_same_is_heard(bytes in noise(2000), piece in 1..300_usize) {
        let bytes = [&bytes[..], answer().as_bytes(), &bytes].concat();
        prop_assert_eq!(heard(&bytes, piece), heard(&bytes, 1));
    }

    #[test]
    fn an_answer_is_heard_after_any_noise(before in noise(600), after in noise(600)) {
        let bytes = [&before[..], answer().as_bytes(), &after].concat();
        let whole = Line::Whole(answer().trim_end().to_owned());
        prop_assert!(heard(&bytes, 64).contains(&whole), "{:?}", bytes);
    }

    #[test]
    fn an_answer_that_was_cut_is_never_whole(place in 1..20_usize, behind in "[ -~]{0,20}") {
        let sound = answer();
        let bytes = format!("{}\n{behind}\r\n", &sound[..place.min(sound.len() - 3)]);
        let heard = heard(bytes.as_bytes(), 64);
        prop_assert!(!heard.iter().any(|line| matches!(line, Line::Whole(_))), "{}", bytes);
    }
}

//! Tells what an instrument sends apart: answers to commands, its other sentences and frames, what others send, and noise.

use mavlink::dialects::common::MavMessage;
use mavlink::{MAV_STX_V2, MAVLinkV2MessageRaw, Message};
use protocol::answer::ANSWER;
use protocol::command::content;
use protocol::receiver::LONGEST_LINE;

use super::heard::Heard;

/// Bytes of a frame before its payload.
const HEADER: usize = 10;
/// Place of the number of the component that sends it.
const COMPONENT: usize = 6;
/// Bytes of a frame behind it: of the checksum, and of the signature that a signed one has.
const CHECKSUM: usize = 2;
const SIGNATURE: usize = 13;
/// The flag of a frame that is signed, the only one that there is.
const SIGNED: u8 = 1;
/// Most characters of a line of text: what is longer is noise that happens to be printable.
const LONGEST_TEXT: usize = 200;

/// A line that is meant as an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Line {
    /// With a checksum that is right.
    Whole(String),
    /// Cut, or with a checksum that is wrong.
    Damaged(String),
}

/// Takes bytes as they come.
#[derive(Debug, Default)]
pub struct Hearing {
    /// Bytes that are not told apart yet.
    waiting: Vec<u8>,
    /// Whether the last byte before them lets a line begin.
    is_at_start: bool,
    /// What came.
    heard: Heard,
}

/// What the bytes that wait begin with, and how many of them it takes.
enum Beginning {
    /// Something whose end has not come yet, or nothing.
    Incomplete,
    /// The end of a line.
    End,
    /// A sentence, without its end.
    Sentence(usize),
    /// The beginning of a sentence that something else follows.
    Cut(usize),
    /// A line of text.
    Text(usize),
    /// A frame of MAVLink.
    Frame(usize),
    /// So many bytes of nothing.
    Noise(usize),
}

impl Hearing {
    /// What came since [`Self::forget`].
    #[must_use]
    pub fn heard(&self) -> &Heard {
        &self.heard
    }

    /// Forgets what came, without losing the line that is under way.
    pub fn forget(&mut self) {
        self.heard = Heard::default();
    }

    /// Takes bytes, and hands over the answers that they complete.
    pub fn take(&mut self, bytes: &[u8]) -> Vec<Line> {
        self.heard.bytes += bytes.len();
        self.waiting.extend_from_slice(bytes);
        let mut lines = Vec::new();
        loop {
            match beginning(&self.waiting, self.is_at_start) {
                Beginning::Incomplete => return lines,
                found => lines.extend(self.note(&found)),
            }
        }
    }

    /// Takes note of what the bytes that wait begin with, and drops it; an answer is handed over.
    fn note(&mut self, found: &Beginning) -> Option<Line> {
        let (length, line) = match *found {
            Beginning::Incomplete => (0, None),
            Beginning::End => (1, None),
            Beginning::Sentence(length) => (length, self.sentence(length)),
            Beginning::Cut(length) => (length, self.cut(length)),
            Beginning::Text(length) => {
                self.heard.text(&self.first(length));
                (length, None)
            }
            Beginning::Frame(length) => {
                self.heard.frame(self.waiting[COMPONENT]);
                (length, None)
            }
            Beginning::Noise(length) => {
                self.heard.noise += length;
                (length, None)
            }
        };
        self.drop_first(length);
        line
    }

    /// Notes that nothing has come for a while: a frame that waits for its end is none.
    pub fn pause(&mut self) -> Vec<Line> {
        if self.waiting.first() != Some(&MAV_STX_V2) {
            return Vec::new();
        }
        self.heard.noise += 1;
        self.drop_first(1);
        self.take(&[])
    }

    /// The line that waits for its end, where it is meant as an answer: it was cut.
    #[must_use]
    pub fn unfinished(&self) -> Option<String> {
        let text = self.first(self.waiting.len());
        is_meant(&text).then_some(text)
    }

    /// The first characters that wait.
    fn first(&self, length: usize) -> String {
        String::from_utf8_lossy(&self.waiting[..length]).into_owned()
    }

    /// Drops the first bytes that wait, after which a line begins where one has ended.
    fn drop_first(&mut self, count: usize) {
        self.is_at_start = count > 0 && matches!(self.waiting[count - 1], b'\r' | b'\n');
        self.waiting.drain(..count);
    }

    /// Takes note of a sentence; an answer is handed over.
    fn sentence(&mut self, length: usize) -> Option<Line> {
        let line = self.first(length);
        let is_sound = content(&line[1..]).is_some();
        match (is_meant(&line), is_sound) {
            (true, true) => {
                self.heard.sentence(&line);
                Some(Line::Whole(line))
            }
            (false, true) => {
                self.heard.sentence(&line);
                None
            }
            (_, false) => self.cut(length),
        }
    }

    /// Takes note of a sentence that was cut.
    fn cut(&mut self, length: usize) -> Option<Line> {
        let line = self.first(length);
        self.heard.noise += length;
        is_meant(&line).then_some(Line::Damaged(line))
    }
}

/// Whether a line, or the beginning of one, is meant as an answer.
fn is_meant(line: &str) -> bool {
    line.strip_prefix('$').is_some_and(|line| line.starts_with(ANSWER))
}

/// What bytes begin with, of which the first may be that of a line or not.
fn beginning(bytes: &[u8], is_at_start: bool) -> Beginning {
    match bytes {
        [] => Beginning::Incomplete,
        [b'\r' | b'\n', ..] => Beginning::End,
        [MAV_STX_V2, ..] => frame(bytes),
        [b'$' | b'!', ..] => sentence(bytes),
        [b' '..=b'~', ..] if is_at_start => text(bytes),
        _ => Beginning::Noise(1),
    }
}

/// How many printable characters bytes begin with, and what follows them; a sentence ends where another one begins.
fn printable(bytes: &[u8]) -> (usize, Option<u8>) {
    let is_end =
        |(index, byte): (usize, &u8)| !(b' '..=b'~').contains(byte) || (*byte == b'$' && index > 0);
    let length = bytes.iter().enumerate().position(is_end).unwrap_or(bytes.len());
    (length, bytes.get(length).copied())
}

fn sentence(bytes: &[u8]) -> Beginning {
    match printable(bytes) {
        (length, Some(b'\r' | b'\n')) if length <= LONGEST_LINE => Beginning::Sentence(length),
        (length, None) if length <= LONGEST_LINE => Beginning::Incomplete,
        // However much more of it has come.
        (length, _) => Beginning::Cut(length.min(LONGEST_LINE + 1)),
    }
}

fn text(bytes: &[u8]) -> Beginning {
    match printable(bytes) {
        (length, Some(b'\r' | b'\n')) if length <= LONGEST_TEXT => Beginning::Text(length),
        (length, None) if length <= LONGEST_TEXT => Beginning::Incomplete,
        (length, _) => Beginning::Noise(length.min(LONGEST_TEXT + 1)),
    }
}

fn frame(bytes: &[u8]) -> Beginning {
    let [_, payload, flags, ..] = bytes else { return Beginning::Incomplete };
    if *flags > SIGNED {
        return Beginning::Noise(1);
    }
    let end = HEADER + usize::from(*payload) + CHECKSUM;
    let length = end + if *flags == SIGNED { SIGNATURE } else { 0 };
    let Some(whole) = bytes.get(..length) else { return Beginning::Incomplete };
    let mut frame = MAVLinkV2MessageRaw::new();
    frame.as_mut_slice()[..length].copy_from_slice(whole);
    // One checksum of noise in 65 536 is right: it must also be a message that there is.
    let is_known = MavMessage::default_message_from_id(frame.message_id()).is_some();
    let extra = MavMessage::extra_crc(frame.message_id());
    if is_known && frame.has_valid_crc_with_extra_crc(extra) {
        Beginning::Frame(length)
    } else {
        Beginning::Noise(1)
    }
}

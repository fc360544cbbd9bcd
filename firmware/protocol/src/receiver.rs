//! Lines and frames among the bytes that the link receives.
//!
//! What comes may be anything: noise, the chatter of a ship's bus, frames for others, the halves of a line that was cut. A
//! line is taken from the start of a line or from a `$` to its end, a frame from its mark, with a header of a message that is
//! taken here, to its checksum. Where a candidate turns out to be none, the search goes on at the byte after its first, so
//! that nothing that follows is lost with it.
//!
//! **Cost.** A candidate for a frame is given up at the first byte of its header that is none. What is left of a frame
//! whose checksum fails is looked at once more: at most some forty candidates among its 280 bytes.

use mavlink::dialects::common::{
    COMMAND_LONG_DATA, GPS_RAW_INT_DATA, HEARTBEAT_DATA, PARAM_REQUEST_LIST_DATA,
    PARAM_REQUEST_READ_DATA, PARAM_SET_DATA, TIMESYNC_DATA,
};
use mavlink::{MAV_STX_V2, MAVLinkV2MessageRaw, MessageData, calculate_crc};

/// Most characters of a line: those of a sentence, without its end.
pub const LONGEST_LINE: usize = crate::nmea::LONGEST - 2;
/// Most bytes of a frame that is taken: with the longest payload and a signature.
const ROOM: usize = 280;
/// Bytes of a frame before its payload, and of its checksum.
const HEADER: usize = 10;
const CHECKSUM: usize = 2;
/// Bytes of a signature, which is not examined.
const SIGNATURE: usize = 13;
/// The flag of a frame that is signed.
const SIGNED: u8 = 1;

/// Messages that are taken: number, and the byte with which their checksums end. A payload may be shorter than theirs, as
/// zeros at its end are not sent, and longer, with fields of later versions.
const TAKEN: [(u32, u8); 7] = [
    taken::<HEARTBEAT_DATA>(),
    taken::<PARAM_REQUEST_READ_DATA>(),
    taken::<PARAM_REQUEST_LIST_DATA>(),
    taken::<PARAM_SET_DATA>(),
    taken::<GPS_RAW_INT_DATA>(),
    taken::<COMMAND_LONG_DATA>(),
    taken::<TIMESYNC_DATA>(),
];

/// What [`TAKEN`] has of a message.
const fn taken<M: MessageData>() -> (u32, u8) {
    (M::ID, M::EXTRA_CRC)
}

/// What was received.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one at a time, on the stack")]
pub enum Received<'r> {
    /// A line of printable ASCII characters, without its end.
    Line(&'r str),
    /// A frame whose checksum is right.
    Frame(Frame),
}

/// A frame of MAVLink 2 that was received.
pub type Frame = MAVLinkV2MessageRaw;

/// What the bytes that wait begin with.
enum Beginning {
    /// Something whose end has not come yet, or nothing.
    Incomplete,
    /// So many bytes of nothing; whether a line may begin after them.
    Void(usize, bool),
    /// A line of so many characters, with one more byte for its end.
    Line(usize),
    /// A frame of so many bytes.
    Frame(usize),
}

/// Searches for lines and frames.
#[derive(Clone, Debug)]
pub struct Receiver {
    /// Bytes that wait, behind those that are done with.
    waiting: heapless::Vec<u8, ROOM>,
    /// How many of them are done with.
    done: usize,
    /// Whether a line may begin with the first of them that is not.
    is_at_start: bool,
}

impl Default for Receiver {
    fn default() -> Self {
        Self { waiting: heapless::Vec::new(), done: 0, is_at_start: true }
    }
}

impl Receiver {
    /// Takes as many bytes as there is room for, at least one after [`next`](Self::next) has returned nothing; how many.
    pub fn take(&mut self, bytes: &[u8]) -> usize {
        let done = core::mem::take(&mut self.done);
        self.waiting.drain(..done);
        let count = bytes.len().min(ROOM - self.waiting.len());
        // There is room for them.
        let _ = self.waiting.extend_from_slice(&bytes[..count]);
        count
    }

    /// Notes that nothing has come for some time: a frame that waits for its end is none. A line may be typed slowly.
    pub fn pause(&mut self) {
        if self.waiting.get(self.done) == Some(&MAV_STX_V2) {
            self.skip(1, false);
        }
    }

    /// Notes that bytes were lost: what waits is none, and a line begins after the next end of one.
    pub fn lose(&mut self) {
        self.skip(self.waiting.len() - self.done, false);
    }

    /// The next line or frame; [`None`] until more bytes have come.
    #[expect(clippy::should_implement_trait, reason = "what it returns borrows from it")]
    pub fn next(&mut self) -> Option<Received<'_>> {
        loop {
            let begin = self.done;
            match beginning(&self.waiting[begin..], self.is_at_start) {
                Beginning::Incomplete => return None,
                Beginning::Void(count, is_at_start) => self.skip(count, is_at_start),
                Beginning::Line(length) => {
                    self.skip(length + 1, true);
                    let line = self.waiting.get(begin..begin + length)?;
                    return str::from_utf8(line).ok().map(Received::Line);
                }
                Beginning::Frame(length) => {
                    self.skip(length, true);
                    let mut frame = Frame::new();
                    let whole = &self.waiting[begin..begin + length];
                    frame.as_mut_slice()[..length].copy_from_slice(whole);
                    return Some(Received::Frame(frame));
                }
            }
        }
    }

    /// Is done with bytes. Whether a line may begin after them.
    const fn skip(&mut self, count: usize, is_at_start: bool) {
        self.done += count;
        self.is_at_start = is_at_start;
    }
}

/// What bytes begin with, of which the first may be that of a line or not.
fn beginning(bytes: &[u8], is_at_start: bool) -> Beginning {
    match bytes {
        [] => Beginning::Incomplete,
        [b'\r' | b'\n', ..] => Beginning::Void(1, true),
        [MAV_STX_V2, ..] => frame(bytes),
        [b'$', ..] => line(bytes),
        [b' '..=b'~', ..] if is_at_start => line(bytes),
        _ => Beginning::Void(1, false),
    }
}

/// What bytes begin with that begin as a line.
fn line(bytes: &[u8]) -> Beginning {
    let is_end =
        |(index, byte): (usize, &u8)| !(b' '..=b'~').contains(byte) || (*byte == b'$' && index > 0);
    match bytes.iter().enumerate().position(is_end) {
        Some(length) if length <= LONGEST_LINE && b"\r\n".contains(&bytes[length]) => {
            Beginning::Line(length)
        }
        Some(length) => Beginning::Void(length, false),
        None if bytes.len() > LONGEST_LINE => Beginning::Void(bytes.len(), false),
        None => Beginning::Incomplete,
    }
}

/// What bytes begin with that begin as a frame.
fn frame(bytes: &[u8]) -> Beginning {
    const NONE: Beginning = Beginning::Void(1, false);
    let [_, payload, flags, ..] = bytes else { return Beginning::Incomplete };
    if *flags > SIGNED {
        return NONE;
    }
    let Some(number) = bytes.get(HEADER - 3..HEADER) else { return Beginning::Incomplete };
    let number = u32::from_le_bytes([number[0], number[1], number[2], 0]);
    let end = HEADER + usize::from(*payload);
    let Some((_, extra)) = TAKEN.iter().find(|(id, _)| *id == number) else { return NONE };
    let length = end + CHECKSUM + if *flags == SIGNED { SIGNATURE } else { 0 };
    let Some(whole) = bytes.get(..length) else { return Beginning::Incomplete };
    let sum = calculate_crc(&whole[1..end], *extra);
    if sum.to_le_bytes() == whole[end..end + CHECKSUM] { Beginning::Frame(length) } else { NONE }
}

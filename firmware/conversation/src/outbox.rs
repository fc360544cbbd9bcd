//! What is sent together over the link.

use protocol::mavlink::{MessageData, Sender};
use protocol::nmea::{LONGEST, Sentence};

/// Most bytes of a sentence, a message or an answer: the message with the longest payload here, 117 bytes, which a command
/// asks for, and the acknowledgement of that command, 10 bytes, each in a frame of 12.
pub const PIECE: usize = 117 + 10 + 2 * 12;

/// Most bytes that are handed to the link at once. They take half a second at 4800 baud, the slowest link, and less time
/// than as many as a port keeps for its reader.
const ROOM: usize = 224;

/// Sentences, messages and answers that are sent together, and who sends them.
pub struct Outbox {
    bytes: [u8; ROOM],
    length: usize,
    /// Who sends messages.
    pub sender: Sender,
}

impl Outbox {
    /// Nothing is to be sent.
    pub(crate) const fn of(sender: Sender) -> Self {
        Self { bytes: [0; ROOM], length: 0, sender }
    }

    /// Whether there is room for another sentence, message or answer.
    #[must_use]
    pub const fn has_room(&self) -> bool {
        self.length + PIECE <= ROOM
    }

    /// Whether there is room for another sentence.
    #[must_use]
    pub const fn has_room_for_sentence(&self) -> bool {
        self.length + LONGEST <= ROOM
    }

    /// How many bytes are to be sent.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.length
    }

    /// Whether nothing is to be sent.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// What is to be sent.
    pub(crate) fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }

    /// It was sent.
    pub(crate) const fn clear(&mut self) {
        self.length = 0;
    }

    /// Puts a sentence, where there is one.
    pub fn put(&mut self, sentence: Option<&Sentence>) {
        if let Some(sentence) = sentence {
            self.extend(sentence.as_bytes());
        }
    }

    /// Puts a message.
    pub fn put_message<M: MessageData>(&mut self, message: &M) {
        let frame = self.sender.frame(message);
        self.extend(frame.raw_bytes());
    }

    /// Puts bytes, for which there is room.
    fn extend(&mut self, bytes: &[u8]) {
        let end = self.length + bytes.len();
        if let Some(place) = self.bytes.get_mut(self.length..end) {
            place.copy_from_slice(bytes);
            self.length = end;
        }
    }
}

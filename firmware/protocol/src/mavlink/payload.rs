//! Payloads read and written field by field. The library's own reading of a command has every command that there is, which
//! takes more flash than all else that is received.

use heapless::String;
use mavlink::dialects::common::{COMMAND_ACK_DATA, MavResult};
use mavlink::error::ParserError;
use mavlink::{MavlinkVersion, MessageData};

use super::Name;

/// The payload of a frame, of which zeros at its end are not sent. Its fields begin at the offsets that the order of their
/// sizes gives them.
pub(super) struct Payload<'p>(pub &'p [u8]);

impl Payload<'_> {
    /// Bytes from an offset on.
    pub fn bytes<const N: usize>(&self, offset: usize) -> [u8; N] {
        core::array::from_fn(|place| self.byte(offset + place))
    }

    /// A byte.
    pub fn byte(&self, offset: usize) -> u8 {
        self.0.get(offset).copied().unwrap_or(0)
    }

    /// A number of single precision.
    pub fn float(&self, offset: usize) -> f32 {
        f32::from_le_bytes(self.bytes(offset))
    }

    /// The name of a parameter: sixteen characters, or fewer before a zero.
    pub fn name(&self, offset: usize) -> Option<Name> {
        let characters: [u8; 16] = self.bytes(offset);
        let letters = characters.iter().take_while(|letter| **letter != 0);
        let letters = letters.map(|letter| letter.is_ascii().then_some(char::from(*letter)));
        letters.collect::<Option<String<16>>>()
    }
}

/// The answer to a command: `COMMAND_ACK`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acknowledgement {
    /// Number of the command.
    pub number: u16,
    /// What became of it.
    pub result: MavResult,
    /// System and component that have sent it.
    pub to: [u8; 2],
}

impl MessageData for Acknowledgement {
    type Message = <COMMAND_ACK_DATA as MessageData>::Message;

    const ID: u32 = COMMAND_ACK_DATA::ID;
    const NAME: &'static str = COMMAND_ACK_DATA::NAME;
    const EXTRA_CRC: u8 = COMMAND_ACK_DATA::EXTRA_CRC;
    const ENCODED_LEN: usize = COMMAND_ACK_DATA::ENCODED_LEN;

    fn ser(&self, _: MavlinkVersion, payload: &mut [u8]) -> usize {
        let [low, high] = self.number.to_le_bytes();
        let [system, component] = self.to;
        // Progress and the second result are not stated.
        let fields = [low, high, self.result as u8, 0, 0, 0, 0, 0, system, component];
        for (place, field) in payload.iter_mut().zip(fields) {
            *place = field;
        }
        fields.iter().rposition(|field| *field != 0).map_or(1, |last| last + 1)
    }

    fn deser(_: MavlinkVersion, _: &[u8]) -> Result<Self, ParserError> {
        Err(ParserError::UnknownMessage { id: Self::ID })
    }
}

//! A serial peripheral interface as a controller of its bus (RM0351, chapter 42): full duplex, words of a byte, two
//! buffers of four bytes.

use std::collections::VecDeque;

use super::Refused;
use crate::time::Time;
use embedded_hal::spi::{Mode, Phase, Polarity};
use hal_mock::wires::Clock;

/// Bytes that each buffer holds.
const DEPTH: usize = 4;
/// Bit of `SPIx_CR1` that enables it.
const ENABLED: u32 = 1 << 6;
/// Bits of `SPIx_CR2` that say how long a word is.
const WORD: u32 = 0xF00;
/// Words of eight bits.
const BYTE: u32 = 0x700;
/// `SPIx_SR`: a byte was received.
const RECEIVED: u32 = 1;
/// `SPIx_SR`: there is room for a byte to send.
const EMPTY: u32 = 1 << 1;
/// `SPIx_SR`: data that came while the buffer was full was lost.
const OVERRUN: u32 = 1 << 6;
/// `SPIx_CR1`: checksums, half duplex, receive only, bits in reverse order.
const UNUSUAL: u32 = 1 << 13 | 1 << 15 | 1 << 10 | 1 << 7;
/// `SPIx_CR1`: it masters its bus, and the software, not a pin, says that it may.
const MASTER: u32 = 1 << 9 | 1 << 8 | 1 << 2;
/// `SPIx_CR2`: pulses of the select line, another format of frames, last items of odd transfers.
const UNUSUAL_FRAMES: u32 = 1 << 3 | 1 << 4 | 1 << 13 | 1 << 14;

/// How far the flag of lost data is from being cleared: by a read of the data and then one of the status (42.4.11).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Overrun {
    /// Nothing was lost, or the flag is cleared.
    #[default]
    None,
    /// Data was lost.
    Lost,
    /// The data register was read since then.
    Read,
}

/// The registers.
#[derive(Clone, Debug, Default)]
pub struct Spi {
    /// `SPIx_CR1` and `SPIx_CR2`.
    control: [u32; 2],
    /// Bytes to be sent.
    sending: VecDeque<u8>,
    /// Bytes that were received.
    received: VecDeque<u8>,
    /// When the byte that is on the wires began.
    shifting: Option<Time>,
    /// Whether data was lost.
    overrun: Overrun,
    /// Whether the next byte never begins: a fault that is injected, until the interface is disabled in that state.
    pub hangs: bool,
    /// Whether no byte ever begins, whatever is done: the same fault, for good.
    pub is_stuck: bool,
    /// Whether a byte waits because of it.
    is_hung: bool,
    /// Bytes that were lost because the buffer was full.
    pub overruns: u64,
}

impl Spi {
    /// The registers after a reset.
    pub fn new() -> Self {
        Self { control: [0, BYTE], ..Self::default() }
    }

    /// A reset, which mends no fault for good.
    pub fn reset(&mut self) {
        *self = Self { is_stuck: self.is_stuck, ..Self::new() };
    }

    /// Whether it is enabled; then it masters its bus.
    fn is_on(&self) -> bool {
        self.control[0] & ENABLED != 0
    }

    /// Clock and mode of the bus, by the clock of the peripheral, Hz: `CPOL` is bit 1 and `CPHA` bit 0 of
    /// `SPIx_CR1`.
    pub fn clock(&self, hertz: u64) -> Clock {
        let [control, _] = self.control;
        let polarity = if control & 2 != 0 { Polarity::IdleHigh } else { Polarity::IdleLow };
        let phase = if control & 1 != 0 {
            Phase::CaptureOnSecondTransition
        } else {
            Phase::CaptureOnFirstTransition
        };
        Clock { mode: Mode { polarity, phase }, hertz: (hertz >> (1 + (control >> 3 & 7))) as u32 }
    }

    /// The byte that begins now, where there is one.
    pub fn begin(&mut self, now: Time) -> Option<u8> {
        if self.shifting.is_some() || !self.is_on() {
            return None;
        }
        if self.hangs || self.is_stuck {
            self.is_hung = !self.sending.is_empty();
            return None;
        }
        let byte = self.sending.pop_front()?;
        self.shifting = Some(now);
        Some(byte)
    }

    /// When the byte on the wires ends, by the clock of the peripheral, Hz.
    pub fn due(&self, hertz: u64) -> Time {
        let bits = || Time::periods(8, self.clock(hertz).hertz.into());
        self.shifting.map_or(Time::NEVER, |begin| begin + bits())
    }

    /// Whether a byte is on the wires.
    pub const fn is_shifting(&self) -> bool {
        self.shifting.is_some()
    }

    /// The byte on the wires has ended: takes in the one that came back. All that comes after lost data is lost, too,
    /// until the flag is cleared (42.4.11).
    pub fn receive(&mut self, byte: u8) {
        self.shifting = None;
        if self.received.len() < DEPTH && self.overrun == Overrun::None {
            self.received.push_back(byte);
        } else {
            if self.overrun == Overrun::None {
                self.overrun = Overrun::Lost;
            }
            self.overruns += 1;
        }
    }

    /// Whether there is room for bytes to send: more than half full, the buffer counts as full (42.4.9).
    fn has_room(&self) -> bool {
        self.sending.len() <= DEPTH / 2
    }

    /// Whether it asks for a byte to send by direct memory access.
    pub fn wants_byte(&self) -> bool {
        self.control[1] & 2 != 0 && self.is_on() && self.has_room()
    }

    /// Whether it has a byte for the direct memory access.
    pub fn has_byte(&self) -> bool {
        self.control[1] & 1 != 0 && !self.received.is_empty()
    }

    /// The status (42.6.3).
    fn status(&self) -> u32 {
        let level = |bytes: &VecDeque<u8>| [0, 1, 2, 2, 3][bytes.len().min(DEPTH)];
        let threshold = if self.control[1] & 1 << 12 != 0 { 1 } else { 2 };
        let is_busy = self.shifting.is_some() || (self.is_on() && !self.sending.is_empty());
        let flag = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        flag(self.received.len() >= threshold, RECEIVED)
            | flag(self.has_room(), EMPTY)
            | flag(self.overrun != Overrun::None, OVERRUN)
            | flag(is_busy, 1 << 7)
            | level(&self.received) << 9
            | level(&self.sending) << 11
    }

    /// Whether it interrupts: by a byte, by room for one, by lost data (42.5).
    pub fn interrupts(&self) -> bool {
        let (status, [_, control]) = (self.status(), self.control);
        let by = |enable: u32, flag: u32| control & enable != 0 && status & flag != 0;
        by(1 << 6, RECEIVED) || by(1 << 7, EMPTY) || by(1 << 5, OVERRUN)
    }

    /// Reads a register by an access of so many bytes.
    pub fn read(&mut self, offset: u32, size: u32) -> Result<u32, Refused> {
        match offset {
            0x00 | 0x04 => Ok(self.control[(offset / 4) as usize]),
            0x08 => {
                let status = self.status();
                if self.overrun == Overrun::Read {
                    self.overrun = Overrun::None;
                }
                Ok(status)
            }
            0x0C => {
                if self.overrun == Overrun::Lost {
                    self.overrun = Overrun::Read;
                }
                let bytes = (0..size.min(2))
                    .map(|place| u32::from(self.received.pop_front().unwrap_or(0)) << (8 * place));
                Ok(bytes.sum())
            }
            _ => Err(Refused::Unknown),
        }
    }

    /// Writes a register by an access of so many bytes.
    pub fn write(&mut self, offset: u32, value: u32, size: u32) -> Result<(), Refused> {
        Refused::where_asked(unmodelled(offset, value))?;
        match offset {
            0x00 => {
                // A byte that is on the wires when it is disabled is lost; the buffers stay (42.4.9).
                if value & ENABLED == 0 {
                    self.shifting = None;
                    self.hangs &= !std::mem::take(&mut self.is_hung);
                }
                self.control[0] = value;
            }
            // Words of fewer than four bits become those of a byte.
            0x04 => self.control[1] = if value & WORD == 0 { value | BYTE } else { value },
            // Its flags are not cleared by writing.
            0x08 => {}
            0x0C => {
                if !self.has_room() {
                    return Err(Refused::NotModelled("a byte to be sent while there is no room"));
                }
                let bytes = value.to_le_bytes();
                self.sending.extend(&bytes[..size.min(2) as usize]);
            }
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }
}

/// What a write of a register asks for that is not modelled.
const fn unmodelled(offset: u32, value: u32) -> Option<&'static str> {
    match offset {
        0x00 if value & UNUSUAL != 0 => {
            Some("checksums, half duplex, receive only or bits in reverse order")
        }
        0x00 if value & ENABLED != 0 && value & MASTER != MASTER => {
            Some("a bus that another one masters, or whose select line is the hardware's")
        }
        0x04 if value & WORD != BYTE && value & WORD != 0 => Some("words that are no bytes"),
        0x04 if value & UNUSUAL_FRAMES != 0 => {
            Some("pulses of the select line, frames of another format or odd last items")
        }
        _ => None,
    }
}

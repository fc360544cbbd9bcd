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
/// Data that came while the buffer was full was lost.
const OVERRUN: u32 = 1 << 6;

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
    /// Sticky flags of the status.
    flags: u32,
    /// Whether the next byte never begins: a fault that is injected, until the interface is disabled in that state.
    pub hangs: bool,
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

    /// Whether it is enabled, and masters its bus.
    fn is_on(&self) -> bool {
        self.control[0] & (ENABLED | 4) == ENABLED | 4
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
        if self.hangs {
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

    /// The byte on the wires has ended: takes in the one that came back.
    pub fn receive(&mut self, byte: u8) {
        self.shifting = None;
        if self.received.len() < DEPTH {
            self.received.push_back(byte);
        } else {
            self.flags |= OVERRUN;
            self.overruns += 1;
        }
    }

    /// Whether it asks for a byte to send by direct memory access.
    pub fn wants_byte(&self) -> bool {
        self.control[1] & 2 != 0
            && self.control[0] & ENABLED != 0
            && self.sending.len() <= DEPTH / 2
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
        u32::from(self.received.len() >= threshold)
            | u32::from(self.sending.len() <= DEPTH / 2) << 1
            | u32::from(is_busy) << 7
            | self.flags
            | level(&self.received) << 9
            | level(&self.sending) << 11
    }

    /// Reads a register by an access of so many bytes.
    pub fn read(&mut self, offset: u32, size: u32) -> Result<u32, Refused> {
        match offset {
            0x00 | 0x04 => Ok(self.control[(offset / 4) as usize]),
            0x08 => Ok(self.status()),
            0x0C => {
                let bytes = (0..size.min(2))
                    .map(|place| u32::from(self.received.pop_front().unwrap_or(0)) << (8 * place));
                Ok(bytes.sum())
            }
            _ => Err(Refused::Unknown),
        }
    }

    /// Writes a register by an access of so many bytes.
    pub fn write(&mut self, offset: u32, value: u32, size: u32) -> Result<(), Refused> {
        match offset {
            0x00 => {
                if value & 0x2000 != 0 || value & 0x8480 != 0 {
                    return Err(Refused::NotModelled(
                        "checksums, half duplex, receive only or bits in reverse order",
                    ));
                }
                // A byte that is on the wires when it is disabled is lost; the buffers stay (42.4.9).
                if value & ENABLED == 0 {
                    self.shifting = None;
                    self.hangs &= !std::mem::take(&mut self.is_hung);
                }
                self.control[0] = value;
            }
            0x04 if value & WORD != BYTE && value & WORD != 0 => {
                return Err(Refused::NotModelled("words that are no bytes"));
            }
            // Words of fewer than four bits become those of a byte.
            0x04 => self.control[1] = if value & WORD == 0 { value | BYTE } else { value },
            0x08 => {}
            0x0C => {
                let bytes = value.to_le_bytes();
                self.sending.extend(&bytes[..size.min(2) as usize]);
                self.sending.truncate(DEPTH);
            }
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }
}

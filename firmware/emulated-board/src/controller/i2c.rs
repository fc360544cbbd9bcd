//! An I²C interface that masters its bus (RM0351, chapter 39): 7-bit addresses, transfers of up to 255 bytes and
//! longer ones by reloading, automatic stop, direct memory access.

use super::{Refused, pins};
use crate::time::Time;
use crate::wiring::{I2cBus, Wiring};

/// Flags of `I2C_ISR`.
const TXE: u32 = 1;
/// The transmit register wants a byte.
const TXIS: u32 = 1 << 1;
/// The receive register has a byte.
const RXNE: u32 = 1 << 2;
/// The other side did not acknowledge.
const NACKF: u32 = 1 << 4;
/// A stop was sent.
const STOPF: u32 = 1 << 5;
/// The transfer is complete and waits for a start or a stop.
const TC: u32 = 1 << 6;
/// The part of the transfer is complete and waits for the next one.
const TCR: u32 = 1 << 7;
/// The bus is in use.
const BUSY: u32 = 1 << 15;

/// `I2C_CR1`: it is enabled, its interrupts, direct memory access. No other bit may be set.
const CONTROL: u32 = 0xC0FF;
/// `I2C_CR2`: addresses of ten bits, checksums.
const UNUSUAL: u32 = 1 << 11 | 1 << 12 | 1 << 26;

/// Bits of `I2C_CR2`.
const READS: u32 = 1 << 10;
/// Asks for a start.
const START: u32 = 1 << 13;
/// Asks for a stop.
const STOP: u32 = 1 << 14;
/// The transfer goes on after these bytes.
const RELOAD: u32 = 1 << 24;
/// A stop follows the last byte.
const AUTOEND: u32 = 1 << 25;

/// What is on the wires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wire {
    /// The start with the address.
    Address,
    /// A byte to the other side.
    Sending(u8),
    /// A byte from the other side.
    Receiving,
    /// The stop.
    Stop,
}

/// The registers.
#[derive(Clone, Debug, Default)]
pub struct I2c {
    /// `I2C_CR1` and `I2C_CR2`.
    control: [u32; 2],
    /// `I2C_TIMINGR`.
    timing: u32,
    /// Flags of the status.
    flags: u32,
    /// Bytes of this part of the transfer that are left.
    left: u32,
    /// What is on the wires, with when it began and ends.
    wire: Option<(Wire, [Time; 2])>,
    /// The byte to be sent.
    waiting: Option<u8>,
    /// The byte that was received.
    received: Option<u8>,
    /// Whether the bus is this controller's, between a start and a stop.
    is_owner: bool,
    /// Whether a device holds the clock line low, so that nothing on the wires ends: a fault that is injected, until a
    /// reset.
    pub hangs: bool,
}

impl I2c {
    /// The registers after a reset.
    pub fn new() -> Self {
        Self::default()
    }

    /// Clock of the bus, Hz, by the clock of the peripheral, Hz: low and high time, and the edges that are
    /// synchronised, about four clocks.
    pub fn hertz(&self, clock: u64) -> u32 {
        let field = |bit: u32, mask: u32| u64::from(self.timing >> bit & mask) + 1;
        let clocks = (field(0, 0xFF) + field(8, 0xFF)) * field(28, 0xF) + 4;
        (clock / clocks) as u32
    }

    /// Whether something is on the wires.
    pub const fn uses_wires(&self) -> bool {
        self.wire.is_some()
    }

    /// When what is on the wires ends.
    pub fn due(&self) -> Time {
        let wire = self.wire.filter(|_| !self.hangs);
        wire.map_or(Time::NEVER, |(_, [_, end])| end)
    }

    /// Puts something on the wires, of so many bits.
    fn put(&mut self, wire: Wire, bits: u64, now: Time, clock: u64) {
        self.wire = Some((wire, [now, now + Time::periods(bits, self.hertz(clock).into())]));
    }

    /// Does what is due: ends what is on the wires until now, and begins what follows.
    pub fn advance(&mut self, now: Time, clock: u64, bus: &mut dyn Wiring) {
        if self.hangs {
            return;
        }
        if let Some((wire, [begin, _])) = self.wire.take_if(|(_, [_, end])| *end <= now) {
            self.end(wire, [begin, now], clock, bus);
        }
        if self.has_work() && (self.is_owner || !is_data_low(bus, now)) {
            self.begin(now, clock);
        }
    }

    /// The interface lets both wires go, whatever is on them: a device that sends a byte waits for the rest of its clocks.
    pub fn let_go(&mut self, now: Time, clock: u64, bus: &mut dyn I2cBus) {
        let reads = self.is_owner && self.control[1] & (READS | START) == READS && self.left > 0;
        if reads && !self.hangs {
            let began = self.wire.map_or(now, |(_, [begin, _])| begin);
            let bit = (now - began).count(self.hertz(clock).into());
            bus.stop_clock(bit as u32, began);
        }
    }

    /// What is on the wires has ended.
    fn end(&mut self, wire: Wire, [begin, now]: [Time; 2], clock: u64, bus: &mut dyn I2cBus) {
        let acknowledged = match wire {
            Wire::Address => {
                self.control[1] &= !START;
                let address = (self.control[1] >> 1 & 0x7F) as u8;
                let hertz = self.hertz(clock);
                bus.start(address, self.control[1] & READS != 0, hertz, begin)
            }
            Wire::Sending(byte) => {
                self.left -= 1;
                bus.write(byte, begin)
            }
            Wire::Receiving => {
                self.left -= 1;
                let is_last = self.left == 0 && self.control[1] & RELOAD == 0;
                self.received = Some(bus.read(!is_last, begin));
                true
            }
            Wire::Stop => {
                self.control[1] &= !STOP;
                self.is_owner = false;
                self.flags |= STOPF;
                bus.stop(begin);
                return;
            }
        };
        if !acknowledged {
            self.flags |= NACKF;
            self.waiting = None;
            self.left = 0;
            self.put(Wire::Stop, 1, now, clock);
        }
    }

    /// Whether something may begin.
    const fn has_work(&self) -> bool {
        let is_asked = self.is_owner || self.control[1] & START != 0;
        self.control[0] & 1 != 0 && self.wire.is_none() && is_asked
    }

    /// Begins what can begin.
    fn begin(&mut self, now: Time, clock: u64) {
        let control = self.control[1];
        if control & START != 0 {
            self.is_owner = true;
            self.left = control >> 16 & 0xFF;
            self.flags &= !(TC | TCR);
            return self.put(Wire::Address, 10, now, clock);
        }
        if control & STOP != 0 {
            return self.put(Wire::Stop, 1, now, clock);
        }
        if self.left == 0 {
            match () {
                () if control & RELOAD != 0 => self.flags |= TCR,
                () if control & AUTOEND != 0 => self.put(Wire::Stop, 1, now, clock),
                () => self.flags |= TC,
            }
        } else if control & READS != 0 {
            if self.received.is_none() {
                self.put(Wire::Receiving, 9, now, clock);
            }
        } else if let Some(byte) = self.waiting.take() {
            self.put(Wire::Sending(byte), 9, now, clock);
        }
    }

    /// Whether a byte is wanted to be sent.
    fn is_empty(&self) -> bool {
        let addressed =
            self.is_owner && !matches!(self.wire, Some((Wire::Address | Wire::Stop, _)));
        let pending =
            self.left - u32::from(matches!(self.wire, Some((Wire::Sending(_), _)))).min(self.left);
        addressed
            && self.control[1] & (READS | START) == 0
            && self.waiting.is_none()
            && pending > 0
            && self.flags & NACKF == 0
    }

    /// Whether it asks for a byte to send by direct memory access.
    pub fn wants_byte(&self) -> bool {
        self.control[0] & 1 << 14 != 0 && self.is_empty()
    }

    /// Whether it has a byte for the direct memory access.
    pub fn has_byte(&self) -> bool {
        self.control[0] & 1 << 15 != 0 && self.received.is_some()
    }

    /// The status (39.7.7). The bus is busy while a device holds the data line low.
    pub fn status(&self, is_data_low: bool) -> u32 {
        let mut status = self.flags;
        status |= if self.waiting.is_none() { TXE } else { 0 };
        status |= if self.is_empty() { TXIS } else { 0 };
        status |= if self.received.is_some() { RXNE } else { 0 };
        let is_busy = self.is_owner || is_data_low && self.control[0] & 1 != 0;
        status |= if is_busy { BUSY } else { 0 };
        status
    }

    /// Whether it interrupts by an event, and by an error.
    pub fn interrupts(&self) -> [bool; 2] {
        let (status, control) = (self.status(false), self.control[0]);
        let by = |bit: u32, flags: u32| control & bit != 0 && status & flags != 0;
        let event =
            by(2, TXIS) || by(4, RXNE) || by(16, NACKF) || by(32, STOPF) || by(64, TC | TCR);
        [event, by(128, 0x3F00)]
    }

    /// Reads a register other than the status.
    pub fn read(&mut self, offset: u32) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 | 0x04 => self.control[(offset / 4) as usize],
            0x10 => self.timing,
            // It has no address of its own, and no time-outs.
            0x08 | 0x0C | 0x14 => 0,
            0x24 => self.received.take().unwrap_or(0).into(),
            0x28 => self.waiting.unwrap_or(0).into(),
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        Refused::where_asked(unmodelled(offset, value))?;
        match offset {
            0x00 => {
                self.control[0] = value;
                if value & 1 == 0 {
                    // Its software reset releases the bus (39.4.6).
                    self.flags = 0;
                    self.control[1] &= !(START | STOP);
                    (self.wire, self.waiting, self.received, self.is_owner) =
                        (None, None, None, false);
                }
            }
            0x04 => {
                // Start and stop are cleared by what they ask for only.
                self.control[1] = value | self.control[1] & (START | STOP);
                if self.flags & TCR != 0 && value >> 16 & 0xFF != 0 {
                    self.flags &= !TCR;
                    self.left = value >> 16 & 0xFF;
                }
                if value & (START | STOP) != 0 {
                    self.flags &= !TC;
                }
            }
            0x10 => self.timing = value,
            0x18 if value & TXE != 0 => self.waiting = None,
            0x08 | 0x0C | 0x14 | 0x18 => {}
            0x1C => self.flags &= !(value & (NACKF | STOPF | 0x3F00)),
            0x28 => self.waiting = Some(value as u8),
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }
}

/// Whether a device holds the data line low.
pub fn is_data_low(wiring: &mut dyn Wiring, now: Time) -> bool {
    !wiring.level(pins::I2C[1].pin, now)
}

/// What a write of a register asks for that is not modelled.
const fn unmodelled(offset: u32, value: u32) -> Option<&'static str> {
    match offset {
        0x00 if value & !CONTROL != 0 => Some("other filters, or functions of a device on the bus"),
        0x04 if value & UNUSUAL != 0 => Some("addresses of ten bits, or checksums"),
        0x08 | 0x0C | 0x14 if value != 0 => Some("an address of its own, or time-outs"),
        _ => None,
    }
}

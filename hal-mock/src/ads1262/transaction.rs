//! What the bytes between select low and select high do (SBAS661C figures 9-43, 9-44, table 9-33).

use embassy_time::Instant;

use super::frame::{Frame, frame};
use super::{Ads1262, registers, timing};
use crate::chip::{Transaction, bus_time};
use crate::violation::Misuse;

/// Where the chip is in a transaction.
#[derive(Clone, Debug)]
enum Phase {
    /// The next byte is a command.
    Command,
    /// The next byte is the number of registers less one.
    Count { address: u8, is_write: bool },
    /// Registers come in or go out.
    Registers { address: u8, is_write: bool, left: u8 },
    /// A conversion goes out.
    Data { frame: Frame, sent: usize },
}

/// What goes out while no command's answer does: the shift register, over and over, if it was loaded
/// since the bus last moved (figure 9-43); otherwise zeros.
struct Direct {
    /// What the shift register was loaded with, empty where it was not.
    frame: Frame,
    /// Bytes that have gone out, repetitions counted.
    sent: usize,
}

impl Direct {
    /// The next byte that goes out.
    fn next(&mut self) -> u8 {
        let length = self.frame.len().max(1);
        let byte = self.frame.get(self.sent % length).copied().unwrap_or(0);
        self.sent += 1;
        byte
    }

    /// Whether a whole conversion has gone out.
    fn is_read(&self) -> bool {
        !self.frame.is_empty() && self.sent >= self.frame.len()
    }
}

/// Answers a transaction.
pub(super) fn transact(chip: &mut Ads1262, transaction: &Transaction, reply: &mut [u8]) {
    let Transaction { now, hertz, sent } = *transaction;
    let first = sent.first().copied().unwrap_or(0);
    if hertz > timing::GREATEST_BUS_HERTZ {
        chip.violations.record(Misuse::ClockTooFast, first, now);
    }
    let mut direct = Direct { frame: chip.shift_register(), sent: 0 };
    // The first falling edge of the clock lifts the data-ready line (TI, e2e.ti.com thread 634263).
    chip.is_ready &= sent.is_empty();
    let mut phase = Phase::Command;
    for (index, (&byte, out)) in sent.iter().zip(reply).enumerate() {
        *out = chip.output(&phase, &mut direct);
        let span = [index, index + 1].map(|bytes| now + bus_time(bytes, hertz));
        phase = chip.input(phase, byte, span);
    }
    chip.holding.is_new &= !direct.is_read();
    chip.end(&phase, now);
}

impl Ads1262 {
    /// What is read without a command: the newest conversion, where it was not read before.
    fn shift_register(&self) -> Frame {
        if self.is_ready { self.frame() } else { Frame::new() }
    }

    /// The newest conversion in the form that the registers ask for.
    fn frame(&self) -> Frame {
        frame(&self.registers, self.status(), self.holding.code)
    }

    /// The answer to a read command, in which a bit of the data may be wrong.
    fn commanded_frame(&mut self) -> Frame {
        let mut frame = self.frame();
        if core::mem::take(&mut self.chip_fault.corrupts_next) {
            frame.iter_mut().skip(2).take(1).for_each(|byte| *byte ^= 0x10);
        }
        frame
    }

    /// The byte that goes out while the next one comes in.
    fn output(&self, phase: &Phase, direct: &mut Direct) -> u8 {
        match phase {
            Phase::Registers { address, is_write: false, .. } => {
                self.registers.get(*address).unwrap_or(0)
            }
            Phase::Data { frame, sent } => frame.get(*sent).copied().unwrap_or(0),
            _ => direct.next(),
        }
    }

    /// Takes a byte that came in between the two times.
    fn input(&mut self, phase: Phase, byte: u8, [begin, end]: [Instant; 2]) -> Phase {
        match phase {
            Phase::Command if begin < self.operational => {
                self.violations.record(Misuse::TooEarly, byte, begin);
                Phase::Command
            }
            Phase::Command => self.command(byte, end),
            Phase::Count { address, is_write } => {
                Phase::Registers { address, is_write, left: byte }
            }
            Phase::Registers { address, is_write, left } => {
                if is_write {
                    self.write(address, byte, end);
                } else if self.registers.get(address).is_none() {
                    self.violations.record(Misuse::UnknownRegister, address, begin);
                }
                let address = address.saturating_add(1);
                match left.checked_sub(1) {
                    Some(left) => Phase::Registers { address, is_write, left },
                    None => Phase::Command,
                }
            }
            Phase::Data { frame, sent } if sent + 1 < frame.len() => {
                Phase::Data { frame, sent: sent + 1 }
            }
            Phase::Data { .. } => Phase::Command,
        }
    }

    /// Executes a command at the end of its byte (table 9-33).
    fn command(&mut self, byte: u8, at: Instant) -> Phase {
        match byte {
            0x00 => {}
            0x06 | 0x07 => {
                self.reset(at);
                self.operational = at + timing::RESET;
            }
            0x08 | 0x09 => self.start(byte, at),
            0x0A | 0x0B => self.running = None,
            0x12 | 0x13 => {
                let frame = self.commanded_frame();
                self.holding.is_new = false;
                return Phase::Data { frame, sent: 0 };
            }
            0x20..=0x3F => return Phase::Count { address: byte & 0x1F, is_write: false },
            0x40..=0x5F => return Phase::Count { address: byte & 0x1F, is_write: true },
            _ => self.violations.record(Misuse::UnknownCommand, byte, at),
        }
        Phase::Command
    }

    /// Begins conversions by the START pin or a command; a reference that has not settled is recorded.
    pub(super) fn start(&mut self, command: u8, at: Instant) {
        if self.registers.references() == (0, 0) && at < self.reference_since + timing::REFERENCE {
            self.violations.record(Misuse::TooEarly, command, at);
        }
        if self.registers.is_rate_excluded() {
            self.violations.record(Misuse::ForbiddenValue, registers::MODE2, at);
        }
        self.begin(at);
    }

    /// Writes a register at the end of its byte, with what that starts anew.
    fn write(&mut self, address: u8, value: u8, at: Instant) {
        if self.chip_fault.broken_register == Some(address) {
            return;
        }
        let was_on = self.registers.is_set(registers::REFERENCE_ON);
        if let Err(misuse) = self.registers.set(address, value) {
            self.violations.record(misuse, address, at);
        }
        if !was_on && self.registers.is_set(registers::REFERENCE_ON) {
            self.reference_since = at;
        }
        if registers::restarts(address) && self.running.is_some() {
            self.begin(at);
        }
    }

    /// Select high: what was not completed is given up, and recorded as a wrong length.
    fn end(&mut self, phase: &Phase, now: Instant) {
        let address = match phase {
            Phase::Command => return,
            Phase::Count { address, .. } | Phase::Registers { address, .. } => *address,
            Phase::Data { .. } => 0x12,
        };
        self.violations.record(Misuse::Length, address, now);
    }
}

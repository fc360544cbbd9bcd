//! What the bytes between select low and select high do (SBAS661C figures 9-43, 9-44, table 9-33).

use embassy_time::Instant;

use super::frame::{Frame, frame};
use super::{Ads1262, registers, timing};
use crate::chip::Exchange;
use crate::violation::Misuse;

/// Where the chip is in a transaction.
#[derive(Clone, Copy, Debug, Default)]
enum Phase {
    /// The next byte is a command.
    #[default]
    Command,
    /// The next byte is the number of registers less one.
    Count { address: u8, is_write: bool },
    /// Registers come in or go out.
    Registers { address: u8, is_write: bool, left: u8 },
    /// A conversion goes out.
    Data { sent: u8 },
}

/// What goes out while no command's answer does: the shift register, over and over, if it was loaded
/// since the bus last moved (figure 9-43); otherwise zeros.
#[derive(Clone, Debug, Default)]
struct Direct {
    /// What the shift register was loaded with, empty where it was not.
    frame: Frame,
    /// The byte of it that goes out next.
    next: usize,
    /// Whether a whole conversion has gone out.
    is_read: bool,
}

impl Direct {
    /// The next byte that goes out.
    fn next(&mut self) -> u8 {
        let Some(byte) = self.frame.get(self.next).copied() else { return 0 };
        self.next += 1;
        if self.next == self.frame.len() {
            self.next = 0;
            self.is_read = true;
        }
        byte
    }
}

/// What has passed since the select line fell.
#[derive(Clone, Debug, Default)]
pub(super) struct Course {
    /// Whether conversions that end have to wait.
    pub(super) is_selected: bool,
    /// Whether a byte has passed.
    is_clocked: bool,
    /// What the next byte is.
    phase: Phase,
    /// What goes out without a command.
    direct: Direct,
    /// The answer to the latest read command.
    commanded: Frame,
}

impl Course {
    /// Nothing has passed yet.
    pub(super) fn begun() -> Self {
        Self { is_selected: true, ..Self::default() }
    }
}

impl Ads1262 {
    /// Takes a byte and gives the one that goes out meanwhile.
    pub(super) fn pass(&mut self, exchange: &Exchange) -> u8 {
        if !self.course.is_clocked {
            self.first_edge(exchange);
        }
        let reply = self.output();
        self.course.phase = self.input(exchange);
        reply
    }

    /// The first falling edge of the clock, which lifts the data-ready line (TI, e2e.ti.com thread 634263).
    fn first_edge(&mut self, exchange: &Exchange) {
        if exchange.hertz > timing::GREATEST_BUS_HERTZ {
            self.violations.record(Misuse::ClockTooFast, exchange.sent, exchange.since);
        }
        if self.waiting.is_some_and(|(ended, _)| ended <= exchange.begin) {
            self.release();
        }
        self.course.direct.frame = self.shift_register();
        self.course.is_selected = true;
        self.course.is_clocked = true;
        self.is_ready = false;
    }

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
    fn output(&mut self) -> u8 {
        match self.course.phase {
            Phase::Registers { address, is_write: false, .. } => {
                self.registers.get(address).unwrap_or(0)
            }
            Phase::Data { sent } => {
                self.course.commanded.get(usize::from(sent)).copied().unwrap_or(0)
            }
            _ => self.course.direct.next(),
        }
    }

    /// Takes a byte; what the next one is.
    fn input(&mut self, exchange: &Exchange) -> Phase {
        let Exchange { sent: byte, begin, end, .. } = *exchange;
        match self.course.phase {
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
            Phase::Data { sent } if usize::from(sent) + 1 < self.course.commanded.len() => {
                Phase::Data { sent: sent + 1 }
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
            0x0A | 0x0B => self.stop(),
            0x12 | 0x13 => {
                self.course.commanded = self.commanded_frame();
                self.holding.is_new = false;
                return Phase::Data { sent: 0 };
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

    /// Shows a conversion that has waited; what was read of the one before is read.
    pub(super) fn release(&mut self) {
        if core::mem::take(&mut self.course.direct).is_read {
            self.holding.is_new = false;
        }
        if let Some((_, volts)) = self.waiting.take() {
            self.hold(volts);
        }
    }

    /// Select high: what was not completed is given up, and recorded as a wrong length.
    pub(super) fn end(&mut self, since: Instant, is_whole: bool) {
        self.release();
        let address = match core::mem::take(&mut self.course).phase {
            Phase::Command if is_whole => return,
            Phase::Command => 0x00,
            Phase::Count { address, .. } | Phase::Registers { address, .. } => address,
            Phase::Data { .. } => 0x12,
        };
        self.violations.record(Misuse::Length, address, since);
    }
}

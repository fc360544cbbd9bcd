//! The serial port USART1 (RM0351, chapter 40): frames of eight bits, no parity, one stop bit, both ways.

use std::collections::VecDeque;

use super::Refused;
use crate::time::Time;

/// Bits of a frame on the wire.
const FRAME: u64 = 10;
/// `USART_CR1`: it is enabled.
const ENABLED: u32 = 1;
/// `USART_CR1`: it receives.
const RECEIVES: u32 = 4;
/// `USART_CR1`: it sends.
const SENDS: u32 = 8;
/// `USART_CR1`: frames of other lengths, parity, oversampling by eight; names of receivers and their silence, pins that
/// enable a driver, interrupts but those by bytes and by an idle line.
const UNUSUAL: u32 = !(ENABLED | RECEIVES | SENDS | IDLE | RECEIVED | COMPLETE | EMPTY);
/// `USART_CR3`: errors interrupt, memory is accessed, one sample decides a bit. No other bit may be set.
const MODES: u32 = 1 | 1 << 6 | 1 << 7 | 1 << 11;
/// `USART_ISR`: a byte came before the one before it was read.
const OVERRUN: u32 = 1 << 3;
/// `USART_ISR`: the line was idle for the time of a frame.
const IDLE: u32 = 1 << 4;
/// `USART_ISR`: a byte has come.
const RECEIVED: u32 = 1 << 5;
/// `USART_ISR`: all that was to be sent has been.
const COMPLETE: u32 = 1 << 6;
/// `USART_ISR`: another byte can be sent.
const EMPTY: u32 = 1 << 7;

/// `USART_ISR`: a frame is on the line that it receives.
const BUSY: u32 = 1 << 16;

/// The registers.
#[derive(Clone, Debug, Default)]
pub struct Usart {
    /// `USART_CR1`, `CR2`, which stays zero, and `CR3`.
    control: [u32; 3],
    /// `USART_BRR`.
    divider: u32,
    /// Flags that stay.
    flags: u32,
    /// The byte that waits to be sent.
    waiting: Option<u8>,
    /// The byte on the wire, and when its frame ends.
    shifting: Option<(u8, Time)>,
    /// The byte that was received.
    received: Option<u8>,
    /// Bytes that the other side sends, each with when its frame begins and ends.
    incoming: VecDeque<(u8, [Time; 2])>,
    /// Since when it receives, where it does.
    receives_since: Option<Time>,
    /// Whether an idle line is still to be told: the first one that it hears, and one after each frame (40.8.8).
    awaits_idle: bool,
    /// When the line, which is quiet, will have been idle for a frame, where that is to be told.
    idle: Option<Time>,
    /// Bytes that were sent.
    pub sent: Vec<u8>,
    /// Bytes of the other side that were lost, because the one before was not read.
    pub overruns: u64,
}

impl Usart {
    /// The registers after a reset.
    pub fn new() -> Self {
        Self { flags: COMPLETE, ..Self::default() }
    }

    /// A reset; what was sent is not the port's any more, and the other side goes on to send.
    pub fn reset(&mut self) {
        let (sent, incoming) = (std::mem::take(&mut self.sent), std::mem::take(&mut self.incoming));
        *self = Self { sent, incoming, overruns: self.overruns, ..Self::new() };
    }

    /// Periods of its clock for a bit.
    fn bit(&self) -> u64 {
        self.divider.max(16).into()
    }

    /// Its rate, baud, by the clock of the peripheral, Hz.
    pub fn baud(&self, hertz: u64) -> u32 {
        (hertz / self.bit()) as u32
    }

    /// Whether it is enabled and a bit of `USART_CR1` is set.
    const fn is_on(&self, bit: u32) -> bool {
        self.control[0] & (ENABLED | bit) == ENABLED | bit
    }

    /// The other side sends bytes at its rate, baud, one after the other, from now on or after those before them.
    pub fn offer(&mut self, bytes: &[u8], baud: u32, now: Time) {
        let frame = Time::periods(FRAME, baud.into());
        for byte in bytes {
            let begin = self.incoming.back().map_or(now, |(_, [_, end])| *end);
            self.incoming.push_back((*byte, [begin, begin + frame]));
        }
        self.idle = self.idle.filter(|_| self.incoming.is_empty());
    }

    /// Time of a frame at its own rate, by the clock of the peripheral, Hz.
    fn frame(&self, hertz: u64) -> Time {
        Time::periods(FRAME * self.bit(), hertz)
    }

    /// Listens to the line from now on, where it begins to receive, or to nothing.
    fn listen(&mut self, now: Time, hertz: u64) {
        if !self.is_on(RECEIVES) {
            (self.receives_since, self.awaits_idle, self.idle) = (None, false, None);
        } else if self.receives_since.is_none() {
            (self.receives_since, self.awaits_idle) = (Some(now), true);
            self.quieten(now, hertz);
        }
    }

    /// The line is quiet from a moment on, unless a frame is on it: an idle line is one that is so for a whole frame
    /// (40.5.1), at the rate of the receiver.
    fn quieten(&mut self, since: Time, hertz: u64) {
        let is_told = self.awaits_idle && self.incoming.is_empty();
        self.idle = is_told.then(|| since + self.frame(hertz));
    }

    /// Begins the frame that waits to be sent, where it can; whether one begins.
    pub fn begin(&mut self, now: Time, hertz: u64) -> bool {
        self.listen(now, hertz);
        if !self.is_on(SENDS) || self.shifting.is_some() {
            return false;
        }
        let end = now + self.frame(hertz);
        self.shifting = self.waiting.take().map(|byte| (byte, end));
        self.shifting.is_some()
    }

    /// Whether it receives a frame that began then: one that it has not heard from its start is lost.
    fn hears(&self, begin: Time) -> bool {
        self.receives_since.is_some_and(|since| since <= begin)
    }

    /// Whether frames are on the wires that it sends, and that it receives.
    pub fn uses(&self) -> [bool; 2] {
        let receives = self.incoming.front().is_some_and(|(_, [begin, _])| self.hears(*begin));
        [self.shifting.is_some(), receives]
    }

    /// When a frame ends, or the line has been idle for one.
    pub fn due(&self) -> Time {
        let sending = self.shifting.map(|(_, end)| end);
        let receiving = self.incoming.front().map(|(_, [_, end])| *end);
        [sending, receiving, self.idle].into_iter().flatten().fold(Time::NEVER, Time::min)
    }

    /// Ends frames that end until now, by the clock of the peripheral, Hz; whether one was received.
    pub fn advance(&mut self, now: Time, hertz: u64) -> bool {
        if self.idle.take_if(|idle| *idle <= now).is_some() {
            self.flags |= IDLE;
            self.awaits_idle = false;
        }
        self.end_sent(now);
        self.end_received(now, hertz)
    }

    /// Ends a frame on the wire that it sends, where that ends until now.
    fn end_sent(&mut self, now: Time) {
        if let Some((byte, _)) = self.shifting.take_if(|(_, end)| *end <= now) {
            self.sent.push(byte);
            if self.waiting.is_none() {
                self.flags |= COMPLETE;
            }
        }
    }

    /// Ends a frame on the wire that it receives, where that ends until now; whether it was received.
    fn end_received(&mut self, now: Time, hertz: u64) -> bool {
        let Some((byte, [begin, end])) = self.incoming.pop_front_if(|(_, [_, end])| *end <= now)
        else {
            return false;
        };
        let is_heard = self.hears(begin);
        if is_heard {
            self.take(byte);
        }
        self.awaits_idle |= is_heard;
        self.quieten(end, hertz);
        is_heard
    }

    /// Takes a byte that was received; it is lost where the one before was not read (40.5.3).
    fn take(&mut self, byte: u8) {
        if self.received.is_some() {
            self.flags |= OVERRUN;
            self.overruns += 1;
        } else {
            self.received = Some(byte);
        }
    }

    /// Whether it asks for a byte to send by direct memory access.
    pub fn wants_byte(&self) -> bool {
        self.control[2] & 0x80 != 0 && self.is_on(SENDS) && self.waiting.is_none()
    }

    /// Whether it has a byte for the direct memory access.
    pub fn has_byte(&self) -> bool {
        self.control[2] & 0x40 != 0 && self.received.is_some()
    }

    /// The status (40.8.8).
    fn status(&self) -> u32 {
        let empty = if self.waiting.is_none() { EMPTY } else { 0 };
        let received = if self.received.is_some() { RECEIVED } else { 0 };
        // TEACK and REACK follow the enable bits.
        let acknowledged = if self.control[0] & ENABLED != 0 {
            (self.control[0] & SENDS) << 18 | (self.control[0] & RECEIVES) << 20
        } else {
            0
        };
        let busy = if self.uses()[1] { BUSY } else { 0 };
        self.flags | empty | received | busy | acknowledged
    }

    /// Whether it interrupts: bits of `USART_CR1` are at the places of their flags; errors by `CR3`.
    pub fn interrupts(&self) -> bool {
        let status = self.status();
        status & self.control[0] & (IDLE | RECEIVED | COMPLETE | EMPTY) != 0
            || (status & OVERRUN != 0
                && (self.control[0] & RECEIVED != 0 || self.control[2] & 1 != 0))
    }

    /// Reads a register.
    pub fn read(&mut self, offset: u32) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 | 0x04 | 0x08 => self.control[(offset / 4) as usize],
            0x0C => self.divider,
            0x10 | 0x14 | 0x18 => 0,
            0x1C => self.status(),
            0x24 => self.received.take().unwrap_or(0).into(),
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        Refused::where_asked(unmodelled(offset, value))?;
        match offset {
            0x00 | 0x04 | 0x08 => self.control[(offset / 4) as usize] = value,
            0x0C => self.divider = value,
            0x18 if value == 8 => self.received = None,
            0x10 | 0x14 | 0x18 => {}
            0x20 => self.flags &= !value,
            0x28 => {
                self.waiting = Some(value as u8);
                self.flags &= !COMPLETE;
            }
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }
}

/// What a write of a register asks for that is not modelled.
const fn unmodelled(offset: u32, value: u32) -> Option<&'static str> {
    match (offset, value) {
        (0x00, _) if value & UNUSUAL != 0 => {
            Some("frames of other lengths, parity, oversampling by eight, other interrupts")
        }
        (0x04, 1..) => Some("other stop bits, levels or places of the pins"),
        (0x08, _) if value & !MODES != 0 => Some("one wire for both ways, or a handshake"),
        (0x18, 0 | 8) => None,
        (0x10 | 0x14 | 0x18, 1..) => Some("time-outs, breaks, or a rate that is measured"),
        _ => None,
    }
}

//! The timer TIM15 (RM0351, chapter 32), which counts the microseconds of the image.

use super::Refused;
use crate::time::Time;

/// Update interrupt flag, as in DIER and SR.
const UPDATE: u32 = 1;

/// `TIMx_CR1`: it counts, and only an overflow sets the update flag. No other bit may be set.
const CONTROL: u32 = 0b101;
/// `TIMx_DIER`: an update and both compare channels interrupt. No other bit may be set.
const INTERRUPTS: u32 = 0b111;
/// Offsets of the registers that stay zero: `TIMx_CR2`, `SMCR`, `CCMR1`, `CCER`, `RCR`, `BDTR`.
const OTHERS: [u32; 6] = [0x04, 0x08, 0x18, 0x20, 0x30, 0x44];

/// A timer of 16 bits that counts up, with two compare channels.
#[derive(Clone, Debug)]
pub struct Timer {
    /// `TIMx_CR1`.
    control: u32,
    /// `TIMx_DIER`.
    enabled: u32,
    /// `TIMx_SR`.
    status: u32,
    /// `TIMx_PSC` as written; it acts from the next update on.
    prescaler: u32,
    /// `TIMx_ARR`.
    reload: u32,
    /// `TIMx_CCR1` and `TIMx_CCR2`.
    compare: [u32; 2],
    /// Periods of its clock for a count: the prescaler that acts, and one.
    divider: u64,
    /// Its clock, Hz.
    clock: u64,
    /// When the count was zero, the latest time that it was set.
    since: Time,
    /// Count at that time.
    base: u64,
    /// Counts up to which flags are set.
    seen: u64,
}

impl Timer {
    /// The registers after a reset; its clock has so many hertz.
    pub const fn new(clock: u64) -> Self {
        Self {
            control: 0,
            enabled: 0,
            status: 0,
            prescaler: 0,
            reload: 0xFFFF,
            compare: [0; 2],
            divider: 1,
            clock,
            since: Time::ZERO,
            base: 0,
            seen: 0,
        }
    }

    /// Frequency at which it counts, Hz.
    const fn hertz(&self) -> u64 {
        self.clock / self.divider
    }

    /// Goes on at another clock, Hz, from the count that it has.
    pub fn reclock(&mut self, clock: u64, now: Time) {
        if clock != self.clock {
            self.advance(now);
            self.set(self.total(now), now);
            self.clock = clock;
        }
    }

    /// Counts since it was set, without the wrap.
    fn total(&self, now: Time) -> u64 {
        if self.control & 1 == 0 {
            return self.base;
        }
        self.base + (now - self.since).count(self.hertz())
    }

    /// The length of a round.
    fn round(&self) -> u64 {
        u64::from(self.reload & 0xFFFF) + 1
    }

    /// Sets the count.
    fn set(&mut self, count: u64, now: Time) {
        (self.base, self.seen, self.since) = (count, count, now);
    }

    /// Sets the flags of all that was reached until now.
    pub fn advance(&mut self, now: Time) {
        let total = self.total(now);
        for (bit, at) in self.marks() {
            // How often the mark was passed until a count.
            let passed = |count: u64| (count + self.round() - at) / self.round();
            if passed(total) > passed(self.seen) {
                self.status |= bit;
            }
        }
        self.seen = total;
    }

    /// Flags with the counts in a round at which they are set.
    fn marks(&self) -> [(u32, u64); 3] {
        let [first, second] = self.compare.map(u64::from);
        [(UPDATE, 0), (2, first), (4, second)]
    }

    /// When a flag that interrupts is next set.
    pub fn due(&self) -> Time {
        if self.control & 1 == 0 {
            return Time::NEVER;
        }
        let (seen, round) = (self.seen, self.round());
        let next = |at: u64| {
            let distance = (at + round - seen % round) % round;
            seen + if distance == 0 { round } else { distance }
        };
        let wanted = self
            .marks()
            .into_iter()
            .filter(|(bit, _)| self.enabled & bit != 0 && self.status & bit == 0);
        let next = wanted.map(|(_, at)| next(at)).min();
        next.map_or(Time::NEVER, |count| {
            self.since + Time::periods(count - self.base, self.hertz())
        })
    }

    /// Whether it interrupts.
    pub fn interrupts(&self) -> bool {
        self.status & self.enabled & 7 != 0
    }

    /// Reads a register.
    pub fn read(&mut self, offset: u32, now: Time) -> Result<u32, Refused> {
        self.advance(now);
        Ok(match offset {
            0x00 => self.control,
            0x0C => self.enabled,
            0x10 => self.status,
            0x14 => 0,
            0x24 => (self.total(now) % self.round()) as u32,
            0x28 => self.prescaler,
            0x2C => self.reload,
            0x34 | 0x38 => self.compare[(offset / 4 - 13) as usize],
            _ if OTHERS.contains(&offset) => 0,
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32, now: Time) -> Result<(), Refused> {
        Refused::where_asked(self.unmodelled(offset, value))?;
        self.advance(now);
        match offset {
            0x00 => {
                let count = self.total(now);
                self.control = value;
                self.set(count, now);
            }
            0x0C => self.enabled = value,
            0x10 => self.status &= value,
            0x14 => {
                self.divider = u64::from(self.prescaler) + 1;
                self.set(0, now);
                // URS: only an overflow sets the flag.
                self.status |= if self.control & 4 == 0 { UPDATE } else { 0 };
            }
            0x24 => self.set(u64::from(value & 0xFFFF), now),
            0x28 => self.prescaler = value & 0xFFFF,
            0x2C => self.reload = value & 0xFFFF,
            0x34 | 0x38 => self.compare[(offset / 4 - 13) as usize] = value & 0xFFFF,
            _ if OTHERS.contains(&offset) => {}
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// What a write of a register asks for that is not modelled.
    fn unmodelled(&self, offset: u32, value: u32) -> Option<&'static str> {
        match offset {
            0x00 if value & !CONTROL != 0 => Some("another way to count than up, on and on"),
            0x0C if value & !INTERRUPTS != 0 => Some("requests of the timer for memory"),
            0x14 if value != UPDATE => Some("events of the timer but updates"),
            0x28 if self.control & 1 != 0 => Some("a prescaler that changes while it counts"),
            _ if OTHERS.contains(&offset) && value != 0 => {
                Some("outputs, inputs and repetitions of the timer")
            }
            _ => None,
        }
    }
}

//! The timer TIM15 (RM0351, chapter 32), which counts the microseconds of the image.

use super::Refused;
use crate::time::Time;

/// Update interrupt flag, as in DIER and SR.
const UPDATE: u32 = 1;

/// Offsets of the registers without effect: `TIMx_CR2`, `SMCR`, `CCMR1`, `CCER`, `RCR`, `BDTR`.
const OTHERS: [u32; 6] = [0x04, 0x08, 0x18, 0x20, 0x30, 0x44];

/// The place of a register without effect.
fn other(offset: u32) -> Result<usize, Refused> {
    OTHERS.iter().position(|other| *other == offset).ok_or(Refused::Unknown)
}

/// A timer of 16 bits that counts up, with two compare channels.
#[derive(Clone, Debug, Default)]
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
    /// Frequency at which it counts, Hz; zero before the first update.
    hertz: u64,
    /// When the count was zero, the latest time that it was set.
    since: Time,
    /// Count at that time.
    base: u64,
    /// Counts up to which flags are set.
    seen: u64,
    /// The registers that have no effect here ([`OTHERS`]).
    others: [u32; OTHERS.len()],
}

impl Timer {
    /// Counts since it was set, without the wrap.
    fn total(&self, now: Time) -> u64 {
        if self.control & 1 == 0 {
            return self.base;
        }
        self.base + (now - self.since).count(self.hertz)
    }

    /// The length of a round.
    fn round(&self) -> u64 {
        u64::from(self.reload & 0xFFFF) + 1
    }

    /// Sets the count, at a frequency in hertz.
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
        if self.control & 1 == 0 || self.hertz == 0 {
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
        next.map_or(Time::NEVER, |count| self.since + Time::periods(count - self.base, self.hertz))
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
            _ => self.others[other(offset)?],
        })
    }

    /// Writes a register; the timer's clock has so many hertz.
    pub fn write(&mut self, offset: u32, value: u32, now: Time, hertz: u64) -> Result<(), Refused> {
        self.advance(now);
        match offset {
            0x00 => {
                let count = self.total(now);
                self.control = value;
                self.set(count, now);
            }
            0x0C => self.enabled = value,
            0x10 => self.status &= value,
            0x14 if value & 1 != 0 => {
                self.hertz = hertz / u64::from(self.prescaler + 1);
                self.set(0, now);
                // URS: only an overflow sets the flag.
                self.status |= if self.control & 4 == 0 { UPDATE } else { 0 };
            }
            0x24 => self.set(u64::from(value & 0xFFFF), now),
            0x28 => self.prescaler = value & 0xFFFF,
            0x2C => self.reload = value & 0xFFFF,
            0x34 | 0x38 => self.compare[(offset / 4 - 13) as usize] = value & 0xFFFF,
            _ => self.others[other(offset)?] = value,
        }
        Ok(())
    }
}

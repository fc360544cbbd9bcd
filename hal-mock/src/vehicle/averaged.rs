//! A vehicle's motion as chips see it that average.
//!
//! A sigma-delta converter and the filter of an accelerometer average: every reading is the mean since
//! the reading before it by the same chip, or over one period where that is long ago.

use super::motion::{Integrals, Motion};
use crate::earth::InertialInput;

/// Periods after which a reading no longer reaches back to the one before it.
const LONG_AGO: f64 = 1.5;

/// What had been integrated when a chip read last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mark {
    /// When the chip read, s from the start.
    time_s: f64,
    /// Integrals up to then.
    integrals: Integrals,
}

/// A motion, with what each of its chips has seen of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Averaged<'a, const CHIPS: usize> {
    /// The motion up to the latest reading.
    pub(crate) motion: Motion<'a>,
    /// The latest reading of each chip.
    marks: [Mark; CHIPS],
}

impl<'a, const CHIPS: usize> Averaged<'a, CHIPS> {
    /// A motion of which no chip has seen anything yet.
    pub(crate) fn new(motion: Motion<'a>) -> Self {
        Self { motion, marks: [Mark::default(); CHIPS] }
    }

    /// Means over the sample of a chip with a period in s that ends at a time in s.
    pub(crate) fn felt(&mut self, chip: usize, time_s: f64, period_s: f64) -> InertialInput {
        if time_s - self.marks[chip].time_s > LONG_AGO * period_s {
            self.motion.advance(time_s - period_s);
            self.marks[chip] = self.mark();
        }
        self.motion.advance(time_s);
        let (from, to) = (self.marks[chip], self.mark());
        self.marks[chip] = to;
        to.integrals.means(&from.integrals, to.time_s - from.time_s)
    }

    /// What has been integrated by now.
    fn mark(&self) -> Mark {
        Mark { time_s: self.motion.time_s, integrals: self.motion.integrals }
    }
}

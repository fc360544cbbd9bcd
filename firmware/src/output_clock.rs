//! Times of the outputs of a sensor that samples by an oscillator of its own, and is read more often than it has
//! a new output.
//!
//! ```text
//!  outputs   │      │      │      │      │      │       period of the sensor
//!  readings    │   │   │   │   │   │   │   │   │        of which nearly every second one finds a new output
//! ```
//!
//! An output stands for the sensor's own period, not for the time between two readings: how late it is read
//! changes with the beat of both rates, and what shakes at that beat would add up to a rotation that there was
//! not. For the same reason no output may be left out, so the readings are at least [`LEAST_READINGS`] times as
//! many. The period is estimated over the latest 512 outputs by the gains of a line fit, 4/n for the time
//! and 6/n² for the period.

use orientation::units::Instant;

/// Least number of readings for each output: none is left out then, even where a reading is late by some of a
/// period, and the oscillator quicker than it should be.
pub const LEAST_READINGS: f64 = 1.5;

/// Number of outputs for which the nominal period counts: with it the gains begin.
const NOMINAL: f32 = 8.0;
/// Number of outputs over which the period is averaged: some seconds, in which an oscillator does not change.
const MEMORY: f32 = 512.0;
/// Greatest deviation of the period from the nominal one, relative: oscillators of coarse sensors are off by some
/// per cent.
const DEVIATION: f32 = 0.15;

/// When an output was read, and the time for which it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// Time of the output, with the mean delay of its readings.
    pub time: Instant,
    /// Period of the sensor, ns, over which the output is a mean.
    pub period: u32,
    /// Number of periods since the output that was read before, ≥ 1: more where outputs are missing.
    pub periods: u32,
}

/// The clock of a sensor's outputs.
#[derive(Clone, Copy, Debug)]
pub struct OutputClock {
    /// Nominal and estimated time between two outputs, µs.
    nominal: f32,
    period: f32,
    /// Number of outputs that the estimate averages.
    count: f32,
    /// Time of the latest output; none after a start of the sensor.
    latest: Option<Instant>,
    /// Time of the latest reading, whether there was a new output or not.
    looked: Instant,
}

impl OutputClock {
    /// Clock of a sensor with this nominal time between two outputs, µs, > 0.
    #[must_use]
    pub const fn new(nominal: f32) -> Self {
        Self { nominal, period: nominal, count: NOMINAL, latest: None, looked: Instant(0) }
    }

    /// Begins anew with the next output, as after a start of the sensor; the period is kept.
    pub const fn restart(&mut self) {
        self.latest = None;
    }

    /// Takes the time of a reading at which there was no new output.
    pub const fn look(&mut self, read: Instant) {
        self.looked = read;
    }

    /// Takes the time at which a new output was read.
    pub fn take(&mut self, read: Instant) -> Output {
        let looked = core::mem::replace(&mut self.looked, read);
        let Some(latest) = self.latest else { return self.output(read, 1) };
        let late = read.0.saturating_sub(latest.0) as f32 - self.period;
        // Between two readings that are less than a period apart there was this output alone.
        let is_alone = read.0.saturating_sub(looked.0) as f32 <= self.period;
        let missing = if is_alone { 0 } else { (late / self.period + 0.5) as u32 };
        let half = 0.5 * self.period;
        let off = (late - missing as f32 * self.period).max(-half).min(half);
        let gain = 4.0 / self.count;
        let limits = [(1.0 - DEVIATION) * self.nominal, (1.0 + DEVIATION) * self.nominal];
        self.period =
            (self.period + 6.0 / (self.count * self.count) * off).max(limits[0]).min(limits[1]);
        self.count = (self.count + 1.0).min(MEMORY);
        let time = read.0.saturating_add_signed(-((1.0 - gain) * off) as i64);
        self.output(Instant(time), missing.saturating_add(1))
    }

    /// An output at this time, so many periods after the one before.
    fn output(&mut self, time: Instant, periods: u32) -> Output {
        self.latest = Some(time);
        Output { time, period: (1e3 * self.period) as u32, periods }
    }
}

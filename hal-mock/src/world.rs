//! A whole recording of kind `stage`, sample by sample: instruments, stops, disturbances, one seed.

use crate::disturbance::{self, Disturbance};
use crate::instruments::{Instruments, InstrumentsConfiguration, Sample, Truth};
use crate::stage::{Stage, Stop};

/// A run: the instruments, where the stage goes, what disturbs it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldConfiguration<'a> {
    /// Site, attitude, sensors.
    pub instruments: InstrumentsConfiguration,
    /// Positions of the stage, in order; the run ends with the last dwell.
    pub stops: &'a [Stop],
    /// Events, in any order.
    pub disturbances: &'a [Disturbance],
}

/// A world at work: an iterator of samples that starts at t = 0 and ends after the last dwell. Sample k is
/// taken at k/`rate_hz`; the same configuration and seed give the same samples, bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub struct World<'a> {
    /// The stage on its way.
    stage: Stage<'a>,
    /// What disturbs the sensors, in any order.
    disturbances: &'a [Disturbance],
    /// What is mounted on the stage.
    instruments: Instruments,
    /// Number of the next sample.
    next: u64,
}

impl<'a> World<'a> {
    /// The world of a configuration; the seed fixes everything random in it.
    #[must_use]
    pub fn new(configuration: WorldConfiguration<'a>, seed: u64) -> Self {
        Self {
            stage: Stage::new(configuration.stops, configuration.instruments.rate_hz),
            disturbances: configuration.disturbances,
            instruments: Instruments::new(&configuration.instruments, seed),
            next: 0,
        }
    }

    /// The truth behind the latest sample.
    pub fn truth(&self) -> Truth {
        self.instruments.truth()
    }
}

impl Iterator for World<'_> {
    type Item = Sample;

    #[inline]
    fn next(&mut self) -> Option<Sample> {
        let stage = self.stage.state(self.next)?;
        let time_s = self.next as f64 / self.stage.rate_hz;
        self.next += 1;
        self.instruments.turn(stage);
        let effect = disturbance::total(self.disturbances, time_s);
        Some(self.instruments.sample(time_s, &effect))
    }
}

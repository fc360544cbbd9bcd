//! Three gyros and two accelerometers fixed to the body.

use super::SpinConfiguration;
use super::body::Felt;
use crate::accelerometer::Accelerometer;
use crate::gyro::Gyro;
use crate::noise::{Generator, source};
use crate::vehicle::SensorFault;

/// Temperature of all of it, °C: that at which a gyro's bias is stated.
const TEMPERATURE_C: f64 = 25.0;

/// A seed for each of the three gyros, so that none shares a stream with another.
pub(super) fn gyro_seeds(seed: u64) -> [u64; 3] {
    source::SPIN_GYROS.map(|index| Generator::stream(seed, index).next_u64())
}

/// The sensors at work.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sensors<'a> {
    gyros: [Gyro; 3],
    accelerometer: Accelerometer,
    rate_limits_rad_s: [f64; 3],
    force_limit_m_s2: f64,
    faults: &'a [SensorFault],
    last: Felt,
}

impl<'a> Sensors<'a> {
    pub(super) fn new(configuration: &SpinConfiguration<'a>, seed: u64) -> Self {
        let (c, seeds) = (configuration, gyro_seeds(seed));
        Self {
            gyros: [0, 1, 2].map(|axis: usize| Gyro::new(&c.gyros[axis], c.rate_hz, seeds[axis])),
            accelerometer: Accelerometer::new(&c.accelerometer, c.rate_hz, seed),
            rate_limits_rad_s: c.gyro_full_scale_rad_s,
            force_limit_m_s2: c.accelerometer_full_scale_m_s2,
            faults: c.faults,
            last: Felt::default(),
        }
    }

    /// What a gyro shows next, rad/s, of a rate about its axis. Call at its rate.
    pub(super) fn rate(&mut self, axis: usize, time_s: f64, rate_rad_s: f64) -> f64 {
        let gyro = &mut self.gyros[axis];
        let steady_rad_s = gyro.steady(rate_rad_s, [0.0; 2]);
        let value = gyro.sample(steady_rad_s, time_s, TEMPERATURE_C);
        let (last, full) = (self.last.rate_rad_s[axis], self.rate_limits_rad_s[axis]);
        let shown = SensorFault::spoilt(self.faults, axis, time_s, [value, last], full);
        self.last.rate_rad_s[axis] = shown;
        shown
    }

    /// What both accelerometers show next, m/s². Call at their rate.
    pub(super) fn force(&mut self, time_s: f64, force_m_s2: [f64; 2]) -> [f64; 2] {
        let [_, y, z] = self.accelerometer.sample([0.0, force_m_s2[0], force_m_s2[1]]);
        let (last, full) = (self.last.force_m_s2, self.force_limit_m_s2);
        let shown = |axis: usize, value| {
            SensorFault::spoilt(self.faults, 3 + axis, time_s, [value, last[axis]], full)
        };
        self.last.force_m_s2 = [shown(0, y), shown(1, z)];
        self.last.force_m_s2
    }

    /// What all of them show next.
    pub(super) fn sample(&mut self, time_s: f64, felt: &Felt) -> Felt {
        let rate_rad_s = [0, 1, 2].map(|axis| self.rate(axis, time_s, felt.rate_rad_s[axis]));
        Felt { rate_rad_s, force_m_s2: self.force(time_s, felt.force_m_s2) }
    }

    /// Scale factor errors of the gyros, 1.
    pub(super) fn scale_errors(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis: usize| self.gyros[axis].scale_error())
    }
}

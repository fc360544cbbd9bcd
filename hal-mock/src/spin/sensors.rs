//! Three gyros and two accelerometers fixed to the body.

use super::SpinConfiguration;
use super::body::Felt;
use crate::accelerometer::Accelerometer;
use crate::noise::source;
use crate::strapdown::{Strapdown, gyro_seeds, gyros};

/// Temperature of all of it, °C: that at which a gyro's bias is stated.
const TEMPERATURE_C: f64 = 25.0;

/// The sensors at work.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sensors<'a>(pub(super) Strapdown<'a, 2>);

impl<'a> Sensors<'a> {
    /// The sensors of a body at the start of its flight.
    pub(super) fn new(configuration: &SpinConfiguration<'a>, seed: u64) -> Self {
        let c = configuration;
        Self(Strapdown {
            gyros: gyros(&c.gyros, c.rate_hz, gyro_seeds(seed, source::SPIN_GYROS)),
            accelerometer: Accelerometer::new(&c.accelerometer, c.rate_hz, seed),
            rate_limits_rad_s: c.gyro_full_scale_rad_s,
            faults: c.faults,
            rates_rad_s: [0.0; 3],
            forces_m_s2: [0.0; 2],
        })
    }

    /// What a gyro shows next, rad/s, of a rate about its axis. Call at its rate.
    pub(super) fn rate(&mut self, axis: usize, time_s: f64, rate_rad_s: f64) -> f64 {
        self.0.rate(axis, time_s, rate_rad_s, [0.0; 2], TEMPERATURE_C)
    }

    /// What both accelerometers show next, m/s². Call at their rate.
    pub(super) fn force(&mut self, time_s: f64, [y, z]: [f64; 2]) -> [f64; 2] {
        self.0.force(time_s, [0.0, y, z])
    }

    /// What all of them show next.
    pub(super) fn sample(&mut self, time_s: f64, felt: &Felt) -> Felt {
        let rate_rad_s = [0, 1, 2].map(|axis| self.rate(axis, time_s, felt.rate_rad_s[axis]));
        Felt { rate_rad_s, force_m_s2: self.force(time_s, felt.force_m_s2) }
    }
}

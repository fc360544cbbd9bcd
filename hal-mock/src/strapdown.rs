//! Three gyros and up to three accelerometers fixed to a body, with their full scales and faults.
//!
//! A true rate or force goes through the error model of its sensor, then through the faults, and clips
//! last: a fault may show what no sensor would, but never more than the full scale.

use crate::accelerometer::Accelerometer;
use crate::gyro::{Gyro, GyroConfiguration};
use crate::noise::Generator;
use crate::sensor_fault::SensorFault;

/// A seed for each of three gyros, from as many streams of a seed: none shares a stream with another.
pub(crate) fn gyro_seeds(seed: u64, streams: [u64; 3]) -> [u64; 3] {
    streams.map(|index| Generator::stream(seed, index).next_u64())
}

/// Three gyros read `rate_hz` times a second (> 0), each with a seed of its own.
pub(crate) fn gyros(of: &[GyroConfiguration; 3], rate_hz: f64, seeds: [u64; 3]) -> [Gyro; 3] {
    [0, 1, 2].map(|axis: usize| Gyro::new(&of[axis], rate_hz, seeds[axis]))
}

/// The sensors at work, of which the last `N` axes of the accelerometer are looked at. Each keeps what it
/// showed last, for a fault that repeats it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Strapdown<'a, const N: usize> {
    /// The gyros.
    pub(crate) gyros: [Gyro; 3],
    /// The accelerometers.
    pub(crate) accelerometer: Accelerometer,
    /// Rates at which the gyros clip, rad/s, > 0.
    pub(crate) rate_limits_rad_s: [f64; 3],
    /// What goes wrong, in any order; channels 0 to 2 are the gyros, those from 3 on the accelerometers.
    pub(crate) faults: &'a [SensorFault],
    /// What was shown last: rates, rad/s, and forces, m/s².
    pub(crate) rates_rad_s: [f64; 3],
    /// Forces that were shown last, m/s².
    pub(crate) forces_m_s2: [f64; N],
}

impl<const N: usize> Strapdown<'_, N> {
    /// What a gyro shows next, rad/s, of a rate about its axis in rad/s and a specific force along it and
    /// along the next axis in g. Call at its rate.
    pub(crate) fn rate(
        &mut self,
        axis: usize,
        time_s: f64,
        rate_rad_s: f64,
        force_g: [f64; 2],
        temperature_c: f64,
    ) -> f64 {
        let gyro = &mut self.gyros[axis];
        let steady_rad_s = gyro.steady(rate_rad_s, force_g);
        let value = gyro.sample(steady_rad_s, time_s, temperature_c);
        let (last, full) = (self.rates_rad_s[axis], self.rate_limits_rad_s[axis]);
        let shown = SensorFault::spoilt(self.faults, axis, time_s, [value, last], full);
        self.rates_rad_s[axis] = shown;
        shown
    }

    /// What the accelerometers show next, m/s², of a specific force in m/s². Call at their rate.
    pub(crate) fn force(&mut self, time_s: f64, force_m_s2: [f64; 3]) -> [f64; N] {
        let values = self.accelerometer.sample(force_m_s2);
        let (last, full) = (self.forces_m_s2, self.accelerometer.full_scale_m_s2);
        self.forces_m_s2 = core::array::from_fn(|index| {
            let value = [values[3 - N + index], last[index]];
            SensorFault::spoilt(self.faults, 3 + index, time_s, value, full)
        });
        self.forces_m_s2
    }

    /// Whether one of the latest outputs is at its full scale.
    pub(crate) fn is_clipped(&self) -> bool {
        let mut rates = self.rates_rad_s.iter().zip(self.rate_limits_rad_s);
        let full_m_s2 = self.accelerometer.full_scale_m_s2;
        rates.any(|(rate, limit)| rate.abs() >= limit)
            || self.forces_m_s2.iter().any(|force| force.abs() >= full_m_s2)
    }
}

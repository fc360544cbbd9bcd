//! Three gyros and three accelerometers fixed to the vehicle.

use super::{SensorFault, VehicleConfiguration};
use crate::accelerometer::Accelerometer;
use crate::earth::normal_gravity_m_s2;
use crate::gyro::Gyro;
use crate::noise::{Generator, source};
use crate::temperature::TemperatureConfiguration;

/// Means of the true rate, rad/s, and specific force, m/s², over a sample; what sensors show of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    /// About forward, right, down.
    pub rate_rad_s: [f64; 3],
    /// Along them.
    pub force_m_s2: [f64; 3],
}

/// A seed for each of the three gyros, so that none shares a stream with another.
pub(super) fn gyro_seeds(seed: u64) -> [u64; 3] {
    source::VEHICLE_GYROS.map(|index| Generator::stream(seed, index).next_u64())
}

/// The sensors at work.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sensors<'a> {
    gyros: [Gyro; 3],
    accelerometer: Accelerometer,
    temperature: TemperatureConfiguration,
    /// Gravity at the start, the g of the g-sensitivity.
    gravity_m_s2: f64,
    rate_limit_rad_s: f64,
    force_limit_m_s2: f64,
    faults: &'a [SensorFault],
    last: Means,
}

impl<'a> Sensors<'a> {
    /// Sensors of a vehicle whose accelerometers are read `accelerometer_hz` times a second (> 0).
    pub(super) fn new(
        configuration: &VehicleConfiguration<'a>,
        accelerometer_hz: f64,
        seed: u64,
    ) -> Self {
        let (c, seeds) = (configuration, gyro_seeds(seed));
        Self {
            gyros: [0, 1, 2].map(|axis: usize| Gyro::new(&c.gyros[axis], c.rate_hz, seeds[axis])),
            accelerometer: Accelerometer::new(&c.accelerometer, accelerometer_hz, seed),
            temperature: c.temperature,
            gravity_m_s2: normal_gravity_m_s2(c.latitude_deg.to_radians()),
            rate_limit_rad_s: c.gyro_full_scale_rad_s,
            force_limit_m_s2: c.accelerometer_full_scale_m_s2,
            faults: c.faults,
            last: Means::default(),
        }
    }

    /// What a gyro shows next, rad/s, at the end of its sample. Call at its rate.
    pub(super) fn rate(&mut self, axis: usize, time_s: f64, felt: &Means) -> f64 {
        let temperature_c = self.temperature.at(time_s);
        let force_g =
            [axis, (axis + 1) % 3].map(|along| felt.force_m_s2[along] / self.gravity_m_s2);
        let gyro = &mut self.gyros[axis];
        let steady_rad_s = gyro.steady(felt.rate_rad_s[axis], force_g);
        let value = gyro.sample(steady_rad_s, time_s, temperature_c);
        let last = self.last.rate_rad_s[axis];
        let shown =
            SensorFault::spoilt(self.faults, axis, time_s, [value, last], self.rate_limit_rad_s);
        self.last.rate_rad_s[axis] = shown;
        shown
    }

    /// What the accelerometers show next, m/s². Call at their rate.
    pub(super) fn force(&mut self, time_s: f64, felt: &Means) -> [f64; 3] {
        let (values, last) = (self.accelerometer.sample(felt.force_m_s2), self.last.force_m_s2);
        let limit = self.force_limit_m_s2;
        self.last.force_m_s2 = [0, 1, 2].map(|i: usize| {
            SensorFault::spoilt(self.faults, 3 + i, time_s, [values[i], last[i]], limit)
        });
        self.last.force_m_s2
    }

    /// What all of them show next, and whether anything clips.
    pub(super) fn sample(&mut self, time_s: f64, felt: &Means) -> (Means, bool) {
        let rate_rad_s = [0, 1, 2].map(|axis| self.rate(axis, time_s, felt));
        let force_m_s2 = self.force(time_s, felt);
        let is_clipped = rate_rad_s.iter().any(|rate| rate.abs() >= self.rate_limit_rad_s)
            || force_m_s2.iter().any(|force| force.abs() >= self.force_limit_m_s2);
        (Means { rate_rad_s, force_m_s2 }, is_clipped)
    }

    /// Turn-on biases, rad/s and m/s².
    pub(super) fn biases(&self) -> Means {
        Means {
            rate_rad_s: [0, 1, 2].map(|axis: usize| self.gyros[axis].bias_rad_s()),
            force_m_s2: self.accelerometer.bias_m_s2(),
        }
    }

    /// Scale factor errors of the gyros, 1.
    pub(super) fn scale_errors(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis: usize| self.gyros[axis].scale_error())
    }
}

//! Three gyros and three accelerometers fixed to the vehicle.

use super::{VehicleConfiguration, VehicleTruth};
use crate::accelerometer::Accelerometer;
use crate::earth::{InertialInput, normal_gravity_m_s2};
use crate::noise::source;
use crate::strapdown::{Strapdown, gyro_seeds, gyros};
use crate::temperature::TemperatureConfiguration;
use crate::vehicle::motion::Motion;

/// The sensors at work.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sensors<'a> {
    /// The gyros and accelerometers, with full scales and faults.
    pub(super) strapdown: Strapdown<'a, 3>,
    /// The warm-up.
    temperature: TemperatureConfiguration,
    /// Gravity at the start, the g of the g-sensitivity.
    gravity_m_s2: f64,
}

impl<'a> Sensors<'a> {
    /// Sensors of a vehicle whose accelerometers are read `accelerometer_hz` times a second (> 0).
    pub(super) fn new(
        configuration: &VehicleConfiguration<'a>,
        accelerometer_hz: f64,
        seed: u64,
    ) -> Self {
        let c = configuration;
        let strapdown = Strapdown {
            gyros: gyros(&c.gyros, c.rate_hz, gyro_seeds(seed, source::VEHICLE_GYROS)),
            accelerometer: Accelerometer::new(&c.accelerometer, accelerometer_hz, seed),
            rate_limits_rad_s: [c.gyro_full_scale_rad_s; 3],
            faults: c.faults,
            rates_rad_s: [0.0; 3],
            forces_m_s2: [0.0; 3],
        };
        Self {
            strapdown,
            temperature: c.temperature,
            gravity_m_s2: normal_gravity_m_s2(c.latitude_deg.to_radians()),
        }
    }

    /// What a gyro shows next, rad/s, at the end of its sample. Call at its rate.
    pub(super) fn rate(&mut self, axis: usize, time_s: f64, felt: &InertialInput) -> f64 {
        let temperature_c = self.temperature.at(time_s);
        let force_g =
            [axis, (axis + 1) % 3].map(|along| felt.force_m_s2[along] / self.gravity_m_s2);
        self.strapdown.rate(axis, time_s, felt.rate_rad_s[axis], force_g, temperature_c)
    }

    /// What the accelerometers show next, m/s². Call at their rate.
    pub(super) fn force(&mut self, time_s: f64, felt: &InertialInput) -> [f64; 3] {
        self.strapdown.force(time_s, felt.force_m_s2)
    }

    /// What all of them show next, and whether anything clips.
    pub(super) fn sample(&mut self, time_s: f64, felt: &InertialInput) -> (InertialInput, bool) {
        let rate_rad_s = [0, 1, 2].map(|axis| self.rate(axis, time_s, felt));
        let force_m_s2 = self.force(time_s, felt);
        (InertialInput { rate_rad_s, force_m_s2 }, self.strapdown.is_clipped())
    }

    /// The truth behind them on a motion of this moment.
    pub(super) fn truth(&self, motion: &Motion) -> VehicleTruth {
        let gyros = self.strapdown.gyros.each_ref();
        VehicleTruth {
            attitude: motion.attitude(),
            position: motion.position,
            displacement_m: motion.displacement_m(),
            velocity_m_s: motion.velocity_m_s(),
            gyro_bias_rad_s: gyros.map(|gyro| gyro.bias_rad_s),
            gyro_scale_error: gyros.map(|gyro| gyro.scale_error),
            accelerometer_bias_m_s2: self.strapdown.accelerometer.bias_m_s2,
        }
    }
}

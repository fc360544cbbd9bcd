//! Three gyros and three accelerometers fixed to the vehicle.

use super::{SensorFault, VehicleConfiguration};
use crate::accelerometer::Accelerometer;
use crate::gyro::Gyro;
use crate::noise::{Generator, source};
use crate::temperature::TemperatureConfiguration;

/// The gyros of a vehicle, forward, right, down, read `rate_hz` times a second; each draws from streams
/// of its own.
pub(super) fn gyros(configuration: &VehicleConfiguration, rate_hz: f64, seed: u64) -> [Gyro; 3] {
    let own = source::VEHICLE_GYROS.map(|index| Generator::stream(seed, index).next_u64());
    [0, 1, 2].map(|axis| Gyro::new(&configuration.gyros[axis], rate_hz, own[axis]))
}

/// Means of the true rate, rad/s, and specific force, m/s², over a sample; what sensors show of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Means {
    pub(super) rate_rad_s: [f64; 3],
    pub(super) force_m_s2: [f64; 3],
}

/// The sensors at work, read in step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sensors<'a> {
    gyros: [Gyro; 3],
    accelerometer: Accelerometer,
    temperature: TemperatureConfiguration,
    gravity_m_s2: f64,
    rate_limit_rad_s: f64,
    force_limit_m_s2: f64,
    faults: &'a [SensorFault],
    last: Means,
}

impl<'a> Sensors<'a> {
    pub(super) fn new(configuration: &VehicleConfiguration<'a>, seed: u64) -> Self {
        let c = configuration;
        Self {
            gyros: gyros(c, c.rate_hz, seed),
            accelerometer: Accelerometer::new(&c.accelerometer, c.rate_hz, seed),
            temperature: c.temperature,
            gravity_m_s2: c.gravity_m_s2(),
            rate_limit_rad_s: c.gyro_full_scale_rad_s,
            force_limit_m_s2: c.accelerometer_full_scale_m_s2,
            faults: c.faults,
            last: Means::default(),
        }
    }

    /// What they show next, at the end of a sample, and whether anything clips.
    pub(super) fn sample(&mut self, time_s: f64, felt: &Means) -> (Means, bool) {
        let along = felt.force_m_s2.map(|force| force / self.gravity_m_s2);
        let temperature_c = self.temperature.at(time_s);
        let mut shown = Means { force_m_s2: self.accelerometer.sample(felt.force_m_s2), ..*felt };
        for (axis, gyro) in self.gyros.iter_mut().enumerate() {
            let force_g = [along[axis], along[(axis + 1) % 3]];
            let steady_rad_s = gyro.steady(felt.rate_rad_s[axis], force_g);
            shown.rate_rad_s[axis] = gyro.sample(steady_rad_s, time_s, temperature_c);
        }
        let is_clipped = self.spoil(&mut shown, time_s);
        self.last = shown;
        (shown, is_clipped)
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

    /// Puts faults and full scales on it; whether anything clips.
    fn spoil(&self, shown: &mut Means, time_s: f64) -> bool {
        let rates = shown.rate_rad_s.iter_mut().zip(self.last.rate_rad_s);
        let forces = shown.force_m_s2.iter_mut().zip(self.last.force_m_s2);
        let limits = [[self.rate_limit_rad_s; 3], [self.force_limit_m_s2; 3]];
        let mut is_clipped = false;
        for ((channel, (value, last)), full) in
            rates.chain(forces).enumerate().zip(limits.into_iter().flatten())
        {
            for fault in self.faults {
                *value = fault.shown(time_s, channel, *value, last, full);
            }
            is_clipped |= value.abs() >= full;
            *value = value.max(-full).min(full);
        }
        is_clipped
    }
}

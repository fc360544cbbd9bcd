//! The configuration of the sensors on a spinning body.

use drivers::ads1262::configuration::Gain;
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use orientation::units::AngleIncrement;

use crate::ports::{Code, Quantity, clipped};

/// Number of converters, for three gyros and two accelerometers.
pub const CHANNELS: usize = 5;
/// Number of converters that belong to gyros.
pub const GYROS: usize = 3;
/// Step of a [`orientation::units::SpinForce`], m/s².
const FORCE_STEP: f64 = 1e-5;

/// A sensor behind its converter: scale factor and range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Conversion of a code to steps of the sensor's quantity.
    pub scale: Scale,
    /// Magnitude of a code beyond which the sensor's own output may saturate, while the converter
    /// does not.
    pub limit: u32,
}

impl Channel {
    /// A gyro with a scale factor, V per rad/s (negative if its axis is reversed), that may
    /// saturate beyond `limit_rad_s`, rad/s, sampled at `sample_rate`, Hz. [`None`] if the scale
    /// factor cannot be represented.
    #[must_use]
    pub fn gyro(volts_per_rad_s: f64, limit_rad_s: f64, sample_rate: f64) -> Option<Self> {
        let volts_per_step = volts_per_rad_s * AngleIncrement::STEP * sample_rate;
        Self::new(volts_per_step, volts_per_rad_s * limit_rad_s)
    }

    /// An accelerometer with a scale factor, V per m/s², that may saturate beyond `limit_m_s2`,
    /// m/s². [`None`] if the scale factor cannot be represented.
    #[must_use]
    pub fn accelerometer(volts_per_m_s2: f64, limit_m_s2: f64) -> Option<Self> {
        Self::new(volts_per_m_s2 * FORCE_STEP, volts_per_m_s2 * limit_m_s2)
    }

    /// A sensor by the voltage of one step and the voltage at which it may saturate, with the
    /// converter's internal reference and unity gain.
    fn new(volts_per_step: f64, limit_volts: f64) -> Option<Self> {
        let scale = Scale::of_steps(volts_per_step, INTERNAL_REFERENCE_VOLTS, Gain::X1)?;
        let limit = limit_volts.abs() / INTERNAL_REFERENCE_VOLTS * f64::from(i32::MAX);
        Some(Self { scale, limit: limit as u32 })
    }

    /// Converts a code to steps of the sensor's quantity; at a limit of the number range if sensor
    /// or converter is saturated.
    #[must_use]
    pub fn steps(&self, code: Code) -> i32 {
        let steps = self.scale.steps(code.0);
        clipped(steps, code.is_saturated() || code.0.unsigned_abs() >= self.limit)
    }
}

/// The sensors of a spinning body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinConfiguration {
    /// Sampling rate of each converter, Hz.
    pub sample_rate: f64,
    /// The gyros about x, y and z.
    pub gyros: [Channel; GYROS],
    /// The accelerometers along y and z.
    pub accelerometers: [Channel; 2],
}

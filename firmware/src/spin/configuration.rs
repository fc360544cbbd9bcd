//! What the instrument must know of the board on a spinning body.

use drivers::ads1262::configuration::Gain;
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use orientation::units::AngleIncrement;

use crate::ports::{Code, Quantity};

/// Converters: of three gyros and two accelerometers.
pub const CHANNELS: usize = 5;
/// How many of them belong to gyros.
pub const GYROS: usize = 3;
/// One step of a [`orientation::units::SpinForce`], m/s².
const FORCE_STEP: f64 = 1e-5;

/// A sensor behind its converter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Steps of a code.
    pub scale: Scale,
    /// Size of a code beyond which the sensor's own output may clip, while its converter does not.
    pub limit: u32,
}

impl Channel {
    /// A gyro of so many V per rad/s (negative where it turns the other way) that may clip beyond a rate,
    /// rad/s, converted so many times a second; none where there is no such scale.
    #[must_use]
    pub fn gyro(volts_per_rad_s: f64, limit_rad_s: f64, sample_rate: f64) -> Option<Self> {
        let volts_per_step = volts_per_rad_s * AngleIncrement::STEP * sample_rate;
        Self::new(volts_per_step, volts_per_rad_s * limit_rad_s)
    }

    /// An accelerometer of so many V per m/s² that may clip beyond a force, m/s²; none where there is no
    /// such scale.
    #[must_use]
    pub fn accelerometer(volts_per_m_s2: f64, limit_m_s2: f64) -> Option<Self> {
        Self::new(volts_per_m_s2 * FORCE_STEP, volts_per_m_s2 * limit_m_s2)
    }

    fn new(volts_per_step: f64, limit_volts: f64) -> Option<Self> {
        let scale = Scale::of_steps(volts_per_step, INTERNAL_REFERENCE_VOLTS, Gain::X1)?;
        let limit = limit_volts.abs() / INTERNAL_REFERENCE_VOLTS * f64::from(i32::MAX);
        Some(Self { scale, limit: limit as u32 })
    }

    /// A code in the sensor's steps; at a limit where sensor or converter clip.
    #[must_use]
    pub fn steps(&self, code: Code) -> i32 {
        let steps = self.scale.steps(code.0);
        let is_clipped = code.is_saturated() || code.0.unsigned_abs() >= self.limit;
        match (is_clipped, steps < 0) {
            (false, _) => steps,
            (true, false) => i32::MAX,
            (true, true) => i32::MIN,
        }
    }
}

/// The sensors of a spinning body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinConfiguration {
    /// Samples of each converter a second, Hz.
    pub sample_rate: f64,
    /// The gyros about x, y and z.
    pub gyros: [Channel; GYROS],
    /// The accelerometers along y and z.
    pub accelerometers: [Channel; 2],
}

impl SpinConfiguration {
    /// The sample period, µs, to nearest.
    #[must_use]
    pub fn period(&self) -> u32 {
        libm::round(1e6 / self.sample_rate) as u32
    }

    /// From the middle of a conversion to its end, µs, to nearest.
    #[must_use]
    pub fn half_period(&self) -> u32 {
        libm::round(0.5e6 / self.sample_rate) as u32
    }
}

//! What the instrument must know of its board before it begins.

use embassy_time::Duration;
use orientation::units::DEGREE;

use crate::calibration::Harmonics;

/// The stage's mechanics and how patiently it is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageConfiguration {
    /// Stage angle at which the index switch closes, rad; it stays closed below.
    pub index: f64,
    /// How far from there the encoder may stand after the stage has stopped, rad: what a wrong zero of
    /// the encoder may cost in azimuth.
    pub index_tolerance: f64,
    /// Where the stage waits for the session, rad: the first position, so that no time is lost.
    pub home: f64,
    /// Travel from lowest to highest angle, rad.
    pub travel: [f64; 2],
    /// Rate of the search for the index, rad/s.
    pub seek_rate: f64,
    /// Distance from the target that needs no correction, rad; less than the session's `arrival`.
    pub tolerance: f64,
    /// What motor and encoder may differ by, rad: backlash, the encoder's error, a step of either.
    /// Less than the azimuth's σ lets pass, more than the backlash.
    pub agreement: f64,
    /// Rest after the motor has stopped, before the encoder is believed.
    pub settle: Duration,
    /// Longest time for any single movement.
    pub longest: Duration,
}

impl Default for StageConfiguration {
    /// Index at −5°, home at 0°, travel −10°…370° (cables wrap), search at 12°/s, within 0.03° of the
    /// target, motor and encoder within 0.05°, a quarter of a second of rest, 60 s for any movement.
    fn default() -> Self {
        Self {
            index: -5.0 * DEGREE,
            index_tolerance: 0.05 * DEGREE,
            home: 0.0,
            travel: [-10.0 * DEGREE, 370.0 * DEGREE],
            seek_rate: 12.0 * DEGREE,
            tolerance: 0.03 * DEGREE,
            agreement: 0.05 * DEGREE,
            settle: Duration::from_millis(250),
            longest: Duration::from_secs(60),
        }
    }
}

/// The instrument's configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Samples of the precise gyro a second, Hz.
    pub sample_rate: f64,
    /// The accelerometer is read with every so-manieth sample, ≥ 1.
    pub force_divider: u32,
    /// The encoder is read with every so-manieth sample, ≥ 1.
    pub angle_divider: u32,
    /// What the encoder shows beyond the true angle.
    pub encoder: Harmonics,
    /// The stage.
    pub stage: StageConfiguration,
}

/// Rate at which the accelerometer is read, Hz; its mean is all that an alignment needs.
const FORCE_RATE: f64 = 100.0;
/// Rate at which the encoder is read, Hz: the stage turns 0.1° between two readings.
const ANGLE_RATE: f64 = 200.0;

impl Configuration {
    /// The default board with a gyro of so many samples a second.
    #[must_use]
    pub fn at(sample_rate: f64) -> Self {
        let divider = |rate: f64| (libm::round(sample_rate / rate) as u32).max(1);
        Self {
            sample_rate,
            force_divider: divider(FORCE_RATE),
            angle_divider: divider(ANGLE_RATE),
            encoder: Harmonics::default(),
            stage: StageConfiguration::default(),
        }
    }

    /// The sample period, µs, to nearest.
    #[must_use]
    pub fn period(&self) -> u32 {
        libm::round(1e6 / self.sample_rate) as u32
    }
}

//! Temperature of the instrument: a warm-up and a thermometer's noise.

use crate::noise::{White, source};

/// A warm-up T(t) = start + rise·(1 − exp(−t/τ)); the default stands at 25 °C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemperatureConfiguration {
    /// Temperature at the first sample, °C.
    pub start_c: f64,
    /// How far it rises in the end, °C; negative cools.
    pub rise_c: f64,
    /// Time constant, s, > 0 where it rises.
    pub time_constant_s: f64,
    /// White noise of the thermometer per sample, °C; the gyro feels the true temperature.
    pub noise_c: f64,
}

impl Default for TemperatureConfiguration {
    fn default() -> Self {
        Self { start_c: 25.0, rise_c: 0.0, time_constant_s: 600.0, noise_c: 0.0 }
    }
}

impl TemperatureConfiguration {
    /// True temperature, °C, `elapsed_s` after the first sample.
    #[inline]
    #[must_use]
    pub fn at(&self, elapsed_s: f64) -> f64 {
        if self.rise_c == 0.0 {
            return self.start_c;
        }
        self.start_c - self.rise_c * libm::expm1(-elapsed_s / self.time_constant_s)
    }
}

/// A thermometer: the state of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Thermometer {
    /// The true temperature over the time.
    pub(crate) temperature: TemperatureConfiguration,
    /// White noise of a reading, °C.
    white: White,
}

impl Thermometer {
    /// A thermometer with the noise of a configuration; the seed fixes its readings.
    pub(crate) fn new(configuration: &TemperatureConfiguration, seed: u64) -> Self {
        let white = White::new(configuration.noise_c, seed, source::THERMOMETER);
        Self { temperature: *configuration, white }
    }

    /// The next reading, °C, `elapsed_s` seconds after switching on.
    #[inline]
    pub fn sample(&mut self, elapsed_s: f64) -> f64 {
        self.temperature.at(elapsed_s) + self.white.sample()
    }
}

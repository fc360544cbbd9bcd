//! The error budget: where the standard deviation of an azimuth comes from.

use crate::error::Source;

/// The 1σ parts of the azimuth's standard deviation, rad; their root sum of squares is σ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// White noise of the gyro.
    pub noise: f64,
    /// Bias instability, random walk and ramp of the gyro, and what estimating a trend costs; what a base that
    /// turns or tilts, or may, does.
    pub drift: f64,
    /// Unknown part of the g-sensitivity, times the tilt.
    pub g_sensitivity: f64,
    /// Tilt error: the accelerometer's noise and bias.
    pub accelerometer: f64,
    /// Encoder zero and harmonics.
    pub encoder: f64,
    /// Latitude.
    pub latitude: f64,
    /// Gyro scale factor.
    pub scale: f64,
    /// What estimating a temperature slope costs.
    pub temperature: f64,
    /// Where a vehicle drove meanwhile.
    pub displacement: f64,
}

impl Budget {
    /// The parts with their names, in the order in which they are printed.
    #[must_use]
    pub fn parts(&self) -> [(Source, f64); 9] {
        [
            (Source::Noise, self.noise),
            (Source::Drift, self.drift),
            (Source::GSensitivity, self.g_sensitivity),
            (Source::Accelerometer, self.accelerometer),
            (Source::Encoder, self.encoder),
            (Source::Latitude, self.latitude),
            (Source::Scale, self.scale),
            (Source::Temperature, self.temperature),
            (Source::Displacement, self.displacement),
        ]
    }

    /// Root sum of squares, rad.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        libm::sqrt(self.parts().iter().map(|(_, part)| part * part).sum())
    }

    /// Root sum of squares of all parts but noise, rad.
    #[must_use]
    pub fn beside_noise(&self) -> f64 {
        Self { noise: 0.0, ..*self }.sigma()
    }

    /// The part that contributes most.
    #[must_use]
    pub fn greatest(&self) -> (Source, f64) {
        let parts = self.parts();
        parts.into_iter().fold(parts[0], |most, part| if part.1 > most.1 { part } else { most })
    }

    /// The part that makes up more than half of the variance, if there is one beside noise.
    #[must_use]
    pub fn dominant(&self) -> Option<Source> {
        let (source, part) = self.greatest();
        let dominates = part * part > 0.5 * self.sigma() * self.sigma();
        (dominates && source != Source::Noise).then_some(source)
    }
}

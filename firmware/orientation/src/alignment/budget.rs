//! Error budget: the contributions to the standard deviation of an azimuth. Every result prints it,
//! because σ and the refusal of a poor azimuth both follow from it; an error source that is left
//! out would show up as a wrong north with a small σ.

use crate::units::Radians;

/// Source of the uncertainty of an azimuth: one line of the error budget; see [`Budget`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Source {
    /// White noise (angle random walk) of the gyro.
    Noise,
    /// Bias instability, rate random walk and ramp of the gyro.
    Drift,
    /// Sensitivity of the gyro to specific force (g-sensitivity), acting through the tilt.
    GSensitivity,
    /// Tilt as measured by the accelerometer: its noise and bias.
    Accelerometer,
    /// Errors of the stage encoder: zero, first and second harmonic.
    Encoder,
    /// Uncertainty of the latitude, which sets the horizontal Earth rate Ω cos φ.
    Latitude,
    /// Scale-factor error of the gyro.
    Scale,
    /// Temperature slope of the gyro's bias.
    Temperature,
    /// Uncertainty of the distance and direction that a vehicle drove between stops.
    Displacement,
    /// Scatter of what was fitted beyond noise and drift of the gyro, of both of which it is counted.
    Scatter,
}

crate::words! { Source:
    Self::Noise => "gyro noise";
    Self::Drift => "gyro drift";
    Self::GSensitivity => "g-sensitivity";
    Self::Accelerometer => "tilt from the accelerometer";
    Self::Encoder => "stage encoder";
    Self::Latitude => "latitude";
    Self::Scale => "gyro scale factor";
    Self::Temperature => "temperature slope";
    Self::Displacement => "displacement of the vehicle";
    Self::Scatter => "scatter beyond noise and drift";
}

/// Contributions to the azimuth's standard deviation, 1σ, rad; their root sum of squares is σ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// White noise of the gyro.
    pub noise: Radians,
    /// Bias instability, random walk and ramp of the gyro, the cost of estimating a trend, and slow
    /// rotation or tilting of the base.
    pub drift: Radians,
    /// Unknown part of the g-sensitivity times the tilt, over the horizontal Earth rate:
    /// `σ_κ`·|F|/`Ω_h`.
    pub g_sensitivity: Radians,
    /// Tilt error: the accelerometer's noise and bias.
    pub accelerometer: Radians,
    /// Zero, first and second harmonic of the encoder.
    pub encoder: Radians,
    /// Uncertainty of the latitude.
    pub latitude: Radians,
    /// Uncertainty of the gyro's scale factor.
    pub scale: Radians,
    /// Cost of estimating a temperature slope of the bias.
    pub temperature: Radians,
    /// Uncertainty of the distance that a vehicle drove between stops.
    pub displacement: Radians,
}

impl Budget {
    /// The parts with their names, in the order in which they are printed.
    pub fn parts(&self) -> [(Source, Radians); 9] {
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

    /// Standard deviation of the azimuth: root sum of squares of all contributions.
    pub fn sigma(&self) -> Radians {
        Radians(libm::sqrt(self.parts().iter().map(|(_, part)| part.0 * part.0).sum()))
    }

    /// Root sum of squares of all contributions except noise.
    pub(crate) fn beside_noise(&self) -> Radians {
        Self { noise: Radians(0.0), ..*self }.sigma()
    }

    /// The parts with noise and drift as they are stated, and last what scatters beyond them, of which a fit has raised
    /// both by this factor.
    pub fn parts_of(&self, excess: f64) -> [(Source, Radians); 10] {
        let stated = |part: Radians| Radians(part.0 / excess);
        let of_noise = self.noise.0 * self.noise.0 + self.drift.0 * self.drift.0;
        let scatter = Radians(libm::sqrt(of_noise * (1.0 - 1.0 / (excess * excess)).max(0.0)));
        let as_stated = Self { noise: stated(self.noise), drift: stated(self.drift), ..*self };
        let mut parts = [(Source::Scatter, scatter); 10];
        parts[..9].copy_from_slice(&as_stated.parts());
        parts
    }

    /// Source of the largest of these parts.
    pub(crate) fn greatest(&self, excess: f64) -> Source {
        Self::greatest_of(&self.parts_of(excess)).0
    }

    fn greatest_of(parts: &[(Source, Radians); 10]) -> (Source, Radians) {
        parts.iter().fold(parts[0], |most, part| if part.1 > most.1 { *part } else { most })
    }

    /// Source that makes up more than half of the variance; `None` where it is noise or there is no
    /// such source.
    #[must_use]
    pub fn dominant(&self, excess: f64) -> Option<Source> {
        let (source, part) = Self::greatest_of(&self.parts_of(excess));
        let dominates = part.0 * part.0 > 0.5 * self.sigma().0 * self.sigma().0;
        (dominates && source != Source::Noise).then_some(source)
    }
}

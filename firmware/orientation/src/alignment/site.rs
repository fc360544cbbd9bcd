//! Site of an alignment, gyro and requirements, and the checks that every method makes of them.

use super::budget::Source;
use super::refusal::{Passed, Refusal, refuse_if};
use super::setup::{GREATEST, SetupError, check_ranges};
use crate::earth::Latitude;
use crate::noise::{GyroNoise, StatedNoise};
use crate::units::{
    DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, Degrees, GSensitivity, MetresPerSecondSquared, Radians,
    RadiansPerRootSecond, TURN,
};

/// Site, instrument and requirements. A standard deviation of zero means exact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Site {
    /// Geodetic latitude.
    pub latitude: Latitude,
    /// Standard deviation of the latitude, 1σ.
    pub latitude_sigma: Radians,
    /// Noise of the gyro; where its white part is unknown, the data show it.
    pub noise: StatedNoise,
    /// Standard deviation of the gyro's scale factor, 1σ, relative.
    pub scale_sigma: f64,
    /// g-sensitivity κ along the sensitive axis and 90° clockwise of it, rad/s per g; on a
    /// two-frame mount along the inner frame's axis instead.
    pub g_sensitivity: [GSensitivity; 2],
    /// Standard deviation of either part of κ, 1σ, rad/s per g; on a two-frame mount also of the
    /// third part, which is taken as zero.
    pub g_sensitivity_sigma: GSensitivity,
    /// Whether κ and its σ are known; otherwise κ is taken as zero and its σ follows from the
    /// gyro's noise.
    pub g_sensitivity_known: bool,
    /// Standard deviation of each accelerometer bias, 1σ.
    pub accelerometer_bias_sigma: MetresPerSecondSquared,
    /// Standard deviation of the azimuth due to the encoder's zero and harmonics, 1σ; on a
    /// two-frame mount including the residual of its calibration ([`super::stepwise::mount::azimuth_sigma`]).
    pub encoder_sigma: Radians,
    /// Greatest standard deviation of the azimuth that is accepted.
    pub required_sigma: Radians,
    /// Greatest tilt of the platform that is accepted.
    pub allowed_tilt: Radians,
}

/// Relative uncertainty of the Earth rate below which it counts as exact: it has no effect on the
/// azimuth.
const EXACT_AMPLITUDE: f64 = 1e-9;

/// Standard deviation of an unknown g-sensitivity, rad/s per g for each (rad/√s)² of N²: 50 000
/// °/h/g for each (°/√h)², which is 0.05 °/h/g for a fibre-optic gyro of 0.001 °/√h and 20 °/h/g
/// for a micromachined one of 0.02 °/√h.
const KAPPA_OF_NOISE: f64 =
    50_000.0 * DEGREE_PER_HOUR / (DEGREE_PER_SQRT_HOUR * DEGREE_PER_SQRT_HOUR);
/// Upper limit of that standard deviation, rad/s per g: 100 °/h/g, half of the greatest value in
/// data sheets of micromachined gyros.
const GREATEST_KAPPA: f64 = 100.0 * DEGREE_PER_HOUR;

/// Additional tolerance of the Earth-rate ratio where the scale is configured as exact: scale
/// errors that no data sheet excludes and that do not change the azimuth.
const RATIO_TOLERANCE: f64 = 0.005;

impl Site {
    /// Ideal instrument at a latitude: nothing is uncertain, N is estimated, an azimuth of 10° (1σ)
    /// and a tilt of 15° are accepted.
    #[must_use]
    pub fn at(latitude: Latitude) -> Self {
        Self {
            latitude,
            latitude_sigma: Radians(0.0),
            noise: StatedNoise::ExceptWhite(GyroNoise::default()),
            scale_sigma: 0.0,
            g_sensitivity: [GSensitivity(0.0); 2],
            g_sensitivity_sigma: GSensitivity(0.0),
            g_sensitivity_known: true,
            accelerometer_bias_sigma: MetresPerSecondSquared(0.0),
            encoder_sigma: Radians(0.0),
            required_sigma: Radians(10.0 / 360.0 * TURN),
            allowed_tilt: Radians(15.0 / 360.0 * TURN),
        }
    }

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`].
    pub fn check(&self) -> Result<(), SetupError> {
        let [along, across] = self.g_sensitivity.map(|part| part.0);
        let (positive, either) = ([0.0, GREATEST], [-GREATEST, GREATEST]);
        let [q, n, b, k, r] = self.noise.model().coefficients();
        check_ranges(&[
            ("quantisation", q, positive),
            ("angle_random_walk", n, positive),
            ("bias_instability", b, positive),
            ("rate_random_walk", k, positive),
            ("rate_ramp", r, positive),
            ("latitude_sigma", self.latitude_sigma.0, [0.0, TURN]),
            ("scale_sigma", self.scale_sigma, positive),
            ("g_sensitivity", along, either),
            ("g_sensitivity", across, either),
            ("g_sensitivity_sigma", self.g_sensitivity_sigma.0, positive),
            ("accelerometer_bias_sigma", self.accelerometer_bias_sigma.0, positive),
            ("encoder_sigma", self.encoder_sigma.0, [0.0, TURN]),
            ("required_sigma", self.required_sigma.0, [0.0, GREATEST]),
            ("allowed_tilt", self.allowed_tilt.0, [0.0, TURN]),
        ])
    }

    /// Standard deviation of either part of κ, 1σ, for a gyro with this N.
    pub(crate) fn kappa_sigma(&self, angle_random_walk: RadiansPerRootSecond) -> GSensitivity {
        if self.g_sensitivity_known {
            self.g_sensitivity_sigma
        } else {
            let n = angle_random_walk.0;
            GSensitivity((KAPPA_OF_NOISE * n * n).min(GREATEST_KAPPA))
        }
    }

    /// Relative 1σ of the horizontal Earth rate as the gyro measures it: scale factor and latitude.
    pub(crate) fn amplitude_sigma(&self) -> f64 {
        let latitude = libm::tan(self.latitude.rad()) * self.latitude_sigma.0;
        let sigma = libm::hypot(self.scale_sigma, latitude);
        if sigma < EXACT_AMPLITUDE { 0.0 } else { sigma }
    }

    /// Tolerance of the Earth-rate ratio beyond multiples of its σ.
    pub(crate) fn ratio_tolerance(&self) -> f64 {
        if self.scale_sigma > 0.0 { 0.0 } else { RATIO_TOLERANCE }
    }

    /// Refuses a latitude at which too little of the Earth rate is horizontal.
    ///
    /// # Errors
    /// [`Refusal::LatitudeTooHigh`].
    pub(crate) fn check_latitude(&self) -> Passed {
        let latitude = Radians(self.latitude.rad()).into();
        refuse_if(!self.latitude.has_north(), Refusal::LatitudeTooHigh { latitude })
    }

    /// Refuses a tilt of the platform, given by its sine: the horizontal force over gravity.
    ///
    /// # Errors
    /// [`Refusal::TiltTooGreat`].
    pub(crate) fn check_tilt(&self, sine: f64) -> Passed {
        let (tilt, allowed) = (Radians(libm::asin(sine.min(1.0))), self.allowed_tilt);
        let is_great = tilt > allowed;
        let [tilt, allowed] = [tilt, allowed].map(Degrees::from);
        refuse_if(is_great, Refusal::TiltTooGreat { tilt, allowed })
    }

    /// Refuses a standard deviation of the azimuth that is zero, not a number, or greater
    /// than required; the source is that of its greatest part.
    ///
    /// # Errors
    /// [`Refusal::BudgetNotMet`].
    pub(crate) fn check_sigma(&self, sigma: Radians, source: Source) -> Passed {
        let is_met = sigma.0 > 0.0 && sigma <= self.required_sigma;
        let [sigma, required] = [sigma, self.required_sigma].map(Degrees::from);
        refuse_if(!is_met, Refusal::BudgetNotMet { sigma, required, source })
    }
}

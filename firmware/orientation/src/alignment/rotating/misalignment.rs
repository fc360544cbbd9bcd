//! Axis misalignment: the response of the gyro to the platform's own rate, measured by
//! rate-modulated turns.
//!
//! A sensitive axis that is raised by α over the platform's plane measures −sin α of the platform's
//! rate (MET 2018, section 4). Rotation is never perfectly uniform, and its unevenness is mostly
//! once per turn, where the Earth rate is looked for. A rate-modulated turn, with a strong
//! modulation away from that frequency, determines the sine and the lag of the gyro behind the
//! encoder: rate = s (θ̇ − τ θ̈), the first order of a lag.

use super::part::Modulated;
use crate::checksum::{numbers, record, record_bytes};
use crate::math::{Column, Complex};
use crate::noise::GyroNoise;
use crate::signal::phasor::{COLUMNS, QUICKENING, RATE, TURNING};
use crate::units::{Radians, RadiansPerSecond, Seconds, TURN};

/// Least modulation of the platform's rate, RMS over its mean, that determines a misalignment.
const LEAST_MODULATION: f64 = 0.02;
/// Relative distance from once per turn within which a modulation counts as once per turn.
const SAME_FREQUENCY: f64 = 0.1;
/// Least number of rate-modulated turns: the modulation must be resolved from once per turn.
const LEAST_TURNS: f64 = 3.0;

/// Size of a stored misalignment, bytes.
pub const BYTES: usize = record_bytes(7);

/// Version of the stored layout.
const LAYOUT: u32 = 1;

/// Axis misalignment and lag of the gyro, from one rate-modulated stretch or from storage.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AxisMisalignment {
    /// Part of the platform's rate that the gyro shows, s = −sin α: the in-phase response at the
    /// frequency of the modulation.
    pub sine: f64,
    /// Part of the platform's acceleration that the gyro shows, q = −s τ.
    pub quadrature: Seconds,
    /// Standard deviation of `sine`, 1σ.
    pub sine_sigma: f64,
    /// Standard deviation of `quadrature`, 1σ.
    pub quadrature_sigma: Seconds,
    /// Frequency of the modulation.
    pub frequency: RadiansPerSecond,
    /// Date of the measurement, s since 1970; zero where it is unknown.
    pub date: u64,
    /// Temperature at the measurement, °C; NaN where it is unknown.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "or_unknown"))]
    pub temperature: f32,
}

/// Reads a number that text holds as a missing one where it is NaN.
#[cfg(feature = "serde")]
fn or_unknown<'de, D: serde::Deserializer<'de>>(text: D) -> Result<f32, D::Error> {
    let number: Option<f32> = serde::Deserialize::deserialize(text)?;
    Ok(number.unwrap_or(f32::NAN))
}

impl Modulated {
    /// Axis misalignment that a rate-modulated stretch shows, modulated at two frequencies that are
    /// apart by twice `width` of their mean, or at one; `None` where the modulation was too weak or
    /// the stretch too short.
    #[must_use]
    pub fn misalignment(&self, noise: &GyroNoise) -> Option<AxisMisalignment> {
        let Self { sums, seconds, turned, width } = self;
        let mean = turned / seconds;
        let rows = f64::from(sums.rows.max(1));
        let modulation = sums.product(TURNING, TURNING) / rows - squared(sums.mean(TURNING));
        let enough =
            turned.abs() >= LEAST_TURNS * TURN && modulation > squared(LEAST_MODULATION * mean);
        if !enough {
            return None;
        }
        let found = sums.regression(RATE).solve(&[Column::Free; COLUMNS])?;
        let shown = libm::sqrt(sums.product(QUICKENING, QUICKENING) / rows / modulation);
        // Ends that cut a period short make this frequency uncertain by some hundredths.
        let is_once_a_turn = (shown - mean.abs()).abs() < SAME_FREQUENCY * mean.abs();
        let frequency = if is_once_a_turn { mean.abs() } else { shown };
        // Noise density of a row, which is a mean over this time.
        let density = noise.density_at(frequency / TURN) * rows / seconds;
        let sigma = |column: usize| libm::sqrt(density * found.covariance[column][column]);
        let (sine, quadrature) = (found.coefficients[TURNING], found.coefficients[QUICKENING]);
        let whole = at_one_frequency(frequency * quadrature / sine, *width);
        Some(AxisMisalignment {
            sine,
            quadrature: Seconds(quadrature * whole),
            sine_sigma: sigma(TURNING),
            quadrature_sigma: Seconds(sigma(QUICKENING)),
            frequency: RadiansPerSecond(frequency),
            date: 0,
            temperature: f32::NAN,
        })
    }
}

impl AxisMisalignment {
    /// Misalignment angle α of the axis from the platform's plane, up positive.
    pub fn angle(&self) -> Radians {
        Radians(-libm::asin(self.sine.clamp(-1.0, 1.0)))
    }

    /// Lag of the gyro behind the encoder as one pole; near zero where the misalignment is too
    /// small to show it.
    pub fn lag(&self) -> Seconds {
        // The estimate is shrunk by the part that noise alone would explain.
        let sigma = self.frequency.0 * self.quadrature_sigma.0;
        let variance = squared(sigma) + squared(self.sine_sigma);
        let power = (squared(self.sine) + variance).max(f64::MIN_POSITIVE);
        Seconds(-self.quadrature.0 * self.sine / power)
    }

    /// Standard deviation of that lag, 1σ, s; infinite without misalignment.
    pub(super) fn lag_sigma(&self) -> f64 {
        self.quadrature_sigma.0 / self.sine.abs()
    }

    /// Response of the gyro to a modulation of the platform's rate at a frequency in rad/s,
    /// clockwise rotation positive: the misalignment behind one pole, which lags, or leads as a
    /// high-pass does.
    pub fn response(&self, frequency: f64) -> Complex {
        let (lag, own) = (self.lag().0, self.frequency.0);
        let passed = self.sine * (1.0 + squared(own * lag));
        // The tangent of a lag grows with the frequency, that of a lead falls.
        let tangent = if lag < 0.0 { lag * squared(own) / frequency } else { frequency * lag };
        Complex::new(passed, 0.0) / Complex::new(1.0, tangent)
    }

    /// Standard deviations, 1σ, of the in-phase and quadrature parts of that response.
    pub(super) fn sigmas(&self, frequency: f64) -> [f64; 2] {
        [self.sine_sigma, frequency * self.quadrature_sigma.0]
    }

    /// Stored form: version, the numbers in the order of their fields, CRC-32, all little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; BYTES] {
        let [sine, quadrature] = [self.sine, self.quadrature.0].map(f64::to_bits);
        let sigmas = [self.sine_sigma, self.quadrature_sigma.0].map(f64::to_bits);
        let (frequency, temperature) =
            (self.frequency.0.to_bits(), self.temperature.to_bits().into());
        record(LAYOUT, &[sine, quadrature, sigmas[0], sigmas[1], frequency, self.date, temperature])
    }

    /// Reads the stored form; `None` where it is damaged, of another version, or out of range.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; BYTES]) -> Option<Self> {
        let [numbers @ .., date, temperature] = numbers::<7>(LAYOUT, bytes)?;
        let [sine, quadrature, sine_sigma, quadrature_sigma, frequency] =
            numbers.map(f64::from_bits);
        let temperature = f32::from_bits(temperature as u32);
        let (quadrature, quadrature_sigma) = (Seconds(quadrature), Seconds(quadrature_sigma));
        let frequency = RadiansPerSecond(frequency);
        let misalignment =
            Self { sine, quadrature, sine_sigma, quadrature_sigma, frequency, date, temperature };
        misalignment.is_possible().then_some(misalignment)
    }

    /// Whether every number is finite and in its range.
    fn is_possible(&self) -> bool {
        let Self { sine, quadrature, sine_sigma, quadrature_sigma, frequency, .. } = *self;
        let numbers = [sine, quadrature.0, sine_sigma, quadrature_sigma.0, frequency.0];
        numbers.iter().all(|number| number.is_finite()) && sine.abs() <= 1.0 && frequency.0 > 0.0
    }
}

/// Factor by which a lag fitted to two frequencies at once, apart by twice `width` of their mean,
/// is too small: one pole attenuates the higher one more. A lead (tangent > 0) obeys another law
/// and is left unchanged.
fn at_one_frequency(lead: f64, width: f64) -> f64 {
    let power = squared(lead);
    if lead < 0.0 { 1.0 + squared(2.0 * width) * power / (1.0 + power) } else { 1.0 }
}

/// Misalignment that was measured nearest to a speed in rad/s.
#[must_use]
pub fn nearest(misalignments: &[AxisMisalignment], speed: f64) -> Option<&AxisMisalignment> {
    let apart = |misalignment: &AxisMisalignment| (misalignment.frequency.0 - speed.abs()).abs();
    misalignments.iter().reduce(|best, next| if apart(next) < apart(best) { next } else { best })
}

/// Square of a number.
fn squared(x: f64) -> f64 {
    x * x
}

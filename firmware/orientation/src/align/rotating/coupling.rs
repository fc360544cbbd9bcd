//! How the gyro feels the platform's own turning, found by turning it unevenly on purpose.
//!
//! A sensitive axis that is raised by α over the platform's plane feels −sin α of the platform's rate
//! (equations.md §4; MET 2018, section 4). Rotation is never quite even, mostly once per turn, where
//! the Earth rate is looked for. A turn with a strong modulation beside that frequency gives the sine,
//! and how far the gyro lags behind the encoder: rate = s (θ̇ − τ θ̈), the first order of a lag.

use crate::align::regression::Column;
use crate::checksum::crc32;
use crate::math::Complex;
use crate::noise::model::GyroNoise;
use crate::signal::phasor::{COLUMNS, QUICKENING, RATE, Sums, TURNING};
use crate::units::TURN;

/// Least modulation of the platform's rate, RMS over its mean, from which a coupling is learnt.
const LEAST_MODULATION: f64 = 0.02;
/// How near to once per turn a modulation counts as just that, relative.
const SAME_FREQUENCY: f64 = 0.1;
/// Least number of turns with it: the modulation must stand apart from once per turn.
const LEAST_TURNS: f64 = 3.0;

/// A coupling with its lag, as one uneven turn found it, or as it was stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Part of the platform's rate that the gyro shows, s = −sin α: its part in phase at the frequency
    /// of the modulation.
    pub sine: f64,
    /// Its part of the platform's acceleration, q = −s τ, s.
    pub quadrature: f64,
    /// 1σ of `sine`.
    pub sine_sigma: f64,
    /// 1σ of `quadrature`, s.
    pub quadrature_sigma: f64,
    /// Frequency of the modulation, rad/s.
    pub frequency: f64,
    /// When it was found, s since 1970; zero where nobody knew.
    pub date: u64,
    /// Temperature then, °C; not a number where nobody knew.
    pub temperature: f32,
}

impl Coupling {
    /// From the sums of an uneven stretch of `seconds`, in which the platform turned by `turned` rad,
    /// modulated at two frequencies that are apart by twice `width` of their mean, or at one; `None` where
    /// it was too even, or too short, to tell.
    #[must_use]
    pub fn of(
        sums: &Sums,
        seconds: f64,
        turned: f64,
        width: f64,
        noise: &GyroNoise,
    ) -> Option<Self> {
        let mean = turned / seconds;
        let rows = f64::from(sums.rows().max(1));
        let modulation = sums.product(TURNING, TURNING) / rows - squared(sums.mean(TURNING));
        let enough =
            turned.abs() >= LEAST_TURNS * TURN && modulation > squared(LEAST_MODULATION * mean);
        if !enough {
            return None;
        }
        let found = sums.regression(RATE).solve(&[Column::Free; COLUMNS])?;
        let shown = libm::sqrt(sums.product(QUICKENING, QUICKENING) / rows / modulation);
        // Ends that cut a period short make this uncertain by some hundredths.
        let is_once_a_turn = (shown - mean.abs()).abs() < SAME_FREQUENCY * mean.abs();
        let frequency = if is_once_a_turn { mean.abs() } else { shown };
        // Noise of a row, whose mean is over this time.
        let density = noise.density_at(frequency / TURN) * rows / seconds;
        let sigma = |column: usize| libm::sqrt(density * found.covariance[column][column]);
        let (sine, quadrature) = (found.coefficients[TURNING], found.coefficients[QUICKENING]);
        Some(Self {
            sine,
            quadrature: quadrature * at_one_frequency(frequency * quadrature / sine, width),
            sine_sigma: sigma(TURNING),
            quadrature_sigma: sigma(QUICKENING),
            frequency,
            date: 0,
            temperature: f32::NAN,
        })
    }

    /// How far the axis stands from the platform's plane, rad, up positive.
    #[must_use]
    pub fn angle(&self) -> f64 {
        -libm::asin(self.sine.clamp(-1.0, 1.0))
    }

    /// How far the gyro lags behind the encoder, s, as one pole; as good as zero where the coupling is too
    /// small to show it.
    #[must_use]
    pub fn lag(&self) -> f64 {
        // Shrunk by what noise alone would make of it.
        let doubt = squared(self.frequency * self.quadrature_sigma) + squared(self.sine_sigma);
        -self.quadrature * self.sine / (squared(self.sine) + doubt).max(f64::MIN_POSITIVE)
    }

    /// 1σ of that lag, s: infinite where there is no coupling.
    #[must_use]
    pub fn lag_sigma(&self) -> f64 {
        self.quadrature_sigma / self.sine.abs()
    }

    /// What the gyro shows of a modulation of the platform's rate at a frequency in rad/s, turning
    /// clockwise positive: the coupling behind one pole, which lags, or leads as a high-pass does.
    #[must_use]
    pub fn response(&self, frequency: f64) -> Complex {
        let lag = self.lag();
        let passed = self.sine * (1.0 + squared(self.frequency * lag));
        // A lag's tangent grows with the frequency, a lead's falls.
        let tangent =
            if lag < 0.0 { lag * squared(self.frequency) / frequency } else { frequency * lag };
        Complex::new(passed, 0.0) / Complex::new(1.0, tangent)
    }

    /// 1σ of the parts of that response, in phase and in quadrature.
    #[must_use]
    pub fn sigmas(&self, frequency: f64) -> [f64; 2] {
        [self.sine_sigma, frequency * self.quadrature_sigma]
    }
}

/// What a lag that is fitted to two frequencies at once, apart by twice `width` of their mean, is too
/// small by: one pole answers the higher one less. A lead (its tangent > 0), of which the law is another,
/// is left as it is.
fn at_one_frequency(lead: f64, width: f64) -> f64 {
    let power = squared(lead);
    if lead < 0.0 { 1.0 + squared(2.0 * width) * power / (1.0 + power) } else { 1.0 }
}

/// The one that was found nearest to a speed in rad/s.
#[must_use]
pub fn nearest(couplings: &[Coupling], speed: f64) -> Option<&Coupling> {
    let apart = |coupling: &Coupling| (coupling.frequency - speed.abs()).abs();
    couplings.iter().reduce(|best, next| if apart(next) < apart(best) { next } else { best })
}

/// Bytes of a stored coupling.
pub const BYTES: usize = 64;

/// Version of that layout.
const LAYOUT: u32 = 1;

impl Coupling {
    /// As it is stored: version, the numbers in the order of their fields, CRC-32, little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; BYTES] {
        let mut bytes = [0; BYTES];
        bytes[..4].copy_from_slice(&LAYOUT.to_le_bytes());
        let numbers =
            [self.sine, self.quadrature, self.sine_sigma, self.quadrature_sigma, self.frequency];
        for (place, number) in bytes[4..].chunks_exact_mut(8).zip(numbers) {
            place.copy_from_slice(&number.to_le_bytes());
        }
        bytes[44..52].copy_from_slice(&self.date.to_le_bytes());
        bytes[52..56].copy_from_slice(&self.temperature.to_le_bytes());
        let checksum = checksum(&bytes);
        bytes[CHECKED..].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    /// From what was stored; `None` where it is damaged, of another version, or no coupling.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; BYTES]) -> Option<Self> {
        let word = |at: usize| <[u8; 4]>::try_from(bytes.get(at..at + 4)?).ok();
        let long = |at: usize| <[u8; 8]>::try_from(bytes.get(at..at + 8)?).ok();
        let number = |index: usize| long(4 + 8 * index).map(f64::from_le_bytes);
        let is_sound = u32::from_le_bytes(word(CHECKED)?) == checksum(bytes)
            && u32::from_le_bytes(word(0)?) == LAYOUT;
        let coupling = Self {
            sine: number(0)?,
            quadrature: number(1)?,
            sine_sigma: number(2)?,
            quadrature_sigma: number(3)?,
            frequency: number(4)?,
            date: u64::from_le_bytes(long(44)?),
            temperature: f32::from_le_bytes(word(52)?),
        };
        (is_sound && coupling.is_possible()).then_some(coupling)
    }

    /// Whether every number is one, and in its range.
    fn is_possible(&self) -> bool {
        let numbers = [self.sine, self.quadrature, self.sine_sigma, self.quadrature_sigma];
        let are_finite = numbers.iter().all(|number| number.is_finite());
        are_finite && self.sine.abs() <= 1.0 && self.frequency > 0.0 && self.frequency.is_finite()
    }
}

/// How much of the bytes the checksum is for.
const CHECKED: usize = BYTES - 4;

/// The checksum of what stands before it.
fn checksum(bytes: &[u8; BYTES]) -> u32 {
    let (words, _) = bytes[..CHECKED].as_chunks::<4>();
    crc32(words.iter().map(|word| u32::from_le_bytes(*word)))
}

fn squared(x: f64) -> f64 {
    x * x
}

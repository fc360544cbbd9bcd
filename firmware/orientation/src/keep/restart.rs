//! An azimuth over a loss of supply: it still holds where the vehicle has not moved, which is checked.
//!
//! A vehicle that was moved stands otherwise: its pitch or roll differ, and the Earth turns its gyros
//! otherwise. Gravity alone cannot tell a turn about the vertical, so gyros whose biases come back too badly
//! tell nothing, and then the azimuth is not believed.

use super::Setting;
use crate::checksum::crc32;
use crate::units::{DEGREE, DEGREES_PER_RADIAN as DEGREES};
use crate::words;
use crate::words::Rounded;

/// Shortest rest by which it is judged, s.
pub const REST_SECONDS: f64 = 10.0;
/// How far pitch and roll may differ, rad: what temperature and tyres do to a vehicle that stands, 0.05°.
const TILT: f64 = 0.05 * DEGREE;
/// Standard deviations by which the rates may differ.
const BOUND: f64 = 4.0;
/// Greatest 1σ to which the gyros must be able to tell a turn, rad: 0.5°.
const TELLING: f64 = 0.5 * DEGREE;
/// Version of what is stored.
const VERSION: u32 = 1;
/// Numbers that are stored.
const NUMBERS: usize = 8;
/// Words that are stored: version, numbers, checksum.
const WORDS: usize = 1 + 2 * NUMBERS + 1;

/// What is kept over a loss of supply.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Remembered {
    /// Azimuth of body x, rad.
    pub azimuth: f64,
    /// Its 1σ, rad.
    pub sigma: f64,
    /// Pitch, rad.
    pub pitch: f64,
    /// Roll, rad.
    pub roll: f64,
    /// Mean rates at rest about forward, right, down, rad/s, the Earth's included.
    pub rates: [f64; 3],
    /// For how long they were averaged, s.
    pub rest: f64,
}

/// How the body stands now.
#[derive(Clone, Copy, Debug)]
pub(super) struct Now {
    pub(super) pitch: f64,
    pub(super) roll: f64,
    pub(super) rates: Option<[f64; 3]>,
    pub(super) rest: f64,
}

/// Why a remembered azimuth is not believed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// The body does not stand, or not for long enough.
    NotAtRest {
        /// For how long it stood, s.
        seconds: f64,
    },
    /// It stands otherwise.
    Tilted {
        /// By how much pitch or roll differ, °.
        degrees: f64,
    },
    /// The Earth turns it otherwise.
    Turned {
        /// By how much, in σ.
        sigmas: f64,
    },
    /// The gyros cannot tell whether it was turned.
    CannotTell {
        /// To how much they could, 1σ, °.
        sigma: f64,
    },
}

words! { Doubt:
    Self::NotAtRest { seconds } => "the body stood for {} s: too short", Rounded::<1>(seconds);
    Self::Tilted { degrees } => "it stands otherwise, by {}°", Rounded::<3>(degrees);
    Self::Turned { sigmas } => "the Earth turns it otherwise, by {} σ", Rounded::<1>(sigmas);
    Self::CannotTell { sigma } =>
        "a turn about the vertical could be told to {}° only: the gyros' biases differ from start to start",
        Rounded::<2>(sigma);
}

/// Whether a body still stands as it did.
pub(super) fn check(before: &Remembered, now: &Now, setting: &Setting) -> Result<(), Doubt> {
    let Some(rates) = now.rates.filter(|_| now.rest >= REST_SECONDS) else {
        return Err(Doubt::NotAtRest { seconds: now.rest });
    };
    let tilt = (now.pitch - before.pitch).abs().max((now.roll - before.roll).abs());
    if tilt > TILT || tilt.is_nan() {
        return Err(Doubt::Tilted { degrees: tilt * DEGREES });
    }
    let sigmas: [f64; 3] = core::array::from_fn(|axis| {
        let gyro = &setting.gyros[axis];
        let noise = gyro.noise.white_variance(now.rest) + gyro.noise.white_variance(before.rest);
        libm::sqrt(2.0 * gyro.bias_sigma * gyro.bias_sigma + noise)
    });
    let away = (0..3).map(|axis| (rates[axis] - before.rates[axis]).abs() / sigmas[axis]);
    let away = away.fold(0.0, f64::max);
    if away > BOUND || away.is_nan() {
        return Err(Doubt::Turned { sigmas: away });
    }
    let sigma = telling(before, setting, &sigmas);
    if sigma > TELLING || sigma.is_nan() {
        return Err(Doubt::CannotTell { sigma: sigma * DEGREES });
    }
    Ok(())
}

/// To how much, 1σ, rad, the gyros forward and right can tell a turn: it moves the Earth's horizontal rate
/// from one to the other.
fn telling(before: &Remembered, setting: &Setting, sigmas: &[f64; 3]) -> f64 {
    let (sine, cosine) = libm::sincos(before.azimuth);
    let rate = setting.latitude.horizontal_rate();
    let weight = |moved: f64, sigma: f64| (moved / sigma) * (moved / sigma);
    let whole = weight(rate * sine, sigmas[0]) + weight(rate * cosine, sigmas[1]);
    1.0 / libm::sqrt(whole)
}

impl Remembered {
    /// Bytes of what is stored.
    pub const BYTES: usize = 4 * WORDS;

    /// As it is stored: version, numbers, CRC-32, little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::BYTES] {
        let mut words = [VERSION; WORDS];
        for (pair, number) in words[1..WORDS - 1].chunks_exact_mut(2).zip(self.numbers()) {
            let bits = number.to_bits();
            pair.copy_from_slice(&[bits as u32, (bits >> 32) as u32]);
        }
        words[WORDS - 1] = crc32(words[..WORDS - 1].iter().copied());
        let mut bytes = [0; Self::BYTES];
        for (place, word) in bytes.chunks_exact_mut(4).zip(words) {
            place.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }

    /// From what was stored; none where it is damaged, of another version, or no attitude.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let bytes: &[u8; Self::BYTES] = bytes.try_into().ok()?;
        let mut words = [0; WORDS];
        for (word, place) in words.iter_mut().zip(bytes.chunks_exact(4)) {
            *word = u32::from_le_bytes([place[0], place[1], place[2], place[3]]);
        }
        let is_whole = crc32(words[..WORDS - 1].iter().copied()) == words[WORDS - 1];
        if words[0] != VERSION || !is_whole {
            return None;
        }
        let number = |place: usize| {
            let [low, high] = [words[1 + 2 * place], words[2 + 2 * place]];
            f64::from_bits(u64::from(low) | u64::from(high) << 32)
        };
        let numbers: [f64; NUMBERS] = core::array::from_fn(number);
        numbers.iter().all(|number| number.is_finite()).then(|| Self::of(numbers))
    }

    fn numbers(&self) -> [f64; NUMBERS] {
        let [x, y, z] = self.rates;
        [self.azimuth, self.sigma, self.pitch, self.roll, x, y, z, self.rest]
    }

    fn of([azimuth, sigma, pitch, roll, x, y, z, rest]: [f64; NUMBERS]) -> Self {
        Self { azimuth, sigma, pitch, roll, rates: [x, y, z], rest }
    }
}

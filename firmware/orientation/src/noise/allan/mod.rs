//! Overlapping Allan variance of a running gyro, in fixed memory.
//!
//! With θ the running sum of the rate, the Allan variance at τ = m samples is the mean of
//! (θ(j+2m) − 2θ(j+m) + θ(j))²/(2m²) over j (IEEE Std 952-1997, annex C). Level k keeps every 2ᵏ-th
//! θ in a ring and takes the differences of 4 and 6 of its steps; level 0 those of 1, 2 and 3 too. The
//! grid is so m = 1, 2, 3, 4, 6, 8, 12, 16, 24, …, and successive terms lie m/4 or m/6 apart: nothing
//! is lost against an advance by single samples but a few per cent of the degrees of freedom.
//!
//! The sums are exact integers. A second difference is the sum of m samples less the sum of the m
//! before: its size is at most m·(2³² − 1) < 2⁵⁸ for the largest m = 6·2²³, so it is exact although θ
//! may wrap. Its square, summed over n/2ᵏ terms with m ≤ 6·2ᵏ, is below 36·2²³·2⁶⁴·n < 2¹²⁵ for
//! n < 2³²: a `u128` holds any record.

pub mod covariance;
mod kernel;

use super::model::GyroNoise;
use crate::units::{AngularRate, RadiansPerSecond, Seconds};

/// Number of levels: the last reaches τ = 6·2²³ samples, half of a record of 10⁸.
const LEVELS: usize = 24;
/// Steps of a level over which differences are taken.
const FACTORS: [u32; 2] = [4, 6];
/// Additional differences at level 0, in samples.
const SHORT: [u32; 3] = [1, 2, 3];
/// Entries of a ring: a power of two that holds twice the greatest factor and the newest angle.
const RING: usize = 16;

/// Greatest number of averaging times τ that a record can have.
pub const MOST_POINTS: usize = SHORT.len() + FACTORS.len() * LEVELS;

/// Greatest number of samples; later ones are ignored (25 days at 2 kHz). A record that outlasts
/// the last level (10⁸ samples) makes the existing τ more certain and adds no longer one.
pub(crate) const MOST_SAMPLES: u32 = u32::MAX;

const _: () = assert!(size_of::<Allan>() <= 4096, "the board's room for it");
const _: () = assert!(RING > 2 * FACTORS[1] as usize, "a ring holds a second difference");

/// Factor of each squared coefficient in the Allan variance at τ = `seconds`, in the order Q, N, B,
/// K, R: 3/τ², 1/τ, 2 ln 2/π, τ/3, τ²/2 (IEEE Std 952-1997).
#[must_use]
pub fn terms(seconds: f64) -> [f64; 5] {
    let flat = 2.0 * core::f64::consts::LN_2 / core::f64::consts::PI;
    let square = seconds * seconds;
    [3.0 / square, 1.0 / seconds, flat, seconds / 3.0, 0.5 * square]
}

/// Allan variance that a noise model predicts at τ = `seconds`, (rad/s)².
#[must_use]
pub fn variance(noise: &GyroNoise, seconds: f64) -> f64 {
    let coefficients = noise.coefficients().map(|coefficient| coefficient * coefficient);
    terms(seconds).iter().zip(coefficients).map(|(term, square)| term * square).sum()
}

/// One estimate of the Allan variance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Averaging time τ.
    pub seconds: Seconds,
    /// Allan variance, (rad/s)².
    pub variance: f64,
    /// Time between the starts of successive terms.
    pub stride: Seconds,
    /// Number of terms averaged, ≥ 1.
    pub terms: u64,
}

/// One level: every 2ᵏ-th angle, and the sums of the squared second differences.
#[derive(Clone, Debug)]
struct Level {
    /// Ring of the latest angles, nrad/s·samples.
    angles: [i64; RING],
    /// Sums of squared second differences over 4 and 6 steps.
    sums: [u128; 2],
}

impl Level {
    /// Level at the start, with the angle zero.
    const START: Self = Self { angles: [0; RING], sums: [0; 2] };

    /// Takes the angle with number `index`, nrad/s·samples.
    fn push(&mut self, index: u32, angle: i64) {
        self.angles[index as usize % RING] = angle;
        let Self { angles, sums: [four, six] } = self;
        add::<{ FACTORS[0] }>(four, angles, index, angle);
        add::<{ FACTORS[1] }>(six, angles, index, angle);
    }
}

/// Adds the square of the second difference that ends with `newest`, the angle number `index`, where
/// the record reaches so far back. The steps are constants: that saves a quarter of the instructions.
#[inline]
fn add<const STEP: u32>(sum: &mut u128, angles: &[i64; RING], index: u32, newest: i64) {
    if index >= 2 * STEP {
        let angle = |back: u32| angles[index.wrapping_sub(back) as usize % RING];
        let middle = angle(STEP);
        let difference = newest.wrapping_sub(middle).wrapping_sub(middle);
        let size = u128::from(difference.wrapping_add(angle(2 * STEP)).unsigned_abs());
        *sum += size * size;
    }
}

/// Estimator of the overlapping Allan variance, 4 KB; see the module.
#[derive(Clone, Debug)]
pub struct Allan {
    /// Rings and sums of the octaves.
    levels: [Level; LEVELS],
    /// Sums of squared second differences over 1, 2 and 3 samples.
    short: [u128; 3],
    /// Sum of all samples, nrad/s, modulo 2⁶⁴.
    angle: i64,
    /// Number of samples.
    pub samples: u32,
    /// Latest sample, nrad/s.
    last: i32,
    /// Smallest non-zero change between neighbouring samples less one, nrad/s; a change of zero
    /// wraps to the greatest value.
    change: u32,
    /// Whether any sample stood at a limit of its range.
    pub is_saturated: bool,
}

impl Default for Allan {
    fn default() -> Self {
        Self::new()
    }
}

impl Allan {
    /// Estimator of an empty record.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            levels: [Level::START; LEVELS],
            short: [0; 3],
            angle: 0,
            samples: 0,
            last: 0,
            change: u32::MAX,
            is_saturated: false,
        }
    }

    /// Takes the next sample; samples must be equidistant and without gaps.
    pub fn push(&mut self, rate: AngularRate) {
        if self.samples == MOST_SAMPLES {
            return;
        }
        self.examine(rate);
        self.samples += 1;
        self.angle = self.angle.wrapping_add(i64::from(rate.0));
        let reached = self.samples.trailing_zeros();
        for (shift, level) in (0..=reached).zip(&mut self.levels) {
            level.push(self.samples >> shift, self.angle);
        }
        let (angles, index) = (&self.levels[0].angles, self.samples);
        let [one, two, three] = &mut self.short;
        add::<{ SHORT[0] }>(one, angles, index, self.angle);
        add::<{ SHORT[1] }>(two, angles, index, self.angle);
        add::<{ SHORT[2] }>(three, angles, index, self.angle);
    }

    /// Notes saturation and the smallest change, which reveal an unusable record.
    fn examine(&mut self, rate: AngularRate) {
        self.is_saturated |= rate.is_saturated();
        if self.samples > 0 {
            self.change = self.change.min(rate.0.abs_diff(self.last).wrapping_sub(1));
        }
        self.last = rate.0;
    }

    /// Whether all samples were equal, as with a stuck gyro or bus; true also for an empty record.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.change == u32::MAX
    }

    /// Smallest change between neighbouring samples: in a noisy record this is the step of
    /// the coarsest number format on the way. Zero for a constant record.
    pub fn resolution(&self) -> RadiansPerSecond {
        RadiansPerSecond(f64::from(self.change.wrapping_add(1)) * 1e-9)
    }

    /// Allan variances at every τ that the record reaches, in rising order; `sample_seconds` is the
    /// sample period, s.
    pub fn points(&self, sample_seconds: Seconds) -> impl Iterator<Item = Point> {
        let short = SHORT.into_iter().zip(self.short).map(|(step, sum)| (0, step, sum));
        let levels = (0..).zip(&self.levels).flat_map(|(shift, level)| {
            FACTORS.into_iter().zip(level.sums).map(move |(step, sum)| (shift, step, sum))
        });
        short
            .chain(levels)
            .filter_map(move |(shift, step, sum)| self.point(sample_seconds.0, shift, step, sum))
    }

    /// Estimate from a sum over `step` steps of 2^`shift` samples; `None` without a complete term.
    fn point(&self, sample_seconds: f64, shift: u32, step: u32, sum: u128) -> Option<Point> {
        let terms = ((self.samples >> shift) + 1).checked_sub(2 * step).filter(|&n| n > 0)?;
        let stride = f64::from(1_u32 << shift);
        let m = stride * f64::from(step);
        Some(Point {
            seconds: Seconds(m * sample_seconds),
            variance: sum as f64 * 1e-18 / (2.0 * m * m * f64::from(terms)),
            stride: Seconds(stride * sample_seconds),
            terms: u64::from(terms),
        })
    }
}

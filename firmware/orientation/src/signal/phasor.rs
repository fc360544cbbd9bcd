//! Demodulation of a gyro on a turning platform: from samples to sums of products, in fixed memory.
//!
//! ```text
//!  sample ─trapezoid─▶ block (≈ 20 ms) ─products, i64─▶ stretch of turning ─f64─▶ Sums ─▶ fits
//! ```
//!
//! A block is the mean of the rate over some sample periods, by the trapezoidal rule from sample to
//! sample. Its platform rate is exactly the angle that the encoder turned in that time, so the
//! encoder's quantisation steps cancel from block to block. Cosine and sine are averaged over the
//! same time from its ends and middle. Any regression on these columns can be formed afterwards
//! from the sums of products (MET 2018: the phasor of a signal is its least-squares fit on 1, t,
//! cos θ, sin θ over whole turns).

use super::Sample;
use crate::math::{Regression, Table};
use crate::units::Angle;

/// Number of columns that the gyro's rate may be fitted to.
pub const COLUMNS: usize = 6;

/// Column of the constant.
pub(crate) const ONE: usize = 0;
/// Column of the cosine of the platform angle.
pub(crate) const COSINE: usize = 1;
/// Column of the sine of the platform angle.
pub(crate) const SINE: usize = 2;
/// Column of the time since the reference, s.
pub(crate) const TIME: usize = 3;
/// Column of the platform's rate beyond the reference, rad/s: shows the axis misalignment.
pub const TURNING: usize = 4;
/// Column of the platform's angular acceleration, rad/s²: shows the lag of the sensor.
pub const QUICKENING: usize = 5;

/// Signals of a row: the columns, then the gyro's rate beyond the reference, rad/s.
const SIGNALS: usize = COLUMNS + 1;
/// Index of the gyro's rate among the signals.
pub const RATE: usize = COLUMNS;

/// Size of one integer step of each signal in a row, in the signal's unit.
const STEPS: [f64; SIGNALS] = [1.0, TRIGONOMETRIC, TRIGONOMETRIC, 1e-3, 1e-6, 1e-6, 1e-9];
/// Step of cosine and sine, 2⁻²².
const TRIGONOMETRIC: f64 = 1.0 / 4_194_304.0;
/// Step of the table's cosine, 2⁻³⁰, over [`TRIGONOMETRIC`].
const EXCESS: f32 = 1.0 / 256.0;

/// Greatest deviation of the gyro's rate from the reference, nrad/s: 1.9 °/s. A larger one cannot
/// be Earth rate and marks the products as out of range.
const FURTHEST: i64 = 1 << 25;

/// Greatest deviation of the platform's rate, rad/s, and greatest angular acceleration, rad/s²: no
/// stage is so fast, and 4096 of their squares fit into 64 bits.
const FASTEST: f32 = 16.0;
/// Longest time from the reference, ms: nine hours, of which 4096 squares fit into 64 bits.
const LONGEST: u64 = 1 << 25;

/// Mean values of one block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// Time of the block's middle, µs.
    pub time: u64,
    /// Length of the block, s.
    pub seconds: f32,
    /// Mean rate of the platform, rad/s, clockwise positive.
    pub turning: f32,
    /// Angle that the platform turned, in steps of an [`Angle`].
    pub turned: i64,
    /// Mean cosine and sine of the platform angle, in steps of 2⁻²².
    phasor: [i32; 2],
    /// Mean rate of the gyro, nrad/s.
    pub rate: i32,
    /// Whether a rate within the block stood at the limit of its range.
    pub is_saturated: bool,
}

/// Averages samples into blocks.
///
/// An encoder may be read less often than the gyro: a sample that repeats the previous angle
/// carries no new reading, and a block begins, has its middle and ends only at samples with a new
/// angle. If none comes for two blocks the platform stands still, which makes a block too.
#[derive(Clone, Copy, Debug, Default)]
pub struct Blocks {
    /// Least number of sample periods in a block, and the number after which its middle is taken.
    periods: u32,
    middle: u32,
    /// Previous sample.
    last: Option<Point>,
    /// Sample at which the block began, if it has begun, and the cosine and sine of the angle there
    /// and in the middle, in steps of 2⁻³⁰.
    begun: Option<Point>,
    phasors: [[i32; 2]; 2],
    /// Time of the middle, µs; zero until it is taken.
    middle_time: u64,
    /// Sample periods in the block so far.
    count: u32,
    /// Sums over the periods of the values at both of their ends times the period's length, µs.
    turning: f32,
    rate: i64,
    /// Whether a rate in the block stood at the limit of its range.
    is_saturated: bool,
}

/// The values of one sample that the trapezoidal rule needs.
#[derive(Clone, Copy, Debug)]
struct Point {
    time: u64,
    stage: Angle,
    turning: Option<f32>,
    rate: i32,
}

impl Blocks {
    /// Averages into blocks of this many sample periods: one, or an even number, so that a sample
    /// lies in the middle. An odd number is rounded down to even.
    #[must_use]
    pub fn of(periods: u32) -> Self {
        let middle = periods / 2;
        Self { periods: (2 * middle).max(1), middle, ..Self::default() }
    }

    /// Discards the block in progress, so that the next samples do not join on to it.
    pub(crate) fn restart(&mut self) {
        *self = Self::of(self.periods);
    }

    /// Takes a sample, and the platform's rate in rad/s where it was measured; returns a block when
    /// one is complete. The platform must turn by less than half a turn within a block, else the
    /// angle is ambiguous.
    #[inline]
    pub fn push(&mut self, sample: &Sample, turning: Option<f32>) -> Option<Block> {
        let (time, stage, rate) = (sample.time.0, sample.stage, sample.rate.0);
        let point = Point { time, stage, turning, rate };
        let last = self.last.replace(point)?;
        let is_new = stage != last.stage;
        let Some(begun) = self.begun else {
            self.count += 1;
            if is_new || self.count >= self.periods {
                self.begin(point, Table::built_in().at(stage));
            }
            return None;
        };
        self.count += 1;
        // A period with missing samples counts with its full length.
        let period = time.saturating_sub(last.time) as u32;
        self.rate += (i64::from(rate) + i64::from(last.rate)) * i64::from(period);
        if let (Some(now), Some(before)) = (turning, last.turning) {
            self.turning += (now + before) * period as f32;
        }
        self.is_saturated |= sample.rate.is_saturated();
        let stands = self.count >= 2 * self.periods;
        if stands || (is_new && self.count >= self.periods) {
            return Some(self.finish(&begun, point));
        }
        if is_new && self.count >= self.middle && self.middle_time == 0 {
            self.phasors[1] = Table::built_in().at(stage);
            self.middle_time = time;
        }
        None
    }

    /// Begins a block at a sample whose angle has this cosine and sine, in steps of 2⁻³⁰.
    fn begin(&mut self, point: Point, phasor: [i32; 2]) {
        *self = Self { last: Some(point), begun: Some(point), ..Self::of(self.periods) };
        self.phasors[0] = phasor;
    }

    /// The block that ends with this sample; the next block begins there.
    fn finish(&mut self, begun: &Point, end: Point) -> Block {
        let length = end.time.saturating_sub(begun.time).max(1);
        let seconds = length as f32 * 1e-6;
        // Both ends of every period were summed.
        let twice = 2 * length.cast_signed();
        let turned = i64::from((end.stage - begun.stage).0.cast_signed());
        let shown = turned as f32 * (Angle::STEP as f32) / seconds;
        let phasor = Table::built_in().at(end.stage);
        let block = Block {
            time: begun.time.midpoint(end.time),
            seconds,
            turning: end.turning.map_or(shown, |_| self.turning / twice as f32),
            turned,
            phasor: self.mean_phasor(begun, &end, phasor),
            rate: (self.rate / twice) as i32,
            is_saturated: self.is_saturated,
        };
        self.begin(end, phasor);
        block
    }

    /// Mean cosine and sine, in steps of 2⁻²²: of the parabola through both ends and the middle,
    /// exact to 1e-7 for a tenth of a turn, or of a straight line where the middle is missing.
    fn mean_phasor(&self, begun: &Point, end: &Point, last: [i32; 2]) -> [i32; 2] {
        let [first, middle] = self.phasors;
        let share = |time: u64| time.saturating_sub(begun.time).max(1) as f32;
        // Position of the middle within the block, as a fraction: one half unless samples are
        // missing.
        let place = share(self.middle_time) / share(end.time);
        let weight =
            if self.middle_time == 0 { 0.0 } else { 1.0 / (6.0 * place * (1.0 - place)).max(0.5) };
        let later = 0.5 - weight * place;
        let weights = [1.0 - weight - later, weight, later];
        [0, 1].map(|part| {
            let values = [first[part], middle[part], last[part]];
            let terms = values.iter().zip(weights).map(|(&value, weight)| value as f32 * weight);
            (terms.sum::<f32>() * EXCESS) as i32
        })
    }
}

/// Exact integer products of the signals of some blocks. They must be emptied into [`Sums`] every
/// 4096 blocks at the latest, before the 64-bit sums can overflow.
#[derive(Clone, Copy, Debug, Default)]
pub struct Products {
    /// Lower triangle of the sums of products, row by row, without the square of the rate.
    sums: [i64; PRODUCTS],
    /// Number of blocks.
    rows: u32,
    /// Whether a rate was saturated or too far from the reference, so that its products were
    /// clamped.
    pub is_clamped: bool,
}

/// Number of products of two signals, without the square of the rate, which no fit needs.
const PRODUCTS: usize = SIGNALS * (SIGNALS + 1) / 2 - 1;

impl Products {
    /// Adds a block, with the angular acceleration of the platform, rad/s². Time, gyro rate and
    /// platform rate are counted from those of a reference, so that their products stay small.
    #[inline]
    pub fn push(&mut self, block: &Block, quickening: f32, reference: &Block) {
        let rate = i64::from(block.rate) - i64::from(reference.rate);
        let turning = block.turning - reference.turning;
        let is_far = rate.abs() > FURTHEST || turning.abs().max(quickening.abs()) > FASTEST;
        self.is_clamped |= block.is_saturated || is_far;
        let milliseconds = block.time.saturating_sub(reference.time) / 1000;
        let row = [
            1,
            block.phasor[0],
            block.phasor[1],
            milliseconds.min(LONGEST) as i32,
            (turning.clamp(-FASTEST, FASTEST) * 1e6) as i32,
            (quickening.clamp(-FASTEST, FASTEST) * 1e6) as i32,
            rate.clamp(-FURTHEST, FURTHEST) as i32,
        ];
        let mut sums = self.sums.iter_mut();
        for (index, &one) in row.iter().enumerate() {
            for (&other, sum) in row[..=index].iter().zip(&mut sums) {
                *sum += i64::from(one) * i64::from(other);
            }
        }
        self.rows += 1;
    }

    /// Sums of cosine and sine over the blocks, in steps of 2⁻²².
    pub(crate) fn phasor(&self) -> [f32; 2] {
        [COSINE, SINE].map(|signal| self.sums[signal * (signal + 1) / 2] as f32)
    }
}

/// Sums of products in double precision, for a recording of any length; [`Sums::product`] gives
/// them in SI units.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    products: [f64; PRODUCTS],
    /// Number of blocks.
    pub rows: u32,
}

impl Sums {
    /// Adds the exact products of some blocks.
    pub fn absorb(&mut self, products: &Products) {
        for (sum, &product) in self.products.iter_mut().zip(&products.sums) {
            *sum += product as f64;
        }
        self.rows += products.rows;
    }

    /// Adds the sums of other blocks that have the same reference.
    pub(crate) fn add(&mut self, other: &Self) {
        for (sum, product) in self.products.iter_mut().zip(other.products) {
            *sum += product;
        }
        self.rows += other.rows;
    }

    /// Sum of the products of two signals, which must not both be the rate, in the product of their
    /// units.
    #[must_use]
    pub fn product(&self, one: usize, other: usize) -> f64 {
        let (row, column) = (one.max(other), one.min(other));
        self.products[row * (row + 1) / 2 + column] * STEPS[row] * STEPS[column]
    }

    /// Mean of a signal, in its unit; zero without blocks.
    pub(crate) fn mean(&self, signal: usize) -> f64 {
        self.product(signal, ONE) / f64::from(self.rows.max(1))
    }

    /// Normal equations of the regression of the signal `left` on all columns.
    #[must_use]
    pub fn regression(&self, left: usize) -> Regression<COLUMNS> {
        let mut products = [[0.0; COLUMNS]; COLUMNS];
        let mut with_left = [0.0; COLUMNS];
        for (row, (products, with_left)) in products.iter_mut().zip(&mut with_left).enumerate() {
            for (column, product) in products.iter_mut().enumerate().take(row + 1) {
                *product = self.product(row, column);
            }
            *with_left = self.product(row, left);
        }
        Regression::of_products(products, with_left, self.rows as usize)
    }
}

//! The Allan variance of a record of any length, while it is read (NIST SP 1065, section 5.2).
//!
//! Like the board's estimator, level k sees means over 2ᵏ samples, so that a long averaging time costs no more memory than
//! a short one; it keeps many more of them than a board can. Up to 256 samples every window is used; longer ones begin at
//! every 256th part of their length or more often, which changes a deviation by far less than its own confidence. A record is
//! rates at one period, in segments where samples are missing between them: no difference is taken across a gap.
//!
//! Windows are summed from near by, never from the beginning of the record: neither its length nor a bias that is a million
//! times the noise costs digits.

pub mod analysis;
mod level;
pub mod rest;
pub mod spike;

use orientation::noise::allan::Point;
use orientation::units::Seconds;

use crate::recording::MAX_STREAMED_ROWS;
use level::Level;

/// Windows begin at least so often in their length.
const STEPS: u64 = 256;

/// Samples in the longest window: half of the longest record.
const LONGEST: u64 = MAX_STREAMED_ROWS / 2;

/// The averaging factors 1, 2, 3, 4, 6, 8, 12, … (two to each octave, as on the board) of the longest record.
pub fn factors() -> impl Iterator<Item = u64> {
    let octaves = (1..u64::BITS - 2).flat_map(|k| [2 << k, 3 << k]);
    (1..4).chain(octaves).take_while(|factor| *factor <= LONGEST)
}

/// Sums of the overlapping Allan variance, from which it can be had at any time.
#[derive(Clone, Debug)]
pub struct Overlapping {
    levels: Vec<Level>,
}

impl Default for Overlapping {
    fn default() -> Self {
        Self::new(factors())
    }
}

impl Overlapping {
    /// Estimator of an empty record, for averaging times of so many samples each, in any order; what no
    /// record is long enough for is left out. The memory that it takes goes with the greatest odd part of a factor, not
    /// with the factor nor the record.
    #[must_use]
    pub fn new(factors: impl IntoIterator<Item = u64>) -> Self {
        let mut spans: Vec<Vec<u64>> = Vec::new();
        for factor in factors.into_iter().filter(|factor| (1..=LONGEST).contains(factor)) {
            let level = level_of(factor);
            spans.resize(spans.len().max(level as usize + 1), Vec::new());
            spans[level as usize].push(factor >> level);
        }
        Self { levels: spans.iter().map(|spans| Level::new(spans)).collect() }
    }

    /// Takes the next sample, in any unit of rate.
    pub fn push(&mut self, rate: f64) {
        if self.levels.first_mut().is_some_and(|level| level.push(rate)) {
            self.settle(false);
        }
    }

    /// Samples are missing before the next one.
    pub fn part(&mut self) {
        self.settle(true);
        self.levels.iter_mut().for_each(Level::part);
    }

    /// Sums what is held and gives the means of it to the level above; where that has room left, only if `all` is to go.
    fn settle(&mut self, all: bool) {
        let mut means = Vec::new();
        for level in &mut self.levels {
            let is_full = level.extend(&means);
            if !all && !is_full {
                return;
            }
            means = level.settle();
        }
    }

    /// Numbers that are held at present, whatever the record's length.
    #[must_use]
    pub fn held(&self) -> usize {
        self.levels.iter().map(Level::held).sum()
    }

    /// The Allan variances of what was taken, in the square of the rate's unit, at one sample each `period` s, rising in
    /// averaging time; only those that have a term.
    #[must_use]
    pub fn points(mut self, period: f64) -> Vec<Point> {
        self.settle(true);
        let levels = (0_u32..).zip(&self.levels);
        let sums = levels.flat_map(|(level, sums)| {
            let stride = f64::from(2_u32).powf(f64::from(level));
            sums.variances().map(move |(span, variance, terms)| Point {
                seconds: Seconds(span as f64 * stride * period),
                variance,
                stride: Seconds(stride * period),
                terms,
            })
        });
        let mut points: Vec<Point> = sums.collect();
        points.sort_by(|one, other| one.seconds.0.total_cmp(&other.seconds.0));
        points
    }
}

/// The level whose means a factor is made of: the highest that has whole ones in it, and enough of them.
fn level_of(factor: u64) -> u32 {
    let enough = (factor / STEPS).checked_ilog2().unwrap_or(0);
    factor.trailing_zeros().min(enough)
}

//! How the samples of a recording at rest follow each other: their period, and where some are
//! missing.
//!
//! Where samples are missing is decided while they are read, by the median of the first steps; behind the last one that
//! median is compared with the one of all. A record no longer than what it is learnt from is so judged as if it were held
//! whole.

use std::collections::BTreeMap;

use thiserror::Error;

use super::period::{Steps, median};
use super::range::Short;

/// Most gaps that are kept one by one; of the others the number and the time remain.
pub const MOST_GAPS: usize = 10_000;

/// By how much the median of the first steps may miss that of all, where it matters which is taken.
const STEADY: f64 = 0.05;

/// The times of a recording at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Spacing {
    /// Time from one sample to the next, s: the mean over consecutive samples.
    pub period_s: f64,
    /// Where samples are missing, in the order of the file: the first [`MOST_GAPS`].
    pub gaps: Vec<Gap>,
    /// How many gaps there are.
    pub gap_count: u64,
    /// Time that is missing in all of them, s.
    pub missing_s: f64,
    /// The header's rate, Hz, where it misses that of the times by more than 1 %: the times are
    /// believed.
    pub contradicted_rate_hz: Option<f64>,
}

/// Time from one sample to the next, s, beyond which it is likely to be one in milliseconds.
const LONG: f64 = 2.0;

impl Spacing {
    /// That the times are in milliseconds, as it seems.
    pub(crate) fn unit_note(&self) -> Option<String> {
        let Self { period_s, contradicted_rate_hz, .. } = self;
        // A stated rate says more than a guess, and is told with the correction.
        let is_long = *period_s > LONG && contradicted_rate_hz.is_none();
        is_long.then(|| {
            let period = Short(*period_s);
            format!(
                "t_s was read in s: the samples are {period} s apart, which is long for a gyro; if the times are in ms, divide \
                 them by 1000"
            )
        })
    }
}

/// A step that is longer than a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The row after it, from 0.
    pub row: u64,
    /// The line of that row.
    pub line: u64,
    /// When the row before was taken, s.
    pub from_s: f64,
    /// From that row to this, s.
    pub seconds: f64,
}

/// The usual step, s, of the first samples, and of all: no period holds for the whole record.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "the first samples come every {} s, but most of all every {} s; split the recording where its rate changes",
    Short(*.0), Short(*.1)
)]
pub struct Unsteady(pub f64, pub f64);

/// Finds gaps while rows are read.
#[derive(Clone, Debug)]
pub(crate) struct Spacer {
    steps: Steps,
    census: Census,
    rows: u64,
    /// Time of the row before, s.
    before_s: Option<f64>,
    gaps: Vec<Gap>,
    gap_count: u64,
    /// Sum of all gaps, s.
    gaps_s: f64,
    /// The shortest gap, s.
    shortest_s: f64,
}

impl Spacer {
    /// Spacer that goes by the median step between these times, s, which increase; `None` of fewer than two.
    pub(crate) fn learnt(times_s: impl Iterator<Item = f64> + Clone) -> Option<Self> {
        let steps = times_s.clone().skip(1).zip(times_s).map(|(time, before)| time - before);
        Some(Self {
            steps: Steps::beside(median(steps.collect())?),
            census: Census::default(),
            rows: 0,
            before_s: None,
            gaps: Vec::new(),
            gap_count: 0,
            gaps_s: 0.0,
            shortest_s: f64::INFINITY,
        })
    }

    /// Takes the next row, its line and time, s; whether samples are missing before it.
    pub(crate) fn is_apart(&mut self, line: u64, time_s: f64) -> bool {
        let before_s = self.before_s.replace(time_s);
        self.rows += 1;
        let Some(from_s) = before_s else { return false };
        let seconds = time_s - from_s;
        self.census.add(seconds);
        let is_apart = !self.steps.add(seconds);
        if is_apart {
            self.note(Gap { row: self.rows - 1, line, from_s, seconds });
        }
        is_apart
    }

    fn note(&mut self, gap: Gap) {
        self.gap_count += 1;
        self.gaps_s += gap.seconds;
        self.shortest_s = self.shortest_s.min(gap.seconds);
        if self.gaps.len() < MOST_GAPS {
            self.gaps.push(gap);
        }
    }

    /// What the times were, with the header's rate in Hz.
    ///
    /// # Errors
    /// The steps were not those that it learnt from.
    pub(crate) fn finish(self, rate_hz: Option<f64>) -> Result<Spacing, Unsteady> {
        self.check()?;
        let period_s = self.steps.mean_s();
        let contradicted_rate_hz = rate_hz.filter(|rate| self.steps.contradicted(*rate).is_some());
        let Self { gaps, gap_count, gaps_s, .. } = self;
        let missing_s = gaps_s - gap_count as f64 * period_s;
        Ok(Spacing { period_s, gaps, gap_count, missing_s, contradicted_rate_hz })
    }

    /// Refuses steps whose median is another one and would have found other gaps.
    fn check(&self) -> Result<(), Unsteady> {
        let learnt = self.steps.median_s;
        let usual = self.census.median();
        let near = (1.0 - STEADY) * usual[0]..=(1.0 + STEADY) * usual[1];
        let holds = near.contains(&learnt) || self.steps.stand(usual, self.shortest_s);
        if holds { Ok(()) } else { Err(Unsteady(learnt, usual[0])) }
    }
}

/// How many steps there were of each length, to one part of 256.
#[derive(Clone, Debug, Default)]
struct Census {
    counts: BTreeMap<u64, u64>,
    /// The length that came last, and how often since it is not in `counts`.
    latest: (u64, u64),
}

impl Census {
    /// Bits of a length that are not looked at.
    const FINER: u32 = f64::MANTISSA_DIGITS - 1 - 8;

    /// Adds a step, s, above zero.
    fn add(&mut self, step_s: f64) {
        let length = step_s.to_bits() >> Self::FINER;
        if self.latest.0 != length {
            self.settle();
            self.latest = (length, 0);
        }
        self.latest.1 += 1;
    }

    fn settle(&mut self) {
        let (length, count) = self.latest;
        *self.counts.entry(length).or_default() += count;
    }

    /// Between which lengths, s, the median lies, the lower one of two.
    fn median(&self) -> [f64; 2] {
        let mut all = self.clone();
        all.settle();
        let middle = all.counts.values().sum::<u64>().saturating_sub(1) / 2;
        let mut shorter = 0;
        let median = all.counts.iter().find(|(_, count)| {
            shorter += **count;
            shorter > middle
        });
        let length = median.map_or(0, |(length, _)| *length);
        [length, length + 1].map(|length| f64::from_bits(length << Self::FINER))
    }
}

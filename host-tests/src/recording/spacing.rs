//! How the samples of a recording at rest follow each other: their period, and where some are
//! missing.

use std::ops::Range;

use super::period::Steps;
use super::rows::StaticRow;

/// The times of a recording at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Spacing {
    /// Time from one sample to the next, s: the mean over consecutive samples.
    pub period_s: f64,
    /// Where samples are missing, in the order of the file.
    pub gaps: Vec<Gap>,
    /// The header's rate, Hz, where it misses that of the times by more than 1 %: the times are
    /// believed.
    pub contradicted_rate_hz: Option<f64>,
    rows: usize,
}

/// A step that is longer than a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The row after it, from 0.
    pub row: usize,
    /// The line of that row.
    pub line: u64,
    /// When the row before was taken, s.
    pub from_s: f64,
    /// From that row to this, s.
    pub seconds: f64,
}

impl Spacing {
    /// Spacing of rows whose times increase, with the header's rate in Hz; `None` with fewer than two
    /// rows.
    #[must_use]
    pub fn of(rows: &[StaticRow], rate_hz: Option<f64>) -> Option<Self> {
        let steps = Steps::of(rows, |row| row.time_s)?;
        let between = rows.windows(2).enumerate();
        let gaps = between.filter(|(_, pair)| !steps.is_unbroken(step(pair))).map(|(i, pair)| {
            Gap { row: i + 1, line: pair[1].line, from_s: pair[0].time_s, seconds: step(pair) }
        });
        let gaps = gaps.collect();
        let contradicted_rate_hz = rate_hz.filter(|rate| steps.contradicted(*rate).is_some());
        Some(Self { period_s: steps.mean_s(), gaps, contradicted_rate_hz, rows: rows.len() })
    }

    /// The rows between the gaps.
    pub fn segments(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let starts = std::iter::once(0).chain(self.gaps.iter().map(|gap| gap.row));
        let ends = self.gaps.iter().map(|gap| gap.row).chain([self.rows]);
        starts.zip(ends).map(|(start, end)| start..end)
    }
}

/// From one row to the next, s.
fn step(pair: &[StaticRow]) -> f64 {
    pair[1].time_s - pair[0].time_s
}

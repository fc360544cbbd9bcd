//! What many errors amount to.

use std::borrow::Borrow;
use std::fmt::Display;

use orientation::alignment::{Azimuth, Refusal, Solution, Verdict};
use serde::Serialize;

use crate::output::azimuth_error;

/// One alignment against the truth, in degrees.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// Error of the azimuth.
    pub error: f64,
    /// Standard deviation of the azimuth.
    pub sigma: f64,
    /// Cramér–Rao bound.
    pub limit: f64,
}

impl Answer {
    /// A verdict against the true azimuth.
    ///
    /// # Errors
    /// The refusal of the verdict.
    pub fn of(verdict: Verdict, truth_deg: f64) -> Result<Self, Refusal> {
        let Solution { azimuth: Azimuth { angle, sigma }, limit } = verdict?;
        let error = azimuth_error(angle.degrees(), truth_deg);
        Ok(Self { error, sigma: sigma.degrees(), limit: limit.degrees() })
    }
}

/// What many alignments amount to. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Precision {
    /// Number of runs.
    pub runs: usize,
    /// Runs that were refused; all were healthy.
    pub refused: usize,
    /// The first refusal's reason.
    pub first_reason: Option<String>,
    /// RMS of the errors.
    pub rms_deg: f64,
    /// RMS of the limits.
    pub limit_deg: f64,
    /// RMS of error over limit, run by run.
    pub ratio: f64,
    /// Per cent of errors within 1, 2 and 3 σ.
    pub coverage_percent: [f64; 3],
    /// The greatest error in its σ.
    pub worst_sigmas: f64,
}

impl Precision {
    /// Whether none was refused.
    pub(crate) fn is_complete(&self) -> bool {
        self.refused == 0
    }

    /// Summarises answers.
    pub fn of<'a, E: Display + 'a>(
        answers: impl IntoIterator<Item = &'a Result<Answer, E>, IntoIter: Clone>,
    ) -> Self {
        let answers = answers.into_iter();
        let given = answers.clone().flatten();
        let column = |of: fn(&Answer) -> f64| given.clone().map(of);
        let runs = answers.clone().count();
        Self {
            runs,
            refused: runs - given.clone().count(),
            first_reason: answers.clone().find_map(|a| a.as_ref().err()).map(ToString::to_string),
            rms_deg: rms(column(|answer| answer.error)),
            limit_deg: rms(column(|answer| answer.limit)),
            ratio: rms(column(|answer| answer.error / answer.limit)),
            coverage_percent: coverage(given.clone().map(|answer| [answer.error, answer.sigma])),
            worst_sigmas: column(|answer| (answer.error / answer.sigma).abs()).fold(0.0, f64::max),
        }
    }
}

/// Errors with their 1σ over many runs, °.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    /// RMS of the errors.
    pub rms_deg: f64,
    /// RMS of the σ that goes with them.
    pub sigma_deg: f64,
    /// Per cent of errors within 1, 2 and 3 σ.
    pub coverage_percent: [f64; 3],
}

impl Spread {
    /// Summarises pairs of an error and its σ.
    pub fn of(pairs: impl IntoIterator<Item = [f64; 2], IntoIter: Clone>) -> Self {
        let pairs = pairs.into_iter();
        Self {
            rms_deg: rms(pairs.clone().map(|[error, _]| error)),
            sigma_deg: rms(pairs.clone().map(|[_, sigma]| sigma)),
            coverage_percent: coverage(pairs),
        }
    }
}

/// Root mean square; zero of none.
pub fn rms(values: impl IntoIterator<Item = impl Borrow<f64>>) -> f64 {
    let squares = values.into_iter().map(|value| value.borrow() * value.borrow());
    let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// The greatest absolute value; one that is missing is greater than all, of none it is zero.
pub fn greatest(values: impl IntoIterator<Item = f64>) -> f64 {
    let greater = |most, value: f64| if value.abs() <= most { most } else { value.abs() };
    values.into_iter().fold(0.0, greater)
}

/// The least absolute value; not a number of none.
pub fn least(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(f64::NAN, f64::min)
}

/// Per cent of errors, each with its standard deviation, within one, two and three of these.
pub fn coverage(pairs: impl IntoIterator<Item = [f64; 2], IntoIter: Clone>) -> [f64; 3] {
    let pairs = pairs.into_iter();
    [1.0, 2.0, 3.0].map(|factor| {
        let inside = pairs.clone().filter(|[error, sigma]| error.abs() <= factor * sigma).count();
        100.0 * inside as f64 / pairs.clone().count().max(1) as f64
    })
}

/// What a normal distribution covers, per cent.
pub const NORMAL_COVERAGE: [f64; 3] = [68.27, 95.45, 99.73];

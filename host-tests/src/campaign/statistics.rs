//! What many errors amount to.

use std::fmt::Display;

use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::conclusion::Conclusion;
use serde::Serialize;

use crate::output::{azimuth_error, degrees};

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
    /// A verdict against the true azimuth; its limit, rad, where there is one.
    ///
    /// # Errors
    /// The refusal of the verdict.
    pub fn of(
        verdict: Result<Azimuth, Refusal>,
        limit: Option<f64>,
        truth_deg: f64,
    ) -> Result<Self, Refusal> {
        let azimuth = verdict?;
        let error = azimuth_error(degrees(azimuth.angle), truth_deg);
        let limit = limit.map_or(f64::NAN, degrees);
        Ok(Self { error, sigma: degrees(azimuth.sigma), limit })
    }

    /// The conclusion of a stage against the true azimuth.
    ///
    /// # Errors
    /// The refusal of the conclusion.
    pub fn of_stage(conclusion: &Conclusion, truth_deg: f64) -> Result<Self, Refusal> {
        Self::of(conclusion.verdict, conclusion.fit.as_ref().map(|fit| fit.limit), truth_deg)
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
    #[must_use]
    pub fn of<E: Display>(answers: &[Result<Answer, E>]) -> Self {
        let given: Vec<Answer> =
            answers.iter().filter_map(|answer| answer.as_ref().ok().copied()).collect();
        let column = |of: fn(&Answer) -> f64| given.iter().map(of).collect::<Vec<f64>>();
        let [errors, sigmas, limits] =
            [column(|a| a.error), column(|a| a.sigma), column(|a| a.limit)];
        Self {
            runs: answers.len(),
            refused: answers.len() - given.len(),
            first_reason: answers.iter().find_map(|a| a.as_ref().err()).map(ToString::to_string),
            rms_deg: rms(&errors),
            limit_deg: rms(&limits),
            ratio: rms(&column(|answer| answer.error / answer.limit)),
            coverage_percent: coverage(&errors, &sigmas),
            worst_sigmas: given.iter().fold(0.0, |worst, a| worst.max((a.error / a.sigma).abs())),
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
    #[must_use]
    pub fn of(pairs: &[[f64; 2]]) -> Self {
        let (errors, sigmas): (Vec<_>, Vec<_>) = pairs.iter().map(|[e, s]| (*e, *s)).unzip();
        Self {
            rms_deg: rms(&errors),
            sigma_deg: rms(&sigmas),
            coverage_percent: coverage(&errors, &sigmas),
        }
    }
}

/// Root mean square; zero of none.
#[must_use]
pub fn rms(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// The greatest absolute value; one that is missing is greater than all, of none it is zero.
#[must_use]
pub fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| if value.abs() <= most { most } else { value.abs() })
}

/// The least absolute value; not a number of none.
#[must_use]
pub fn least(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(f64::NAN, f64::min)
}

/// Per cent of errors within one, two and three of their standard deviations.
#[must_use]
pub fn coverage(errors: &[f64], sigmas: &[f64]) -> [f64; 3] {
    [1.0, 2.0, 3.0].map(|factor| {
        let pairs = errors.iter().zip(sigmas);
        let inside = pairs.filter(|(error, sigma)| error.abs() <= factor * **sigma).count();
        100.0 * inside as f64 / errors.len().max(1) as f64
    })
}

/// What a normal distribution covers, per cent.
pub const NORMAL_COVERAGE: [f64; 3] = [68.27, 95.45, 99.73];

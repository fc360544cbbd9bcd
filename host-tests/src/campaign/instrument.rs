//! The whole instrument over many drawn sites, attitudes and seeds: error against limit and σ.

use firmware::ports::NoRecorder;
use firmware::simulated::scenario::Scenario;
use hal_mock::noise::Generator;
use orientation::error::Refusal;
use rayon::prelude::*;
use serde::Serialize;

use super::statistics::{coverage, rms};
use crate::instrument::{self, RunError};
use crate::output::{azimuth_error, degrees};

/// Greatest latitude that is drawn, °.
const LATITUDE_DEG: f64 = 70.0;
/// Greatest tilt that is drawn, °.
const TILT_DEG: f64 = 5.0;
/// Sample rate of the campaign, Hz: the noise per dwell does not depend on it.
const RATE_HZ: f64 = 100.0;

/// What many runs amount to. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Precision {
    /// Runs.
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
    /// Dwells that were measured again, in all runs.
    pub repeated: usize,
    /// Accesses that a data sheet forbids, in all runs.
    pub violations: usize,
}

/// One run's outcome.
struct Outcome {
    found: Result<[f64; 3], Refusal>,
    repeated: usize,
    violations: usize,
}

/// The scenario of one seed: site, attitude and instrument drawn from it.
#[must_use]
pub fn scenario(seed: u64) -> Scenario {
    let mut chance = Generator::new(seed);
    let mut uniform = |low: f64, high: f64| low + (high - low) * chance.uniform();
    let (tilt, toward) = (uniform(0.0, TILT_DEG), uniform(0.0, core::f64::consts::TAU));
    Scenario {
        seed,
        latitude_deg: uniform(-LATITUDE_DEG, LATITUDE_DEG),
        azimuth_deg: uniform(0.0, 360.0),
        pitch_deg: tilt * libm::cos(toward),
        roll_deg: tilt * libm::sin(toward),
        start_deg: uniform(-4.0, 360.0),
        sample_rate_hz: RATE_HZ,
        ..Scenario::default()
    }
}

/// Runs seeds 1 to `runs`; `tick` after each.
///
/// # Errors
/// What keeps a run from beginning, and a deadlock.
pub fn precision(runs: usize, tick: impl Fn() + Sync) -> Result<Precision, RunError> {
    let outcomes = (1..=runs as u64).into_par_iter().map(|seed| {
        let outcome = outcome(&scenario(seed));
        tick();
        outcome
    });
    Ok(summary(&outcomes.collect::<Result<Vec<_>, _>>()?))
}

fn outcome(scenario: &Scenario) -> Result<Outcome, RunError> {
    let run = instrument::align(scenario, None, NoRecorder, &())?;
    let conclusion = run.conclusion().ok_or(RunError::Deadlock)?;
    let limit = conclusion.fit.as_ref().map_or(f64::NAN, |fit| degrees(fit.limit));
    let found = conclusion.verdict.map(|azimuth| {
        let error = azimuth_error(degrees(azimuth.angle), scenario.azimuth_deg);
        [error, degrees(azimuth.sigma), limit]
    });
    Ok(Outcome {
        found,
        repeated: run.replay.session.repetitions().len(),
        violations: run.violations.len(),
    })
}

fn summary(outcomes: &[Outcome]) -> Precision {
    let found: Vec<[f64; 3]> = outcomes.iter().filter_map(|o| o.found.ok()).collect();
    let column = |index: usize| found.iter().map(|row| row[index]).collect::<Vec<f64>>();
    let [errors, sigmas, limits] = [0, 1, 2].map(column);
    let over = |of: &[f64]| errors.iter().zip(of).map(|(e, s)| e / s).collect::<Vec<f64>>();
    Precision {
        runs: outcomes.len(),
        refused: outcomes.len() - found.len(),
        first_reason: outcomes.iter().find_map(|o| o.found.err()).map(|reason| reason.to_string()),
        rms_deg: rms(&errors),
        limit_deg: rms(&limits),
        ratio: rms(&over(&limits)),
        coverage_percent: coverage(&errors, &sigmas),
        worst_sigmas: over(&sigmas).iter().fold(0.0, |worst: f64, e| worst.max(e.abs())),
        repeated: outcomes.iter().map(|o| o.repeated).sum(),
        violations: outcomes.iter().map(|o| o.violations).sum(),
    }
}

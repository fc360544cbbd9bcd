//! The whole instrument over many drawn sites, attitudes and seeds: error against limit and σ.

pub(super) mod report;

use orientation::alignment::{Method, Refusal};
use serde::Serialize;
use simulated::scenario::Scenario;

use super::chance::Chance;
use super::statistics::{Answer, Precision};
use super::{Tick, over};
use crate::instrument::{RunError, Trial};

/// Greatest latitude that is drawn, °.
const LATITUDE_DEG: f64 = 70.0;
/// Greatest tilt that is drawn, °.
const TILT_DEG: f64 = 5.0;
/// Sample rate of the campaign, Hz: the noise per dwell does not depend on it.
const RATE_HZ: f64 = 100.0;

/// What many runs of the instrument amount to.
#[derive(Clone, Debug, Serialize)]
pub struct Runs {
    /// Errors of the runs.
    #[serde(flatten)]
    pub precision: Precision,
    /// Dwells that were measured again, in all runs.
    pub repeated: usize,
    /// Accesses that a data sheet forbids, in all runs.
    pub violations: usize,
}

/// The scenario of one seed: site, attitude and instrument drawn from it.
fn scenario(seed: u64) -> Scenario {
    let mut chance = Chance::new(seed, 0);
    let tilt = chance.between(0.0, TILT_DEG);
    let toward = chance.between(0.0, core::f64::consts::TAU);
    Scenario {
        seed,
        latitude_deg: chance.between(-LATITUDE_DEG, LATITUDE_DEG),
        azimuth_deg: chance.between(0.0, 360.0),
        pitch_deg: tilt * libm::cos(toward),
        roll_deg: tilt * libm::sin(toward),
        start_deg: chance.between(-4.0, 360.0),
        sample_rate_hz: RATE_HZ,
        ..Scenario::default()
    }
}

/// Runs seeds 1 to `runs`; `tick` after each.
///
/// # Errors
/// What keeps a run from beginning, and a deadlock.
pub fn precision(runs: usize, tick: Tick<'_>) -> Result<Runs, RunError> {
    let outcomes = over(runs, tick, |seed| outcome(&scenario(seed)));
    let outcomes = outcomes.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(Runs {
        precision: Precision::of(outcomes.iter().map(|(answer, ..)| answer)),
        repeated: outcomes.iter().map(|(_, repeated, _)| repeated).sum(),
        violations: outcomes.iter().map(|(.., violations)| violations).sum(),
    })
}

/// One run's answer, how many dwells were measured again, and how many accesses were forbidden.
fn outcome(scenario: &Scenario) -> Result<(Result<Answer, Refusal>, usize, usize), RunError> {
    let run = Trial::of(scenario).run()?;
    let session = &run.replay.session;
    let verdict = session.verdict().ok_or(RunError::Deadlock)?;
    let answer = Answer::of(verdict, scenario.azimuth_deg);
    Ok((answer, session.repetitions.len(), run.violations.len()))
}

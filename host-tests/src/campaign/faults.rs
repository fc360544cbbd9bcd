//! Every chip with every sickness: recovered with the azimuth within 5 σ, or refused with a reason.

use std::ops::RangeInclusive;

use firmware::event::Event;
use firmware::ports::NoRecorder;
use firmware::simulated::fault::Fault;
use firmware::simulated::scenario::Scenario;
use rayon::prelude::*;
use serde::Serialize;

use crate::instrument::{self, Run, RunError};
use crate::output::{azimuth_error, degrees};

/// Sample rate of the campaign, Hz.
const RATE_HZ: f64 = 100.0;
/// Error in σ beyond which an azimuth is a wrong north.
pub const WRONG_SIGMAS: f64 = 5.0;

/// The outcome that must never be.
pub const WRONG: &str = "WRONG";

/// What came of one fault.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The fault's name.
    pub fault: String,
    /// `found`, `refused`, or `WRONG` for an azimuth off by more than 5 σ.
    pub outcome: &'static str,
    /// Error in σ, where there is an azimuth.
    pub error_sigmas: Option<f64>,
    /// Why there is none.
    pub reason: Option<String>,
    /// What the board noticed first.
    pub noticed: Option<String>,
    /// Readings lost, restarts, samples missing or overflowed.
    pub faults: u32,
    /// Dwells that were measured again.
    pub repeated: usize,
    /// Dwells that were left out.
    pub left_out: usize,
    /// Virtual time until the end, s.
    pub seconds: f64,
    /// Accesses that a data sheet forbids.
    pub violations: usize,
}

/// Runs every fault with every seed; `tick` after each.
///
/// # Errors
/// What keeps a run from beginning, and a deadlock.
pub fn rows(seeds: RangeInclusive<u64>, tick: impl Fn() + Sync) -> Result<Vec<Row>, RunError> {
    let cases: Vec<(Fault, u64)> =
        seeds.flat_map(|seed| Fault::all().map(move |fault| (fault, seed))).collect();
    let rows = cases.into_par_iter().map(|(fault, seed)| {
        let row = row(fault, seed);
        tick();
        row
    });
    rows.collect()
}

fn row(fault: Fault, seed: u64) -> Result<Row, RunError> {
    let scenario = Scenario { seed, sample_rate_hz: RATE_HZ, ..Scenario::default() };
    let run = instrument::align(&scenario, Some(fault), NoRecorder, &())?;
    let conclusion = run.conclusion().ok_or(RunError::Deadlock)?;
    let error = conclusion.verdict.ok().map(|azimuth| {
        azimuth_error(degrees(azimuth.angle), scenario.azimuth_deg) / degrees(azimuth.sigma)
    });
    Ok(Row {
        fault: fault.to_string(),
        outcome: match error {
            None => "refused",
            Some(sigmas) if sigmas.abs() > WRONG_SIGMAS => WRONG,
            Some(_) => "found",
        },
        error_sigmas: error,
        reason: conclusion.verdict.err().map(|reason| reason.to_string()),
        noticed: noticed(&run),
        faults: run.health.faults(),
        repeated: run.replay.session.repetitions().len(),
        left_out: conclusion.disturbances.iter().filter(|why| why.is_some()).count(),
        seconds: run.seconds,
        violations: run.violations.len(),
    })
}

/// The first event that tells of something wrong.
fn noticed(run: &Run) -> Option<String> {
    let is_wrong = |event: &&Event| {
        !matches!(
            event,
            Event::Begun { .. }
                | Event::Started(_)
                | Event::BaseStill(_)
                | Event::BaseSways(..)
                | Event::Homing(_)
                | Event::Homed(..)
                | Event::Turning(..)
                | Event::Arrived(..)
                | Event::Levelled(..)
                | Event::Dwelled(..)
                | Event::Concluded(..)
        )
    };
    run.events.iter().map(|(_, event)| event).find(is_wrong).map(ToString::to_string)
}

//! The host's own runs of what the image `emulator` runs.

use std::cell::RefCell;

use firmware::ports::NoRecorder;
use firmware::simulated::fault::Injection;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::TurntableScenario;
use firmware::simulated::vehicle::{BRIEF, VehicleScenario};
use orientation::alignment::rotating::turn::Stretch;

use super::outcome::Outcome;
use crate::instrument::{self, RunError};

/// What the run of a scenario finds here.
///
/// # Errors
/// Where it comes to no end.
pub fn outcome(scenario: &Scenario) -> Result<Outcome, String> {
    let run = instrument::align(scenario, None, NoRecorder, &()).map_err(|error| failed(&error))?;
    let conclusion = run.conclusion().ok_or(NOTHING)?;
    let dwells = run.replay.session.dwells().iter().map(Into::into);
    Ok(Outcome::of(scenario.seed, &conclusion.verdict, dwells))
}

/// Runs a platform that turns all the time on the host.
///
/// # Errors
/// Where it comes to no end.
pub fn turning(scenario: &TurntableScenario) -> Result<Outcome, String> {
    let run = instrument::align_turning(scenario, None, NoRecorder, &())
        .map_err(|error| failed(&error))?
        .run;
    let conclusion = run.replay.conclusion().ok_or(NOTHING)?;
    let stretches = run.replay.turn_accumulator().stretches().iter();
    let turns = stretches.flat_map(Stretch::turns).map(Into::into);
    Ok(Outcome::of(scenario.base.seed, &conclusion.verdict, turns))
}

/// Runs a vehicle that goes from stop to stop on the host.
///
/// # Errors
/// Where it comes to no end.
pub fn stops(scenario: &VehicleScenario) -> Result<Outcome, String> {
    let healthy = Injection::NONE;
    let board = RefCell::new(scenario.board(&BRIEF, &[], &healthy));
    let run = instrument::align_stops_on(&board, &healthy, scenario, NoRecorder, &(), ())
        .map_err(|error| failed(&error))?
        .run;
    let conclusion = run.replay.conclusion().ok_or(NOTHING)?;
    let stops = run.replay.stops().iter().map(Into::into);
    let kept = run.reports.iter().map(Into::into);
    Ok(Outcome::of(scenario.base.seed, &conclusion.verdict, stops.chain(kept)))
}

const NOTHING: &str = "the host's run found nothing";

fn failed(error: &RunError) -> String {
    format!("the host's run: {error}")
}

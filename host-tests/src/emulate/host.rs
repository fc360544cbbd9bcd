//! The host's own run of what the image `emulator` runs.

use firmware::ports::NoRecorder;
use firmware::simulated::scenario::Scenario;

use super::outcome::Outcome;
use crate::instrument;

/// What the run of a scenario finds here.
///
/// # Errors
/// Where it comes to no end.
pub fn outcome(scenario: &Scenario) -> Result<Outcome, String> {
    let run = instrument::align(scenario, None, NoRecorder, &())
        .map_err(|error| format!("the host's run: {error}"))?;
    let conclusion = run.conclusion().ok_or("the host's run found nothing")?;
    Ok(Outcome::of(scenario.seed, conclusion, run.replay.session.dwells()))
}

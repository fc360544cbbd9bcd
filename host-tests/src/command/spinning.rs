//! `meridian run --method spin`: the board on a body in fast rotation.

use std::path::Path;
use std::time::Instant as WallClock;

use bench::instrument::Run;
use bench::instrument::kept::Kept;
use bench::instrument::spinning::{SpinRun, follow_spin};
use bench::outcome::Finished;
use bench::outcome::run::RunDetails;
use bench::output::progress::Progress;
use bench::recording::Truth;
use bench::spin::{Known, Replay, follow};
use clap::Args;
use firmware::event::Event;
use firmware::simulated::fault::Fault;
use firmware::simulated::spin::{SAMPLE_RATE, SpinScenario};
use firmware::spin::Flight;
use orientation::units::DEGREE;

use super::run::Terminal;
use super::{Shown, Told};

/// What a flight is asked for.
#[derive(Args, Clone, Debug)]
pub struct SpinningOptions {
    /// With --method spin: seconds for which the roll is followed (2).
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    flight_seconds: Option<f64>,
    /// With --method spin: turns a second (100).
    #[arg(long, value_name = "TURNS", value_parser = turns)]
    turns_per_second: Option<f64>,
}

/// A time of flight.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.5..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("not a number of seconds from 0.5 to 60".to_owned()),
    }
}

/// A spin within what the gyro measures.
fn turns(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(turns) if (20.0..=105.0).contains(&turns) => Ok(turns),
        _ => Err("not a number of turns a second from 20 to 105".to_owned()),
    }
}

impl SpinningOptions {
    /// The scenario of a seed.
    pub fn scenario(&self, seed: u64) -> SpinScenario {
        let usual = SpinScenario::default();
        SpinScenario {
            seed,
            seconds: self.flight_seconds.unwrap_or(usual.seconds),
            turns_per_s: self.turns_per_second.unwrap_or(usual.turns_per_s),
            ..usual
        }
    }
}

/// What the pages and blocks call it.
const NAME: &str = "the simulated flight";
/// What a simulated board is told.
const ASSUMED: &str = "what the board is told of its gyros";

/// Greatest 1σ of a roll that is one, rad: 10°, as a replay has it.
const REQUIRED_SIGMA: f64 = 10.0 * DEGREE;

/// Runs the board and tells what came of it.
pub fn run(
    scenario: &SpinScenario,
    fault: Option<Fault>,
    report: Option<&Path>,
    as_json: bool,
) -> Result<Told, String> {
    let begun = WallClock::now();
    let watch = Terminal(Progress::new(0, "samples"));
    let flown = follow_spin(scenario, fault, &watch);
    watch.0.finish();
    let SpinRun { run, samples, rolls_rad, .. } = flown.map_err(|error| error.to_string())?;
    let details = RunDetails::of(&run, &Kept::default(), SAMPLE_RATE, begun.elapsed());
    let assumed = vec![ASSUMED.to_owned()];
    let known = Known { setting: scenario.setting(), required_sigma: REQUIRED_SIGMA, assumed };
    let replay = Replay { ended: ended(&run), ..follow(&samples, known) };
    let truth = Truth { roll_rad: rolls_rad, ..Truth::default() };
    let outcome = replay.outcome(&truth).of_run(scenario.seed, details);
    let finished = &replay;
    Shown { name: NAME, outcome, finished, truth: &truth, body: None }.told(report, as_json)
}

/// Why the board gave the roll up, if it did: what it had by then is none of the end.
fn ended(run: &Run<Flight>) -> Option<String> {
    run.events.iter().find_map(|(_, event)| match event {
        Event::RollEnded(_) => Some(event.to_string()),
        _ => None,
    })
}

//! `meridian run spin`: the board on a body in fast rotation.

use clap::Args;
use host::instrument::Trial;
use host::instrument::recorder::Recorded as _;
use host::methods::asked::REQUIRED_SIGMA;
use host::methods::spin::{Replay, follow};
use host::outcome::run::{OfPlatform, RunDetails};
use host::recording::GIVEN;
use orientation::roll::Progress;
use simulated::spin::{SAMPLE_RATE, SpinScenario};

use super::options::{COURSE, Common, number, seconds};
use super::terminal::FLIGHT;
use super::{Begun, Ran, Shown, Simulated, Terminal};

/// What is asked of a flight.
#[derive(Args, Clone, Debug)]
pub struct SpinOptions {
    /// Seconds for which the roll is followed (2).
    #[arg(long, value_name = "SECONDS", value_parser = seconds(0.5..=60.0), help_heading = COURSE)]
    flight_seconds: Option<f64>,
    /// Turns a second (100).
    #[arg(long, value_name = "TURNS", value_parser = number(20.0..=105.0, "a number of turns a second"), help_heading = COURSE)]
    turns_per_second: Option<f64>,
    #[command(flatten)]
    pub(super) common: Common,
}

impl Simulated for SpinOptions {
    fn run(&self, begun: &Begun) -> Result<Ran, String> {
        let Begun { fault, manner, record } = begun;
        let usual = SpinScenario::default();
        let scenario = SpinScenario {
            seed: self.common.seed,
            seconds: self.flight_seconds.unwrap_or(usual.seconds),
            turns_per_s: self.turns_per_second.unwrap_or(usual.turns_per_s),
            ..usual
        };
        let (run, wall) =
            Terminal::watching((*manner, FLIGHT, scenario.seconds), &None, |watch| {
                Trial::of(&scenario).fault(*fault).watch(watch).run()
            })?;
        let written = Common::write(record.as_ref(), &scenario, &run, (&run.truth.samples, None));
        let (_, truth) = scenario.end_of(&run);
        let assumed = vec![GIVEN.to_owned()];
        let ended = run.ended().map(|reason| Progress::Ended(reason).to_string());
        let replay = follow(&run.truth.samples, scenario.setting(), REQUIRED_SIGMA, assumed);
        let finished = Box::new(Replay { ended, ..replay });
        let details = RunDetails::of(&run, SAMPLE_RATE, wall, OfPlatform::default());
        let shown = Shown { name: "the simulated flight", finished, truth, body: None };
        Ok(Ran { shown, details, written })
    }
}

//! The runs of the image `emulator`: what each is called, what a sample may take in it, and the same
//! run on the host.

use firmware::budget;
use orientation::signal::{InertialSample, Sample, SpinSample};
use simulated::fault::Injection;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::spin::SpinScenario;
use simulated::trace::Trace;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::{BRIEF, Day, VehicleScenario};

use super::outcome::Outcome;
use crate::instrument::{Carrier, Run, Trial, VehiclePlan};
use crate::methods::stepwise::Replay;

/// A run of the image.
#[derive(Debug)]
pub struct Job {
    /// The word by which it is requested.
    pub word: &'static str,
    /// What its figures are counted over.
    pub title: &'static str,
    /// Instructions that a sample may take in the whole instrument.
    pub sample_budget: Option<u64>,
    /// Whether a gyro at the highest sample rate must leave the core idle for most of the time.
    pub is_idle: bool,
    /// The same run on the host, by its seed.
    pub on_host: fn(u64) -> Result<Outcome, String>,
}

/// The run of which the azimuth is printed.
pub static STAGE: Job = Job {
    word: "stage",
    title: "from dwell to dwell at 400 Hz, on a stage",
    sample_budget: None,
    is_idle: false,
    on_host: |seed| outcome(Trial::of(&Scenario::usual(seed)), of_stage),
};

/// A run at the highest sample rate.
pub static BRIEF_STAGE: Job = Job {
    word: "brief",
    title: "from dwell to dwell at 2400 Hz, on a stage",
    sample_budget: Some(budget::SAMPLE_INSTRUCTIONS),
    is_idle: true,
    on_host: |seed| outcome(Trial::of(&Scenario::brief(seed)), of_stage),
};

/// The run that learns the noise of its gyro and plans by it.
pub static SURVEY: Job = Job {
    word: "survey",
    title: "from dwell to dwell at 100 Hz, after a survey of two minutes",
    sample_budget: None,
    is_idle: false,
    on_host: |seed| outcome(Trial::of(&Scenario::surveying(seed)), of_stage),
};

/// A run on two frames.
pub static TWO_FRAME: Job = Job {
    word: "two-frame",
    title: "from dwell to dwell at 2400 Hz, on a two-frame mount",
    sample_budget: Some(budget::FRAMES_SAMPLE_INSTRUCTIONS),
    is_idle: false,
    on_host: |seed| outcome(Trial::of(&FramesScenario::brief(seed)), of_stage),
};

/// A run on a turntable.
pub static TURNTABLE: Job = Job {
    word: "turntable",
    title: "from turn to turn at 2400 Hz, on a turntable",
    sample_budget: Some(budget::TURNING_SAMPLE_INSTRUCTIONS),
    is_idle: true,
    on_host: |seed| {
        outcome(Trial::of(&TurntableScenario::brief(seed)), |run| {
            Outcome::of::<Sample>(&run.replay, &[])
        })
    },
};

/// A run in a vehicle, with what it keeps afterwards.
pub static VEHICLE: Job = Job {
    word: "vehicle",
    title: "from stop to stop at 50 Hz, in a vehicle",
    sample_budget: Some(budget::STOPS_SAMPLE_INSTRUCTIONS),
    is_idle: false,
    on_host: |seed| {
        let scenario = VehicleScenario::brief(seed);
        let day = Day { legs: BRIEF.into_iter().collect(), ..scenario.day(None) };
        let plan = VehiclePlan { day, chips: Injection::NONE };
        outcome(Trial::of(&scenario).plan(plan), |run| {
            let kept: Vec<_> = run.reports.iter().map(|report| report as &dyn Trace).collect();
            Outcome::of::<InertialSample>(&run.replay, &kept)
        })
    },
};

/// A flight of a spinning body.
pub static SPIN: Job = Job {
    word: "spin",
    title: "over a flight at 14.4 kHz, on a spinning body",
    sample_budget: Some(budget::SPIN_SAMPLE_INSTRUCTIONS),
    is_idle: false,
    on_host: |seed| {
        outcome(Trial::of(&SpinScenario::brief(seed)), |run| {
            Outcome::of::<SpinSample>(&run.replay, &[])
        })
    },
};

/// All runs, in the order in which they are made.
pub static JOBS: [&Job; 7] =
    [&STAGE, &BRIEF_STAGE, &SURVEY, &TWO_FRAME, &TURNTABLE, &VEHICLE, &SPIN];

/// What came of a run on the host.
fn outcome<C: Carrier>(trial: Trial<'_, C>, of: fn(&C::Run) -> Outcome) -> Result<Outcome, String> {
    trial.run().map(|run| of(&run)).map_err(|error| format!("the host's run: {error}"))
}

fn of_stage<T>(run: &Run<Replay, T>) -> Outcome {
    Outcome::of::<Sample>(&run.replay.session, &[])
}

//! A flat gyro on an uneven platform: the error after each stage of compensation, and what noise leaves
//! of it.

use std::f64::consts::TAU;

use orientation::alignment::rotating::Sensor;
use orientation::units::{Radians, RadiansPerSecond, Seconds};
use serde::Serialize;

use super::world::{Integrating, World};
use super::{Solved, solve};
use crate::campaign::statistics::{Precision, greatest, rms};
use crate::campaign::{Tick, azimuth_deg, one_by_one, over};
use crate::output::azimuth_error;

/// Speed, turns a second: that of the last figure of MET 2018.
pub const TURN_HZ: f64 = 0.137;
/// Time each way, s.
pub const SECONDS: f64 = 200.0;
/// Angle random walks, °/√h: one that shows what is left of the errors, and a realistic one.
pub const WALKS: [f64; 2] = [0.000_2, 0.02];
/// An integrated g-sensitivity that cancels between the senses, over the horizontal Earth rate.
const RATIO: f64 = 0.004;

/// What the solver is given about such a gyro: no more than what size the part may have that cancels, rad/s.
const SENSOR: Sensor = Sensor {
    is_flat: true,
    molecular_sigma: RadiansPerSecond(RATIO * TAU * TURN_HZ),
    settle_seconds: Seconds(1.0),
};

/// The stages in their order.
pub const STAGES: [&str; 4] = ["raw", "without unevenness", "both senses", "everything"];

/// What one stage leaves, over many runs, °.
#[derive(Clone, Debug, Serialize)]
pub struct Stage {
    /// The stage.
    pub stage: &'static str,
    /// RMS error.
    pub rms_deg: f64,
    /// Greatest absolute error.
    pub greatest_deg: f64,
}

/// Many runs with one gyro.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// N of the gyro, °/√h.
    pub n_deg_sqrt_h: f64,
    /// What each stage leaves.
    pub stages: Vec<Stage>,
    /// The azimuths in the end, against limit and σ.
    #[serde(flatten)]
    pub precision: Precision,
    /// The raw error of each run, °, over where the gear is quickest as it acts, from the azimuth, °.
    #[serde(skip)]
    pub raw: Vec<(f64, f64)>,
}

/// One run: where the unevenness acts, and the error after each stage, °.
struct Run {
    acts_deg: f64,
    errors_deg: Option<[f64; 4]>,
    solved: Solved,
}

/// Runs seeds 1 to `runs` with each gyro; `tick` after each.
#[must_use]
pub fn rows(runs: usize, tick: Tick<'_>) -> Vec<Row> {
    one_by_one(WALKS, tick, |n| row(n, runs, tick))
}

fn row(n_deg_sqrt_h: f64, runs: usize, tick: Tick<'_>) -> Row {
    let runs = over(runs, tick, |seed| run(n_deg_sqrt_h, seed));
    let raw = |run: &Run| Some((run.acts_deg, run.errors_deg?[0]));
    Row {
        n_deg_sqrt_h,
        stages: (0..STAGES.len()).map(|index| stage(index, &runs)).collect(),
        precision: Precision::of(runs.iter().map(|run| &run.solved.answer)),
        raw: runs.iter().filter_map(raw).collect(),
    }
}

fn stage(index: usize, runs: &[Run]) -> Stage {
    let errors = runs.iter().filter_map(|run| Some(run.errors_deg?[index]));
    Stage { stage: STAGES[index], rms_deg: rms(errors.clone()), greatest_deg: greatest(errors) }
}

/// The world of a seed: azimuths fill the circle evenly, the rest is drawn.
pub(super) fn world(n_deg_sqrt_h: f64, seed: u64) -> World {
    World {
        n_deg_sqrt_h,
        azimuth_deg: azimuth_deg(seed),
        molecular: Some(
            Integrating { ratio: RATIO, toward_deg: 0.0, lag_deg: 0.0, speed_hz: TURN_HZ }.sensor(),
        ),
        ..World::drawn(seed, &[], 0.0)
    }
}

fn run(n_deg_sqrt_h: f64, seed: u64) -> Run {
    let world = world(n_deg_sqrt_h, seed);
    let solved = solve(&world, SENSOR, &[TURN_HZ], SECONDS, seed);
    // The misalignment's sine is negative: what is quickest acts as slowest. Its phasor is conjugate.
    let acts_deg = azimuth_error(180.0 - world.quickest_deg, world.azimuth_deg);
    let error = |stage: Radians| azimuth_error(stage.degrees(), world.azimuth_deg);
    let errors_deg = solved.fit.map(|fit| {
        let stages = fit.stages;
        [stages.raw, stages.misalignment, stages.senses, stages.full].map(error)
    });
    Run { acts_deg, errors_deg, solved }
}

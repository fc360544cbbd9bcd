//! Dynamic north finding by simulation: papers/004 with the figures of equations.md §4.

pub mod molecular;
pub mod motor;
pub mod refusals;
pub mod stages;
pub mod world;

use std::f64::consts::TAU;

use orientation::align::rotating::solution::Fit;
use orientation::align::rotating::{Sensor, Setting};
use orientation::align::setting::Setting as Common;
use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::noise::model::GyroNoise;
use orientation::session::rotating::{Procedure, Session};
use orientation::units::DEGREE_PER_HOUR;

use serde_json::json;

use self::world::{LATITUDE_DEG, World};
use super::statistics::{Answer, Precision};
use super::{Asked, Campaign, Done, Tick, over, tenth, unless};
use crate::methods::rotating::follow;
use crate::output::campaign;

/// The stages of compensation, molecular-electronic sensors, and what must be refused.
pub(super) const CAMPAIGN: Campaign = Campaign {
    name: "rotating",
    meaning: "A platform that turns all the time (MET 2018), its errors and what is done about each",
    runs: 500,
    takes: &[],
    steps: "alignments",
    count: |asked| {
        let tables = stages::WALKS.len() + molecular::COUNT;
        tables * asked.runs + refusals::COUNT * tenth(asked.runs)
    },
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where no healthy run was refused and no north was wrong.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let stages = stages::rows(asked.runs, tick);
    let molecular = molecular::rows(asked.runs, tick);
    let refusals = refusals::rows(tenth(asked.runs), tick);
    let sensors = molecular.iter().map(|row| &row.precision);
    let mut healthy = stages.iter().map(|row| &row.precision).chain(sensors);
    let found = healthy.all(Precision::is_complete) && refusals.iter().all(|row| row.wrong == 0);
    Done {
        report: campaign::rotating::report(&stages, &molecular, &refusals),
        refusal: unless(found, "a healthy run was refused, or a north was wrong"),
        object: json!({ "stages": stages, "molecular": molecular, "refusals": refusals }),
    }
}

/// Golden angle, °: azimuths of successive seeds fill the circle evenly.
const GOLDEN_ANGLE_DEG: f64 = 137.507_764;
/// By how much a number of turns may miss a whole one for rounding.
const WHOLE: f64 = 1e-9;
/// Time for level, uneven turns and changes of speed, s.
const SPARE: f64 = 600.0;
/// What a solver is told of a gyro without noise, °/√h: less than any.
const LEAST_WALK: f64 = 0.000_2;

/// What a session made of a world.
#[derive(Clone, Copy, Debug)]
pub struct Solved {
    /// The azimuth against the truth, or why there is none.
    pub answer: Result<Answer, Refusal>,
    /// The fit, where there is one.
    pub fit: Option<Fit>,
}

/// Turns a world's platform as a session wants it: at these speeds in turns a second, so many seconds each
/// way in all, shared between the speeds as the session does.
#[must_use]
pub fn solve(world: &World, sensor: Sensor, speeds_hz: &[f64], seconds: f64, seed: u64) -> Solved {
    let speeds: Vec<f64> = speeds_hz.iter().map(|speed| TAU * speed).collect();
    let slowest = speeds_hz.iter().copied().fold(f64::INFINITY, f64::min);
    let squares: f64 = speeds_hz.iter().map(|speed| speed * speed).sum();
    let mut procedure = Procedure::new(&speeds, 1.0 / world::RATE_HZ);
    procedure.turns = (seconds * slowest * slowest / squares * slowest + WHOLE) as u32;
    let session = setting(world, sensor).and_then(|setting| Session::new(setting, procedure).ok());
    let Some(mut session) = session else { return Solved::NONE };
    world.obey(&mut session, 2.0 * seconds + SPARE, seed);
    Solved::of(&session, world)
}

/// Turns a world's platform by its own segments, and follows it.
#[must_use]
pub fn follow_world(world: &World, sensor: Sensor, seed: u64) -> Solved {
    let session = setting(world, sensor)
        .and_then(|setting| follow(setting, &world.rows(seed), 1.0 / world::RATE_HZ).ok());
    session.map_or(Solved::NONE, |session| Solved::of(&session, world))
}

impl Solved {
    /// Where a session could not even begin.
    const NONE: Self = Self { answer: Err(Refusal::TimeExhausted), fit: None };

    fn of(session: &Session, world: &World) -> Self {
        let conclusion = session.conclusion();
        let verdict = conclusion.map_or(Err(Refusal::TimeExhausted), |found| found.verdict);
        let fit = conclusion.and_then(|found| found.fit);
        let answer = Answer::of(verdict, fit.map(|fit| fit.limit), world.azimuth_deg);
        Self { answer, fit }
    }
}

fn setting(world: &World, sensor: Sensor) -> Option<Setting> {
    let walk = world.n_deg_sqrt_h.max(LEAST_WALK);
    let common = Common {
        noise: GyroNoise::from_field_units(walk, 0.0, 0.0, 0.0),
        white_known: true,
        g_sensitivity: world.g_sensitivity_deg_h_g.map(|part| part * DEGREE_PER_HOUR),
        ..Common::at(Latitude::from_degrees(LATITUDE_DEG)?)
    };
    Some(Setting::new(common, sensor))
}

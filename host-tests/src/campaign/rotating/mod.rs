//! Dynamic north finding by simulation: the study of a molecular-electronic sensor on a turning platform (MET 2018), its formulas derived anew.

pub mod molecular;
pub mod motor;
pub mod refusals;
pub(super) mod report;
pub mod stages;
pub mod world;

use std::f64::consts::TAU;

use orientation::alignment::rotating::session::{Procedure, Session};
use orientation::alignment::rotating::solution::Fit;
use orientation::alignment::rotating::{Sensor, Setting};
use orientation::alignment::site::Site;
use orientation::alignment::{Method, Refusal};
use orientation::units::{GSensitivity, RadiansPerSecond, Seconds};

use self::world::{LATITUDE_DEG, World};
use super::site;
use super::statistics::Answer;
use crate::methods::rotating::follow;

/// By how much a number of turns may miss a whole one for rounding.
const WHOLE: f64 = 1e-9;
/// Time for level, rate-modulated turns and changes of speed, s.
const SPARE: f64 = 600.0;
/// What a solver is given about a gyro without noise, °/√h: less than any.
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
fn solve(world: &World, sensor: Sensor, speeds_hz: &[f64], seconds: f64, seed: u64) -> Solved {
    let speeds: Vec<_> = speeds_hz.iter().map(|speed| RadiansPerSecond(TAU * speed)).collect();
    let slowest = speeds_hz.iter().copied().fold(f64::INFINITY, f64::min);
    let squares: f64 = speeds_hz.iter().map(|speed| speed * speed).sum();
    let mut procedure = Procedure::new(&speeds, Seconds(1.0 / world::RATE_HZ));
    procedure.turns = (seconds * slowest * slowest / squares * slowest + WHOLE) as u32;
    let Ok(mut session) = Session::new(setting(world, sensor), procedure) else {
        return Solved::NONE;
    };
    world.obey(&mut session, 2.0 * seconds + SPARE, seed);
    Solved::of(&session, world)
}

/// Turns a world's platform by its own segments, and follows it.
fn follow_world(world: &World, sensor: Sensor, seed: u64) -> Solved {
    let session = follow(setting(world, sensor), &world.rows(seed), 1.0 / world::RATE_HZ);
    session.map_or(Solved::NONE, |session| Solved::of(&session, world))
}

impl Solved {
    /// Where a session could not even begin.
    const NONE: Self = Self { answer: Err(Refusal::TimeExhausted), fit: None };

    fn of(session: &Session, world: &World) -> Self {
        let verdict = session.verdict().unwrap_or(Err(Refusal::TimeExhausted));
        let fit = session.conclusion().and_then(|found| found.fit);
        Self { answer: Answer::of(verdict, world.azimuth_deg), fit }
    }
}

fn setting(world: &World, sensor: Sensor) -> Setting {
    let walk = world.n_deg_sqrt_h.max(LEAST_WALK);
    let site = Site {
        g_sensitivity: world.g_sensitivity_deg_h_g.map(GSensitivity::from_degrees_per_hour),
        ..site(LATITUDE_DEG, [walk, 0.0, 0.0, 0.0])
    };
    Setting::new(site, sensor)
}

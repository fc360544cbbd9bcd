//! Platforms that do not turn as they should, and sensors that do not feel what they should: each is
//! refused with its reason, or gives a north that holds.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use hal_mock::disturbance::Disturbance;
use hal_mock::turntable::{EncoderSlip, Segment};
use orientation::alignment::rotating::Sensor;
use serde::Serialize;

use super::stages::{SECONDS, TURN_HZ};
use super::world::World;
use super::{Solved, follow_world};
use crate::campaign::faults::WRONG_SIGMAS;
use crate::campaign::statistics::Answer;
use crate::campaign::{Tick, one_by_one, over};

/// Angle random walk of the gyro, °/√h.
const WALK: f64 = 0.002;
/// Before this the rate-modulated stretch is over, and the first even turns, s.
const LATER: f64 = 160.0;

/// Something that goes wrong: its name, and what it does to a world.
type Case = (&'static str, fn(&mut World));

/// What came of one case, over many runs.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What went wrong.
    pub case: &'static str,
    /// Number of runs.
    pub runs: usize,
    /// Runs that were refused.
    pub refused: usize,
    /// Runs whose azimuth is off by more than 5 σ: there must be none.
    pub wrong: usize,
    /// The reason that was given most often.
    pub reason: Option<String>,
    /// How often that reason was given.
    pub reason_given: usize,
}

/// Every case with seeds 1 to `runs`; `tick` after each run.
#[must_use]
pub fn rows(runs: usize, tick: Tick<'_>) -> Vec<Row> {
    one_by_one(&CASES, tick, |case| row(case, runs, tick))
}

/// How many cases there are.
pub const COUNT: usize = CASES.len();

fn row((name, spoil): &Case, runs: usize, tick: Tick<'_>) -> Row {
    let solved = over(runs, tick, |seed| {
        let mut world = World { n_deg_sqrt_h: WALK, ..World::drawn(seed, &[TURN_HZ], SECONDS) };
        spoil(&mut world);
        follow_world(&world, Sensor::GYRO, seed)
    });
    let (reason, reason_given) = most_given(&solved);
    Row {
        case: name,
        runs: solved.len(),
        refused: solved.iter().filter(|run| run.answer.is_err()).count(),
        wrong: solved.iter().filter(|run| is_wrong(run)).count(),
        reason,
        reason_given,
    }
}

fn is_wrong(run: &Solved) -> bool {
    let is_right = |answer: Answer| answer.error.abs() <= WRONG_SIGMAS * answer.sigma;
    run.answer.is_ok_and(|answer| !is_right(answer))
}

/// The reason that was given most often, its numbers apart, in the words of its first run.
fn most_given(solved: &[Solved]) -> (Option<String>, usize) {
    let mut reasons: BTreeMap<String, (String, usize)> = BTreeMap::new();
    for reason in solved.iter().filter_map(|run| run.answer.err()) {
        let text = reason.to_string();
        let words: String = text.chars().filter(|letter| letter.is_alphabetic()).collect();
        reasons.entry(words).or_insert((text, 0)).1 += 1;
    }
    let most = reasons.into_values().max_by_key(|(_, count)| *count);
    most.map_or((None, 0), |(text, count)| (Some(text), count))
}

/// The last stretch, which is counter-clockwise.
fn last(world: &mut World, of: impl Fn(Segment) -> Vec<Segment>) {
    let segment = world.segments.pop();
    world.segments.extend(segment.into_iter().flat_map(of));
}

const CASES: [Case; 11] = [
    ("counter-clockwise 2 % faster", |world| faster(world, 1.02)),
    ("counter-clockwise 10 % faster", |world| faster(world, 1.1)),
    ("platform never turns back", |world| world.segments.truncate(2)),
    ("platform stops on the way back", |world| {
        last(world, |segment| {
            let moving = Segment { seconds: 1.5 / TURN_HZ, ..segment };
            vec![moving, Segment::steady(0.0, SECONDS - moving.seconds)]
        });
    }),
    ("platform stands", |world| world.segments = vec![Segment::steady(0.0, 300.0)]),
    ("half a turn each way", |world| {
        for segment in world.segments.iter_mut().skip(1) {
            segment.seconds = 0.5 / TURN_HZ;
        }
    }),
    ("encoder slips by 2°", |world| {
        world.slip = EncoderSlip { from_s: LATER, by_rad: TAU / 180.0, rad_per_s: 0.0 }
    }),
    ("encoder creeps by 10° a minute", |world| {
        world.slip = EncoderSlip { from_s: LATER, by_rad: 0.0, rad_per_s: TAU / 2160.0 }
    }),
    ("accelerometer saturated from the start", |world| saturate(world, 0.0, 600.0)),
    ("accelerometer saturated later on", |world| saturate(world, LATER, 600.0)),
    ("accelerometer saturated for 3 s", |world| saturate(world, LATER, 3.0)),
];

fn faster(world: &mut World, factor: f64) {
    last(world, |segment| vec![Segment { rate_rad_s: factor * segment.rate_rad_s, ..segment }]);
}

fn saturate(world: &mut World, start_s: f64, seconds: f64) {
    let force_m_s2 = [100.0, 0.0, 0.0];
    world.disturbances.push(Disturbance { start_s, seconds, force_m_s2, ..Disturbance::default() });
}

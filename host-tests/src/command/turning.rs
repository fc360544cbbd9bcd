//! `meridian run --method rotating`: the board on a platform that turns all the time.

use std::path::Path;
use std::time::Instant as WallClock;

use bench::instrument::{TurntableRun, align_turning};
use bench::output::progress::Progress;
use bench::output::text;
use bench::output::{page, rotating as told};
use bench::rotating::Replay;
use bench::rotating::recorder::RowRecorder;
use clap::{Args, ValueEnum};
use firmware::simulated::fault::Fault;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::TurntableScenario;

use super::Told;
use super::run::{Terminal, object};

/// What a platform that turns all the time is asked for.
#[derive(Args, Clone, Debug)]
pub struct TurningOptions {
    /// With --method rotating: the sensor (gyro).
    #[arg(long, value_enum)]
    sensor: Option<Sensor>,
    /// With --method rotating: one or two speeds in turns a second (0.137; of met 0.1,0.2).
    #[arg(long, value_name = "HERTZ[,HERTZ]", value_parser = speeds)]
    speeds: Option<[f64; 2]>,
    /// With --method rotating: whole turns each way at the slowest speed.
    #[arg(long, value_parser = clap::value_parser!(u32).range(2..=1000))]
    turns: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Sensor {
    /// A gyro, by --gyro.
    Gyro,
    /// A molecular-electronic sensor, whose gain, lag and g-sensitivity nobody knows.
    Met,
}

/// The slowest and the quickest turn that the stage holds, Hz.
const SPEEDS: std::ops::RangeInclusive<f64> = 0.02..=0.5;

/// One or two different speeds, the second zero where there is one.
fn speeds(text: &str) -> Result<[f64; 2], String> {
    let speed = |text: &str| match text.parse::<f64>() {
        Ok(speed) if SPEEDS.contains(&speed) => Ok(speed),
        _ => Err(format!("not a speed from {} to {} Hz", SPEEDS.start(), SPEEDS.end())),
    };
    let Some((first, second)) = text.split_once(',') else { return Ok([speed(text)?, 0.0]) };
    let both = [speed(first)?, speed(second)?];
    let alike = (both[0] / both[1]).max(both[1] / both[0]) < LEAST_RATIO;
    if alike { Err("two speeds must be apart by a fifth at least".to_owned()) } else { Ok(both) }
}

/// Speeds closer than this tell nothing apart.
const LEAST_RATIO: f64 = 1.2;

impl TurningOptions {
    /// Whether any of them was given.
    pub fn is_given(&self) -> bool {
        self.sensor.is_some() || self.speeds.is_some() || self.turns.is_some()
    }

    /// Whether the sensor is a molecular-electronic one.
    pub fn is_molecular(&self) -> bool {
        self.sensor == Some(Sensor::Met)
    }

    /// The scenario on a base.
    pub fn scenario(&self, base: &Scenario) -> TurntableScenario {
        let usual = if self.is_molecular() {
            let molecular = TurntableScenario::molecular(base.seed);
            let gyro = molecular.base.gyro;
            TurntableScenario { base: Scenario { gyro, ..*base }, ..molecular }
        } else {
            TurntableScenario { base: *base, ..TurntableScenario::default() }
        };
        let (speeds_hz, turns) = (self.speeds, self.turns);
        TurntableScenario {
            speeds_hz: speeds_hz.unwrap_or(usual.speeds_hz),
            turns: turns.unwrap_or(usual.turns),
            ..usual
        }
    }
}

/// What the pages and blocks call it.
const NAME: &str = "the simulated run";

/// Runs the board and tells what came of it.
pub fn run(
    scenario: &TurntableScenario,
    fault: Option<Fault>,
    report: Option<&Path>,
    as_json: bool,
) -> Result<Told, String> {
    let begun = WallClock::now();
    let watch = Terminal(Progress::new(0, "turns"));
    let mut recorder = RowRecorder::default();
    let run = align_turning(scenario, fault, &mut recorder, &watch);
    watch.0.finish();
    let TurntableRun { run, .. } = run.map_err(|error| error.to_string())?;
    let wall = begun.elapsed().as_secs_f64();
    let replay =
        Replay { session: run.replay.clone(), zero_s: 0.0, assumed: vec![ASSUMED.to_owned()] };
    let conclusion = replay.conclusion().ok_or("the session did not end")?;
    let truth = Some(scenario.base.azimuth_deg);
    let found = told::json::object(&replay, conclusion, truth);
    let object = object(&run, &scenario.base, found)?;
    let told = Told::of(conclusion.verdict.is_ok(), as_json, &object, |block| {
        told::text::block(block, NAME, &replay, conclusion, truth)?;
        text::run(block, &run, &scenario.base, wall)
    })?;
    let refusal = conclusion.verdict.as_ref().err().map(ToString::to_string);
    let page = || page::rotating::report(NAME, &replay, conclusion, recorder.rows());
    Ok(Told { refusal, ..told }.with_page(report, page))
}

/// What a simulated board is told.
const ASSUMED: &str = "what the board is told of place and instrument";

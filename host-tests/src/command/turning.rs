//! `meridian run --method rotating`: the board on a platform that turns all the time.

use std::path::{Path, PathBuf};
use std::time::Instant as WallClock;

use bench::instrument::kept::Kept;
use bench::instrument::recorder::{Samples, turning_rows};
use bench::instrument::{Keeping, Run, TurntableRun, align_turning_again, flash_file};
use bench::outcome::Finished;
use bench::outcome::run::RunDetails;
use bench::output::progress::Progress;
use bench::recording::{Body, Truth};
use bench::rotating::Replay;
use clap::{Args, ValueEnum};
use firmware::date::Day;
use firmware::event::Event;
use firmware::simulated::fault::Fault;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::TurntableScenario;
use firmware::storage::{Remembered, Today};

use super::files::{self, Written};
use super::run::Terminal;
use super::{Shown, Told, whole};

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
    #[arg(long, value_parser = whole::<2, 1000>)]
    turns: Option<u64>,
    /// With --method rotating: uneven turns before them, 0 where what --flash keeps is to do (12).
    #[arg(long, value_name = "TURNS", value_parser = uneven_turns)]
    uneven_turns: Option<u32>,
    /// With --method rotating: the board's flash, which keeps what uneven turns find from run to run.
    #[arg(long, value_name = "FILE")]
    flash: Option<PathBuf>,
    /// With --flash: today, so that the board knows when it found something.
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, requires = "flash")]
    date: Option<u64>,
}

/// None, or enough to tell a coupling from the Earth rate.
fn uneven_turns(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(turns) if turns == 0 || (4..=1000).contains(&turns) => Ok(turns),
        _ => Err("neither 0 nor a number of turns from 4 to 1000".to_owned()),
    }
}

/// A day of the calendar, as s since 1970.
fn date(text: &str) -> Result<u64, String> {
    let mut parts = text.splitn(3, '-').map(str::parse::<u16>);
    let mut part = || parts.next()?.ok();
    let found = (|| {
        let (year, month, day) = (part()?, part()?, part()?);
        Day::begin(year, month.try_into().ok()?, day.try_into().ok()?)
    })();
    found.ok_or_else(|| "no day from 1970-01-01 on, as YYYY-MM-DD".to_owned())
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
    /// The file of the flash, and the one in which it is written first.
    pub fn files(&self) -> [Option<Written>; 2] {
        let beside = self.flash.as_deref().map(flash_file::beside);
        [self.flash.as_ref(), beside.as_ref()]
            .map(|path| files::written("--flash", "the flash", path))
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
        TurntableScenario {
            speeds_hz: self.speeds.unwrap_or(usual.speeds_hz),
            uneven_turns: self.uneven_turns.unwrap_or(usual.uneven_turns),
            turns: self.turns.map_or(usual.turns, |turns| turns as u32),
            ..usual
        }
    }

    /// The board's flash and the day; none where it keeps nothing.
    fn keeping(&self) -> Result<Option<Keeping>, String> {
        let Some(path) = &self.flash else { return Ok(None) };
        let today = Today { date: self.date, longest: None };
        Ok(Some(Keeping { store: flash_file::load(path)?.store(), today }))
    }

    /// Writes back what the board keeps.
    fn put_away(&self, keeping: Option<Keeping>) -> Result<(), String> {
        match (&self.flash, keeping) {
            (Some(path), Some(keeping)) => flash_file::save(path, &keeping.store.into_flash()),
            _ => Ok(()),
        }
    }
}

/// What the pages and blocks call it.
const NAME: &str = "the simulated run";

/// Runs the board and tells what came of it.
pub fn run(
    options: &TurningOptions,
    scenario: &TurntableScenario,
    fault: Option<Fault>,
    report: Option<&Path>,
    as_json: bool,
) -> Result<Told, String> {
    let begun = WallClock::now();
    let mut keeping = options.keeping()?;
    let watch = Terminal(Progress::new(0, "turns"));
    let mut recorder = Samples::default();
    let run = align_turning_again(scenario, fault, &mut recorder, &watch, keeping.as_mut());
    watch.0.finish();
    let TurntableRun { run, .. } = run.map_err(|error| error.to_string())?;
    let put_away = options.put_away(keeping);
    let rate_hz = scenario.base.sample_rate_hz;
    let mut details = RunDetails::of(&run, &Kept::default(), rate_hz, begun.elapsed());
    details.recalled = Some(recalled(&run).map(Into::into).collect());
    let replay =
        Replay { session: run.replay.clone(), zero_s: 0.0, assumed: vec![ASSUMED.to_owned()] };
    let truth = Truth { azimuth_deg: Some(scenario.base.azimuth_deg), ..Truth::default() };
    let outcome = replay.outcome(&truth).of_run(scenario.base.seed, details);
    let body = Body::Rotating(turning_rows(&recorder.0));
    let (finished, body) = (&replay, Some(&body));
    let shown = Shown { name: NAME, outcome, finished, truth: &truth, body };
    Ok(shown.told(report, as_json)?.with_written(put_away))
}

/// The stored axis misalignments that the board used.
fn recalled<R>(run: &Run<R>) -> impl Iterator<Item = &Remembered> {
    run.events.iter().filter_map(|(_, event)| match event {
        Event::Recalled(coupling) => Some(coupling),
        _ => None,
    })
}

/// What a simulated board is told.
const ASSUMED: &str = "what the board is told of place and instrument";

//! `meridian run turntable`: the board on a platform that turns all the time.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use firmware::date::Day;
use firmware::event::Event;
use firmware::storage::{FlashStore, Today};
use host::instrument::recorder::{Recorded as _, given_by, turning_rows};
use host::instrument::{Trial, flash_file};
use host::methods::rotating::Replay;
use host::outcome::kept::finished;
use host::outcome::run::{OfPlatform, RunDetails};
use host::recording::Body;
use simulated::flash::Flash;
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;

use super::keeping::{KeepingOptions, lasting};
use super::options::{COURSE, Common, Inclination, KEEPING, Place, SENSOR};
use super::{Begun, Ran, Shown, Simulated, Terminal};
use crate::command::faults::FaultChoice;
use crate::command::files::{self, Written};
use crate::command::stated::Stated;
use crate::command::whole;

/// What is asked of a platform that turns all the time.
#[derive(Args, Clone, Debug)]
pub struct TurntableOptions {
    #[command(flatten)]
    place: Place,
    #[command(flatten)]
    inclination: Inclination,
    #[command(flatten)]
    keeping: KeepingOptions,
    /// The sensor (gyro).
    #[arg(long, value_enum, help_heading = SENSOR)]
    sensor: Option<Sensor>,
    /// One or two speeds in turns a second (0.137; of met 0.1,0.2).
    #[arg(long, value_name = "HERTZ[,HERTZ]", value_parser = speeds, help_heading = COURSE)]
    speeds: Option<[f64; 2]>,
    /// Whole turns each way at the slowest speed.
    #[arg(long, value_parser = whole::<2, 1000>, help_heading = COURSE)]
    turns: Option<u64>,
    /// Rate-modulated turns before them, 0 where what --flash keeps is to do (12).
    #[arg(long, value_name = "TURNS", value_parser = modulated_turns, help_heading = COURSE)]
    modulated_turns: Option<u32>,
    /// The board's flash, which keeps the axis misalignments that rate-modulated turns find from run to run.
    #[arg(long, value_name = "FILE", help_heading = KEEPING)]
    flash: Option<PathBuf>,
    /// Today, so that the board knows when it found something.
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, requires = "flash", help_heading = KEEPING)]
    date: Option<u64>,
    #[command(flatten)]
    pub(super) common: Common,
}

/// None, or enough to distinguish an axis misalignment from the Earth rate.
fn modulated_turns(text: &str) -> Result<u32, String> {
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
    /// A molecular-electronic sensor, whose gain, lag and g-sensitivity are not known.
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

/// Options that plan an alignment, of which there is none where an azimuth is handed over.
const ALIGNING: [&str; 4] = ["sensor", "speeds", "turns", "modulated_turns"];

/// Speeds closer than this distinguish nothing.
const LEAST_RATIO: f64 = 1.2;

impl TurntableOptions {
    fn scenario(&self) -> TurntableScenario {
        let seed = self.common.seed;
        let usual = match self.sensor {
            Some(Sensor::Met) => TurntableScenario::molecular(seed),
            _ => TurntableScenario { base: Scenario::usual(seed), ..TurntableScenario::default() },
        };
        let Inclination { pitch: pitch_deg, roll: roll_deg } = self.inclination;
        // A fault shows in the alignment; and a run by a flash begins where the one before began, not where it ended.
        let is_plain = self.common.fault.is_some() || self.flash.is_some();
        let is_timed = self.speeds.is_some() || self.turns.is_some();
        let is_usual = !is_timed && self.modulated_turns.is_none() && self.sensor.is_none();
        let hold = self.keeping.hold(is_plain, is_usual);
        let has_base_imu =
            hold.seconds > 0.0 || self.common.fault.is_some_and(FaultChoice::is_of_base_imu);
        let given = self.place.scenario(seed);
        let base = Scenario { pitch_deg, roll_deg, hold, has_base_imu, ..given };
        let gyro = if self.place.gyro.is_some() { base.gyro } else { usual.base.gyro };
        TurntableScenario {
            base: Scenario { gyro, ..base },
            speeds_hz: self.speeds.unwrap_or(usual.speeds_hz),
            modulated_turns: self.modulated_turns.unwrap_or(usual.modulated_turns),
            turns: self.turns.map_or(usual.turns, |turns| turns as u32),
            today: self.flash.is_some().then_some(Today { date: self.date, longest: None }),
            ..usual
        }
    }

    /// The board's flash, an empty one where it keeps nothing.
    fn store(&self) -> Result<FlashStore<Flash>, String> {
        let flash = self.flash.as_deref().map_or(Ok(Flash::default()), flash_file::load)?;
        Ok(flash.store())
    }

    /// Writes back what the board keeps.
    fn put_away(&self, store: FlashStore<Flash>) -> Result<(), String> {
        self.flash.as_ref().map_or(Ok(()), |path| flash_file::save(path, &store.into_flash()))
    }
}

impl Simulated for TurntableOptions {
    /// The file of the flash, and the one in which it is written first.
    fn files(&self) -> Vec<Written> {
        let beside = self.flash.as_deref().map(flash_file::beside);
        [self.flash.as_ref(), beside.as_ref()].map(Written::flash).into()
    }

    fn check(&self, stated: &Stated) -> Result<(), String> {
        let scenario = self.scenario();
        let hold = scenario.base.hold;
        if self.flash.is_some() && hold.seconds > 0.0 {
            return Err("--flash: the next run begins where this one began, so no heading is kept in it; leave \
                        --hold out"
                .to_owned());
        }
        let hold = (&hold, hold.stop_seconds(scenario.alignment_seconds()));
        self.keeping.check(stated, hold, &self.common, &ALIGNING)?;
        if self.sensor == Some(Sensor::Met) && self.place.gyro.is_some() {
            return Err(
                "--gyro: a molecular-electronic sensor takes its place; leave out --sensor met"
                    .to_owned(),
            );
        }
        Ok(())
    }

    fn run(&self, begun: &Begun) -> Result<Ran, String> {
        let Begun { fault, manner, record } = begun;
        let mut scenario = self.scenario();
        scenario.base.hold = self.place.going_on(scenario.base.hold);
        // It is written when the run is over; that it can be is to be known before.
        drop(files::opened("the flash", self.flash.as_ref())?);
        let mut store = self.store()?;
        let (mut recorder, inputs) =
            self.common.wanted(record.as_ref(), given_by(&scenario, &mut store))?;
        let expected_s = lasting(&scenario.base.hold, scenario.alignment_seconds());
        let watched = (*manner, "turns", expected_s);
        // Figures show them.
        recorder.is_idle = false;
        let (run, wall) = Terminal::watching(watched, &inputs, |watch| {
            let recorder = (&mut recorder, inputs.as_ref());
            let trial = Trial::of(&scenario).fault(*fault).record(recorder);
            trial.store(&mut store).watch(watch).run()
        })?;
        let recorded = Common::write(record.as_ref(), &scenario, &run, (&recorder.taken, inputs));
        let (_, truth) = scenario.end_of(&run);
        let written = self.put_away(store).and(recorded);
        let recalled = run.events.iter().filter_map(|(_, event)| match event {
            Event::Recalled(misalignment) => Some(*misalignment),
            _ => None,
        });
        let beside = OfPlatform::recalled(&recalled.collect::<Vec<_>>());
        let details = RunDetails::of(&run, scenario.base.sample_rate_hz, wall, beside);
        let is_aligned = run.replay.conclusion().is_some();
        let site = run.replay.setting.site;
        let finished = finished(is_aligned, &site, Replay::of_run(run.replay));
        let body = Some(Body::Rotating(turning_rows(&recorder.taken)));
        let shown = Shown { name: "the simulated run", finished, truth, body };
        Ok(Ran { shown, details, written })
    }
}

//! `meridian run stage` and `meridian run two-frame`: a base that stands while its gyro stops at positions.

use std::time::Duration;

use clap::Args;
use firmware::event::Event;
use host::angle::Quantity;
use host::instrument::recorder::Recorded;
use host::instrument::{Run, Trial};
use host::methods::stepwise::{Replay, subtracts_sway};
use host::outcome::kept::finished;
use host::outcome::run::{OfPlatform, RunDetails};
use host::output::degrees;
use host::recording::Truth;
use orientation::alignment::stepwise::setting::Half;
use orientation::signal::Sample;
use simulated::mount::FramesScenario;
use simulated::scenario::{Aim, Scenario};

use super::keeping::{KeepingOptions, lasting};
use super::options::{CHANCE, COURSE, Common, Inclination, Place, number, seconds};
use super::{Begun, Ran, Shown, Simulated, Terminal};
use crate::command::faults::FaultChoice;
use crate::command::stated::Stated;
use crate::command::{HALVES, angle, named, sigma, whole};

/// What is asked of a stage.
#[derive(Args, Clone, Debug)]
pub struct StageOptions {
    #[command(flatten)]
    pub(super) base: BaseOptions,
    /// Positions on the full circle (24), to the first of which it comes once more at the end.
    #[arg(long, value_parser = whole::<2, 64>, conflicts_with_all = ["seconds", "sigma"], help_heading = COURSE)]
    positions: Option<u64>,
}

/// What is asked of two frames.
#[derive(Args, Clone, Debug)]
pub struct FramesOptions {
    #[command(flatten)]
    pub(super) base: BaseOptions,
    /// How often the four headings are visited (6).
    #[arg(long, value_name = "PASSES", value_parser = whole::<1, 16>, conflicts_with_all = ["seconds", "sigma"], help_heading = COURSE)]
    passes: Option<u64>,
}

/// What a stage and two frames share: a base that stands or sways, and a plan of positions.
#[derive(Args, Clone, Debug)]
pub(super) struct BaseOptions {
    #[command(flatten)]
    place: Place,
    #[command(flatten)]
    inclination: Inclination,
    /// The best schedule for the gyro in so many seconds, instead of positions on the full circle; with
    /// --sigma the time allowed.
    #[arg(long, value_name = "SECONDS", value_parser = seconds(60.0..=36_000.0), help_heading = COURSE)]
    seconds: Option<f64>,
    /// Goes on until this standard deviation is reached, in degrees (1σ).
    #[arg(long, value_name = "DEGREES", value_parser = wanted, help_heading = COURSE)]
    sigma: Option<f64>,
    /// Stands still first for so many seconds, to know the gyro's noise and to plan by it.
    #[arg(long, value_name = "SECONDS", value_parser = seconds(60.0..=36_000.0), help_heading = COURSE)]
    survey: Option<f64>,
    /// The half of the circle in which the board is given that the azimuth lies: two positions need it.
    #[arg(long, value_parser = named(&HALVES), help_heading = COURSE)]
    half: Option<Half>,
    /// Seconds at each position (10).
    #[arg(long, value_name = "SECONDS", value_parser = seconds(0.5..=600.0), conflicts_with_all = ["seconds", "sigma"], help_heading = COURSE)]
    dwell: Option<f64>,
    #[command(flatten)]
    keeping: KeepingOptions,
    /// Amplitude of the base's sway in degrees; brings a coarse IMU on the base with it.
    #[arg(long, value_name = "DEGREES", value_parser = amplitude, help_heading = CHANCE)]
    sway: Option<f64>,
    /// Frequency of the sway in hertz.
    #[arg(long, value_name = "HERTZ", default_value = "0.5", value_parser = number(0.05..=5.0, "a frequency in hertz"), requires = "sway", help_heading = CHANCE)]
    sway_hertz: f64,
    /// Lets the base sway without a coarse IMU on it.
    #[arg(long, requires = "sway", help_heading = CHANCE)]
    no_base_imu: bool,
    #[command(flatten)]
    pub(super) common: Common,
}

/// Least rate of the samples at which the coarse IMU, which is read with them, shows how a vehicle shakes, Hz.
const KEPT_HERTZ: f64 = 50.0;

fn amplitude(text: &str) -> Result<f64, String> {
    match angle(text, Quantity::Other) {
        Ok(degrees) if (0.0..=2.0).contains(&degrees) => Ok(degrees),
        _ => Err("not an amplitude in degrees from 0 to 2".to_owned()),
    }
}

fn wanted(text: &str) -> Result<f64, String> {
    sigma(text).map(f64::to_degrees)
}

/// Time allowed for an accuracy where none is stated, s.
const ALLOWED: f64 = 1800.0;
/// Options that plan an alignment, of which there is none where an azimuth is handed over.
const ALIGNING: [&str; 7] = ["positions", "dwell", "passes", "seconds", "sigma", "survey", "half"];

impl BaseOptions {
    /// How the schedule is chosen.
    fn aim(&self) -> Aim {
        match (self.sigma, self.seconds) {
            (None, None) => Aim::Circle,
            (None, Some(seconds)) => Aim::Time(seconds),
            (Some(sigma_deg), seconds) => {
                Aim::Accuracy { sigma_deg, seconds: seconds.unwrap_or(ALLOWED) }
            }
        }
    }

    /// The scenario of the base, where its positions are the usual ones or not.
    fn scenario(&self, has_usual_positions: bool) -> Scenario {
        let usual = self.place.scenario(self.common.seed);
        // A fault shows in the alignment, and one that goes on until an accuracy is reached may last: the base must not
        // drive off meanwhile.
        let fault = self.common.fault;
        let is_plain = fault.is_some() || self.no_base_imu || self.sigma.is_some();
        let is_timed = self.seconds.is_some() || self.survey.is_some() || self.dwell.is_some();
        let hold = self.keeping.hold(is_plain, has_usual_positions && !is_timed);
        let needs_base_imu = self.sway.is_some()
            || hold.seconds > 0.0
            || fault.is_some_and(FaultChoice::is_of_base_imu);
        Scenario {
            pitch_deg: self.inclination.pitch,
            roll_deg: self.inclination.roll,
            aim: self.aim(),
            survey_s: self.survey.unwrap_or(0.0),
            half: self.half,
            dwell_s: self.dwell.unwrap_or(usual.dwell_s),
            sway_deg: self.sway.unwrap_or(0.0),
            sway_hz: self.sway_hertz,
            has_base_imu: needs_base_imu && !self.no_base_imu,
            hold,
            ..usual
        }
    }

    /// Runs a board, and writes the recording; `shown` gets the time, too, that it took on this machine.
    fn run<C: Recorded<Sample = Sample>>(
        &self,
        (carrier, seconds): (&C, f64),
        Begun { fault, manner, record }: &Begun,
        shown: impl FnOnce(C::Run, Truth, Duration) -> Ran,
    ) -> Result<Ran, String> {
        let (mut wanted, inputs) = self.common.wanted(record.as_ref(), carrier.given())?;
        let (run, wall) = Terminal::watching((*manner, "positions", seconds), &inputs, |watch| {
            let recorder = (&mut wanted, inputs.as_ref());
            Trial::of(carrier).fault(*fault).record(recorder).watch(watch).run()
        })?;
        let written = Common::write(record.as_ref(), carrier, &run, (&wanted.taken, inputs));
        let (_, truth) = carrier.end_of(&run);
        Ok(Ran { written, ..shown(run, truth, wall) })
    }

    /// That the base sways and nothing of it is subtracted, where that is so. Where a later alignment found north, the
    /// vehicle has driven meanwhile, and sways no more.
    fn sway_left<T>(&self, run: &Run<Replay, T>) -> Option<String> {
        let sways =
            |sway: &f64| *sway > 0.0 && run.earlier.is_empty() && !self.keeping.is_handed_over();
        let sway = self.sway.filter(sways)?;
        let why = if self.no_base_imu {
            "no coarse IMU shows it"
        } else {
            "it is too small for the coarse IMU on the base"
        };
        (!subtracts_sway(&run.replay.session))
            .then(|| format!("the base sways by {sway}°, which is not subtracted: {why}"))
    }

    /// What keeping needs, and what it takes the place of.
    fn check(
        &self,
        stated: &Stated,
        (scenario, alignment_s): (&Scenario, f64),
        aligning: &[&'static str],
    ) -> Result<(), String> {
        if self.no_base_imu && self.common.fault.is_some_and(FaultChoice::is_of_base_imu) {
            return Err("--fault: --no-base-imu leaves out what it happens to".to_owned());
        }
        let asked = stated.first(&["realign", "handover"]);
        let keeps = asked.is_some() || stated.has("hold") && scenario.hold.seconds > 0.0;
        if keeps && self.no_base_imu {
            return Err("--no-base-imu: without coarse sensors nothing is kept".to_owned());
        }
        if !self.no_base_imu && scenario.hold.seconds > 0.0 && scenario.sample_rate_hz < KEPT_HERTZ
        {
            return Err(format!(
                "--rate: the coarse IMU is read with the samples, and an attitude is kept from {KEPT_HERTZ} a second on; \
                 take more, or --hold 0"
            ));
        }
        let keeping = (&scenario.hold, scenario.hold.stop_seconds(alignment_s));
        self.keeping.check(stated, keeping, &self.common, aligning)
    }
}

impl StageOptions {
    fn scenario(&self) -> Scenario {
        let base = self.base.scenario(self.positions.is_none());
        Scenario {
            positions: self.positions.map_or(base.positions, |count| count as usize),
            ..base
        }
    }
}

impl Simulated for StageOptions {
    fn check(&self, stated: &Stated) -> Result<(), String> {
        let scenario = self.scenario();
        // A stage keeps its azimuth by the coarse gyros alone.
        let aligning = [&["gyro"][..], &ALIGNING].concat();
        self.base.check(stated, (&scenario, scenario.alignment_seconds()), &aligning)
    }

    fn run(&self, begun: &Begun) -> Result<Ran, String> {
        let mut scenario = self.scenario();
        scenario.hold = self.base.place.going_on(scenario.hold);
        let seconds = lasting(&scenario.hold, scenario.alignment_seconds());
        self.base.run((&scenario, seconds), begun, |run, truth, wall| {
            let details =
                RunDetails::of(&run, scenario.sample_rate_hz, wall, OfPlatform::default())
                    .noting(self.base.sway_left(&run));
            ran("the simulated run", run, details, truth)
        })
    }
}

impl FramesOptions {
    fn scenario(&self) -> FramesScenario {
        let usual = FramesScenario::default();
        FramesScenario {
            base: self.base.scenario(self.passes.is_none()),
            passes: self.passes.map_or(usual.passes, |count| count as usize),
            ..usual
        }
    }
}

impl Simulated for FramesOptions {
    fn check(&self, stated: &Stated) -> Result<(), String> {
        let scenario = self.scenario();
        self.base.check(stated, (&scenario.base, scenario.alignment_seconds()), &ALIGNING)
    }

    fn run(&self, begun: &Begun) -> Result<Ran, String> {
        let mut scenario = self.scenario();
        scenario.base.hold = self.base.place.going_on(scenario.base.hold);
        let seconds = lasting(&scenario.base.hold, scenario.alignment_seconds());
        self.base.run((&scenario, seconds), begun, |run, truth, wall| {
            let [forward, right, down] = run.truth;
            let is_vertical =
                run.events.iter().any(|(_, event)| matches!(event, Event::Stored(..)));
            let off_deg = degrees(forward.hypot(right).atan2(down));
            let beside = OfPlatform::stored(is_vertical, off_deg);
            let details = RunDetails::of(&run, scenario.base.sample_rate_hz, wall, beside)
                .noting(self.base.sway_left(&run));
            ran("the simulated run on two frames", run, details, truth)
        })
    }
}

/// What came of a run at standstills; what it kept, where no alignment of it stands.
fn ran<T>(name: &'static str, run: Run<Replay, T>, details: RunDetails, truth: Truth) -> Ran {
    let site = run.replay.session.setting.site;
    let finished = finished(run.conclusion().is_some(), &site, run.replay);
    Ran { shown: Shown { name, finished, truth, body: None }, details, written: Ok(()) }
}

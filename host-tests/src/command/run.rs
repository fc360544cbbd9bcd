//! `meridian run`: the whole board application on simulated chips.

use std::path::PathBuf;
use std::time::Instant as WallClock;

use bench::instrument::kept::{Kept, KeptPlan, KeptRun};
use bench::instrument::recorder::{self, Samples};
use bench::instrument::{self, FramesRun, Run, RunError};
use bench::outcome::Finished;
use bench::outcome::run::{KeptAzimuth, RunDetails};
use bench::output::degrees;
use bench::output::progress::Progress;
use bench::recording::Truth;
use bench::unwritten;
use clap::{Args, ValueEnum};
use drivers::ads1262::configuration::DataRate;
use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::{NoRecorder, Observer, Recorder};
use firmware::simulated::fault::{Fault, Platform};
use firmware::simulated::keep::Hold;
use firmware::simulated::mount::FramesScenario;
use firmware::simulated::scenario::{Aim, GyroClass, RATES, Scenario};
use orientation::session::{Session, rotating, stops};

use super::driving::DrivingOptions;
use super::faults::{self, Asked};
use super::keeping::KeepingOptions;
use super::spinning::SpinningOptions;
use super::suits::{self, Given, carrier};
use super::turning::TurningOptions;
use super::{Half, Shown, Told, files, whole};

/// What can be said of a simulated alignment.
#[derive(Args, Clone, Debug)]
pub struct RunOptions {
    /// Latitude in degrees, north positive.
    #[arg(long, value_name = "DEGREES", default_value = "47.58", value_parser = within::<90>)]
    latitude: f64,
    /// True azimuth of body x in degrees; the board is not told.
    #[arg(long, value_name = "DEGREES", default_value = "213.7", value_parser = within::<360>)]
    azimuth: f64,
    /// True pitch of the base in degrees, nose up positive.
    #[arg(long, value_name = "DEGREES", default_value = "0.6", value_parser = within::<90>)]
    pitch: f64,
    /// True roll of the base in degrees, right side down positive.
    #[arg(long, value_name = "DEGREES", default_value = "-0.4", value_parser = within::<180>)]
    roll: f64,
    /// The precise gyro (fog).
    #[arg(long, value_enum)]
    gyro: Option<Gyro>,
    /// Samples of the gyro a second: a data rate of its converter (400; with --method siap 100).
    #[arg(long, value_name = "HERTZ", value_parser = rate)]
    rate: Option<f64>,
    /// The best schedule for the gyro in so many seconds, instead of positions on the full circle; with
    /// --sigma the time allowed.
    #[arg(long, value_name = "SECONDS", value_parser = allowed, conflicts_with_all = ["positions", "dwell"])]
    seconds: Option<f64>,
    /// Goes on until this standard deviation is reached, in degrees (1σ).
    #[arg(long, value_name = "DEGREES", value_parser = wanted, conflicts_with_all = ["positions", "dwell"])]
    sigma: Option<f64>,
    /// Stands still first for so many seconds, to know the gyro's noise and to plan by it.
    #[arg(long, value_name = "SECONDS", value_parser = allowed)]
    survey: Option<f64>,
    /// What carries the gyro.
    #[arg(long, value_enum, default_value = "stage")]
    mount: MountKind,
    /// With two frames: how often the four headings are visited (6).
    #[arg(long, value_name = "PASSES", value_parser = whole::<1, 16>, conflicts_with_all = ["seconds", "sigma"])]
    passes: Option<u64>,
    /// The half of the circle in which the board is told that the azimuth lies: two positions need it.
    #[arg(long, value_enum)]
    half: Option<Half>,
    /// On a stage: positions on the full circle (24), to the first of which it comes once more at the end.
    #[arg(long, value_parser = whole::<2, 64>)]
    positions: Option<u64>,
    /// Seconds at each position (10).
    #[arg(long, value_name = "SECONDS", value_parser = dwell)]
    dwell: Option<f64>,
    #[command(flatten)]
    turning: TurningOptions,
    #[command(flatten)]
    driving: DrivingOptions,
    #[command(flatten)]
    keeping: KeepingOptions,
    #[command(flatten)]
    spinning: SpinningOptions,
    /// Amplitude of the base's sway in degrees; brings a coarse IMU on the base with it.
    #[arg(long, value_name = "DEGREES", value_parser = sway, conflicts_with = "record")]
    sway: Option<f64>,
    /// Frequency of the sway in hertz.
    #[arg(long, value_name = "HERTZ", default_value = "0.5", value_parser = sway_hertz, requires = "sway")]
    sway_hertz: f64,
    /// Lets the base sway without a coarse IMU on it.
    #[arg(long, requires = "sway")]
    no_base_imu: bool,
    /// What fixes everything random.
    #[arg(long, default_value_t = 1, value_parser = super::seed)]
    seed: u64,
    /// Method.
    #[arg(long, value_enum, default_value = "stepwise")]
    method: Method,
    /// What goes wrong; `list` names the faults of the method.
    #[arg(long, value_name = "NAME", value_parser = faults::parse)]
    fault: Option<Asked>,
    /// Writes the samples that the session got as a recording for `replay`.
    #[arg(long, value_name = "FILE.csv")]
    record: Option<PathBuf>,
    /// Writes figures and tables as a page for a browser.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Method {
    /// Stepwise gyrocompassing over the full circle, unless a plan is asked for.
    Stepwise,
    /// Autocompensated positions: the best schedule for the gyro, in 300 s unless stated.
    Positions,
    /// A platform that turns all the time, on a slip ring.
    Rotating,
    /// A vehicle that drives from stop to stop.
    Siap,
    /// The roll of a body in fast rotation.
    Spin,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MountKind {
    /// A single-axis stage.
    Stage,
    /// Two frames: four headings, and vertical to store the azimuth.
    TwoFrame,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Gyro {
    /// Fibre-optic: N 0.001 °/√h, B 0.007 °/h.
    Fog,
    /// Fibre-optic, lower grade: N 0.02 °/√h, B 0.1 °/h.
    FogCoarse,
    /// The best micromechanical: N 0.036 °/√h, B 0.3 °/h.
    MemsFine,
    /// Micromechanical, tactical grade: N 0.15 °/√h, B 0.5 °/h.
    Mems,
}

fn within<const LIMIT: u16>(text: &str) -> Result<f64, String> {
    let limit = f64::from(LIMIT);
    match text.parse::<f64>() {
        Ok(angle) if angle.abs() <= limit => Ok(angle),
        Ok(_) => Err(format!("outside ±{limit}°")),
        Err(_) => Err("not a number".to_owned()),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rates = RATES.map(DataRate::hertz);
    let known = rates.map(|rate| rate.to_string()).join(", ");
    let rate = text.parse::<f64>().ok().filter(|rate| rates.contains(rate));
    rate.ok_or_else(|| format!("not one of the converter's rates: {known}"))
}

fn allowed(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (60.0..=36_000.0).contains(&seconds) => Ok(seconds),
        _ => Err("not a number of seconds from 60 to 36000".to_owned()),
    }
}

fn wanted(text: &str) -> Result<f64, String> {
    super::sigma(text).map(f64::to_degrees)
}

fn dwell(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.5..=600.0).contains(&seconds) => Ok(seconds),
        _ => Err("not a number of seconds from 0.5 to 600".to_owned()),
    }
}

fn sway(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(amplitude) if (0.0..=2.0).contains(&amplitude) => Ok(amplitude),
        _ => Err("not an amplitude from 0 to 2°".to_owned()),
    }
}

fn sway_hertz(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(frequency) if (0.05..=5.0).contains(&frequency) => Ok(frequency),
        _ => Err("not a frequency from 0.05 to 5 Hz".to_owned()),
    }
}

impl From<Gyro> for GyroClass {
    fn from(gyro: Gyro) -> Self {
        match gyro {
            Gyro::Fog => Self::FIBRE_OPTIC,
            Gyro::FogCoarse => Self::FIBRE_OPTIC_COARSE,
            Gyro::MemsFine => Self::MICROMECHANICAL_FINE,
            Gyro::Mems => Self::MICROMECHANICAL,
        }
    }
}

/// Positions on the full circle where none are stated.
const POSITIONS: usize = 24;
/// Seconds at each where none are stated.
const DWELL: f64 = 10.0;
/// Passes on two frames where none are stated.
const PASSES: usize = 6;
/// Time of a plan where none is stated, s.
const USUAL: f64 = 300.0;
/// Samples a second where none are stated.
const RATE: f64 = 400.0;
/// Time allowed for an accuracy where none is stated, s.
const ALLOWED: f64 = 1800.0;

impl RunOptions {
    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    pub fn check(&self, given: &Given) -> Result<(), String> {
        if let Some(Asked::List) = self.fault {
            return match given.beside(&["fault", "method", "mount"]) {
                Some(option) => Err(format!("{}: --fault list runs nothing", suits::long(option))),
                None => Ok(()),
            };
        }
        suits::check(suits::RUN, given, &self.carrier())?;
        if let Some(Asked::One(fault)) = self.fault {
            faults::check(fault, self.platform(), self.no_base_imu)?;
        }
        self.check_plan(given)?;
        self.check_keeping(given)?;
        if self.turning.is_molecular() && self.gyro.is_some() {
            return Err(
                "--gyro: a molecular-electronic sensor takes its place; leave out --sensor met"
                    .into(),
            );
        }
        let record = files::written("--record", "the recording", self.record.as_ref());
        let report = files::written("--report", "the page", self.report.as_ref());
        let [flash, beside] = self.turning.files();
        files::check(None, &[record, flash, beside, report])
    }

    /// What carries the gyro.
    fn carrier(&self) -> suits::Named {
        match (self.method, self.mount) {
            (Method::Spin, _) => carrier::BODY,
            (Method::Siap, _) => carrier::VEHICLE,
            (Method::Rotating, _) => carrier::TURNTABLE,
            (Method::Stepwise, MountKind::TwoFrame) => carrier::FRAMES,
            (Method::Stepwise, MountKind::Stage) => carrier::STAGE,
            (Method::Positions, _) => carrier::PLANNED,
        }
    }

    /// What two frames cannot take, however their positions come about.
    fn check_plan(&self, given: &Given) -> Result<(), String> {
        if self.mount == MountKind::TwoFrame && given.has("record") {
            return Err("--record: --mount two-frame does not take it: it is one of a stage".into());
        }
        Ok(())
    }

    /// What keeping an azimuth needs, and what it takes the place of.
    fn check_keeping(&self, given: &Given) -> Result<(), String> {
        let asked = given.first(&["realign", "handover"]);
        let keeps = given.has("hold") && self.hold().seconds > 0.0;
        match asked.or(keeps.then_some("hold")) {
            Some(_) if self.record.is_some() => {
                return Err(
                    "--record: what a base with coarse sensors shows is not recorded".into()
                );
            }
            Some(_) if self.no_base_imu => {
                return Err("--no-base-imu: without coarse sensors nothing is kept".into());
            }
            _ => {}
        }
        if let Some(option) = asked.filter(|_| self.hold().seconds <= 0.0) {
            let option = suits::long(option);
            return Err(format!("{option}: nothing is kept after this run; add --hold SECONDS"));
        }
        let first = Hold::default().drive_s + Hold::default().stop_s;
        if self.keeping.realigns() && self.hold().seconds < first {
            return Err(format!(
                "--realign: the first stop after the alignment ends after {first} s; add --hold of more"
            ));
        }
        self.check_handover(given)
    }

    /// What an azimuth from outside takes the place of, unless the vehicle aligns itself anew later.
    fn check_handover(&self, given: &Given) -> Result<(), String> {
        let stopping = &["positions", "dwell", "passes", "seconds", "sigma", "survey", "half"][..];
        // A stage keeps its azimuth by the coarse gyros alone.
        let aligning = match (self.method, self.mount) {
            (Method::Siap, _) => &["stops", "no_displacement"][..],
            (_, MountKind::TwoFrame) => stopping,
            (_, MountKind::Stage) => &[&["gyro"][..], stopping].concat(),
        };
        let is_alone = given.has("handover") && !self.keeping.realigns();
        match given.first(aligning).filter(|_| is_alone) {
            Some(option) => Err(format!(
                "{}: --handover takes the place of the alignment; add --realign or leave one out",
                suits::long(option)
            )),
            None => Ok(()),
        }
    }

    /// What carries the gyro, as the catalogue of faults names it.
    fn platform(&self) -> Platform {
        match (self.method, self.mount) {
            (Method::Spin, _) => Platform::Spin,
            (Method::Siap, _) => Platform::Vehicle,
            (Method::Rotating, _) => Platform::Turntable,
            (_, MountKind::TwoFrame) => Platform::TwoFrame,
            (_, MountKind::Stage) => Platform::Stage,
        }
    }

    fn aim(&self) -> Aim {
        match (self.sigma, self.seconds) {
            (None, None) => match self.method {
                Method::Stepwise => Aim::Circle,
                _ => Aim::Time(USUAL),
            },
            (None, Some(seconds)) => Aim::Time(seconds),
            (Some(sigma_deg), seconds) => {
                Aim::Accuracy { sigma_deg, seconds: seconds.unwrap_or(ALLOWED) }
            }
        }
    }
}

impl RunOptions {
    /// How the run goes on. A recording is to be replayed, and a fault seen, as it ever was; and where nobody knows
    /// how long the alignment takes, the base must not drive off.
    fn hold(&self) -> Hold {
        let is_watched = self.record.is_some() || self.fault.is_some();
        let is_plain = is_watched || self.no_base_imu || self.sigma.is_some();
        match self.method {
            Method::Rotating => Hold::default(),
            _ => self.keeping.hold(is_plain),
        }
    }
}

impl From<&RunOptions> for Scenario {
    fn from(options: &RunOptions) -> Self {
        let hold = options.hold();
        Self {
            seed: options.seed,
            latitude_deg: options.latitude,
            azimuth_deg: options.azimuth.rem_euclid(360.0),
            pitch_deg: options.pitch,
            roll_deg: options.roll,
            gyro: options.gyro.unwrap_or(Gyro::Fog).into(),
            sample_rate_hz: options.rate.unwrap_or(RATE),
            aim: options.aim(),
            survey_s: options.survey.unwrap_or(0.0),
            half: options.half.map(Into::into),
            positions: options.positions.map_or(POSITIONS, |count| count as usize),
            dwell_s: options.dwell.unwrap_or(DWELL),
            sway_deg: options.sway.unwrap_or(0.0),
            sway_hz: options.sway_hertz,
            has_base_imu: (options.sway.is_some()
                || hold.seconds > 0.0
                || options.fault.is_some_and(Asked::is_of_base_imu))
                && !options.no_base_imu,
            hold,
            ..Self::default()
        }
    }
}

/// Shows the log and the progress while the board works.
pub(super) struct Terminal(pub Progress);

impl Observer for Terminal {
    fn event(&self, at: Instant, event: &Event) {
        let seconds = at.as_micros() as f64 * 1e-6;
        self.0.log(&format!("{seconds:>11.6} {event}"));
    }

    fn progress(&self, session: &Session) {
        self.0.session(session);
    }

    fn turned(&self, session: &rotating::Session) {
        self.0.steps(session.turns());
    }

    fn stopped(&self, session: &stops::Session) {
        self.0.steps((session.stops().len() as u32, session.procedure().stops as u32));
    }
}

/// Runs the board and tells what came of it.
pub fn run(options: &RunOptions, as_json: bool) -> Result<Told, String> {
    let fault = match options.fault {
        Some(Asked::List) => return faults::list(options.platform(), as_json),
        Some(Asked::One(fault)) => Some(fault),
        None => None,
    };
    let scenario = Scenario::from(options);
    if let Method::Spin = options.method {
        let scenario = options.spinning.scenario(options.seed);
        return super::spinning::run(&scenario, fault, options.report.as_deref(), as_json);
    }
    if let Method::Siap = options.method {
        let scenario = options.driving.scenario(&scenario, options.rate);
        return super::driving::run(&scenario, fault, options.report.as_deref(), as_json);
    }
    if let Method::Rotating = options.method {
        let scenario = options.turning.scenario(&scenario);
        let report = options.report.as_deref();
        return super::turning::run(&options.turning, &scenario, fault, report, as_json);
    }
    if options.mount == MountKind::TwoFrame {
        return run_frames(&scenario, fault, options, as_json);
    }
    let begun = WallClock::now();
    let (KeptRun { run, kept }, recorded) = simulate(&scenario, fault, options)?;
    let details = RunDetails::of(&run, &kept, scenario.sample_rate_hz, begun.elapsed());
    let told = tell(NAME, &run, details, &scenario, options, as_json)?;
    Ok(told.with_written(recorded))
}

/// What the pages and texts call a run.
const NAME: &str = "the simulated run";

/// Tells what came of a run at standstills; what it kept, where no alignment of it stands.
fn tell(
    name: &str,
    run: &Run,
    details: RunDetails,
    scenario: &Scenario,
    options: &RunOptions,
    as_json: bool,
) -> Result<Told, String> {
    let truth = Truth { azimuth_deg: Some(scenario.azimuth_deg), ..Truth::default() };
    let finished: &dyn Finished =
        if run.conclusion().is_some() { &run.replay } else { &KeptAzimuth };
    let outcome = finished.outcome(&truth).of_run(scenario.seed, details);
    let shown = Shown { name, outcome, finished, truth: &truth, body: None };
    shown.told(options.report.as_deref(), as_json)
}

/// Runs the board with a two-frame mount and tells what came of it.
fn run_frames(
    base: &Scenario,
    fault: Option<Fault>,
    options: &RunOptions,
    as_json: bool,
) -> Result<Told, String> {
    let passes = options.passes.map_or(PASSES, |count| count as usize);
    let scenario = FramesScenario { base: *base, passes, ..FramesScenario::default() };
    let begun = WallClock::now();
    let watch = Terminal(Progress::new(0, "positions"));
    let frames = instrument::align_frames(&scenario, fault, NoRecorder, &watch);
    watch.0.finish();
    let FramesRun { run, axis: [forward, right, down], kept } =
        frames.map_err(|error| error.to_string())?;
    let stored = run.events.iter().any(|(_, event)| matches!(event, Event::Stored(..)));
    let mut details = RunDetails::of(&run, &kept, base.sample_rate_hz, begun.elapsed());
    details.stored = Some(stored);
    details.truth_off_vertical_deg = Some(degrees(forward.hypot(right).atan2(down)));
    tell("the simulated run on two frames", &run, details, base, options, as_json)
}

/// Runs the board; the run with what it kept, and whether its recording is whole.
fn simulate(
    scenario: &Scenario,
    fault: Option<Fault>,
    options: &RunOptions,
) -> Result<(KeptRun, Result<(), String>), String> {
    let watch = Terminal(Progress::new(0, "positions"));
    let mut recorded = Ok(());
    let run = match &options.record {
        None => align(scenario, fault, NoRecorder, &watch),
        Some(path) => {
            let failed = |error: std::io::Error| unwritten::told("the recording", path, &error);
            let mut samples = Samples::default();
            let run = align(scenario, fault, &mut samples, &watch);
            if let Ok(KeptRun { run, .. }) = &run {
                recorded = recorder::write(path, scenario, run, &samples.0).map_err(failed);
            }
            run
        }
    };
    watch.0.finish();
    run.map(|run| (run, recorded)).map_err(|error| error.to_string())
}

/// Runs it on a base with sensors, or without.
fn align<R: Recorder>(
    scenario: &Scenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &Terminal,
) -> Result<KeptRun, RunError> {
    if scenario.has_base_imu {
        let plan = KeptPlan::of(fault);
        return instrument::align_and_keep(scenario, &plan, recorder, watch, ());
    }
    let run = instrument::align(scenario, fault, recorder, watch)?;
    Ok(KeptRun { run, kept: Kept::default() })
}

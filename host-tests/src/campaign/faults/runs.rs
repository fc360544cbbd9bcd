//! One run of a platform with a fault in its middle, on the shortest schedule that shows it.

use firmware::event::Event;
use firmware::health::Health;
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::units::Radians;
use simulated::coarse::CoarseClass;
use simulated::fault::{Fault, Platform};
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::spin::SpinScenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;

use crate::instrument::{Run, RunError, Trial};
use crate::methods::stepwise::Replay;
use crate::output::{azimuth_error, degrees};

/// Sample rate of all but the spinning body, Hz.
const RATE_HZ: f64 = 100.0;
/// The same where the base sways, Hz: a coarse IMU that is read less often gives fewer outputs, which leave more of it.
const SWAYING_RATE_HZ: f64 = 400.0;
/// Amplitude of the base's sway where the coarse IMU is what fails, °.
const SWAY_DEG: f64 = 0.1;
/// Passes on two frames.
const PASSES: usize = 2;
/// Speed of the turntable, Hz, its rate-modulated turns, and its turns each way.
const SPEED_HZ: f64 = 0.2;
const MODULATED_TURNS: u32 = 6;
const TURNS: u32 = 4;
/// Stops of the vehicle, how long it levels at each, and how long it drives between them, s.
const STOPS: usize = 2;
const STOP_S: f64 = 30.0;
const DRIVE_S: f64 = 600.0;
/// How long the spinning body flies, s: a chip that fails in the middle is given up by then.
const FLIGHT_S: f64 = 3.0;
/// Greatest 1σ of a roll that is one, °.
const ROLL_SIGMA_DEG: f64 = 10.0;

/// How a run ended; by default how one did that came to no end.
#[derive(Debug, Default)]
pub(super) struct Ended {
    /// Error in σ, where there is an azimuth or a roll.
    pub(super) error_sigmas: Option<f64>,
    /// Why there is none.
    pub(super) reason: Option<String>,
    pub(super) events: Vec<Event>,
    pub(super) health: Health,
    /// Dwells that were measured again, and that were left out.
    pub(super) dwells: Option<[usize; 2]>,
    pub(super) seconds: f64,
    pub(super) violations: usize,
}

impl Ended {
    fn new<R, T>(run: &Run<R, T>, verdict: Result<f64, String>) -> Self {
        Self {
            error_sigmas: verdict.as_ref().ok().copied(),
            reason: verdict.err(),
            events: run.events.iter().map(|(_, event)| *event).collect(),
            health: run.health,
            dwells: None,
            seconds: run.seconds,
            violations: run.violations.len(),
        }
    }

    /// How a run with dwells ended.
    fn with_dwells<T>(run: &Run<Replay, T>, truth_deg: f64) -> Result<Self, RunError> {
        let conclusion = run.conclusion().ok_or(RunError::Deadlock)?;
        let left_out = conclusion.disturbances.iter().filter(|why| why.is_some()).count();
        let dwells = Some([run.replay.session.repetitions.len(), left_out]);
        Ok(Self { dwells, ..Self::new(run, in_sigmas(conclusion.verdict, truth_deg)) })
    }
}

/// The error of an azimuth in σ, or why there is none.
fn in_sigmas(verdict: Result<Azimuth, Refusal>, truth_deg: f64) -> Result<f64, String> {
    let azimuth = verdict.map_err(|reason| reason.to_string())?;
    Ok(azimuth_error(azimuth.angle.degrees(), truth_deg) / azimuth.sigma.degrees())
}

/// Runs a platform with a fault.
pub(super) fn run(platform: Platform, fault: Fault, seed: u64) -> Result<Ended, RunError> {
    match platform {
        Platform::Stage => on_stage(fault, seed),
        Platform::TwoFrame => on_frames(fault, seed),
        Platform::Turntable => on_turntable(fault, seed),
        Platform::Vehicle => in_vehicle(fault, seed),
        Platform::Spin => in_flight(fault, seed),
    }
}

/// The default site and gyro; where the coarse IMU fails, on a base that sways, with one that is fine enough
/// for an answer in a short time.
fn base(fault: Fault, seed: u64) -> Scenario {
    let base = Scenario { sample_rate_hz: RATE_HZ, ..Scenario::usual(seed) };
    if !matches!(fault, Fault::Chip(Device::Base, _)) {
        return base;
    }
    let base = Scenario { sample_rate_hz: SWAYING_RATE_HZ, ..base };
    Scenario { sway_deg: SWAY_DEG, has_base_imu: true, coarse: CoarseClass::FINE, ..base }
}

fn on_stage(fault: Fault, seed: u64) -> Result<Ended, RunError> {
    let scenario = base(fault, seed);
    let run = Trial::of(&scenario).fault(Some(fault)).run()?;
    Ended::with_dwells(&run, scenario.azimuth_deg)
}

fn on_frames(fault: Fault, seed: u64) -> Result<Ended, RunError> {
    let scenario =
        FramesScenario { base: base(fault, seed), passes: PASSES, ..FramesScenario::default() };
    let run = Trial::of(&scenario).fault(Some(fault)).run()?;
    Ended::with_dwells(&run, scenario.base.azimuth_deg)
}

fn on_turntable(fault: Fault, seed: u64) -> Result<Ended, RunError> {
    // Its alignment does not need the coarse IMU, which measures no sway of its base.
    let scenario = TurntableScenario {
        base: Scenario { sway_deg: 0.0, ..base(fault, seed) },
        speeds_hz: [SPEED_HZ, 0.0],
        modulated_turns: MODULATED_TURNS,
        turns: TURNS,
        ..TurntableScenario::default()
    };
    let run = Trial::of(&scenario).fault(Some(fault)).run()?;
    let conclusion = run.replay.conclusion().ok_or(RunError::Deadlock)?;
    Ok(Ended::new(&run, in_sigmas(conclusion.verdict, scenario.base.azimuth_deg)))
}

fn in_vehicle(fault: Fault, seed: u64) -> Result<Ended, RunError> {
    let usual = VehicleScenario::usual(seed);
    let scenario = VehicleScenario { stops: STOPS, stop_s: STOP_S, drive_s: DRIVE_S, ..usual };
    let found = Trial::of(&scenario).fault(Some(fault)).run()?;
    let conclusion = found.replay.conclusion().ok_or(RunError::Deadlock)?;
    let truth_deg = degrees(found.truth.attitude.azimuth_rad);
    Ok(Ended::new(&found, in_sigmas(conclusion.verdict, truth_deg)))
}

fn in_flight(fault: Fault, seed: u64) -> Result<Ended, RunError> {
    let scenario = SpinScenario { seed, seconds: FLIGHT_S, ..SpinScenario::default() };
    let flown = Trial::of(&scenario).fault(Some(fault)).run()?;
    let spin = &flown.replay.spin;
    let verdict = match (flown.ended(), spin.sigma().map(Radians::degrees)) {
        (Some(reason), _) => Err(reason.to_string()),
        (None, Some(sigma)) if sigma <= ROLL_SIGMA_DEG => {
            let [roll, truth] = [spin.roll().rad(), flown.truth.end.roll_rad].map(degrees);
            Ok(azimuth_error(roll, truth) / sigma)
        }
        (None, Some(sigma)) => Err(format!("σ of the roll at the end is {sigma:.1}°")),
        (None, None) => Err(format!("the roll is not known at the end: {}", spin.state())),
    };
    Ok(Ended::new(&flown, verdict))
}

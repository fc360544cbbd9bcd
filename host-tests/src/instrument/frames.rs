//! Wires one simulated board with a two-frame mount to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{acquire, on_mount};
use firmware::gimbal::Gimbal;
use firmware::keep::Keeping;
use firmware::ports::{NoBase, Recorder, Store};
use firmware::sway::{CompensatesSway, SwayCompensation};
use hal_mock::plant::journey::JourneyConfiguration;
use orientation::alignment::stepwise::session::Session;
use orientation::attitude::Keeper;
use orientation::signal::Sample;
use simulated::Wires;
use simulated::fault::{Fault, FaultyRecorder};
use simulated::mount::FramesScenario;

use super::harness::Harness;
use super::kept::KeptPlan;
use super::latest::Latest;
use super::trial::{Carrier, Trial};
use super::{Run, RunError};
use crate::methods::stepwise::{POSITIONS, Replay, given_with};

/// A finished run on a two-frame mount, with the true direction of the gyro's axis at the end: forward,
/// right, down in the base.
pub type FramesRun = Run<Replay, [f64; 3]>;

impl Carrier for FramesScenario {
    type Sample = Sample;
    type Plan = KeptPlan;
    type Run = FramesRun;

    fn plan(&self, fault: Option<Fault>) -> KeptPlan {
        KeptPlan::of(fault)
    }

    fn run<R: Recorder, T: Store>(trial: Trial<'_, Self, R, T>) -> Result<FramesRun, RunError> {
        let (scenario, plan) = (trial.carrier, trial.plan.clone());
        if !scenario.base.has_base_imu {
            return align_on(NoBase, None, trial);
        }
        plan.on_base(&scenario.base, scenario.alignment_seconds(), |imu, journey| {
            align_on(SwayCompensation::new(imu), journey, trial)
        })
    }
}

/// Makes a trial with these sensors on a base that goes along a journey where there is one.
fn align_on<B: CompensatesSway, R: Recorder, T: Store>(
    base: B,
    journey: Option<JourneyConfiguration<'_>>,
    trial: Trial<'_, FramesScenario, R, T>,
) -> Result<FramesRun, RunError> {
    let Trial { carrier: scenario, plan, watch, traffic, recorder, store } = trial;
    let injection = &plan.chips;
    let outside = || RunError::Latitude(scenario.base.latitude_deg);
    let setting = scenario.setting().ok_or_else(outside)?;
    let mut session = Latest::of(Session::new(setting, scenario.procedure())?);
    let frames = scenario.frames()?;
    let board = RefCell::new(scenario.board(journey, injection));
    let harness = Harness::new(watch, traffic);
    let channels = harness.channels();
    let configuration = scenario.base.configuration();
    let wires = Wires(&board, injection);
    let mut sensors = wires.frame_sensors(scenario, base);
    let mut actuator = wires.actuators();
    let mut keeper = Keeper::new(&scenario.base.keeper().ok_or_else(outside)?);
    let policy = scenario.base.policy();
    let ended = harness.run(
        acquire(&mut on_mount(&mut sensors, &configuration, &frames, &channels)),
        &mut Gimbal::new(&mut actuator, &frames, &channels.shared),
        (&mut session, Some(Keeping { keeper: &mut keeper, policy })),
        (&scenario.base.hold.aiding(), FaultyRecorder::new(recorder, injection.hang), store),
        (scenario.settings(), &channels),
    )?;
    let [outer, inner] = board.borrow().plant.frames();
    let misalignment = scenario.gimbal(None, injection).misalignment;
    let axis = misalignment.axes(outer.angle_rad, inner.angle_rad).sensitive;
    let (session, is_cut_short) = harness.concluded::<Sample, _>(session);
    let replay = Replay { method: POSITIONS, session, assumed: given_with(scenario.base.half) };
    Ok(harness.clear(ended, &board, (replay, is_cut_short), axis))
}

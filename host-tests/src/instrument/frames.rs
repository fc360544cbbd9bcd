//! Wires one simulated board with a two-frame mount to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{acquire, on_mount};
use firmware::gimbal::Gimbal;
use firmware::keep::Keeping;
use firmware::ports::{Frames, NoBase, Observer, Ports, Recorder, Store};
use firmware::run::navigate;
use firmware::simulated::Wires;
use firmware::simulated::base;
use firmware::simulated::fault::{Fault, FaultyRecorder, Injection};
use firmware::simulated::keep::journey;
use firmware::simulated::mount::FramesScenario;
use firmware::sway::{CompensatesSway, SwayCompensation};
use hal_mock::gimbal::board::GimbalBoard;
use orientation::alignment::stepwise::session::Session;
use orientation::attitude::Keeper;

use super::harness::{self, Harness};
use super::kept::{Kept, KeptPlan};
use super::{Run, RunError};
use crate::methods::stepwise::{POSITIONS, Replay, given_with};

/// A finished run on a two-frame mount.
#[derive(Clone, Debug)]
pub struct FramesRun {
    /// What every simulated board brings back.
    pub run: Run,
    /// The true direction of the gyro's axis at the end: forward, right, down in the base.
    pub axis: [f64; 3],
}

/// Runs a scenario in virtual time on this thread, with a fault in its middle or none.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align_frames<R: Recorder, W: Observer>(
    scenario: &FramesScenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<FramesRun, RunError> {
    align_frames_and_keep(scenario, &KeptPlan::of(fault), recorder, watch, ())
}

/// Runs a scenario and goes on as it says, on a base with sensors where it has them; with a store of the
/// heading over a loss of supply.
///
/// # Errors
/// Fails as [`align_frames`] does.
pub fn align_frames_and_keep<R: Recorder, W: Observer>(
    scenario: &FramesScenario,
    plan: &KeptPlan,
    recorder: R,
    watch: &W,
    store: impl Store,
) -> Result<FramesRun, RunError> {
    if !scenario.base.has_base_imu {
        let board = RefCell::new(scenario.board(None, &plan.chips));
        return align_with(&board, NoBase, scenario, &plan.chips, recorder, watch, store);
    }
    let day = plan.day(scenario.day());
    let journey = journey(&day, &plan.base);
    let journey = (scenario.base.hold.seconds > 0.0).then_some(journey);
    let rig = RefCell::new(base::rig(&scenario.base, journey.as_ref()));
    let mut imu = base::imu(&rig, &scenario.base, &plan.chips);
    let board = RefCell::new(scenario.board(journey, &plan.chips));
    let mut frames = align_with(
        &board,
        SwayCompensation::new(&mut imu),
        scenario,
        &plan.chips,
        recorder,
        watch,
        store,
    )?;
    let rig = rig.borrow();
    let violations = base::violations(&rig).iter();
    frames.run.violations.extend(violations.map(|violation| format!("Base: {violation}")));
    frames.run.kept = Kept::of(&frames.run.reports, day.configuration().motion());
    Ok(frames)
}

/// Runs a scenario on a board with these sensors on the base.
fn align_with<B: CompensatesSway, R: Recorder, W: Observer>(
    board: &RefCell<GimbalBoard<'_>>,
    base: B,
    scenario: &FramesScenario,
    injection: &Injection,
    recorder: R,
    watch: &W,
    store: impl Store,
) -> Result<FramesRun, RunError> {
    let outside = || RunError::Latitude(scenario.base.latitude_deg);
    let setting = scenario.setting().ok_or_else(outside)?;
    let mut session = Session::new(setting, scenario.procedure()).map_err(RunError::Procedure)?;
    let frames = scenario.frames().map_err(RunError::Mount)?;
    let harness = Harness::new(watch);
    let channels = harness.channels();
    let latest = Frames::unread();
    let configuration = scenario.base.configuration();
    let wires = Wires(board, injection);
    let mut sensors = wires.frame_sensors(scenario).with_base(base);
    let recorder = FaultyRecorder::new(recorder, injection.hang);
    let Ports { mut actuator, mut link, mut recorder } =
        wires.frame_ports(harness.wire(), recorder);
    let mut keeper = Keeper::new(&scenario.keeper().ok_or_else(outside)?);
    let policy = scenario.base.policy().ok_or_else(outside)?;
    let ended = harness::run(
        acquire(&mut on_mount(&mut sensors, &configuration, &frames, &latest, &channels)),
        navigate(
            &mut Gimbal::new(&mut actuator, &frames, &latest, &channels.shared),
            &mut session,
            Some(Keeping { keeper: &mut keeper, policy, store }),
            &scenario.base.hold.aiding(),
            (&mut link, &mut recorder),
            &channels,
        ),
    )?;
    let [outer, inner] = board.borrow().plant.frames();
    let misalignment = scenario.gimbal(None, injection).misalignment;
    let axis = misalignment.axes(outer.angle_rad, inner.angle_rad).sensitive;
    let replay = Replay {
        method: POSITIONS,
        setting: *session.setting(),
        session,
        assumed: given_with(scenario.base.half),
    };
    let run = harness.clear(&ended, board, replay);
    Ok(FramesRun { run, axis })
}

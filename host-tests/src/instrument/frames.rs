//! Wires one simulated board with a two-frame mount to the instrument and runs it.

use std::cell::RefCell;

use firmware::ports::{Frames, NoBase, NoRecorder, Observer};
use firmware::run::{acquire_frames, run_frames};
use firmware::simulated::base;
use firmware::simulated::mount::{self, FramePlan, FramesScenario};
use firmware::steady::Base;
use orientation::session::Session;

use super::desk::{self, ASSUMED, Desk};
use super::{Run, RunError};
use crate::replay::{Method, Replay};

/// A finished run on a two-frame mount.
#[derive(Clone, Debug)]
pub struct FramesRun {
    /// As of any board.
    pub run: Run,
    /// The true direction of the gyro's axis at the end: forward, right, down in the base.
    pub axis: [f64; 3],
}

/// Runs a scenario in virtual time on this thread.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align_frames<W: Observer>(
    scenario: &FramesScenario,
    plan: &FramePlan,
    watch: &W,
) -> Result<FramesRun, RunError> {
    if !scenario.base.has_base_imu {
        return align_frames_on(NoBase, scenario, plan, watch);
    }
    let rig = RefCell::new(base::rig(&scenario.base));
    let mut frames = align_frames_on(base::imu(&rig, &scenario.base), scenario, plan, watch)?;
    let rig = rig.borrow();
    let violations = base::violations(&rig).iter();
    frames.run.violations.extend(violations.map(|violation| format!("Base: {violation}")));
    Ok(frames)
}

/// The same with these sensors on the base.
fn align_frames_on<B: Base, W: Observer>(
    base: B,
    scenario: &FramesScenario,
    plan: &FramePlan,
    watch: &W,
) -> Result<FramesRun, RunError> {
    let setting = scenario.setting().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
    let mut session = Session::new(setting, scenario.procedure()).map_err(RunError::Procedure)?;
    let frames = scenario.frames().map_err(RunError::Mount)?;
    let board = RefCell::new(scenario.board(plan));
    let desk = Desk::new(watch);
    let seams = desk.seams();
    let latest = Frames::unread();
    let configuration = scenario.base.configuration();
    let mut sensors = mount::sensors(&board, scenario).with_base(base);
    let mut ports = mount::ports(&board, desk.wire(), NoRecorder);
    let ended = desk::run(
        acquire_frames(&mut sensors, &configuration, &frames, &latest, &seams),
        run_frames(&mut ports, &frames, &latest, &mut session, &seams),
    )?;
    let [outer, inner] = board.borrow().gimbal.frames();
    let misalignment = scenario.gimbal(plan).misalignment;
    let axis = misalignment.axes(outer.angle_rad, inner.angle_rad).sensitive;
    let replay = Replay {
        method: Method::Positions,
        setting: *session.setting(),
        session,
        assumed: vec![ASSUMED.to_owned()],
    };
    let violations = desk::told(mount::violations(&board.borrow()));
    Ok(FramesRun { run: desk.clear(&ended, violations, replay), axis })
}

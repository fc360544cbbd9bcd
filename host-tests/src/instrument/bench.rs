//! Wires one simulated board to the instrument and runs it.

use std::cell::RefCell;

use firmware::ports::{NoBase, Observer, Recorder};
use firmware::run::{acquire, run};
use firmware::simulated;
use firmware::simulated::base;
use firmware::simulated::fault::{Fault, FaultyRecorder, Plan};
use firmware::simulated::scenario::Scenario;
use firmware::steady::Base;
use orientation::session::Session;

use super::desk::{self, ASSUMED, Desk};
use super::{Run, RunError};
use crate::replay::{HALF, Method, Replay};

/// Runs a scenario in virtual time on this thread.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align<R: Recorder, W: Observer>(
    scenario: &Scenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<Run, RunError> {
    if !scenario.has_base_imu {
        return align_on(NoBase, scenario, fault, recorder, watch);
    }
    let rig = RefCell::new(base::rig(scenario));
    let mut run = align_on(base::imu(&rig, scenario), scenario, fault, recorder, watch)?;
    let rig = rig.borrow();
    run.violations
        .extend(base::violations(&rig).iter().map(|violation| format!("Base: {violation}")));
    Ok(run)
}

/// The same with these sensors on the base.
///
/// # Errors
/// Those of [`align`].
pub fn align_on<B: Base, R: Recorder, W: Observer>(
    base: B,
    scenario: &Scenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<Run, RunError> {
    let setting = scenario.setting().ok_or(RunError::Latitude(scenario.latitude_deg))?;
    let mut session = Session::new(setting, scenario.procedure()).map_err(RunError::Procedure)?;
    let plan = Plan::of(fault);
    let board = RefCell::new(simulated::board(scenario, &plan));
    let desk = Desk::new(watch);
    let seams = desk.seams();
    let configuration = scenario.configuration();
    let mut sensors = simulated::sensors(&board, scenario, &plan).with_base(base);
    let recorder = FaultyRecorder::new(recorder, plan.hang);
    let mut ports = simulated::ports(&board, &plan, desk.wire(), recorder);
    let ended = desk::run(
        acquire(&mut sensors, &configuration, &seams),
        run(&mut ports, &configuration, &mut session, &seams),
    )?;
    let assumed = [ASSUMED].into_iter().chain(scenario.half.map(|_| HALF));
    let replay = Replay {
        method: Method::of(&session),
        setting: *session.setting(),
        session,
        assumed: assumed.map(str::to_owned).collect(),
    };
    let violations = desk::told(simulated::violations(&board.borrow()));
    Ok(desk.clear(&ended, violations, replay))
}

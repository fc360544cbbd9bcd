//! Wires one simulated board with a turning platform to the instrument and runs it.

use std::cell::RefCell;

use firmware::ports::{Observer, Recorder};
use firmware::run::{acquire, run_rotating};
use firmware::simulated;
use firmware::simulated::fault::{Fault, FaultyRecorder};
use firmware::simulated::turntable::{self, TurntableScenario};
use orientation::session::rotating;

use super::desk::{self, Desk};
use super::{Run, RunError};

/// A finished run on a turning platform.
#[derive(Clone, Debug)]
pub struct TurntableRun {
    /// As of any board.
    pub run: Run<rotating::Session>,
    /// The platform's true rate at the end, rad/s.
    pub rate: f64,
}

/// Runs a scenario in virtual time on this thread.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align_turning<R: Recorder, W: Observer>(
    scenario: &TurntableScenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<TurntableRun, RunError> {
    let setting = scenario.setting().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
    let mut session =
        rotating::Session::new(setting, scenario.procedure()).map_err(RunError::Procedure)?;
    let plan = scenario.plan(fault);
    let board = RefCell::new(scenario.board(&plan));
    let desk = Desk::new(watch);
    let seams = desk.seams();
    let configuration = scenario.configuration();
    let platform = scenario.turntable();
    let mut sensors = turntable::sensors(&board, scenario, &plan);
    let recorder = FaultyRecorder::new(recorder, plan.hang);
    let mut ports = turntable::ports(&board, &plan, desk.wire(), recorder);
    let ended = desk::run(
        acquire(&mut sensors, &configuration, &seams),
        run_rotating(&mut ports, &platform, &mut session, &seams),
    )?;
    let violations = desk::told(simulated::violations(&board.borrow()));
    let rate = board.borrow().plant.truth().stage.rate_rad_s;
    Ok(TurntableRun { run: desk.clear(&ended, violations, session), rate })
}

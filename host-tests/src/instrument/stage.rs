//! Wires one simulated board to the instrument and runs it.

use std::cell::RefCell;

use drivers::tmc5160::configuration::Configuration as Motor;
use firmware::acquire::{acquire, on_stage};
use firmware::keep::Keeping;
use firmware::ports::{NoBase, Observer, Ports, Recorder, Store};
use firmware::run::navigate;
use firmware::simulated::base;
use firmware::simulated::fault::{Fault, FaultyRecorder, Injection};
use firmware::simulated::keep::journey;
use firmware::simulated::scenario::{self, Scenario};
use firmware::simulated::{self, Chips, Wires};
use firmware::stage::Stage;
use firmware::sway::{CompensatesSway, SwayCompensation};
use orientation::alignment::stepwise::session::Session;
use orientation::attitude::Keeper;

use super::harness::{self, Harness};
use super::kept::{Kept, KeptPlan};
use super::{Run, RunError};
use crate::methods::stepwise::{Replay, given_with, name_of};

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
    align_and_keep(scenario, &KeptPlan::of(fault), recorder, watch, ())
}

/// Runs a scenario and, where the base has sensors, what follows its alignment; with a store of the heading over a
/// loss of supply.
///
/// # Errors
/// Fails as [`align`] does.
pub fn align_and_keep<R: Recorder, W: Observer>(
    scenario: &Scenario,
    plan: &KeptPlan,
    recorder: R,
    watch: &W,
    store: impl Store,
) -> Result<Run, RunError> {
    if !scenario.has_base_imu {
        let board = RefCell::new(simulated::board(scenario, None, &plan.chips));
        return align_with(&board, NoBase, scenario, &plan.chips, recorder, watch, store);
    }
    let day = plan.day(scenario.day());
    let journey = journey(&day, &plan.base);
    let journey = (scenario.hold.seconds > 0.0).then_some(journey);
    let rig = RefCell::new(base::rig(scenario, journey.as_ref()));
    let mut imu = base::imu(&rig, scenario, &plan.chips);
    let board = RefCell::new(simulated::board(scenario, journey, &plan.chips));
    let mut run = align_with(
        &board,
        SwayCompensation::new(&mut imu),
        scenario,
        &plan.chips,
        recorder,
        watch,
        store,
    )?;
    let rig = rig.borrow();
    run.violations
        .extend(base::violations(&rig).iter().map(|violation| format!("Base: {violation}")));
    run.kept = Kept::of(&run.reports, day.configuration().motion());
    Ok(run)
}

/// Runs a scenario with these sensors on the base.
///
/// # Errors
/// Fails as [`align`] does.
pub fn align_on<B: CompensatesSway, R: Recorder, W: Observer>(
    base: B,
    scenario: &Scenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<Run, RunError> {
    let injection = Injection::of(fault);
    let board = RefCell::new(simulated::board(scenario, None, &injection));
    align_with(&board, base, scenario, &injection, recorder, watch, ())
}

fn align_with<B: CompensatesSway, R: Recorder, W: Observer>(
    board: &RefCell<Chips<'_>>,
    base: B,
    scenario: &Scenario,
    injection: &Injection,
    recorder: R,
    watch: &W,
    store: impl Store,
) -> Result<Run, RunError> {
    let outside = || RunError::Latitude(scenario.latitude_deg);
    let setting = scenario.setting().ok_or_else(outside)?;
    let mut session = Session::new(setting, scenario.procedure()).map_err(RunError::Procedure)?;
    let harness = Harness::new(watch);
    let channels = harness.channels();
    let configuration = scenario.configuration();
    let wires = Wires(board, injection);
    let mut sensors = wires.sensors(scenario, scenario::FORCE).with_base(base);
    let recorder = FaultyRecorder::new(recorder, injection.hang);
    let Ports { mut actuator, mut link, mut recorder } =
        wires.ports(Motor::default(), harness.wire(), recorder);
    let mut keeper = Keeper::new(&scenario.keeper().ok_or_else(outside)?);
    let policy = scenario.policy().ok_or_else(outside)?;
    let ended = harness::run(
        acquire(&mut on_stage(&mut sensors, &configuration, &channels)),
        navigate(
            &mut Stage::new(&mut actuator, &configuration.stage, &channels.shared),
            &mut session,
            Some(Keeping { keeper: &mut keeper, policy, store }),
            &scenario.hold.aiding(),
            (&mut link, &mut recorder),
            &channels,
        ),
    )?;
    let replay = Replay {
        method: name_of(&session),
        setting: *session.setting(),
        session,
        assumed: given_with(scenario.half),
    };
    Ok(harness.clear(&ended, board, replay))
}

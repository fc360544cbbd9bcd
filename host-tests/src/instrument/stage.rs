//! Wires one simulated board to the instrument and runs it.

use std::cell::RefCell;

use drivers::tmc5160::configuration::Configuration as Motor;
use firmware::acquire::{acquire, on_stage};
use firmware::keep::Keeping;
use firmware::ports::{NoBase, Recorder, Store};
use firmware::stage::Stage;
use firmware::sway::{CompensatesSway, SwayCompensation};
use hal_mock::plant::journey::JourneyConfiguration;
use orientation::alignment::stepwise::session::Session;
use orientation::attitude::Keeper;
use orientation::signal::Sample;
use simulated::fault::{Fault, FaultyRecorder};
use simulated::scenario::{self, Scenario};
use simulated::{self, Wires};

use super::harness::Harness;
use super::kept::KeptPlan;
use super::latest::Latest;
use super::trial::{Carrier, Trial};
use super::{Run, RunError};
use crate::methods::stepwise::{Replay, given_with, name_of};

impl Carrier for Scenario {
    type Sample = Sample;
    type Plan = KeptPlan;
    type Run = Run;

    fn plan(&self, fault: Option<Fault>) -> KeptPlan {
        KeptPlan::of(fault)
    }

    fn run<R: Recorder, T: Store>(trial: Trial<'_, Self, R, T>) -> Result<Run, RunError> {
        let (scenario, plan) = (trial.carrier, trial.plan.clone());
        if !scenario.has_base_imu {
            return align_on(NoBase, None, trial);
        }
        plan.on_base(scenario, scenario.alignment_seconds(), |imu, journey| {
            align_on(SwayCompensation::new(imu), journey, trial)
        })
    }
}

/// Makes a trial with these sensors on a base that goes along a journey where there is one.
///
/// # Errors
/// As [`Trial::run`](super::Trial::run).
pub fn align_on<B: CompensatesSway, R: Recorder, T: Store>(
    base: B,
    journey: Option<JourneyConfiguration<'_>>,
    trial: Trial<'_, Scenario, R, T>,
) -> Result<Run, RunError> {
    let Trial { carrier: scenario, plan, watch, traffic, recorder, store } = trial;
    let injection = &plan.chips;
    let outside = || RunError::Latitude(scenario.latitude_deg);
    let setting = scenario.setting().ok_or_else(outside)?;
    let mut session = Latest::of(Session::new(setting, scenario.procedure())?);
    let board = RefCell::new(simulated::board(scenario, journey, injection));
    let harness = Harness::new(watch, traffic);
    let channels = harness.channels();
    let configuration = scenario.configuration();
    let wires = Wires(&board, injection);
    let mut sensors = wires.sensors(scenario, scenario::FORCE, base);
    let mut actuator = wires.actuator(Motor::default());
    let mut keeper = Keeper::new(&scenario.keeper().ok_or_else(outside)?);
    let ended = harness.run(
        acquire(&mut on_stage(&mut sensors, &configuration, &channels)),
        &mut Stage::new(&mut actuator, &configuration.stage, &channels.shared),
        (&mut session, Some(Keeping { keeper: &mut keeper, policy: scenario.policy() })),
        (&scenario.hold.aiding(), FaultyRecorder::new(recorder, injection.hang), store),
        (scenario.settings(), &channels),
    )?;
    let (session, is_cut_short) = harness.concluded::<Sample, _>(session);
    let replay = Replay { method: name_of(&session), session, assumed: given_with(scenario.half) };
    Ok(harness.clear(ended, &board, (replay, is_cut_short), ()))
}

//! Wires one simulated board on a turning platform to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{acquire, on_stage};
use firmware::configuration::TurntableConfiguration;
use firmware::keep::Keeping;
use firmware::ports::{NoBase, Recorder, Store};
use firmware::storage::{CalibrationStore, SharedStore, load_calibration};
use firmware::sway::{CompensatesSway, SwayCompensation};
use firmware::turntable::Turntable;
use hal_mock::plant::journey::JourneyConfiguration;
use orientation::alignment::rotating::session as rotating;
use orientation::attitude::Keeper;
use orientation::signal::Sample;
use simulated::Wires;
use simulated::fault::{Fault, FaultyRecorder};
use simulated::turntable::{self, TurntableScenario};

use super::harness::Harness;
use super::kept::KeptPlan;
use super::latest::Latest;
use super::trial::{Carrier, Trial};
use super::{Run, RunError};
use crate::virtual_time;

/// A finished run on a turning platform, with its true rate at the end, rad/s.
pub type TurntableRun = Run<rotating::Session, f64>;

impl Carrier for TurntableScenario {
    type Sample = Sample;
    type Plan = KeptPlan;
    type Run = TurntableRun;

    fn plan(&self, fault: Option<Fault>) -> KeptPlan {
        KeptPlan { chips: self.injection(fault), ..KeptPlan::of(None) }
    }

    fn run<R: Recorder, T: Store>(trial: Trial<'_, Self, R, T>) -> Result<TurntableRun, RunError> {
        let (scenario, plan) = (trial.carrier, trial.plan.clone());
        if !scenario.base.has_base_imu {
            return align_on(NoBase, None, trial);
        }
        plan.on_base(&scenario.base, scenario.alignment_seconds(), |imu, journey| {
            align_on(SwayCompensation::for_keeping(imu), journey, trial)
        })
    }
}

/// Makes a trial with these sensors on a base that goes along a journey where there is one.
fn align_on<B: CompensatesSway, R: Recorder, T: Store>(
    base: B,
    journey: Option<JourneyConfiguration<'_>>,
    trial: Trial<'_, TurntableScenario, R, T>,
) -> Result<TurntableRun, RunError> {
    let Trial { carrier: scenario, plan, watch, traffic, recorder, store } = trial;
    let outside = || RunError::Latitude(scenario.base.latitude_deg);
    let mut setting = scenario.setting().ok_or_else(outside)?;
    let mut procedure = scenario.procedure();
    let injection = &plan.chips;
    let board = RefCell::new(scenario.board(journey, injection));
    let harness = Harness::new(watch, traffic);
    let channels = &harness.channels();
    let store = &SharedStore::new(store);
    if let Some(today) = scenario.today {
        let given = (&mut setting, &mut procedure);
        let mut opened = store;
        let load = load_calibration(&mut opened, today, given, &channels.shared);
        virtual_time::run(load).map_err(|_| RunError::Deadlock)?;
    }
    let mut session = Latest::of(rotating::Session::new(setting, procedure)?);
    let configuration = scenario.base.configuration();
    let platform = TurntableConfiguration::default();
    let wires = Wires(&board, injection);
    let mut sensors = wires.sensors(&scenario.base, turntable::FORCE, base);
    let mut actuator = wires.actuator(turntable::motor());
    let mut keeper = Keeper::new(&scenario.base.keeper().ok_or_else(outside)?);
    let policy = scenario.base.policy();
    let calibrations = scenario.today.map(|_| CalibrationStore { store, channels });
    let recorder = (FaultyRecorder::new(recorder, injection.hang), calibrations);
    let ended = harness.run(
        acquire(&mut on_stage(&mut sensors, &configuration, channels)),
        &mut Turntable::new(&mut actuator, &platform, &channels.shared),
        (&mut session, Some(Keeping { keeper: &mut keeper, policy })),
        (&scenario.base.hold.aiding(), recorder, store),
        (scenario.settings(), channels),
    )?;
    let rate = board.borrow().plant.truth().stage.rate_rad_s;
    let session = harness.concluded::<Sample, _>(session);
    Ok(harness.clear(ended, &board, session, rate))
}

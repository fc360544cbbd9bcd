//! Wires one simulated board on a turning platform to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{acquire, on_stage};
use firmware::configuration::TurntableConfiguration;
use firmware::keep::Keeping;
use firmware::ports::{NoBase, Recorder, Store};
use firmware::run::navigate;
use firmware::storage::{CalibrationStore, SharedStore, Today, load_calibration};
use firmware::sway::{CompensatesSway, SwayCompensation};
use firmware::turntable::Turntable;
use hal_mock::plant::journey::JourneyConfiguration;
use orientation::alignment::rotating::session as rotating;
use orientation::attitude::Keeper;
use orientation::signal::Sample;
use simulated::Wires;
use simulated::fault::{Fault, FaultyRecorder};
use simulated::turntable::{self, TurntableScenario};

use super::harness::{self, Harness};
use super::kept::KeptPlan;
use super::trial::{Carrier, Trial};
use super::{Run, RunError};
use crate::virtual_time;

/// What goes wrong on a turning platform, and the day, where it keeps misalignments.
#[derive(Clone, Debug)]
pub struct TurntablePlan {
    /// What goes wrong with its chips, its axis and its base.
    pub kept: KeptPlan,
    /// The day; without one no misalignment is taken from the store, and none kept in it.
    pub today: Option<Today>,
}

/// A finished run on a turning platform.
#[derive(Clone, Debug)]
pub struct TurntableRun {
    /// What every simulated board brings back.
    pub run: Run<rotating::Session>,
    /// The platform's true rate at the end, rad/s.
    pub rate: f64,
}

impl Carrier for TurntableScenario {
    type Sample = Sample;
    type Plan = TurntablePlan;
    type Run = TurntableRun;

    fn plan(&self, fault: Option<Fault>) -> TurntablePlan {
        let chips = self.injection(fault);
        TurntablePlan { kept: KeptPlan { chips, ..KeptPlan::of(None) }, today: None }
    }

    fn run<R: Recorder, T: Store>(trial: Trial<'_, Self, R, T>) -> Result<TurntableRun, RunError> {
        let (scenario, plan) = (trial.carrier, trial.plan.clone());
        if !scenario.base.has_base_imu {
            return align_on(NoBase, None, trial);
        }
        plan.kept.on_base(
            &scenario.base,
            scenario.alignment_seconds(),
            |found: &mut TurntableRun| &mut found.run,
            |imu, journey| align_on(SwayCompensation::for_keeping(imu), journey, trial),
        )
    }
}

/// Makes a trial with these sensors on a base that goes along a journey where there is one.
fn align_on<B: CompensatesSway, R: Recorder, T: Store>(
    base: B,
    journey: Option<JourneyConfiguration<'_>>,
    trial: Trial<'_, TurntableScenario, R, T>,
) -> Result<TurntableRun, RunError> {
    let Trial { carrier: scenario, plan, watch, recorder, store } = trial;
    let outside = || RunError::Latitude(scenario.base.latitude_deg);
    let mut setting = scenario.setting().ok_or_else(outside)?;
    let mut procedure = scenario.procedure();
    let injection = &plan.kept.chips;
    let board = RefCell::new(scenario.board(journey, injection));
    let harness = Harness::new(watch);
    let channels = &harness.channels();
    let store = &SharedStore::new(store);
    if let Some(today) = plan.today {
        let given = (&mut setting, &mut procedure);
        let mut opened = store;
        let load = load_calibration(&mut opened, today, given, &channels.shared);
        virtual_time::run(load).map_err(|_| RunError::Deadlock)?;
    }
    let mut session = rotating::Session::new(setting, procedure)?;
    let configuration = scenario.base.configuration();
    let platform = TurntableConfiguration::default();
    let wires = Wires(&board, injection);
    let mut sensors = wires.sensors(&scenario.base, turntable::FORCE).with_base(base);
    let recorder = FaultyRecorder::new(recorder, injection.hang);
    let mut actuator = wires.actuator(turntable::motor());
    let mut keeper = Keeper::new(&scenario.base.keeper().ok_or_else(outside)?);
    let policy = scenario.base.policy().ok_or_else(outside)?;
    let calibrations = plan.today.map(|_| CalibrationStore { store, channels });
    let ended = harness::run(
        acquire(&mut on_stage(&mut sensors, &configuration, channels)),
        navigate(
            &mut Turntable::new(&mut actuator, &platform, &channels.shared),
            &mut session,
            Some(Keeping { keeper: &mut keeper, policy, store }),
            &scenario.base.hold.aiding(),
            (&mut harness.wire(), &mut (recorder, calibrations)),
            channels,
        ),
    )?;
    let rate = board.borrow().plant.truth().stage.rate_rad_s;
    Ok(TurntableRun { run: harness.clear(ended, &board, session), rate })
}

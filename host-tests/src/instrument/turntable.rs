//! Wires one simulated board with a turning platform to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{acquire, on_stage};
use firmware::configuration::TurntableConfiguration;
use firmware::ports::{Observer, Ports, Recorder};
use firmware::run::navigate;
use firmware::simulated::Wires;
use firmware::simulated::fault::{Fault, FaultyRecorder};
use firmware::simulated::flash::Flash;
use firmware::simulated::turntable::{self, TurntableScenario};
use firmware::storage::{FlashStore, Today, load_calibration, save_calibration};
use firmware::turntable::Turntable;
use orientation::alignment::rotating::session as rotating;

use super::harness::{self, Harness};
use super::{Run, RunError};
use crate::virtual_time;

/// The store of a board that keeps misalignments, and what it is given of the time.
pub struct Keeping {
    /// Where they are kept.
    pub store: FlashStore<Flash>,
    /// The day.
    pub today: Today,
}

/// A finished run on a turning platform.
#[derive(Clone, Debug)]
pub struct TurntableRun {
    /// What every simulated board brings back.
    pub run: Run<rotating::Session>,
    /// The platform's true rate at the end, rad/s.
    pub rate: f64,
}

/// Runs a scenario in virtual time on this thread, on a board that keeps nothing.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align_turning<R: Recorder, W: Observer>(
    scenario: &TurntableScenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<TurntableRun, RunError> {
    align_turning_again(scenario, fault, recorder, watch, None)
}

/// Runs a scenario on a board that may have stored axis misalignments, and stores those that it finds.
///
/// # Errors
/// Fails as [`align_turning`] does.
pub fn align_turning_again<R: Recorder, W: Observer>(
    scenario: &TurntableScenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
    mut keeping: Option<&mut Keeping>,
) -> Result<TurntableRun, RunError> {
    let mut setting = scenario.setting().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
    let mut procedure = scenario.procedure();
    let injection = scenario.injection(fault);
    let board = RefCell::new(scenario.board(&injection));
    let harness = Harness::new(watch);
    let channels = harness.channels();
    if let Some(Keeping { store, today }) = &mut keeping {
        let given = (&mut setting, &mut procedure);
        let prepared = virtual_time::run(load_calibration(store, *today, given, &channels.shared));
        prepared.map_err(|_| RunError::Deadlock)?;
    }
    let mut session = rotating::Session::new(setting, procedure).map_err(RunError::Procedure)?;
    let configuration = scenario.base.configuration();
    let platform = TurntableConfiguration::default();
    let wires = Wires(&board, &injection);
    let mut sensors = wires.sensors(&scenario.base, turntable::FORCE);
    let recorder = FaultyRecorder::new(recorder, injection.hang);
    let Ports { mut actuator, mut link, mut recorder } =
        wires.ports(turntable::motor(), harness.wire(), recorder);
    let instrument = async {
        let health = navigate(
            &mut Turntable::new(&mut actuator, &platform, &channels.shared),
            &mut session,
            None::<firmware::keep::Keeping<'_, ()>>,
            &(),
            (&mut link, &mut recorder),
            &channels,
        )
        .await;
        if let Some(Keeping { store, .. }) = keeping {
            save_calibration(store, &session, &channels).await;
        }
        health
    };
    let ended =
        harness::run(acquire(&mut on_stage(&mut sensors, &configuration, &channels)), instrument)?;
    let rate = board.borrow().plant.truth().stage.rate_rad_s;
    Ok(TurntableRun { run: harness.clear(&ended, &board, session), rate })
}

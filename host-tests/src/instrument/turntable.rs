//! Wires one simulated board with a turning platform to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{acquire, on_stage};
use firmware::configuration::TurntableConfiguration;
use firmware::keep::NotKept;
use firmware::ports::{Ports, Recorder, Store};
use firmware::run::navigate;
use firmware::storage::{Today, load_calibration, save_calibration};
use firmware::turntable::Turntable;
use orientation::alignment::rotating::session as rotating;
use orientation::signal::Sample;
use simulated::Wires;
use simulated::fault::{Fault, FaultyRecorder, Injection};
use simulated::turntable::{self, TurntableScenario};

use super::harness::{self, Harness};
use super::trial::{Around, Carrier};
use super::{Run, RunError};
use crate::virtual_time;

/// What goes wrong on a turning platform, and the day, where it keeps misalignments.
#[derive(Clone, Debug)]
pub struct TurntablePlan {
    /// Faults of its chips and of its axis.
    pub chips: Injection,
    /// The day; without one nothing is taken from the store, and nothing kept in it.
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
        TurntablePlan { chips: self.injection(fault), today: None }
    }

    fn run<R: Recorder, T: Store>(
        &self,
        plan: &TurntablePlan,
        around: Around<'_, R, T>,
    ) -> Result<TurntableRun, RunError> {
        let mut setting = self.setting().ok_or(RunError::Latitude(self.base.latitude_deg))?;
        let mut procedure = self.procedure();
        let Around { watch, recorder, mut store } = around;
        let injection = &plan.chips;
        let board = RefCell::new(self.board(injection));
        let harness = Harness::new(watch);
        let channels = harness.channels();
        if let Some(today) = plan.today {
            let given = (&mut setting, &mut procedure);
            let load = load_calibration(&mut store, today, given, &channels.shared);
            let prepared = virtual_time::run(load);
            prepared.map_err(|_| RunError::Deadlock)?;
        }
        let mut session =
            rotating::Session::new(setting, procedure).map_err(RunError::Procedure)?;
        let configuration = self.base.configuration();
        let platform = TurntableConfiguration::default();
        let wires = Wires(&board, injection);
        let mut sensors = wires.sensors(&self.base, turntable::FORCE);
        let recorder = FaultyRecorder::new(recorder, injection.hang);
        let Ports { mut actuator, mut link, mut recorder } =
            wires.ports(turntable::motor(), harness.wire(), recorder);
        let instrument = async {
            let health = navigate(
                &mut Turntable::new(&mut actuator, &platform, &channels.shared),
                &mut session,
                NotKept,
                &(),
                (&mut link, &mut recorder),
                &channels,
            )
            .await;
            if plan.today.is_some() {
                save_calibration(&mut store, &session, &channels).await;
            }
            health
        };
        let ended = harness::run(
            acquire(&mut on_stage(&mut sensors, &configuration, &channels)),
            instrument,
        )?;
        let rate = board.borrow().plant.truth().stage.rate_rad_s;
        Ok(TurntableRun { run: harness.clear(&ended, &board, session), rate })
    }
}

//! Wires one simulated board in a vehicle to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{TriadAcquisition, acquire};
use firmware::keep::Keeping;
use firmware::mechanism::Strapdown;
use firmware::ports::{Recorder, Store};
use hal_mock::vehicle::VehicleTruth;
use orientation::alignment::stops;
use orientation::attitude::Keeper;
use orientation::signal::InertialSample;
use simulated::Wires;
use simulated::fault::{Fault, FaultyRecorder, Injection};
use simulated::vehicle::{Day, VehicleAiding, VehicleScenario};

use super::harness::Harness;
use super::latest::Latest;
use super::trial::{Carrier, Trial};
use super::{Run, RunError};

/// What a vehicle does, and what goes wrong.
#[derive(Clone, Debug)]
pub struct VehiclePlan {
    /// Its day, with what its sensors feel wrongly.
    pub day: Day,
    /// Faults of its chips.
    pub chips: Injection,
}

/// A finished run in a vehicle, with what was true at the end.
pub type VehicleRun = Run<stops::Session, VehicleTruth>;

impl VehicleRun {
    /// The true azimuth at the latest alignment's last sample, rad: at the end, unless the vehicle went on.
    #[must_use]
    pub fn azimuth_rad(&self) -> f64 {
        self.found_rad.unwrap_or(self.truth.attitude.azimuth_rad)
    }
}

impl Carrier for VehicleScenario {
    type Sample = InertialSample;
    type Plan = VehiclePlan;
    type Run = VehicleRun;

    fn plan(&self, fault: Option<Fault>) -> VehiclePlan {
        VehiclePlan { day: self.day(fault), chips: self.injection(fault) }
    }

    fn run<R: Recorder<InertialSample>, T: Store>(
        trial: Trial<'_, Self, R, T>,
    ) -> Result<VehicleRun, RunError> {
        let Trial { carrier: scenario, plan, watch, traffic, recorder, store } = trial;
        let VehiclePlan { day, chips: injection } = &plan;
        let setting = scenario.setting().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
        let mut session = Latest::of(stops::Session::new(setting, scenario.procedure())?);
        let board = RefCell::new(scenario.board(&day.legs, &day.events, injection));
        let harness = Harness::new(watch, traffic);
        let channels = harness.channels();
        let mut sensors = Wires(&board, injection).triad(scenario);
        let aiding = VehicleAiding::new(&board, scenario);
        let setting = scenario.keeper().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
        let mut keeper = Keeper::new(&setting);
        let keeping = Some(Keeping { keeper: &mut keeper, policy: scenario.policy() });
        let ended = harness.run(
            acquire(&mut TriadAcquisition::new(&mut sensors, &scenario.configuration(), &channels)),
            &mut Strapdown::new(&channels.shared),
            (&mut session, keeping),
            (&aiding, FaultyRecorder::new(recorder, injection.hang), store),
            (scenario.settings(), &channels),
        )?;
        let truth = board.borrow().plant.truth();
        let session = harness.concluded::<InertialSample, _>(session);
        let mut run = harness.clear(ended, &board, session, truth);
        run.compare(day.configuration().motion());
        Ok(run)
    }
}

//! Wires one simulated board in a vehicle to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{TriadAcquisition, acquire};
use firmware::event::Event;
use firmware::keep::Keeping;
use firmware::mechanism::Strapdown;
use firmware::ports::{Observer, Recorder, Store};
use firmware::run::navigate;
use firmware::simulated::Wires;
use firmware::simulated::fault::{Fault, FaultyRecorder, Injection};
use firmware::simulated::vehicle::{Day, VehicleAiding, VehicleScenario};
use hal_mock::vehicle::VehicleTruth;
use hal_mock::vehicle::board::VehicleBoard;
use orientation::alignment::{Progress, stops};
use orientation::attitude::Keeper;
use orientation::signal::InertialSample;

use super::harness::{self, Harness};
use super::kept::{Kept, Point};
use super::{Run, RunError};

/// A finished run in a vehicle.
#[derive(Clone, Debug)]
pub struct VehicleRun {
    /// What every simulated board brings back.
    pub run: Run<stops::Session>,
    /// What was true at the end.
    pub truth: VehicleTruth,
}

impl VehicleRun {
    /// The true azimuth when the session concluded, rad: at the end, unless the vehicle went on.
    #[must_use]
    pub fn azimuth_rad(&self) -> f64 {
        let is_conclusion =
            |event: &Event| matches!(event, Event::Alignment(Progress::Concluded(_)));
        let mut events = self.run.events.iter();
        let at =
            events.find(|(_, event)| is_conclusion(event)).map(|(at, _)| at.as_micros() as f64);
        let later = |point: &&Point| at.is_some_and(|at| point.seconds() * 1e6 >= at);
        let point = self.run.kept.points.iter().find(later);
        point.map_or(self.truth.attitude.azimuth_rad, |point| point.truth.azimuth_rad)
    }
}

/// Runs a scenario in virtual time on this thread.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align_stops<R: Recorder<InertialSample>, W: Observer>(
    scenario: &VehicleScenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<VehicleRun, RunError> {
    let (day, injection) = (scenario.day(fault), scenario.injection(fault));
    align_stops_along(&day, &injection, scenario, recorder, watch, ())
}

/// Runs a scenario on a given day, with what goes wrong, and with a store of the heading over a loss of supply.
///
/// # Errors
/// Fails as [`align_stops`] does.
pub fn align_stops_along<R: Recorder<InertialSample>, W: Observer>(
    day: &Day,
    injection: &Injection,
    scenario: &VehicleScenario,
    recorder: R,
    watch: &W,
    store: impl Store,
) -> Result<VehicleRun, RunError> {
    let board = RefCell::new(scenario.board(&day.legs, &day.events, injection));
    let mut found = align_stops_on(&board, injection, scenario, recorder, watch, store)?;
    found.run.kept = Kept::of(&found.run.reports, day.configuration().motion());
    Ok(found)
}

/// Runs a scenario on a board to which something else may be done, with something around its ports.
///
/// # Errors
/// Fails as [`align_stops`] does.
pub fn align_stops_on<R: Recorder<InertialSample>, W: Observer>(
    board: &RefCell<VehicleBoard<'_>>,
    injection: &Injection,
    scenario: &VehicleScenario,
    recorder: R,
    watch: &W,
    store: impl Store,
) -> Result<VehicleRun, RunError> {
    let setting = scenario.setting().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
    let session = stops::Session::new(setting, scenario.procedure());
    let mut session = session.map_err(RunError::Procedure)?;
    let harness = Harness::new(watch);
    let channels = harness.channels();
    let mut sensors = Wires(board, injection).triad(scenario);
    let aiding = VehicleAiding::new(board, scenario);
    let setting = scenario.keeper().ok_or(RunError::Latitude(scenario.base.latitude_deg))?;
    let mut keeper = Keeper::new(&setting);
    let ended = harness::run(
        acquire(&mut TriadAcquisition::new(&mut sensors, &scenario.configuration(), &channels)),
        navigate(
            &mut Strapdown::new(&channels.shared),
            &mut session,
            Some(Keeping { keeper: &mut keeper, policy: scenario.policy(), store }),
            &aiding,
            (&mut harness.wire(), &mut FaultyRecorder::new(recorder, injection.hang)),
            &channels,
        ),
    )?;
    let truth = board.borrow().plant.truth();
    let run = harness.clear(&ended, board, session);
    Ok(VehicleRun { run, truth })
}

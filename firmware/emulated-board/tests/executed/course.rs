//! A whole course from power-on: survey, conclusions, headings that are saved and forgotten, a page of the store that is
//! erased, drives and a realignment. No conversion is lost in it.

use emulated_board::run::Order;
use emulated_board::world::World;
use firmware::platform::Platform;
use simulated::hold::Hold;
use simulated::scenario::Scenario;
use simulated::vehicle::VehicleScenario;

use super::support::executed::{Executed, execute_in};
use super::support::figure::within;
use super::support::worlds::{FULL, worn_store};

/// Drives of a vehicle and its stops after the first alignment, and for how long it goes on after it, s.
const DRIVE_SECONDS: f64 = 30.0;
const STOP_SECONDS: f64 = 40.0;
const AFTERWARDS: f64 = 150.0;
/// Shortest survey of a stage, and dwells of which a plan is to take no longer, s.
const SURVEY_SECONDS: f64 = 60.0;
const DWELL_SECONDS: f64 = 8.0;

/// Holds that a course lost nothing, told nothing that is false, and had a page erased in it.
fn lost_nothing(shown: &Executed) {
    let report = &shown.report;
    let lost: u64 = report.service.iter().map(|service| service.lost).sum();
    within(lost as f64, 0.0..=0.0, "conversions are lost in a course");
    assert_eq!(report.false_notices(), 0, "{:?}: {}", report.false_notices, shown.text());
    assert_eq!(shown.lines("missing").count(), 0, "{}", shown.text());
    assert!(report.resets.is_empty() && report.violations.is_empty(), "{report:?}");
    assert!(report.flash_use.pages >= 1, "{:?}: {}", report.flash_use, shown.text());
}

#[test]
fn a_vehicle_that_drives_stops_and_aligns_anew_loses_no_conversion() {
    let usual = simulated::executed::vehicle(1);
    let hold = Hold {
        realigns: true,
        drive_s: DRIVE_SECONDS,
        stop_s: Some(STOP_SECONDS),
        ..Hold::of(AFTERWARDS)
    };
    let scenario = VehicleScenario { base: Scenario { hold, ..usual.base }, ..usual };
    let settings = scenario.settings().expect("the scenario has a latitude");
    let world = World::driving(&scenario).expect("its settings are possible");
    let order = Order { afterwards: AFTERWARDS, ..Order::usual(Platform::Vehicle, 1) };
    let shown = execute_in(&order, world.with_store(worn_store(&settings, FULL)));
    lost_nothing(&shown);
    assert_eq!(shown.lines("handed over").count(), 1, "{}", shown.text());
    assert!(shown.lines("realigned: ").count() >= 1, "{}", shown.text());
}

#[test]
fn a_stage_that_surveys_its_gyro_aligns_and_saves_loses_no_conversion() {
    let usual = simulated::executed::stage(1);
    let scenario = Scenario { survey_s: SURVEY_SECONDS, dwell_s: DWELL_SECONDS, ..usual };
    let settings = scenario.settings().expect("the scenario has a latitude");
    let world = World::stepping(&scenario).expect("its settings are possible");
    let shown = execute_in(
        &Order::usual(Platform::Stage, 1),
        world.with_store(worn_store(&settings, FULL)),
    );
    lost_nothing(&shown);
    assert_eq!(shown.lines("survey").count(), 1, "{}", shown.text());
    assert_eq!(shown.lines("handed over").count(), 1, "{}", shown.text());
}

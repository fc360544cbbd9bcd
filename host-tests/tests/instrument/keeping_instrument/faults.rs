//! Something goes wrong while an azimuth is kept: the state says so, the recovery is automatic, and no error
//! is greater than is said.

use super::{at, departure, frames, keep, reported, sigmas};
use embassy_time::{Duration, Instant};
use hal_mock::chip::Select;
use hal_mock::fault::{BusFault, FaultPlan, When};
use hal_mock::sensor_fault::{SensorFailure, SensorFault};
use hal_mock::vehicle::Event;
use host::instrument::FramesRun;
use host::instrument::kept::KeptPlan;
use simulated::fault::Injection;
use simulated::hold::Hold;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;

/// How long after its departure something goes wrong with a base, s.
const AFTER: f64 = 60.0;

fn scenario() -> FramesScenario {
    frames(1, Hold::of(300.0))
}

fn moment(seconds: f64) -> Instant {
    Instant::from_micros((seconds * 1e6) as u64)
}

fn lost(seconds: f64, for_s: f64) -> When {
    When::during(moment(seconds), Duration::from_micros((for_s * 1e6) as u64))
}

fn injected(scenario: &FramesScenario, chips: Injection) -> FramesRun {
    keep(scenario, &KeptPlan { chips, ..KeptPlan::of(None) })
}

fn bus_error(select: Select, when: When) -> Injection {
    let plan = FaultPlan { fault: BusFault::Error, when };
    Injection { buses: [(select, plan)].into_iter().collect(), ..Injection::NONE }
}

/// No error is greater than is said, and the level is found again at the end.
fn check(found: &FramesRun) {
    let [worst, within] = sigmas(&found.kept);
    assert!(worst < 4.5 && within > 0.98, "{worst} σ, {within}: {:#?}", reported(found));
    let last = found.kept.last().expect("it was kept");
    let [pitch, roll] = last.level_error().map(f64::to_degrees);
    // Where it stands gravity shows the level; on the road coarse gyros have it within what they say.
    let bound = if last.report.is_at_rest { 2.0 } else { 4.5 * last.report.level_sigma.degrees() };
    assert!(pitch.abs().max(roll.abs()) < bound, "{pitch}°, {roll}°, {bound}°");
}

fn has(found: &FramesRun, words: &str) -> bool {
    reported(found).iter().any(|line| line.contains(words))
}

#[test]
fn coarse_sensors_that_are_lost_at_rest_for_less_than_a_second_cost_nothing() {
    let scenario = scenario();
    let stands = departure(&scenario) - 25.0;
    let coarse_imu = Some(lost(stands, 0.5));
    let found = injected(&scenario, Injection { coarse_imu, ..Injection::NONE });
    assert!(has(&found, "base: reading lost"), "{:#?}", reported(&found));
    assert!(!has(&found, "the azimuth is lost"), "{:#?}", reported(&found));
    check(&found);
}

/// What nothing has measured for seconds nothing confirms, whether the base went on standing or not.
#[test]
fn an_azimuth_does_not_outlast_seconds_without_coarse_sensors() {
    let scenario = scenario();
    let stands = departure(&scenario) - 25.0;
    let coarse_imu = Some(lost(stands, 4.0));
    let found = injected(&scenario, Injection { coarse_imu, ..Injection::NONE });
    assert!(has(&found, "no motion is measured"), "{:#?}", reported(&found));
    assert!(has(&found, "the azimuth is lost"), "{:#?}", reported(&found));
    check(&found);
}

#[test]
fn coarse_sensors_that_are_lost_on_the_way_come_back_and_nothing_wrong_is_reported() {
    let scenario = scenario();
    let coarse_imu = Some(lost(departure(&scenario) + AFTER, 3.0));
    let found = injected(&scenario, Injection { coarse_imu, ..Injection::NONE });
    assert!(has(&found, "no motion is measured"), "{:#?}", reported(&found));
    check(&found);
}

/// The alignment ends, since its samples have the sway. All else goes on.
#[test]
fn coarse_sensors_that_are_given_up_while_their_sway_is_subtracted_cost_no_other_device_anything() {
    let scenario = scenario();
    let base = Scenario { sway_deg: 0.1, sway_hz: 0.3, ..scenario.base };
    let coarse_imu = Some(When::always(moment(60.0)));
    let plan = Injection { coarse_imu, ..Injection::NONE };
    let lines = reported(&injected(&FramesScenario { base, ..scenario }, plan));
    let count = |words: &str| lines.iter().filter(|line| line.contains(words)).count();
    assert_eq!(count("it is subtracted"), 1, "{lines:#?}");
    assert_eq!(count("no azimuth: base: "), 1, "{lines:#?}");
    assert!(count("base: given up") > 1, "{lines:#?}");
    assert_eq!(count("given up"), count("base: given up"), "{lines:#?}");
    assert_eq!(count("missing"), 0, "{lines:#?}");
}

#[test]
fn coarse_gyros_that_clip_are_reported_and_the_level_comes_back() {
    let scenario = scenario();
    let from_s = departure(&scenario) + AFTER;
    let clipped = |gyro| SensorFault {
        failure: SensorFailure::Saturated(gyro),
        from_s,
        until_s: from_s + 1.0,
    };
    let base = (0..3).map(clipped).collect();
    let found = keep(&scenario, &KeptPlan { base, ..KeptPlan::of(None) });
    assert!(has(&found, "rotation was lost"), "{:#?}", reported(&found));
    check(&found);
}

#[test]
fn coarse_sensors_that_are_stuck_are_started_again() {
    let scenario = scenario();
    let from_s = departure(&scenario) + AFTER;
    let stuck = |channel| SensorFault {
        failure: SensorFailure::Stuck(channel),
        from_s,
        until_s: from_s + 3.0,
    };
    let base = (0..6).map(stuck).collect();
    let found = keep(&scenario, &KeptPlan { base, ..KeptPlan::of(None) });
    assert!(has(&found, "base: the same reading again and again"), "{:#?}", reported(&found));
    check(&found);
}

#[test]
fn where_the_precise_gyro_is_lost_the_coarse_one_goes_on() {
    let scenario = scenario();
    let when = When::always(moment(departure(&scenario) + AFTER));
    let found = injected(&scenario, bus_error(Select::Gyro, when));
    assert!(has(&found, "the coarse gyro, as it was compared, shows"), "{:#?}", reported(&found));
    assert!(found.kept.last().is_some_and(|point| point.report.time.seconds() > 400.0));
    check(&found);
}

#[test]
fn without_the_accelerometer_the_gyros_carry_the_level_on() {
    let scenario = scenario();
    let begins = departure(&scenario) + 10.0;
    let found = injected(&scenario, bus_error(Select::Accelerometer, lost(begins, 20.0)));
    assert!(has(&found, "accelerometer: reading lost"), "{:#?}", reported(&found));
    // Starting it again would cost what the base turns meanwhile.
    assert!(!has(&found, "starting it again"), "{:#?}", reported(&found));
    assert!(has(&found, "without forces"), "{:#?}", reported(&found));
    assert!(has(&found, "keeping: level"), "{:#?}", reported(&found));
    check(&found);
}

#[test]
fn a_free_fall_is_reported_and_over_at_once() {
    let scenario = scenario();
    let at_s = departure(&scenario) + AFTER;
    let events = vec![Event::Fall { at_s, seconds: 0.6 }];
    let found = keep(&scenario, &KeptPlan { events, ..KeptPlan::of(None) });
    assert!(has(&found, "falling freely"), "{:#?}", reported(&found));
    let [_, _, level] = at(&found.kept, at_s + 20.0);
    assert!(level.is_some_and(|level| level < 1.5), "{level:?}°");
    check(&found);
}

//! The supply is lost, and comes back.

use super::{reported, vehicle};
use crate::support::inputs::{recorded, replayed};
use crate::support::link::{sentences, states};
use firmware::event::Event;
use firmware::ports::Store;
use firmware::storage::{FlashStore, HEADING};
use hal_mock::vehicle::{Drive, Leg, Stop};
use host::instrument::{Trial, VehiclePlan, VehicleRun};
use orientation::attitude::restart::{RecallRefusal, Remembered};
use orientation::navigation::Progress;
use simulated::fault::Injection;
use simulated::flash::Flash;
use simulated::hold::Hold;
use simulated::scenario::{GyroClass, Scenario};
use simulated::vehicle::{Day, VehicleScenario};

/// Gyros whose biases come back to 0.03 °/h: only such ones can tell whether a vehicle was turned.
const STEADY: GyroClass =
    GyroClass { n_deg_sqrt_h: 0.001, b_deg_h: 0.007, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 0.03 };

fn scenario(seed: u64, seconds: f64, gyro: GyroClass) -> VehicleScenario {
    let usual = vehicle(seed, Hold::of(seconds));
    VehicleScenario { base: Scenario { gyro, ..usual.base }, stops: 2, drive_s: 300.0, ..usual }
}

/// The first run: it aligns itself, and the supply is lost so many seconds later.
fn first(seconds: f64, gyro: GyroClass, store: &mut FlashStore<Flash>) -> VehicleRun {
    let scenario = scenario(1, seconds, gyro);
    let (day, healthy) = (scenario.day(None), Injection::NONE);
    Trial::of(&scenario)
        .plan(VehiclePlan { day, chips: healthy })
        .store(store)
        .run()
        .expect("possible")
}

/// The second: the vehicle stands as it stood, but for these degrees of azimuth and pitch.
fn second(
    before: &VehicleRun,
    turned: [f64; 2],
    gyro: GyroClass,
    store: &mut impl Store,
) -> VehicleRun {
    let (scenario, day) = standing(before, turned, gyro);
    Trial::of(&scenario)
        .plan(VehiclePlan { day, chips: Injection::NONE })
        .store(store)
        .run()
        .expect("possible")
}

/// What the vehicle does in the second run.
fn standing(
    before: &VehicleRun,
    [azimuth, pitch]: [f64; 2],
    gyro: GyroClass,
) -> (VehicleScenario, Day) {
    // Another seed draws other biases, as a start does.
    let scenario = scenario(2, 20.0, gyro);
    let truth = before.kept.last().expect("it was kept").truth;
    let stop = Stop {
        seconds: 90.0,
        pitch_deg: truth.pitch_rad.to_degrees() + pitch,
        roll_deg: truth.roll_rad.to_degrees(),
        ..Stop::default()
    };
    let latitude = scenario.base.latitude_deg;
    let day = Day::standing(latitude, truth.azimuth_rad.to_degrees() + azimuth, stop);
    let scenario = VehicleScenario {
        base: Scenario { azimuth_deg: truth.azimuth_rad.to_degrees() + azimuth, ..scenario.base },
        ..scenario
    };
    (scenario, day)
}

fn refusal(run: &VehicleRun) -> Option<RecallRefusal> {
    run.events.iter().find_map(|(_, event)| match event {
        Event::Navigation(Progress::RecallRefused(refusal)) => Some(*refusal),
        _ => None,
    })
}

fn is_recalled(run: &VehicleRun) -> bool {
    run.events
        .iter()
        .any(|(_, event)| matches!(event, Event::Navigation(Progress::HeadingRecalled(_))))
}

#[test]
fn a_restart_without_motion_keeps_the_heading() {
    let mut store = Flash::default().store();
    let before = first(8.0, STEADY, &mut store);
    let after = second(&before, [0.0, 0.0], STEADY, &mut store);
    assert!(is_recalled(&after), "{:#?}", reported(&after));
    let (point, [error, sigma]) = after.kept.with_azimuth().next().expect("it is known at once");
    assert!(point.seconds() < 20.0, "after {} s", point.seconds());
    assert!(error.abs() < 3.0 * sigma, "{error} of {sigma} rad");
    // With the azimuth of before the restart no receiver steers unawares.
    let (states, headings) = (states(&after.lines), sentences(&after.lines, "HEHDT"));
    let is_recalled = |state: &[&str; 9]| state[0] == "degraded" && state[8] == "recalled";
    assert!(states.iter().any(is_recalled), "{}", after.lines);
    assert_eq!(states.len(), headings.len());
    for (state, heading) in states.iter().zip(headings) {
        assert_eq!(state[0] == "ready", !heading[0].is_empty(), "{state:?} {heading:?}");
    }
}

#[test]
fn a_heading_that_was_recalled_is_recalled_again_by_a_replay() {
    let mut store = Flash::default().store();
    let before = first(8.0, STEADY, &mut store);
    let (scenario, day) = standing(&before, [0.0, 0.0], STEADY);
    let trial = Trial::of(&scenario).plan(VehiclePlan { day, chips: Injection::NONE });
    let (after, text) = recorded(&scenario, trial.store(&mut store));
    assert!(is_recalled(&after), "{:#?}", reported(&after));
    let again = replayed(&text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.done.kept, after.kept);
}

#[test]
fn a_vehicle_that_was_turned_while_it_was_switched_off_is_not_believed() {
    for turned in [30.0, 180.0, -90.0] {
        let mut store = Flash::default().store();
        let before = first(8.0, STEADY, &mut store);
        let after = second(&before, [turned, 0.0], STEADY, &mut store);
        assert!(
            matches!(refusal(&after), Some(RecallRefusal::Turned { .. })),
            "{:?}",
            refusal(&after)
        );
        assert_eq!(after.kept.with_azimuth().count(), 0);
    }
}

/// What gyros of that repeatability determine a turn about the vertical by, 1σ, °: both starts' biases over the Earth's
/// horizontal rate, 15.04 °/h.
fn determined(latitude_deg: f64) -> f64 {
    let bias = f64::sqrt(2.0) * STEADY.bias_sigma_deg_h;
    (bias / (15.041 * latitude_deg.to_radians().cos())).to_degrees()
}

#[test]
fn a_recalled_heading_states_the_turn_that_its_gyros_would_not_show() {
    let mut store = Flash::default().store();
    let before = first(8.0, STEADY, &mut store);
    let (_, [_, saved]) = before.kept.with_azimuth().last().expect("it was kept");
    let flash = store.into_flash();
    let least = determined(scenario(1, 8.0, STEADY).base.latitude_deg);
    for turned in [0.0, 0.1, -0.2, 0.3, -0.4, 0.5, 0.7, -0.9, 1.2] {
        let after = second(&before, [turned, 0.0], STEADY, &mut flash.clone().store());
        let Some((_, [error, sigma])) = after.kept.with_azimuth().next() else {
            assert!(turned.abs() > 2.0 * least, "{turned}° are refused");
            continue;
        };
        assert!(error.abs() < 3.5 * sigma, "{turned}°: {error} of {sigma} rad");
        let expected = saved.to_degrees().hypot(least);
        let ratio = sigma.to_degrees() / expected;
        assert!((0.95..1.2).contains(&ratio), "{turned}°: {ratio} of {expected}°");
    }
}

#[test]
fn a_vehicle_that_was_tilted_while_it_was_switched_off_is_not_believed() {
    let mut store = Flash::default().store();
    let before = first(8.0, STEADY, &mut store);
    let after = second(&before, [0.0, 0.3], STEADY, &mut store);
    assert!(matches!(refusal(&after), Some(RecallRefusal::Tilted { .. })), "{:?}", refusal(&after));
    assert_eq!(after.kept.with_azimuth().count(), 0);
}

#[test]
fn gyros_that_cannot_tell_a_turn_recall_nothing() {
    let mut store = Flash::default().store();
    let before = first(8.0, GyroClass::FIBRE_OPTIC, &mut store);
    let after = second(&before, [0.0, 0.0], GyroClass::FIBRE_OPTIC, &mut store);
    assert!(
        matches!(refusal(&after), Some(RecallRefusal::TurnUnobservable { .. })),
        "{:?}",
        refusal(&after)
    );
}

#[test]
fn a_vehicle_that_has_set_off_since_is_forgotten() {
    let mut store = Flash::default().store();
    // The supply is lost amid a drive.
    let before = first(90.0, STEADY, &mut store);
    let after = second(&before, [0.0, 0.0], STEADY, &mut store);
    assert!(!is_recalled(&after) && refusal(&after).is_none(), "{:#?}", reported(&after));
}

/// The heading that a store holds.
fn kept(store: &mut FlashStore<Flash>) -> Option<Remembered> {
    let item = host::virtual_time::run(store.load(HEADING)).expect("no deadlock");
    let item: Option<[u8; Remembered::BYTES]> = item.expect("the store is sound");
    item.and_then(|bytes| Remembered::from_bytes(&bytes))
}

/// A vehicle that stands as it stood for some seconds, drives for some with a slight turn, and stands again, upright as
/// before.
fn leaving(
    before: &VehicleRun,
    [stands, drives]: [f64; 2],
    store: &mut FlashStore<Flash>,
) -> VehicleRun {
    let (scenario, mut day) = standing(before, [0.0, 0.0], STEADY);
    let way = scenario.day(None);
    let drive = way.legs.iter().find_map(|leg| match leg {
        Leg::Drive(drive) => Some(*drive),
        Leg::Stop(_) => None,
    });
    let drive = Drive {
        seconds: drives,
        heading_change_deg: 0.8,
        turn_s: 0.5 * drives,
        hills_deg: 0.0,
        ..drive.expect("it drives")
    };
    let stop = day.legs.iter().find_map(|leg| match leg {
        Leg::Stop(stop) => Some(*stop),
        Leg::Drive(_) => None,
    });
    let stop = stop.expect("it stands");
    day.legs = [
        Leg::Stop(Stop { seconds: stands, ..stop }),
        Leg::Drive(drive),
        Leg::Stop(Stop { seconds: 120.0, ..stop }),
    ]
    .into_iter()
    .collect();
    Trial::of(&scenario)
        .plan(VehiclePlan { day, chips: Injection::NONE })
        .store(store)
        .run()
        .expect("possible")
}

#[test]
fn a_vehicle_that_sets_off_before_its_heading_is_checked_recalls_nothing_after_the_drive() {
    for times in [[5.0, 40.0], [8.0, 15.0], [8.0, 4.0], [3.0, 4.0], [0.0, 3.0], [0.0, 20.0]] {
        let mut store = Flash::default().store();
        let before = first(8.0, STEADY, &mut store);
        assert!(kept(&mut store).is_some());
        let after = leaving(&before, times, &mut store);
        assert!(!is_recalled(&after), "{times:?}: {:#?}", reported(&after));
        assert!(refusal(&after).is_some(), "{times:?}: {:#?}", reported(&after));
        assert_eq!(kept(&mut store), None, "{times:?}: {:#?}", reported(&after));
    }
}

#[test]
fn a_heading_that_is_not_believed_is_forgotten() {
    let mut store = Flash::default().store();
    let before = first(8.0, STEADY, &mut store);
    let _ = second(&before, [30.0, 0.0], STEADY, &mut store);
    assert_eq!(kept(&mut store), None);
}

#[test]
fn a_power_cut_amid_the_writing_leaves_a_heading_that_is_whole_or_none() {
    // Up to a whole record, denser where its first words are written.
    for words in [0, 1, 2, 3, 5, 8, 13, 21] {
        let mut flash = Flash::default();
        flash.left = Some(words);
        let mut store = flash.store();
        let before = first(8.0, STEADY, &mut store);
        let mut flash = store.into_flash();
        flash.left = None;
        let mut store = flash.store();
        let kept = host::virtual_time::run(store.load(HEADING)).expect("no deadlock");
        let kept = kept
            .ok()
            .flatten()
            .and_then(|bytes: [u8; Remembered::BYTES]| Remembered::from_bytes(&bytes));
        let truth = before.kept.last().expect("it was kept").report;
        if let (Some(kept), Some(azimuth)) = (kept, truth.azimuth) {
            assert!((kept.azimuth.0 - azimuth.angle.0).abs() < 1e-3, "{words} words");
        }
        if words < 2 {
            let reported = reported(&before);
            assert!(reported.iter().any(|line| line.contains("cannot be kept")), "{reported:#?}");
        }
    }
}

//! What is refused, by name, and what is not silently wrong.

use hal_mock::sensor_fault::{SensorFailure, SensorFault};
use hal_mock::vehicle::{Drive, Leg, VehicleSample};
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops;
use orientation::earth::Latitude;

use super::criteria::{day, drive, stop};
use super::drives::{quiet, three, two};
use super::world::{Day, Kind, Place, known};

fn verdict(day: &Day) -> Result<Azimuth, Refusal> {
    day.run().conclusion.verdict
}

macro_rules! assert_refused {
    ($verdict:expr, $pattern:pat) => {
        let verdict = $verdict;
        assert!(matches!(verdict, Err($pattern)), "{verdict:?}");
    };
}

#[test]
fn a_latitude_near_a_pole_is_refused_whatever_the_stops_show() {
    let mut day = two(1);
    day.setting.site.latitude = Latitude::from_degrees(-85.1).expect("it is one");
    assert_refused!(verdict(&day), Refusal::LatitudeTooHigh { .. });
}

#[test]
fn one_stop_is_not_enough() {
    assert_refused!(
        verdict(&day(&[stop(60.0), drive(300.0)], 1)),
        Refusal::Stops(stops::Refusal::OneStop { .. })
    );
}

#[test]
fn stops_that_are_too_short_are_named() {
    let short = day(&[stop(60.0), drive(300.0), stop(14.0), drive(60.0)], 1);
    assert_refused!(verdict(&short), Refusal::Stops(stops::Refusal::StopTooShort { stop: 2, .. }));
    let stated = Day { rests: Kind::At(&[[0.0, 60.0], [362.0, 368.0]]), ..two(1) };
    assert_refused!(verdict(&stated), Refusal::Stops(stops::Refusal::StopTooShort { stop: 2, .. }));
}

#[test]
fn a_drive_of_no_length_is_named() {
    let parked = Day { rests: Kind::At(&[[0.0, 60.0], [60.0, 120.0]]), ..day(&[stop(120.0)], 1) };
    assert_refused!(verdict(&parked), Refusal::Stops(stops::Refusal::DriveTooShort { .. }));
}

#[test]
fn seconds_without_samples_are_named_with_their_time() {
    let faults = vec![SensorFault { failure: SensorFailure::Gap, from_s: 200.0, until_s: 202.0 }];
    let Err(Refusal::Stops(stops::Refusal::RotationMissing { at, .. })) =
        verdict(&Day { faults, ..two(1) })
    else {
        panic!("a gap")
    };
    assert!((at.0 - 200.0).abs() < 0.1, "{at:?}");
}

#[test]
fn a_gyro_at_its_limit_is_named_with_its_time() {
    let mut day = two(1);
    day.scenario.vehicle.gyro_full_scale_rad_s = 10.0;
    day.faults =
        vec![SensorFault { failure: SensorFailure::Saturated(1), from_s: 150.0, until_s: 150.1 }];
    let Err(Refusal::Stops(stops::Refusal::RotationClipped { at })) = verdict(&day) else {
        panic!("it saturates")
    };
    assert!((at.0 - 150.0).abs() < 0.1, "{at:?}");
}

#[test]
fn a_stated_stop_where_the_vehicle_drives_is_none() {
    let day = Day { rests: Kind::At(&[[0.0, 60.0], [200.0, 260.0]]), ..two(1) };
    assert_refused!(verdict(&day), Refusal::Stops(stops::Refusal::VehicleMoves { stop: 2, .. }));
}

#[test]
fn accelerometers_at_their_limit_leave_no_stop() {
    let mut day = two(1);
    day.scenario.vehicle.accelerometer.full_scale_m_s2 = Some(9.5);
    assert_refused!(verdict(&day), Refusal::Stops(stops::Refusal::NoStop));
    day.rests = Kind::Stated;
    assert_refused!(verdict(&day), Refusal::Stops(stops::Refusal::StopTooShort { stop: 1, .. }));
}

#[test]
fn gyros_that_show_nothing_leave_no_stop() {
    let outcome = two(1).run_through(|sample| {
        sample.turned_rad = [0.0; 3];
        true
    });
    assert_refused!(outcome.conclusion.verdict, Refusal::Stops(stops::Refusal::NoStop));
}

#[test]
fn ten_degrees_of_latitude_show_in_gravity() {
    let mut day = two(1);
    day.setting = known(62.0, 0.05, Some(1.0));
    assert_refused!(verdict(&day), Refusal::Stops(stops::Refusal::VehicleMoves { .. }));
}

#[test]
fn the_other_hemisphere_shows_in_the_rest_rates() {
    for seed in 0..4 {
        let mut day = quiet(two(seed));
        day.setting.site.latitude = known(-52.0, 0.0, None).site.latitude;
        assert_refused!(
            verdict(&day),
            Refusal::Stops(stops::Refusal::EarthNotFelt { stops: 2, of: 2 })
        );
    }
}

/// Runs days with changed samples; how many gave an azimuth that is wrong by more than 5 σ, or at all.
#[track_caller]
fn assert_never_silently_wrong(
    name: &str,
    day: impl Fn(u64) -> Day,
    mut change: impl FnMut(&mut VehicleSample),
) {
    for seed in 0..4 {
        let outcome = day(seed).run_through(|sample| {
            change(sample);
            true
        });
        if outcome.conclusion.verdict.is_ok() {
            let ratios = outcome.ratios();
            assert!(
                ratios.iter().all(|ratio| ratio.abs() < 5.0),
                "{name}, seed {seed}: {ratios:?} σ"
            );
        }
    }
}

#[test]
fn signs_and_axes_of_gyros_are_never_silently_wrong() {
    let quiet_two: fn(u64) -> Day = |seed| quiet(two(seed));
    for day in [two, three, quiet_two] {
        for axis in 0..3 {
            let next = (axis + 1) % 3;
            assert_never_silently_wrong("sign of a gyro", day, |sample| {
                sample.turned_rad[axis] *= -1.0;
            });
            assert_never_silently_wrong("swapped gyros", day, |sample| {
                sample.turned_rad.swap(axis, next);
            });
            assert_never_silently_wrong("a dead gyro", day, |sample| sample.turned_rad[axis] = 0.0);
        }
    }
}

#[test]
fn signs_axes_and_biases_of_accelerometers_are_never_silently_wrong() {
    for day in [two, three] {
        for axis in 0..3 {
            let next = (axis + 1) % 3;
            assert_never_silently_wrong("sign", day, |sample| sample.force_m_s2[axis] *= -1.0);
            assert_never_silently_wrong("swapped", day, |sample| {
                sample.force_m_s2.swap(axis, next);
            });
            assert_never_silently_wrong("5 mg that are not stated", day, |sample| {
                sample.force_m_s2[axis] += 0.05;
            });
        }
    }
}

#[test]
fn a_stuck_sensor_is_never_silently_wrong() {
    for channel in [0, 1, 2, 3, 4] {
        for until_s in [210.0, 1e9] {
            let faults = vec![SensorFault {
                failure: SensorFailure::Stuck(channel),
                from_s: 200.0,
                until_s,
            }];
            assert_never_silently_wrong(
                "stuck",
                |seed| Day { faults: faults.clone(), ..two(seed) },
                |_| (),
            );
        }
    }
}

#[test]
fn a_displacement_that_is_wrong_by_kilometres_is_never_silently_wrong() {
    let place = Place::Wrong([3000.0, -4000.0]);
    assert_never_silently_wrong("5 km", |seed| Day { place, ..two(seed) }, |_| ());
    assert_never_silently_wrong("5 km", |seed| Day { place, ..quiet(two(seed)) }, |_| ());
}

#[test]
fn a_vehicle_on_a_turntable_does_not_stand_but_may_be_turned_between() {
    let turn = |seconds, degrees| {
        Leg::Drive(Drive {
            seconds,
            heading_change_deg: degrees,
            winding_s: 1.0,
            hills_s: 1.0,
            ..Drive::default()
        })
    };
    let turning = day(&[stop(60.0), drive(300.0), turn(60.0, 6.0)], 1);
    assert_refused!(verdict(&turning), Refusal::Stops(stops::Refusal::OneStop { .. }));
    // Turned by a quarter at the second stop: two stops at one place.
    let outcome =
        day(&[stop(60.0), drive(300.0), stop(60.0), turn(20.0, 90.0), stop(60.0)], 1).run();
    assert_eq!(outcome.stops.len(), 3);
    assert!(outcome.ratios().iter().all(|ratio| ratio.abs() < 3.5), "{:?}", outcome.ratios());
}

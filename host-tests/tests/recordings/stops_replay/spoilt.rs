//! Recordings spoilt in one place are refused with the reason, or survive it.

use host::methods::asked::Asked;
use host::methods::error::ReplayError;
use host::methods::stops::replay;
use host::recording::{Body, ImuRow, Kind};
use orientation::alignment::refusal::Refusal;

use super::{FOG, IDEAL, PARKED, Recorded, SIGMAS, THREE, conclusion, recorded};

/// The fibre-optic drive with its rows changed.
fn drive(change: impl FnOnce(&mut Vec<ImuRow>)) -> Recorded {
    let mut recorded = recorded(FOG);
    change(&mut recorded.rows);
    recorded
}

/// The fibre-optic drive with other stops, whose displacement is unknown.
fn stops(stops: &[[f64; 2]]) -> Recorded {
    let mut recorded = recorded(FOG);
    recorded.header.stops_s = Some(stops.to_vec());
    recorded.header.displacements_m = None;
    recorded
}

/// The words in which it is refused.
fn words(recorded: &Recorded) -> String {
    recorded.refusal().to_string()
}

#[test]
fn one_stop_alone_is_refused() {
    let reason = words(&stops(&[[0.0, 60.0]]));
    println!("{reason}");
    assert!(reason.contains("stop"), "{reason}");
}

#[test]
fn a_drive_in_which_no_stop_is_found_is_refused() {
    let mut moving = drive(|rows| rows.retain(|row| (100.0..900.0).contains(&row.time_s)));
    moving.header.stops_s = None;
    moving.header.displacements_m = None;
    let reason = words(&moving);
    println!("{reason}");
    assert!(reason.contains("stop"), "{reason}");
}

#[test]
fn stops_that_are_too_short_are_refused() {
    let reason = words(&stops(&[[0.0, 2.0], [960.0, 962.0]]));
    println!("{reason}");
    assert!(reason.contains("stop 1 has 2.0 s of rest"), "{reason}");
}

#[test]
fn a_drive_of_zero_length_is_refused() {
    let reason = words(&stops(&[[0.0, 20.0], [20.0, 40.0]]));
    println!("{reason}");
    assert!(reason.contains("drive") || reason.contains("stop"), "{reason}");
}

#[test]
fn a_stop_that_is_none_is_refused() {
    let reason = words(&stops(&[[0.0, 60.0], [400.0, 460.0], [960.0, 1020.0]]));
    println!("{reason}");
    assert!(reason.contains("stop") || reason.contains("moves"), "{reason}");
}

#[test]
fn a_gap_on_the_way_costs_sigma_and_one_of_seconds_is_refused() {
    let without = |until| drive(|rows| rows.retain(|row| !(500.0..until).contains(&row.time_s)));
    let found = |recorded: &Recorded| recorded.error(conclusion(&recorded.replayed()));
    let ([_, whole], [error, sigma]) = (found(&drive(|_| ())), found(&without(500.4)));
    println!("{error}° ± {sigma}°, without a gap {whole}°");
    assert!(error.abs() <= SIGMAS * sigma && sigma > 1.05 * whole, "{error}° ± {sigma}°");
    let reason = words(&without(502.0));
    assert!(reason.contains("samples are missing after 4"), "{reason}");
}

#[test]
fn a_gyro_at_its_limit_is_refused() {
    let reason = words(&drive(|rows| {
        let turns = rows.iter().map(|row| row.sample.rates_rad_s[2].abs());
        let limit = 0.7 * turns.fold(0.0, f64::max);
        for row in rows {
            let rate = &mut row.sample.rates_rad_s[2];
            *rate = rate.clamp(-limit, limit);
        }
    }));
    println!("{reason}");
    assert!(reason.contains("a gyro stood at the limit of its range"), "{reason}");
}

#[test]
fn an_accelerometer_at_its_limit_is_left_out() {
    let clipped = drive(|rows| {
        let rest = rows.iter_mut().filter(|row| (30.0..50.0).contains(&row.time_s));
        rest.for_each(|row| row.sample.force_m_s2[0] = 19.62);
    });
    let replay = clipped.replayed();
    let [error, sigma] = clipped.error(conclusion(&replay));
    println!("{error}° ± {sigma}°");
    assert!(error.abs() <= SIGMAS * sigma, "{error}° ± {sigma}°");
    assert!(
        (19..=22).contains(&replay.session.stops()[0].left_out),
        "{:?}",
        replay.session.stops()
    );
}

#[test]
fn a_second_without_samples_at_rest_is_refused_or_costs_nothing() {
    let mut recorded = recorded(PARKED);
    recorded.rows.retain(|row| !(200.0..201.0).contains(&row.time_s));
    let replay = recorded.replayed();
    let conclusion = conclusion(&replay);
    if conclusion.verdict.is_ok() {
        let [error, sigma] = recorded.error(conclusion);
        assert!(error.abs() <= SIGMAS * sigma, "{error}° ± {sigma}°");
    }
}

#[test]
fn a_drive_taken_for_a_parked_vehicle_is_refused() {
    let options = Asked { method: Some("static"), ..Asked::default() };
    let replay = recorded(FOG).replayed_by(&options);
    let reason = conclusion(&replay).verdict.expect_err("it drove");
    println!("{reason}");
}

#[test]
fn a_sigma_that_was_not_reached_is_refused() {
    let options = Asked { required_sigma: Some(1e-4_f64.to_radians()), ..Asked::default() };
    let replay = recorded(FOG).replayed_by(&options);
    let reason = conclusion(&replay).verdict.expect_err("1e-4° is out of reach");
    assert!(matches!(reason, Refusal::BudgetNotMet { .. }), "{reason}");
}

#[test]
fn a_latitude_that_is_not_the_vehicles_does_not_pass_in_silence() {
    let mut recorded = recorded(FOG);
    for latitude in [87.0, 20.0, -52.0] {
        recorded.header.latitude_deg = Some(latitude);
        let reason = recorded.refusal();
        println!("{latitude}°: {reason}");
    }
}

#[test]
fn what_keeps_a_replay_from_beginning_is_reported() {
    let recorded = recorded(IDEAL);
    let begin = |recorded: &Recorded, options: &Asked| {
        let body = Body::Imu(recorded.rows.clone());
        replay(&recorded.header, &body, options).map(|_| ())
    };
    let three = vec![[0.0; 2], [1.0; 2], [2.0; 2]];
    let options = Asked { displacements_m: Some(three), ..Asked::default() };
    let error = begin(&recorded, &options).expect_err("three for two");
    assert_eq!(error, ReplayError::Displacements { stated: 3, stops: 2 });
    assert_eq!(error.to_string(), "3 displacements for 2 stops: state one for each stop");

    let mut nowhere = recorded;
    nowhere.header.latitude_deg = None;
    let error = begin(&nowhere, &Asked::default()).expect_err("no latitude");
    assert_eq!(error, ReplayError::NoLatitude(Kind::Imu));

    nowhere.header.latitude_deg = Some(52.0);
    nowhere.header.stops_s =
        Some((0..99).map(|i| f64::from(i) * 10.0).map(|t| [t, t + 5.0]).collect());
    nowhere.header.displacements_m = None;
    let error = begin(&nowhere, &Asked::default()).expect_err("99 stops");
    assert!(error.to_string().contains("99 stops are more than the"), "{error}");

    let dwells = Body::Dwells(Vec::new());
    let error = replay(&nowhere.header, &dwells, &Asked::default()).expect_err("another kind");
    assert_eq!(
        error.to_string(),
        "kind `dwells` is no vehicle: no method siap, static or vertical"
    );
}

/// The refusal of a recording with other displacements, in words.
fn misplaced(recorded: &Recorded, mend: fn([f64; 2]) -> [f64; 2]) -> String {
    let stated = recorded.header.displacements_m.as_ref().expect("they are stated");
    let options = Asked {
        displacements_m: Some(stated.iter().map(|place| mend(*place)).collect()),
        ..Asked::default()
    };
    let replayed = replay(&recorded.header, &Body::Imu(recorded.rows.clone()), &options);
    replayed.map(|_| ()).expect_err("the forces contradict it").to_string()
}

#[test]
fn displacements_that_the_forces_on_the_way_contradict_are_refused_with_their_likely_cause() {
    for name in [FOG, THREE, IDEAL] {
        let recorded = recorded(name);
        for (mend, words) in [
            ((|[n, e]| [1e-3 * n, 1e-3 * e]) as fn([f64; 2]) -> [f64; 2], "in kilometres"),
            (|[n, e]| [e, n], "north and east are exchanged"),
            (|[n, e]| [-n, -e], "their signs are reversed"),
            (|_| [0.0; 2], "correct them, or leave them out"),
        ] {
            let why = misplaced(&recorded, mend);
            let key = "key displacements_north_east_m: from stop 1 to the next it says ";
            assert!(why.starts_with(key) && why.contains(words), "{name}: {why}");
        }
    }
}

#[test]
fn a_displacement_that_the_forces_cannot_tell_is_reported_as_assumed() {
    let mut recorded = recorded(FOG);
    let assumes = |recorded: &Recorded| {
        let replay = recorded.replayed();
        replay.assumed.iter().any(|line| line.starts_with("displacements in metres north and east"))
    };
    assert!(!assumes(&recorded));
    // In the 900 s of the drive, 0.1 m/s² hide more than the 3.4 km of it: 40 km, were they even, and not taken off.
    recorded.header.accelerometer_bias_m_s2 = Some(0.1);
    assert!(assumes(&recorded));
}

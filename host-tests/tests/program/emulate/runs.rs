//! Two runs are compared bit for bit, and where they differ is named.

use bench::emulate::host;
use bench::emulate::outcome::{
    Bits, Difference, DwellBits, FIELDS, KEPT_FIELDS, KeptBits, Outcome, STOP_FIELDS, StopBits,
    TURN_FIELDS, TurnBits, compare,
};
use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::TurntableScenario;
use firmware::simulated::vehicle::VehicleScenario;

fn outcome() -> Outcome {
    let dwell = |rate: f64| -> DwellBits { Bits([Some(rate.to_bits()); FIELDS.len()]) };
    let turn = |rate: f64| -> TurnBits { Bits([Some(rate.to_bits()); TURN_FIELDS.len()]) };
    let stop = |force: f64| -> StopBits { Bits([Some(force.to_bits()); STOP_FIELDS.len()]) };
    let kept = |angle: f64| -> KeptBits { Bits([Some(angle.to_bits()); KEPT_FIELDS.len()]) };
    Outcome {
        seed: 7,
        azimuth_bits: Some(1.25_f64.to_bits()),
        sigma_bits: Some(0.5_f64.to_bits()),
        reason: None,
        dwells: vec![dwell(1.0), dwell(2.0), dwell(3.0)],
        turns: vec![turn(4.0), turn(5.0)],
        stops: vec![stop(6.0), stop(7.0)],
        kept: vec![kept(8.0), kept(9.0)],
    }
}

#[test]
fn runs_that_are_the_same_in_every_bit_agree() {
    assert_eq!(compare(&outcome(), &outcome()), Ok(()));
}

#[test]
fn one_bit_anywhere_is_found_and_named() {
    for dwell in 0..3 {
        for (index, name) in FIELDS.into_iter().enumerate() {
            for bit in [0, 31, 63] {
                let (host, mut emulated) = (outcome(), outcome());
                let place = &mut emulated.dwells[dwell].0[index];
                *place = place.map(|bits| bits ^ (1 << bit));
                match compare(&emulated, &host) {
                    Err(Difference::Number { of, number, field, .. }) => {
                        assert_eq!((of, number, field), ("dwell", dwell + 1, name));
                    }
                    other => panic!("{other:?}"),
                }
            }
        }
    }
}

#[test]
fn one_bit_of_any_number_that_is_kept_is_found_and_named() {
    for (index, name) in KEPT_FIELDS.into_iter().enumerate() {
        let (host, mut emulated) = (outcome(), outcome());
        let place = &mut emulated.kept[1].0[index];
        *place = place.map(|bits| bits ^ (1 << 7));
        let told = compare(&emulated, &host).expect_err("they differ").to_string();
        assert!(told.starts_with(&format!("report 2, {name}: ")), "{told}");
    }
}

#[test]
fn one_bit_of_any_number_of_a_turn_is_found_and_named() {
    for (index, name) in TURN_FIELDS.into_iter().enumerate() {
        let (host, mut emulated) = (outcome(), outcome());
        let place = &mut emulated.turns[1].0[index];
        *place = place.map(|bits| bits ^ (1 << 29));
        let told = compare(&emulated, &host).expect_err("they differ").to_string();
        assert!(told.starts_with(&format!("turn 2, {name}: ")), "{told}");
    }
}

#[test]
fn one_bit_of_any_number_of_a_stop_is_found_and_named() {
    for (index, name) in STOP_FIELDS.into_iter().enumerate() {
        let (host, mut emulated) = (outcome(), outcome());
        let place = &mut emulated.stops[0].0[index];
        *place = place.map(|bits| bits ^ 1);
        let told = compare(&emulated, &host).expect_err("they differ").to_string();
        assert!(told.starts_with(&format!("stop 1, {name}: ")), "{told}");
    }
}

#[test]
fn a_difference_is_told_with_both_values() {
    let (host, mut emulated) = (outcome(), outcome());
    emulated.dwells[1].0[4] = Some(2.5_f64.to_bits());
    let told = compare(&emulated, &host).expect_err("they differ").to_string();
    assert_eq!(
        told,
        "dwell 2, rate: 0x4004000000000000 (2.5e0) in the emulator, 0x4000000000000000 (2e0) on the host"
    );
}

#[test]
fn an_absent_number_differs_from_any_number() {
    let (host, mut emulated) = (outcome(), outcome());
    emulated.dwells[2].0[9] = None;
    let told = compare(&emulated, &host).expect_err("they differ").to_string();
    assert!(told.starts_with("dwell 3, temperature: none in the emulator"), "{told}");
}

/// What makes a run another one.
type Change = fn(&mut Outcome);

#[test]
fn seed_azimuth_sigma_and_the_number_of_dwells_are_compared() {
    let changes: [(&str, Change); 6] = [
        ("seed", |run| run.seed = 8),
        ("azimuth", |run| run.azimuth_bits = None),
        ("sigma", |run| run.sigma_bits = Some(0)),
        ("dwells", |run| run.dwells.truncate(2)),
        ("turns", |run| run.turns.truncate(1)),
        ("stops", |run| run.stops.truncate(1)),
    ];
    for (name, change) in changes {
        let mut emulated = outcome();
        change(&mut emulated);
        let told = compare(&emulated, &outcome()).expect_err("they differ").to_string();
        assert!(told.starts_with(&format!("{name}: ")), "{told}");
    }
}

#[test]
fn reasons_differ_by_words_and_digits_but_not_by_zeros_at_the_end() {
    let refused = |reason: &str| Outcome {
        azimuth_bits: None,
        sigma_bits: None,
        reason: Some(reason.to_owned()),
        ..outcome()
    };
    let agree = |one, other| compare(&refused(one), &refused(other)).is_ok();
    assert!(agree(
        "σ would be 12.5°, above 10°: gyro noise",
        "σ would be 12.500°, above 10.000°: gyro noise"
    ));
    assert!(!agree("σ would be 12.5°", "σ would be 12.51°"));
    assert!(!agree("σ would be 10°", "σ would be 100°"));
    assert!(!agree("the time allowed ran out", "the time allowed is short"));
    assert!(compare(&refused("no"), &outcome()).is_err());
}

#[test]
fn the_host_finds_the_same_again_and_something_else_for_another_seed() {
    let run = |seed| host::outcome(&Scenario::brief(seed)).expect("it ends");
    assert_eq!(compare(&run(3), &run(3)), Ok(()));
    assert!(run(3).azimuth_bits.is_some() || run(3).reason.is_some());
    assert_ne!(run(3).dwells, run(4).dwells);
}

#[test]
fn the_host_finds_the_same_turns_again_and_others_for_another_seed() {
    let run = |seed| host::turning(&TurntableScenario::brief(seed)).expect("it ends");
    assert_eq!(compare(&run(3), &run(3)), Ok(()));
    assert_eq!((run(3).turns.len(), run(3).reason), (4, None));
    assert_ne!(run(3).turns, run(4).turns);
}

#[test]
fn the_host_finds_the_same_stops_again_and_others_for_another_seed() {
    let run = |seed| host::stops(&VehicleScenario::brief(seed)).expect("it ends");
    assert_eq!(compare(&run(3), &run(3)), Ok(()));
    assert_eq!((run(3).stops.len(), run(3).reason), (2, None));
    assert_ne!(run(3).stops, run(4).stops);
}

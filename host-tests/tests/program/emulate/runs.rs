//! Two runs are compared bit for bit, and where they differ is named.

use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::TurntableScenario;
use firmware::simulated::vehicle::VehicleScenario;
use host::emulate::host as on_host;
use host::emulate::outcome::{DWELL, KEPT, KINDS, Kind, Outcome, Row, STOP, TURN, compare};

fn row(kind: &'static Kind, number: f64) -> Row {
    Row { kind, bits: vec![Some(number.to_bits()); kind.names().count()] }
}

/// Three dwells, then two rows of each other kind.
fn outcome() -> Outcome {
    let dwells = [1.0, 2.0, 3.0].map(|rate| row(&DWELL, rate)).into_iter();
    let others = KINDS[1..].iter().flat_map(|kind| [row(kind, 4.0), row(kind, 5.0)]);
    Outcome {
        seed: 7,
        azimuth_bits: Some(1.25_f64.to_bits()),
        sigma_bits: Some(0.5_f64.to_bits()),
        reason: None,
        rows: dwells.chain(others).collect(),
    }
}

/// The place of a kind's row, numbered from one.
fn place(run: &Outcome, kind: &Kind, number: usize) -> usize {
    let mut places = run.rows.iter().enumerate().filter(|(_, row)| row.kind == kind);
    places.nth(number - 1).expect("there are so many").0
}

#[test]
fn runs_that_are_the_same_in_every_bit_agree() {
    assert_eq!(compare(&outcome(), &outcome()), Ok(()));
}

#[test]
fn one_bit_of_any_number_of_any_row_is_found_and_named() {
    for (kind, last) in [(&DWELL, 3), (&TURN, 2), (&STOP, 2), (&KEPT, 2)] {
        for number in 1..=last {
            for (index, name) in kind.names().enumerate() {
                for bit in [0, 31, 63] {
                    let (host, mut emulated) = (outcome(), outcome());
                    let at = place(&emulated, kind, number);
                    let place = &mut emulated.rows[at].bits[index];
                    *place = place.map(|bits| bits ^ (1 << bit));
                    let reported = compare(&emulated, &host).expect_err("they differ").what;
                    assert_eq!(reported, format!("{} {number}, {name}", kind.word));
                }
            }
        }
    }
}

#[test]
fn a_difference_is_reported_with_both_values() {
    let (host, mut emulated) = (outcome(), outcome());
    emulated.rows[1].bits[4] = Some(2.5_f64.to_bits());
    let reported = compare(&emulated, &host).expect_err("they differ").to_string();
    assert_eq!(
        reported,
        "dwell 2, rate: 0x4004000000000000 (2.5e0) in the emulator, 0x4000000000000000 (2e0) on the host"
    );
}

#[test]
fn an_absent_number_differs_from_any_number() {
    let (host, mut emulated) = (outcome(), outcome());
    emulated.rows[2].bits[9] = None;
    let reported = compare(&emulated, &host).expect_err("they differ").to_string();
    assert!(reported.starts_with("dwell 3, temperature: none in the emulator"), "{reported}");
}

/// What makes a run another one.
type Change = fn(&mut Outcome);

#[test]
fn seed_azimuth_sigma_and_the_number_of_rows_are_compared() {
    let changes: [(&str, Change); 7] = [
        ("seed", |run| run.seed = 8),
        ("azimuth", |run| run.azimuth_bits = None),
        ("sigma", |run| run.sigma_bits = Some(0)),
        ("rows of kind dwell", |run| drop(run.rows.remove(place(run, &DWELL, 3)))),
        ("rows of kind turn", |run| drop(run.rows.remove(place(run, &TURN, 2)))),
        ("rows of kind stop", |run| drop(run.rows.remove(place(run, &STOP, 2)))),
        ("rows of kind kept", |run| drop(run.rows.remove(place(run, &KEPT, 2)))),
    ];
    for (name, change) in changes {
        let mut emulated = outcome();
        change(&mut emulated);
        let reported = compare(&emulated, &outcome()).expect_err("they differ").to_string();
        assert!(reported.starts_with(&format!("{name}: ")), "{reported}");
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
    let run = |seed| on_host::outcome(&Scenario::brief(seed)).expect("it ends");
    assert_eq!(compare(&run(3), &run(3)), Ok(()));
    assert!(run(3).azimuth_bits.is_some() || run(3).reason.is_some());
    assert_ne!(run(3).rows, run(4).rows);
}

#[test]
fn the_host_finds_the_same_turns_again_and_others_for_another_seed() {
    let run = |seed| on_host::turning(&TurntableScenario::brief(seed)).expect("it ends");
    assert_eq!(compare(&run(3), &run(3)), Ok(()));
    assert_eq!((run(3).rows_of(&TURN).count(), run(3).reason), (4, None));
    assert_ne!(run(3).rows, run(4).rows);
}

#[test]
fn the_host_finds_the_same_stops_again_and_others_for_another_seed() {
    let run = |seed| on_host::stops(&VehicleScenario::brief(seed)).expect("it ends");
    assert_eq!(compare(&run(3), &run(3)), Ok(()));
    assert_eq!((run(3).rows_of(&STOP).count(), run(3).reason), (2, None));
    assert_ne!(run(3).rows, run(4).rows);
}

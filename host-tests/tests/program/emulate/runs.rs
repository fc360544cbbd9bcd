//! Two runs are compared bit for bit, and where they differ is named.

use host::emulate::jobs::{BRIEF_STAGE, JOBS, Job, SPIN, TURNTABLE, TWO_FRAME, VEHICLE};
use host::emulate::outcome::{Outcome, Row, compare};
use simulated::trace::{ABSENT, AZIMUTH, DWELL, FLIGHT, KEPT, STOP, TURN};

fn row(head: &str, number: f64) -> Row {
    Row::new(head, &vec![number.to_bits(); head.split(' ').count() - 1])
}

/// A row of every kind, and a second dwell.
fn outcome() -> Outcome {
    let rows = [DWELL, DWELL, TURN, STOP, KEPT, FLIGHT, AZIMUTH].map(|head| row(head, 2.0));
    Outcome { rows: rows.into(), reason: None }
}

#[test]
fn runs_that_are_the_same_in_every_bit_agree() {
    assert_eq!(compare(&outcome(), &outcome()), Ok(()));
}

#[test]
fn one_bit_of_any_number_of_any_row_is_found_and_named() {
    for (at, row) in outcome().rows.iter().enumerate() {
        for (index, name) in row.names().enumerate() {
            for bit in [0, 31, 63] {
                let mut emulated = outcome();
                emulated.rows[at].bits[index] ^= 1 << bit;
                let reported = compare(&emulated, &outcome()).expect_err("they differ").what;
                assert_eq!(reported, format!("row {}, {}, {name}", at + 1, row.kind()));
            }
        }
    }
}

#[test]
fn a_difference_is_reported_with_both_values() {
    let mut emulated = outcome();
    emulated.rows[1].bits[4] = 2.5_f64.to_bits();
    let reported = compare(&emulated, &outcome()).expect_err("they differ").to_string();
    assert_eq!(
        reported,
        "row 2, dwell, rate: 0x4004000000000000 (2.5e0) in the emulator, 0x4000000000000000 (2e0) on the host"
    );
}

#[test]
fn an_absent_number_differs_from_any_number() {
    let mut emulated = outcome();
    emulated.rows[1].bits[9] = ABSENT;
    let reported = compare(&emulated, &outcome()).expect_err("they differ").to_string();
    assert!(reported.starts_with("row 2, dwell, temperature: none in the emulator"), "{reported}");
}

#[test]
fn the_kinds_and_the_number_of_rows_are_compared() {
    for at in 0..outcome().rows.len() {
        let (mut other, mut fewer) = (outcome(), outcome());
        other.rows[at] = row("other of", 2.0);
        let reported = compare(&other, &outcome()).expect_err("they differ").what;
        assert_eq!(reported, format!("kind of row {}", at + 1));
        fewer.rows.truncate(at);
        let reported = compare(&fewer, &outcome()).expect_err("they differ").what;
        assert_eq!(reported, "number of rows");
    }
}

#[test]
fn reasons_differ_by_words_and_digits_but_not_by_zeros_at_the_end() {
    let refused = |reason: &str| Outcome { reason: Some(reason.to_owned()), ..outcome() };
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

/// What is found with a seed in a run on the host.
fn found(job: &Job, seed: u64) -> Outcome {
    (job.on_host)(seed).expect("it comes to an end")
}

#[test]
fn the_host_finds_the_same_again_and_something_else_for_another_seed() {
    let carriers: [(&Job, &str, usize); 5] = [
        (&BRIEF_STAGE, DWELL, 5),
        (&TWO_FRAME, DWELL, 4),
        (&TURNTABLE, TURN, 4),
        (&VEHICLE, STOP, 2),
        (&SPIN, FLIGHT, 1),
    ];
    for (job, head, count) in carriers {
        let first = found(job, 3);
        assert_eq!(compare(&first, &found(job, 3)), Ok(()), "{}", job.word);
        assert_eq!((first.count(head), &first.reason), (count, &None), "{}", job.word);
        assert_ne!(first.rows, found(job, 4).rows, "{}", job.word);
    }
}

#[test]
fn every_run_has_a_word_of_its_own() {
    for (index, job) in JOBS.iter().enumerate() {
        assert!(JOBS[..index].iter().all(|other| other.word != job.word), "{}", job.word);
    }
}

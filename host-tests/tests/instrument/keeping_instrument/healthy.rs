//! Nothing goes wrong.

use super::{drive, frames, keep, reported, sigmas, vehicle, when};
use crate::support::link::{sentences, states};
use firmware::event::Event;
use host::campaign::statistics::rms;
use host::instrument::Trial;
use host::instrument::kept::KeptPlan;
use orientation::navigation::Progress;
use rayon::prelude::*;
use simulated::hold::Hold;
use simulated::scenario::Scenario;

#[test]
fn thirty_minutes_of_driving_in_a_vehicle_stay_within_three_sigma() {
    for seed in 1..=2 {
        // Long ways, so that no bend turns it more quickly than its gyros show.
        let found = drive(&vehicle(seed, Hold { drive_s: 240.0, ..Hold::of(1800.0) }));
        let [worst, within] = sigmas(&found.kept);
        assert!(worst < 4.0 && within > 0.99, "seed {seed}: {worst} σ, {within}");
        let (last, [error, sigma]) = found.kept.with_azimuth().last().expect("it is kept");
        assert!(last.report.seconds.0 > 1790.0, "{} s", last.report.seconds.0);
        // Gyros of 0.001 °/√h and 0.5 °/h, whose biases the alignment and the stops tell.
        assert!(error.abs().to_degrees() < 0.6, "seed {seed}: {}°", error.to_degrees());
        assert!(sigma.to_degrees() < 0.5, "seed {seed}: {}°", sigma.to_degrees());
        assert_eq!(found.violations, [""; 0], "seed {seed}");
        assert_eq!(found.health.faults(), 0, "seed {seed}");
    }
}

#[test]
fn thirty_minutes_of_driving_on_two_frames_stay_within_three_sigma() {
    let found = keep(&frames(1, Hold::of(1800.0)), &KeptPlan::of(None));
    let [worst, within] = sigmas(&found.kept);
    assert!(worst < 4.5 && within > 0.99, "{worst} σ, {within}");
    let (_, [error, _]) = found.kept.with_azimuth().last().expect("it is kept");
    assert!(error.abs().to_degrees() < 1.0, "{}°", error.to_degrees());
    // On the way coarse gyros have the level to degrees; where it stands gravity shows it.
    for point in found.kept.points[60..].iter().filter(|point| point.report.is_at_rest) {
        let [pitch, roll] = point.level_error().map(f64::to_degrees);
        assert!(pitch.abs().max(roll.abs()) < 0.5, "{} s: {pitch}°, {roll}°", point.seconds());
    }
    assert_eq!(found.violations, [""; 0]);
    assert_eq!(found.health.unkept, 0);
}

#[test]
fn no_biases_that_coarse_sensors_are_stated_to_have_make_two_frames_set_off_or_lose_north() {
    let worst: Vec<f64> = (1..=16)
        .into_par_iter()
        .map(|seed| {
            let found = keep(&frames(seed, Hold::of(60.0)), &KeptPlan::of(None));
            let verdict = found.replay.session.conclusion().expect("it concludes").verdict;
            assert!(verdict.is_ok(), "seed {seed}: {verdict:?}");
            sigmas(&found.kept)[0]
        })
        .collect();
    println!("greatest errors over σ: {worst:.1?}");
    assert!(worst.iter().all(|sigmas| *sigmas < 4.0), "{worst:?}");
    assert!(rms(&worst) < 1.7, "RMS of the greatest {} σ", rms(&worst));
}

#[test]
fn a_stage_keeps_by_its_coarse_gyros_alone_and_says_how_well() {
    let kept = |seed| {
        let usual = Scenario::usual(seed);
        let base = Scenario { positions: 8, dwell_s: 5.0, sample_rate_hz: 100.0, ..usual };
        let scenario = Scenario { hold: Hold::of(600.0), has_base_imu: true, ..base };
        let plan = KeptPlan::of(None);
        let found = Trial::of(&scenario).plan(plan).run().expect("possible");
        let (_, [_, sigma]) = found.kept.with_azimuth().last().expect("it is kept");
        // Micromechanical gyros: tenths of a degree after ten minutes, not hundredths.
        assert!((0.1..5.0).contains(&sigma.to_degrees()), "{}°", sigma.to_degrees());
        sigmas(&found.kept)
    };
    let drives: Vec<[f64; 2]> = (1..=6).map(kept).collect();
    println!("greatest errors over σ, and parts within 3 σ: {drives:.2?}");
    assert!(drives.iter().all(|[worst, within]| *worst < 4.0 && *within > 0.99), "{drives:?}");
}

#[test]
fn what_a_stage_keeps_is_within_its_sigma_however_often_its_sensors_are_read() {
    let cases: Vec<(f64, u64)> = [50.0, 60.0, 100.0, 1200.0]
        .into_iter()
        .flat_map(|rate| [2, 5, 7].map(|seed| (rate, seed)))
        .collect();
    let worst: Vec<f64> = cases
        .par_iter()
        .map(|&(sample_rate_hz, seed)| {
            let usual = Scenario::usual(seed);
            let base = Scenario { positions: 8, dwell_s: 5.0, sample_rate_hz, ..usual };
            let scenario = Scenario { hold: Hold::of(60.0), has_base_imu: true, ..base };
            let found = Trial::of(&scenario).plan(KeptPlan::of(None)).run().expect("possible");
            sigmas(&found.kept)[0]
        })
        .collect();
    println!("greatest errors over σ: {worst:.1?}");
    assert!(worst.iter().all(|sigmas| *sigmas < 4.5), "{worst:?} of {cases:?}");
}

#[test]
fn keeping_changes_nothing_of_what_the_session_finds() {
    let verdict = |hold| {
        let found = drive(&vehicle(5, hold));
        found.replay.conclusion().expect("it concludes").verdict.expect("a healthy run")
    };
    let (alone, kept) = (verdict(Hold::default()), verdict(Hold::of(60.0)));
    assert_eq!(alone.angle.0.to_bits(), kept.angle.0.to_bits());
    assert_eq!(alone.sigma.0.to_bits(), kept.sigma.0.to_bits());
}

#[test]
fn the_link_tells_attitude_once_a_second_and_the_heading_once_it_is_valid() {
    let found = drive(&vehicle(1, Hold::of(120.0)));
    let states = states(&found.lines);
    assert!(states.iter().all(|state| state[4] == "0"), "{states:?}");
    let ready = states.iter().filter(|state| state[0] == "ready").count();
    assert!((118..=122).contains(&ready), "{ready} of {} s", states.len());
    let count = |address: &str, has: fn(&[&str]) -> bool| {
        let sentences = sentences(&found.lines, address);
        sentences.iter().filter(|fields| has(fields)).count()
    };
    assert_eq!(count("HEHDT", |fields| !fields[0].is_empty()), ready);
    assert_eq!(count("HETHS", |fields| fields[1] == "S"), ready, "the world is a simulated one");
    // Pitch and roll are known long before.
    assert!(count("PHTRO", |_| true) > ready + 100, "{}", found.lines);
}

#[test]
fn the_frames_turn_the_precise_gyro_vertical_and_the_keeper_takes_it_there() {
    let found = keep(&frames(1, Hold::of(60.0)), &KeptPlan::of(None));
    let lines = reported(&found);
    let place = |words: &str| {
        let line = lines.iter().position(|line| line.contains(words));
        line.unwrap_or_else(|| panic!("{words} is reported: {lines:#?}"))
    };
    assert!(place("handed over") < place("gyro vertical"));
    assert!(place("gyro vertical") < place("the precise gyro shows"));
}

#[test]
fn an_azimuth_from_outside_spares_the_alignment() {
    let azimuth = Scenario::default().azimuth_deg;
    let hold = Hold { handover: Some(([azimuth + 0.1, 0.16], 30.0)), ..Hold::of(300.0) };
    let found = keep(&frames(3, hold), &KeptPlan::of(None));
    assert!(found.conclusion().is_none(), "no session has concluded");
    let handed = when(&found, |event| matches!(event, Event::Navigation(Progress::HandedOver(..))));
    assert!(handed.is_some_and(|at| (30.0..32.0).contains(&at)), "{handed:?}");
    let [worst, _] = sigmas(&found.kept);
    assert!(worst < 3.5, "{worst} σ");
    assert!(reported(&found).iter().any(|line| line.contains("the precise gyro shows")));
}

//! The stored recordings of spinning bodies, which an independent simulator made.

use host::methods::asked::Asked;
use host::methods::error::ReplayError;
use host::methods::spin::errors::Errors;
use host::methods::spin::{Replay, replay};
use host::recording::{Body, Header};

use crate::support::files::recording;

/// Its replay, and the errors of each method.
fn replayed(name: &str) -> (Replay, [Errors; 3]) {
    let (header, body, truth) = recording(name).into_parts();
    let replay = replay(&header, &body, &Asked::default()).expect("it is of a spinning body");
    let errors = [0, 1, 2].map(|index: usize| {
        Errors::of(&replay.tracks[index], &truth.roll_rad).expect("the truth is there")
    });
    (replay, errors)
}

/// RMS errors after the first 0.1 s, °.
fn rms(errors: &[Errors; 3]) -> [f64; 3] {
    errors.each_ref().map(|errors| errors.rms_rad.expect("it is long enough").to_degrees())
}

#[test]
fn without_noise_extrema_are_good_to_half_a_sample_and_the_phase_to_its_last_digits() {
    let (replay, errors) = replayed("spin-100rps");
    let [extrema, interpolated, locked] = rms(&errors);
    println!("extrema {extrema:.4}°, interpolated {interpolated:.5}°, phase-locked {locked:.6}°");
    // A sample is 3.6°: evenly spread over it, an error has 1.04° RMS.
    assert!((0.95..1.1).contains(&extrema), "{extrema}");
    assert!(interpolated < 0.06, "{interpolated}");
    assert!(locked < 0.002, "{locked}");
    let [scale, sigma] = replay.answer().end.scale.expect("a second tells it");
    assert!((scale - 1e-3).abs() < 1e-7, "{scale}");
    assert!(sigma < 1e-5, "{sigma}");
    assert!(errors.iter().all(|errors| errors.turns_lost == 0));
    // Four corrections a turn.
    let turns = 100.36;
    let corrections = replay.tracks[0].corrections.len() as f64 / turns;
    assert!((corrections - 4.0).abs() < 0.03, "{corrections}");
    assert_eq!(replay.refusal(), None);
}

#[test]
fn in_noise_bare_extrema_fail_and_the_phase_lock_loses_no_turn() {
    let (replay, errors) = replayed("spin-80rps-noisy");
    let [extrema, interpolated, locked] = rms(&errors);
    println!("extrema {extrema:.1}°, interpolated {interpolated:.1}°, phase-locked {locked:.4}°");
    // Anywhere on the circle has 104° RMS.
    assert!(extrema > 90.0 && interpolated > 90.0, "{extrema} {interpolated}");
    assert!(locked < 0.2, "{locked}");
    assert_eq!(errors[2].turns_lost, 0);
    let (end, error) = (&replay.answer().end, errors[2].end_rad().expect("the truth is there"));
    let sigma = end.sigma_rad.expect("it is locked");
    assert!(error.abs() < 3.0 * sigma, "{error} {sigma}");
    let [scale, of_scale] = end.scale.expect("a second tells it");
    assert!((scale - 1e-3).abs() < 3.0 * of_scale, "{scale} {of_scale}");
    // The noise is a twentieth of the lift, which grows from 25 to 30 m/s².
    assert!((replay.noise.force - 1.5).abs() < 0.05, "{}", replay.noise.force);
    assert!(end.lift.is_some_and(|lift| (lift - 30.0).abs() < 1.0), "{:?}", end.lift);
}

#[test]
fn a_solver_finds_the_same_roll_without_a_truth() {
    let (header, body, _) = recording("spin-80rps-noisy").into_parts();
    let blind = replay(&header, &body, &Asked::default()).expect("it is of a spinning body");
    let (replay, _) = replayed("spin-80rps-noisy");
    assert_eq!(blind.answer().rolls_rad, replay.answer().rolls_rad);
}

#[test]
fn another_kind_or_a_single_sample_is_refused() {
    let (header, body, _) = recording("spin-100rps").into_parts();
    let Body::Spin(mut rows) = body else { panic!("it is a spinning body") };
    rows.truncate(1);
    let one = Body::Spin(rows);
    let refused = replay(&header, &one, &Asked::default()).map(|_| ());
    assert_eq!(refused, Err(ReplayError::TooFewSamples(1)));
    let (header, body, _) = recording("stepwise-bumped").into_parts();
    let refused = replay(&header, &body, &Asked::default()).map(|_| ());
    assert_eq!(refused, Err(ReplayError::NoSpin(body.kind())));
}

#[test]
fn a_body_without_lift_has_no_roll() {
    let (header, body, _) = recording("spin-100rps").into_parts();
    let Body::Spin(mut rows) = body else { panic!("it is a spinning body") };
    for row in &mut rows {
        // What is left is the square of the rate, and a little of noise that repeats after 997 samples.
        let noise = ((row.line * 7919) % 997) as f64 / 997.0 - 0.5;
        row.force_m_s2 = [-7954.0 + noise, -3977.0 - noise];
    }
    let replay = replay(&header, &Body::Spin(rows), &Asked::default()).expect("it can be read");
    let reason = replay.refusal().expect("there is no roll");
    assert!(reason.starts_with("the roll is not known at the end: searching"), "{reason}");
}

#[test]
fn a_rate_a_little_off_the_times_loses_no_sample_and_no_roll() {
    for name in ["spin-100rps", "spin-80rps-noisy"] {
        let (header, body, truth) = recording(name).into_parts();
        let rate_hz = header.rate_hz.expect("it is stated");
        for part in [-9e-3, -1e-3, -1.6e-4, -3e-5, 3e-5, 1.6e-4, 1e-3, 9e-3] {
            let header = Header { rate_hz: Some(rate_hz * (1.0 + part)), ..header.clone() };
            let replay = replay(&header, &body, &Asked::default()).expect("it can be read");
            let errors =
                Errors::of(&replay.tracks[2], &truth.roll_rad).expect("the truth is there");
            let rms_rad = errors.rms_rad.expect("it is long enough");
            assert!(rms_rad.to_degrees() < 0.2, "{name}, {part}: {rms_rad} rad");
        }
    }
}

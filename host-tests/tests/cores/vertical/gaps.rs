//! Samples that are missing: a rest goes on through them, and what a body turns meanwhile is in σ.

use orientation::attitude::{Gyro, Setting, Trust};
use orientation::units::{DEGREE, RadiansPerSecond};

use super::world::{Body, Known, coarse, keep, precise, shaken};

/// When the azimuth is handed over, and when samples begin to be missing, s.
const HANDED: f64 = 40.0;
const GAP: f64 = 60.0;

/// A body at rest whose gyros show 3 °/s of it, as those of an LSM6DSL may.
fn biased(seconds: f64) -> Body {
    let body = coarse(seconds);
    let bias_sigma = RadiansPerSecond(3.0 * DEGREE);
    let gyros = body.setting.gyros.map(|gyro| Gyro { bias_sigma, ..gyro });
    let biases = [3.0, -2.0, 2.5].map(|bias| bias * DEGREE);
    Body { biases, setting: Setting { gyros, ..body.setting }, handed: Some(HANDED), ..body }
}

/// What is known of a body whose samples are missing for a time from [`GAP`] on, s.
fn without(body: &Body, missing: f64) -> Vec<Known> {
    keep(body, |time, _| !(GAP - 1e-6..GAP + missing - 1e-6).contains(&time))
}

/// The azimuth's 1σ a moment after so many seconds, rad.
fn sigma(known: &[Known], time: f64) -> f64 {
    let known = known.iter().find(|known| known.time >= time).expect("the time is reached");
    known.report.azimuth.expect("there is an azimuth").sigma.0
}

#[test]
fn a_rest_goes_on_through_a_gap_of_a_second_and_costs_no_azimuth() {
    for body in [biased(90.0), Body { handed: Some(HANDED), ..precise(90.0) }] {
        for missing in [0.01, 0.02, 0.1, 0.65, 0.95] {
            let known = without(&body, missing);
            let after = |from: f64| known.iter().filter(move |known| known.time > from);
            assert!(after(HANDED).all(|known| known.report.is_at_rest), "{missing} s");
            assert!(after(HANDED).all(|known| known.report.state.trust == Trust::Level));
            let (before, now) = (sigma(&known, GAP - 0.1), sigma(&known, GAP + missing + 0.5));
            // Of 0.07°/s of noise on each axis at both ends.
            assert!(now - before < 0.05 * DEGREE, "{missing} s: {}°", (now - before) / DEGREE);
            let worst = after(10.0).map(Known::in_sigmas).fold(0.0, f64::max);
            assert!(worst < 3.0, "{missing} s: {worst} σ");
        }
    }
}

#[test]
fn a_body_that_sets_off_in_a_gap_is_not_at_rest_after_it_and_its_turn_is_in_sigma() {
    // It turns about the vertical, evenly from the middle of the gap on.
    let attitude = |time: f64| [0.5 + 0.2 * (time - GAP - 0.3).max(0.0), 0.03, -0.02];
    let known = without(&Body { attitude, ..biased(70.0) }, 0.6);
    for known in known.iter().filter(|known| known.time > GAP + 1.2) {
        assert!(!known.report.is_at_rest, "{} s", known.time);
        let (error, sigma) = (known.azimuth, known.report.azimuth.expect("it is kept").sigma.0);
        assert!(error.is_some_and(|error| error.abs() < 3.0 * sigma), "{error:?} of {sigma}");
    }
}

#[test]
fn what_a_shaken_body_turns_in_a_gap_of_up_to_a_second_is_in_sigma() {
    for missing in [0.01, 0.05, 0.2, 0.5, 0.95] {
        let (mut squares, mut count) = (0.0, 0.0);
        for seed in 1..=12 {
            let body = Body { attitude: shaken, handed: Some(20.0), seed, ..coarse(70.0) };
            // The phase of the shaking in which they are missing differs.
            let from = GAP + 0.37 * seed as f64;
            let known = keep(&body, |time, _| !(from..from + missing).contains(&time));
            let last = known.iter().find(|known| known.time >= from + missing + 0.2);
            let last = last.expect("it goes on");
            let sigma = last.report.azimuth.expect("it is kept").sigma.0;
            squares += (last.azimuth.expect("it is kept") / sigma).powi(2);
            count += 1.0;
            assert!(last.in_sigmas() < 3.0, "{missing} s, seed {seed}: {} σ", last.in_sigmas());
        }
        let ratio = f64::sqrt(squares / count);
        println!("{missing} s: {ratio:.3}");
        assert!(ratio < 1.2, "{missing} s: {ratio}");
    }
}

/// A quarter of a turn that begins and ends within a gap of so many seconds.
fn quarter<const SECONDS: u32>(time: f64) -> [f64; 3] {
    let part = ((time - GAP - 0.2) / (f64::from(SECONDS) - 0.4)).clamp(0.0, 1.0);
    [0.5 + 90.0 * DEGREE * part, 0.03, -0.02]
}

/// After a gap of so many seconds that hides a quarter of a turn, no azimuth is wrong.
fn assert_not_outlasted<const SECONDS: u32>() {
    let missing = f64::from(SECONDS);
    let body = Body { attitude: quarter::<SECONDS>, handed: Some(HANDED), ..precise(130.0) };
    let known = without(&body, missing);
    let after = known.iter().filter(|known| known.time > GAP + missing + 0.1);
    let wrong = after.filter(|known| {
        let sigma = known.report.azimuth.map(|azimuth| azimuth.sigma.0);
        known.azimuth.zip(sigma).is_some_and(|(error, sigma)| error.abs() > 3.0 * sigma)
    });
    assert_eq!(wrong.count(), 0, "{missing} s");
}

#[test]
fn an_azimuth_does_not_outlast_a_gap_in_which_the_body_may_have_turned_anywhere() {
    assert_not_outlasted::<3>();
    assert_not_outlasted::<5>();
    assert_not_outlasted::<10>();
    assert_not_outlasted::<30>();
    assert_not_outlasted::<58>();
}

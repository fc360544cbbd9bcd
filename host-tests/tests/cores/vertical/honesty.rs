//! What the filter may not be too sure of: its level, the biases and the noise that were stated.

use orientation::attitude::{Gyro, Setting};
use orientation::units::{AngleIncrement, DEGREE, RadiansPerSecond};

use super::world::{Body, Known, coarse, keep, precise, shaken};

fn after(known: &[Known], time: f64) -> impl Iterator<Item = &Known> {
    known.iter().filter(move |known| known.time > time)
}

fn worst_tilt(known: &[Known], from: f64) -> f64 {
    after(known, from).map(|known| known.tilt / DEGREE).fold(0.0, f64::max)
}

/// A hand that turns the body to and fro and shakes it, until it lays it down.
fn hand(time: f64) -> [f64; 3] {
    let size = (60.0 - time).clamp(0.0, 1.0) * (time - 20.0).clamp(0.0, 1.0);
    let swing = |rate: f64, angle: f64| size * angle * (rate * time).sin();
    [0.5 + swing(1.7, 0.6), 0.03 + swing(2.3, 0.5), -0.02 + swing(3.1, 0.7)]
}

fn shaking(time: f64) -> [f64; 3] {
    let size = (60.0 - time).clamp(0.0, 1.0) * (time - 20.0).clamp(0.0, 1.0);
    [2.0, 1.5, 2.5].map(|force| size * force * (force * 2.2 * time).sin())
}

#[test]
fn after_any_unseen_turn_a_rest_levels_the_body_within_five_seconds() {
    for degrees in [3.0, 6.0, 10.0, 15.0, 30.0, -30.0, 90.0, 170.0] {
        for body in [coarse(75.0), precise(75.0)] {
            let known =
                keep(&Body { attitude: hand, acceleration: shaking, ..body }, |time, sample| {
                    // The roll gyro is wrong for a tenth of a second, and no sample is flagged.
                    if (59.0..59.1).contains(&time) {
                        sample.turned[0] =
                            AngleIncrement::from_rad(0.1 * degrees * DEGREE, &mut 0.0);
                    }
                    true
                });
            assert!(worst_tilt(&known, 65.0) < 1.0, "{degrees}°: {}°", worst_tilt(&known, 65.0));
            assert!(known.last().is_some_and(|last| last.report.is_at_rest), "{degrees}°");
        }
    }
}

#[test]
fn after_an_unseen_turn_a_body_that_only_rocks_is_level_within_ten_seconds() {
    // Rocking of a degree, nothing accelerates: no rest, and no turn that a hand would make.
    let attitude =
        |time: f64| [0.5, 0.03 + DEGREE * time.sin(), -0.02 + DEGREE * (0.8 * time).sin()];
    for degrees in [5.0, 10.0, 26.0, 60.0] {
        for body in [coarse(100.0), precise(100.0)] {
            let known = keep(&Body { attitude, ..body }, |time, sample| {
                if (60.0..60.1).contains(&time) {
                    let turned = sample.turned[0].rad() + 0.1 * degrees * DEGREE;
                    sample.turned[0] = AngleIncrement::from_rad(turned, &mut 0.0);
                }
                true
            });
            let worst = worst_tilt(&known, 70.0);
            assert!(worst < 1.0, "{degrees}°: {worst}°");
            let sigmas = after(&known, 67.0).map(Known::in_sigmas).fold(0.0, f64::max);
            assert!(sigmas < 4.0, "{degrees}°: {sigmas} σ");
        }
    }
}

#[test]
fn a_vehicle_that_is_shaken_at_random_hides_no_bias_that_is_reported() {
    for seed in 1..=3 {
        let known = keep(&Body { attitude: shaken, seed, ..coarse(300.0) }, |_, _| true);
        assert!(known.iter().all(|known| !known.report.is_bias_beyond_stated), "{seed}");
        assert!(worst_tilt(&known, 10.0) < 1.5, "{seed}: {}°", worst_tilt(&known, 10.0));
    }
}

#[test]
fn a_body_that_lies_still_is_at_rest_though_its_gyros_are_five_times_as_noisy_as_stated() {
    for body in [coarse(60.0), precise(60.0)] {
        let known = keep(&Body { noise: 5.0, ..body }, |_, _| true);
        let (rests, all) = (
            after(&known, 10.0).filter(|known| known.report.is_at_rest).count(),
            after(&known, 10.0).count(),
        );
        assert!(rests as f64 > 0.9 * all as f64, "{rests} of {all}");
    }
}

/// The coarse body with a tenth of its biases stated.
fn understated(seconds: f64) -> Body {
    let body = coarse(seconds);
    let gyros =
        body.setting.gyros.map(|gyro| Gyro { bias_sigma: RadiansPerSecond(0.04 * DEGREE), ..gyro });
    Body { setting: Setting { gyros, ..body.setting }, ..body }
}

#[test]
fn biases_ten_times_as_large_as_stated_are_reported_and_learnt_at_rest() {
    let body = Body { attitude: hand, acceleration: shaking, ..understated(75.0) };
    let known = keep(&body, |_, _| true);
    assert!(worst_tilt(&known, 1.0) < 3.0, "{}°", worst_tilt(&known, 1.0));
    assert!(after(&known, 20.0).all(|known| known.report.is_bias_beyond_stated));
    let last = known.last().expect("samples").report;
    for (found, bias) in last.biases.iter().zip(body.biases) {
        // The Earth turns the body by 0.004°/s at most.
        assert!((found.0 - bias).abs() < 0.02 * DEGREE, "{found:?} {bias}");
    }
}

/// A hand that has turned and shaken the body since before the gyros were switched on, and never rests.
fn restless(time: f64) -> [f64; 3] {
    let swing = |rate: f64, angle: f64| angle * (rate * time).sin();
    [0.5 + swing(1.7, 0.6), 0.03 + swing(2.3, 0.5), -0.02 + swing(3.1, 0.7)]
}

fn pushed(time: f64) -> [f64; 3] {
    [2.0, 1.5, 2.5].map(|force| force * (force * 2.2 * time).sin())
}

#[test]
fn biases_ten_times_as_large_as_stated_are_shown_by_a_body_that_never_rests() {
    for seed in 1..=3 {
        let body = understated(120.0);
        let known =
            keep(&Body { attitude: restless, acceleration: pushed, seed, ..body }, |_, _| true);
        assert!(after(&known, 70.0).all(|known| known.report.is_bias_beyond_stated), "{seed}");
        assert!(worst_tilt(&known, 80.0) < 3.0, "{seed}: {}°", worst_tilt(&known, 80.0));
        // For the first minute the level is off by more than its σ, as nothing shows the biases yet.
        let worst = after(&known, 60.0).map(Known::in_sigmas).fold(0.0, f64::max);
        assert!(worst < 4.0, "{seed}: {worst} σ");
    }
}

#[test]
fn a_body_that_moves_as_it_is_switched_on_says_how_little_it_knows() {
    for body in [coarse(60.0), precise(60.0)] {
        let known = keep(&Body { attitude: restless, acceleration: pushed, ..body }, |_, _| true);
        let worst = known.iter().map(Known::in_sigmas).fold(0.0, f64::max);
        assert!(worst < 4.0 && worst_tilt(&known, 0.0) > 10.0, "{worst} σ");
        assert!(worst_tilt(&known, 20.0) < 1.0, "{}°", worst_tilt(&known, 20.0));
    }
}

#[test]
fn biases_that_are_as_stated_are_not_reported() {
    for body in [coarse(75.0), precise(75.0)] {
        let known = keep(&Body { attitude: hand, acceleration: shaking, ..body }, |_, _| true);
        assert!(known.iter().all(|known| !known.report.is_bias_beyond_stated));
    }
}

#[test]
fn gyros_that_are_half_a_per_cent_off_keep_their_level_through_turns_one_way() {
    // Ten turns of roll, one way, while nothing accelerates: 18° of roll would be missing.
    let attitude = |time: f64| [0.5, 0.03, -0.02 + (time - 20.0).clamp(0.0, 62.8)];
    let body = coarse(100.0);
    let gyros = body.setting.gyros.map(|gyro| Gyro { scale_sigma: 5e-3, ..gyro });
    let body = Body { attitude, setting: Setting { gyros, ..body.setting }, ..body };
    let known = keep(&body, |_, sample| {
        let [x, ..] = &mut sample.turned;
        *x = AngleIncrement((f64::from(x.0) * 1.005).round() as i32);
        true
    });
    let worst = after(&known, 5.0).map(Known::in_sigmas).fold(0.0, f64::max);
    assert!(
        worst < 3.0 && worst_tilt(&known, 5.0) < 1.5,
        "{worst} σ, {}°",
        worst_tilt(&known, 5.0)
    );
}

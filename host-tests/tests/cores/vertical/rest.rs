//! When a body is found to stand: whatever its motion left behind, and never while it only moves quietly.

use orientation::attitude::{Gyro, Setting};
use orientation::units::{AngleIncrement, DEGREE, DEGREE_PER_HOUR};

use super::world::{Body, Known, coarse, keep, precise, shaken};

/// From when on the body counted as standing until the end, s.
fn rests_from(known: &[Known]) -> f64 {
    let last = known.iter().rev().find(|known| !known.report.is_at_rest);
    last.map_or(0.0, |known| known.time)
}

fn rests_within(known: &[Known], times: std::ops::Range<f64>) -> bool {
    known.iter().any(|known| times.contains(&known.time) && known.report.is_at_rest)
}

/// A drive from 60 s to 120 s that rolls and pitches a little, and its springs, which settle in so many tenths of a second.
fn drive<const TENTHS: u32>(time: f64) -> [f64; 3] {
    let size = (time - 60.0).clamp(0.0, 1.0) * (120.0 - time).clamp(0.0, 1.0);
    let bounced =
        if time < 120.0 { 0.0 } else { (-(time - 120.0) / (0.1 * f64::from(TENTHS))).exp() };
    let swing = |rate: f64| 0.02 * size * (rate * time).sin() + 0.01 * bounced;
    [0.5 + 0.3 * size * (0.2 * time).sin(), 0.03 + swing(2.3), -0.02 + swing(3.1)]
}

fn pulling(time: f64) -> [f64; 3] {
    let size = if (61.0..119.0).contains(&time) { 1.0 } else { 0.0 };
    [0.9, 0.7, 1.5].map(|force| size * force * (force * time).sin())
}

#[test]
fn a_body_that_settles_as_it_stops_stands_within_ten_seconds() {
    let springs: [fn(f64) -> [f64; 3]; 4] = [drive::<1>, drive::<3>, drive::<5>, drive::<8>];
    for (place, attitude) in springs.into_iter().enumerate() {
        for seed in 1..=5 {
            for body in [coarse(135.0), precise(135.0)] {
                let body = Body { attitude, acceleration: pulling, seed, ..body };
                let known = keep(&body, |_, _| true);
                assert!(!rests_within(&known, 65.0..120.0), "spring {place}, seed {seed}");
                let from = rests_from(&known);
                assert!(from < 130.0, "spring {place}, seed {seed}: {from} s");
            }
        }
    }
}

#[test]
fn a_level_gyro_whose_bias_moved_on_the_way_hides_the_rest_for_twenty_seconds_at_most() {
    for seed in 1..=3 {
        for (moved, body) in [
            (60.0, coarse(150.0)),
            (-90.0, coarse(150.0)),
            (60.0, precise(150.0)),
            (300.0, precise(150.0)),
        ] {
            let body = Body { attitude: drive::<1>, acceleration: pulling, seed, ..body };
            let more = moved * DEGREE_PER_HOUR * body.setting.sample_seconds.0;
            let mut carried = 0.0;
            let known = keep(&body, |time, sample| {
                if time > 90.0 {
                    let turned = sample.turned[1].rad() + more;
                    sample.turned[1] = AngleIncrement::from_rad(turned, &mut carried);
                }
                true
            });
            let from = rests_from(&known);
            assert!(from < 140.0, "{moved} °/h, seed {seed}: {from} s");
        }
    }
}

#[test]
fn a_shaken_vehicle_that_speeds_up_does_not_stand_though_its_gyros_are_quieter_than_stated() {
    let acceleration =
        |time: f64| if (30.0..80.0).contains(&time) { [0.5, 0.0, 0.0] } else { [0.0; 3] };
    // What is assumed where nothing is stated.
    let gyros = [Gyro::coarse(); 3];
    for seed in 1..=5 {
        let body = coarse(240.0);
        let setting = Setting { gyros, ..body.setting };
        let body = Body { attitude: shaken, acceleration, setting, noise: 0.2, seed, ..body };
        let known = keep(&body, |_, _| true);
        assert!(rests_within(&known, 20.0..30.0), "{seed}");
        assert!(!rests_within(&known, 32.0..240.0), "{seed}");
    }
}

/// Turns about the vertical as it is switched on, by so many tenths of a degree a second for so many seconds.
fn turned_at_first<const TENTHS: u32, const SECONDS: u32>(time: f64) -> [f64; 3] {
    let turned = 0.1 * f64::from(TENTHS) * DEGREE * time.min(f64::from(SECONDS));
    [0.5 + turned, 0.03, -0.02]
}

#[test]
fn a_turn_that_was_taken_for_a_bias_at_first_is_found_out_as_the_body_stands() {
    let turns: [fn(f64) -> [f64; 3]; 4] = [
        turned_at_first::<10, 3>,
        turned_at_first::<5, 3>,
        turned_at_first::<1, 10>,
        turned_at_first::<10, 10>,
    ];
    for (place, attitude) in turns.into_iter().enumerate() {
        for seed in 1..=3 {
            let body = Body { attitude, seed, ..coarse(240.0) };
            let known = keep(&body, |_, _| true);
            let from = rests_from(&known);
            assert!(from < 120.0, "turn {place}, seed {seed}: {from} s");
            let [.., down] = known.last().expect("samples").report.biases;
            // The Earth turns the body by 0.004°/s at most.
            assert!((down.0 - body.biases[2]).abs() < 0.01 * DEGREE, "turn {place}: {down:?}");
        }
    }
}

#[test]
fn an_even_turn_after_a_rest_of_seconds_is_a_turn() {
    let attitude = |time: f64| [0.5 + 3.0 * DEGREE * (time - 5.0).clamp(0.0, 120.0), 0.03, -0.02];
    for seed in 1..=3 {
        let known = keep(&Body { attitude, handed: Some(4.0), seed, ..coarse(160.0) }, |_, _| true);
        assert!(!rests_within(&known, 6.0..124.0), "{seed}");
        let last = known.last().expect("samples");
        let sigma = last.report.azimuth.expect("an azimuth").sigma;
        assert!(last.azimuth.expect("an azimuth").abs() < 3.0 * sigma.0, "{seed}");
        assert!(sigma.0 < 10.0 * DEGREE && rests_from(&known) < 130.0, "{seed}: {sigma:?}");
    }
}

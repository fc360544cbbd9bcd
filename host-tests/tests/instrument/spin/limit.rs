//! The Cramér–Rao bound of the roll against the inverse of the whole information matrix, and the noise that
//! turns show against what was put in.

use host::methods::spin::limit::{Noise, Turns, bounds, gyro_walk};
use orientation::signal::SpinSample;
use orientation::units::{AngleIncrement, Instant, SpinForce};

/// Turned in a sample, rad, and the lift, m/s².
const TURNED: f64 = 0.05;
const LIFT: f64 = 30.0;
/// Noise of a force, m/s².
const NOISE: f64 = 1.5;

/// Samples with forces that a hash makes noisy: sums of twelve even numbers, less six.
fn samples(count: u64) -> Vec<SpinSample> {
    let mut word = 1_u64;
    let mut even = move || {
        word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (word >> 11) as f64 / 9_007_199_254_740_992.0
    };
    let mut normal = move || (0..12).map(|_| even()).sum::<f64>() - 6.0;
    let mut carried = 0.0;
    (0..count)
        .map(|index| {
            let roll = 0.7 + TURNED * index as f64;
            let force = [LIFT * roll.cos() - 8000.0, -LIFT * roll.sin() - 4000.0];
            let turned = if index == 0 { 0.0 } else { TURNED };
            SpinSample {
                time: Instant(index * 100),
                turned: [
                    AngleIncrement::from_rad(turned, &mut carried),
                    AngleIncrement(0),
                    AngleIncrement(0),
                ],
                force: Some(force.map(|force| SpinForce::from_m_per_s2(force + NOISE * normal()))),
            }
        })
        .collect()
}

#[test]
fn the_bound_is_the_inverse_of_the_information_of_all_samples() {
    let samples = samples(5000);
    let noise = Noise { force: NOISE, angle_random_walk: 0.0 };
    let scale_sigma = 0.01;
    let found = bounds(&samples, noise, scale_sigma, |_| LIFT);
    // Roll and scale error at a sample: a sample before it, turned less by an angle, shows the roll plus the
    // scale error's part of that angle.
    let each = (LIFT / NOISE).powi(2);
    let circle = std::f64::consts::TAU / 12.0_f64.sqrt();
    for at in [200, 1000, 4999] {
        let (mut rr, mut rs, mut ss) = (0.0, 0.0, 1.0 / (scale_sigma * scale_sigma));
        for index in 0..=at {
            let since = TURNED * (at - index) as f64;
            rr += each;
            rs += each * since;
            ss += each * since * since;
        }
        // What was unknown of the roll at first counts there.
        let since = TURNED * at as f64;
        let prior = 1.0 / (circle * circle);
        (rr, rs, ss) = (rr + prior, rs + prior * since, ss + prior * since * since);
        let expected = (ss / (rr * ss - rs * rs)).sqrt();
        assert!((found[at] / expected - 1.0).abs() < 1e-6, "{at}: {} {expected}", found[at]);
    }
    // For many samples of an unknown scale: twice the noise over the lift, over the root of their number.
    let rule = 2.0 * NOISE / LIFT / 5000.0_f64.sqrt();
    assert!((found[4999] / rule - 1.0).abs() < 0.01);
}

#[test]
fn a_walk_of_the_gyro_sets_a_floor_to_the_bound() {
    let samples = samples(5000);
    let walk = 0.1;
    let noise = Noise { force: NOISE, angle_random_walk: walk };
    let found = bounds(&samples, noise, 1e-9, |_| LIFT);
    // Steady state of a walk that is measured: P = (√(Q² + 4 Q R) − Q)/2 after the sample.
    let (q, r) = (walk * walk * 1e-4, (NOISE / LIFT).powi(2));
    let expected = (0.5 * ((q * q + 4.0 * q * r).sqrt() - q)).sqrt();
    let last = *found.last().expect("there are samples");
    assert!((last / expected - 1.0).abs() < 1e-3, "{last} {expected}");
}

#[test]
fn without_lift_or_forces_the_bound_learns_nothing() {
    let mut blind = samples(100);
    for sample in &mut blind {
        sample.force = None;
    }
    let noise = Noise { force: NOISE, angle_random_walk: 0.0 };
    let circle = std::f64::consts::TAU / 12.0_f64.sqrt();
    let of_blind = bounds(&blind, noise, 0.0, |_| LIFT);
    let of_falling = bounds(&samples(100), noise, 0.0, |_| 0.0);
    for bound in of_blind.iter().chain(&of_falling) {
        assert!((bound - circle).abs() < 1e-9, "{bound}");
    }
}

#[test]
fn turns_show_the_noise_and_the_lift_that_were_put_in() {
    let turns = Turns::of(&samples(20_000));
    assert_eq!(turns.lifts.len(), 159, "turns of 125.7 samples");
    assert!((turns.force_noise / NOISE - 1.0).abs() < 0.02, "{}", turns.force_noise);
    let mean = turns.lifts.iter().map(|(_, lift)| lift).sum::<f64>() / 159.0;
    // A turn tells its lift to 0.3 m/s², all of them to 0.03.
    assert!((mean - LIFT).abs() < 0.1, "{mean}");
}

#[test]
fn a_gyro_shows_its_white_noise_whatever_its_slow_changes() {
    let mut word = 5_u64;
    let mut even = move || {
        word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (word >> 11) as f64 / 9_007_199_254_740_992.0
    };
    let rates: Vec<f64> = (0..20_000)
        .map(|index| {
            let noise = (0..12).map(|_| even()).sum::<f64>() - 6.0;
            628.0 + 1e-3 * f64::from(index) + 0.02 * noise
        })
        .collect();
    // 0.02 rad/s a sample at 10 kHz: 2e-4 rad/√s.
    let walk = gyro_walk(&rates, 1e-4);
    assert!((walk / 2e-4 - 1.0).abs() < 0.05, "{walk}");
}

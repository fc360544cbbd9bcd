//! Coarse accelerometers: their offset by better ones on a platform, and a level that changes to others.

use hal_mock::noise::Generator;
use orientation::attitude::{Keeper, Setting};
use orientation::signal::InertialSample;
use orientation::signal::force_offset::ForceOffset;
use orientation::units::{
    Angle, AngleIncrement, DEGREE, Instant, MetresPerSecondSquared, SpecificForce,
};

use super::world::coarse;

/// One thousandth of gravity, m/s².
const MG: f64 = 9.80665e-3;

fn force(parts: [f64; 3]) -> [SpecificForce; 3] {
    parts.map(SpecificForce::from_m_per_s2)
}

/// The offset found of a coarse accelerometer, mg, for a platform that stands at these headings, °, thirty pairs each.
fn found(headings: &[f64], offset: [f64; 3], other: [f64; 3], seed: u64) -> Option<[f64; 3]> {
    let mut noise = Generator::new(seed);
    let mut comparison = ForceOffset::default();
    // Pitch 2° nose up, roll 3°: what both feel.
    let (pitch, roll) = (2.0 * DEGREE, 3.0 * DEGREE);
    let up = [pitch.sin(), -roll.sin() * pitch.cos(), -roll.cos() * pitch.cos()];
    let felt = up.map(|part| 9.80665 * part);
    for heading in headings {
        let (sine, cosine) = (heading * DEGREE).sin_cos();
        let [x, y] = [felt[0] * cosine + felt[1] * sine, felt[1] * cosine - felt[0] * sine];
        for _ in 0..30 {
            let mut draw = |of: [f64; 3], bias: [f64; 3], sigma: f64| {
                let mut part =
                    |axis: usize| of[axis] + MG * (bias[axis] + sigma * noise.gaussian());
                force([part(0), part(1), part(2)])
            };
            let coarse = draw(felt, offset, 0.9);
            let better = draw([x, y, felt[2]], other, 0.2);
            comparison.push(coarse, better, Angle::from_rad(heading * DEGREE));
        }
    }
    comparison.offset().map(|found| found.map(|part| part.m_per_s2() / MG))
}

#[test]
fn the_offset_of_a_coarse_accelerometer_is_found_whatever_that_of_the_better_one_is() {
    let circle: Vec<f64> = (0..8).map(|position| 45.0 * f64::from(position)).collect();
    let arc: Vec<f64> = (0..9).map(|position| 22.5 * f64::from(position)).collect();
    let (offset, other) = ([18.7, -25.0, 31.0], [-8.0, 12.0, -9.0]);
    for headings in [circle, arc, vec![0.0, 180.0, 90.0, 270.0, 0.0, 180.0, 90.0, 270.0]] {
        for seed in 1..=4 {
            let found = found(&headings, offset, other, seed).expect("it turns far enough");
            for (found, offset) in found.into_iter().zip(offset) {
                assert!((found - offset).abs() < 0.5, "{headings:?}: {found} of {offset} mg");
            }
        }
    }
}

#[test]
fn the_offset_is_unknown_before_the_platform_has_turned() {
    let (offset, other) = ([18.7, -25.0, 31.0], [-8.0, 12.0, -9.0]);
    assert_eq!(found(&[10.0; 10], offset, other, 1), None);
    let few: Vec<f64> = (0..8).map(|position| 10.0 * f64::from(position)).collect();
    assert_eq!(found(&few, offset, other, 1), None);
    assert_eq!(found(&[0.0, 180.0], offset, other, 1), None);
}

/// Time, s, pitch and its σ, °, of a level body, and whether it rests, each half second: for a minute with forces that
/// are off by 20 mg forward, then with others, of which the keeper is told.
fn levels() -> Vec<(f64, f64, f64, bool)> {
    let body = coarse(100.0);
    let stated = MetresPerSecondSquared(20.0 * MG);
    let setting = Setting { force_bias_sigma: stated, ..body.setting };
    let (mut keeper, mut known) = (Keeper::new(&setting), Vec::new());
    let mut noise = Generator::new(3);
    for index in 1..=10_000 {
        if index == 6000 {
            keeper.exchange_forces(MetresPerSecondSquared(0.1 * MG));
        }
        let offset = if index < 6000 { 20.0 * MG } else { 0.0 };
        let turned = [0.4, -0.3, 0.2]
            .map(|rate| 0.01 * rate * DEGREE + 1e-5 * noise.gaussian())
            .map(|angle| AngleIncrement::from_rad(angle, &mut 0.0));
        let felt = [offset, 0.0, -9.815].map(|part| part + 0.01 * noise.gaussian());
        keeper.push(&InertialSample {
            time: Instant(index * 10_000),
            turned,
            force: Some(force(felt)),
        });
        if index % 50 == 0 {
            let report = keeper.report();
            let sigma = report.level_sigma.degrees();
            known.push((0.01 * index as f64, report.pitch.degrees(), sigma, report.is_at_rest));
        }
    }
    known
}

#[test]
fn a_level_that_changes_to_better_accelerometers_is_theirs_within_seconds() {
    let known = levels();
    for (time, pitch, sigma, is_at_rest) in &known {
        let is_settled = match *time {
            5.0..59.9 => *is_at_rest && (1.1..1.3).contains(sigma),
            64.0.. => *is_at_rest && *sigma < 0.05 && pitch.abs() < 3.0 * sigma,
            _ => true,
        };
        assert!(is_settled, "{time} s: {pitch}° of {sigma}°");
        assert!(pitch.abs() < 3.0 * sigma + 0.01, "{time} s: {pitch}° of {sigma}°");
    }
    // Five seconds of motion would count as setting off.
    let moves = known.iter().filter(|(time, .., is_at_rest)| *time > 5.0 && !is_at_rest).count();
    assert!(moves <= 6, "{moves} halves of a second");
}

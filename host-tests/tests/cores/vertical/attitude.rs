//! The attitude in integers against quaternions in `f64`.

use orientation::math::quaternion::{Attitude, angles, quaternion};
use proptest::prelude::*;

use super::assert_near;

type Quaternion = [f64; 4];

fn product([a, b, c, d]: Quaternion, [w, x, y, z]: Quaternion) -> Quaternion {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

/// Of a rotation vector, rad.
fn rotation(vector: [f64; 3]) -> Quaternion {
    let size = length(&vector);
    if size == 0.0 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let [x, y, z] = vector.map(|part| part / size * (0.5 * size).sin());
    [(0.5 * size).cos(), x, y, z]
}

fn length(parts: &[f64]) -> f64 {
    parts.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// The angle between two attitudes, rad.
fn away(one: Quaternion, other: Quaternion) -> f64 {
    let [w, x, y, z] = one;
    let [between, parts @ ..] = product([w, -x, -y, -z], other);
    2.0 * length(&parts).atan2(between.abs())
}

fn wide(vector: [f32; 3]) -> [f64; 3] {
    vector.map(f64::from)
}

#[test]
fn an_hour_of_the_earths_rate_is_lost_by_no_more_than_a_twentieth_of_a_second_of_arc() {
    let turn = [1.1e-6_f32, -0.3e-6, -0.9e-6];
    let mut attitude = Attitude::default();
    for tick in 0..180_000 {
        attitude.turn(&turn);
        if tick % 5 == 4 {
            attitude.normalise();
        }
    }
    let expected = rotation(wide(turn).map(|part| 180_000.0 * part));
    assert_near(away(attitude.parts(), expected), 0.0, 2.4e-7);
}

#[test]
fn an_hour_of_turning_is_right_to_a_ten_millionth_of_it() {
    for rate in [0.01_f32, 1.0, 30.0] {
        let turn = [0.48_f32, 0.6, 0.64].map(|part| part * rate * 0.02);
        let mut attitude = Attitude::default();
        for _ in 0..180_000 {
            attitude.turn(&turn);
            attitude.normalise();
        }
        let expected = rotation(wide(turn).map(|part| 180_000.0 * part));
        let bound = 1e-7 * 3600.0 * f64::from(rate) + 1.5e-5;
        assert_near(away(attitude.parts(), expected), 0.0, bound);
    }
}

#[test]
fn ten_minutes_of_coning_leave_no_drift() {
    // The body's axis x goes round a cone of half angle a: q = cos a/2 + (j cos ωt + k sin ωt) sin a/2.
    let (half, rate) = (0.5_f64 * 0.02, 30.0_f64);
    let at = |time: f64| {
        let (sine, cosine) = (rate * time).sin_cos();
        [half.cos(), 0.0, half.sin() * cosine, half.sin() * sine]
    };
    let mut attitude = Attitude::new(at(0.0));
    for tick in 0..30_000 {
        let time = f64::from(tick) * 0.02;
        let [w, x, y, z] = at(time);
        let [turned, parts @ ..] = product([w, -x, -y, -z], at(time + 0.02));
        let size = 2.0 * length(&parts).atan2(turned);
        let by = size / length(&parts);
        attitude.turn(&parts.map(|part| (part * by) as f32));
        attitude.normalise();
    }
    assert_near(away(attitude.parts(), at(600.0)), 0.0, 2e-5);
}

#[test]
fn what_is_no_rotation_at_all_leaves_it_a_rotation() {
    let start = quaternion([0.3, 0.4, 0.5]);
    for size in [12.0, 20.0, 200.0, 1e4, 1e9, f32::MAX, f32::INFINITY, f32::NAN] {
        for turn in [[size, 0.0, 0.0], [-size, size, -size]] {
            let mut attitude = Attitude::new(start);
            attitude.turn(&turn);
            assert_near(length(&attitude.parts()), 1.0, 1e-7);
            attitude.correct(&turn);
            assert_near(length(&attitude.parts()), 1.0, 2e-7);
        }
    }
}

#[test]
fn a_body_that_stands_on_end_has_an_attitude_still() {
    for pitch in [90.0, -90.0, 90.0 - 1e-9, 1e-7 - 90.0, 89.999_999, -89.9999, 89.9] {
        for course in 0..12 {
            for roll in 0..12 {
                let [course, roll] = [course, roll].map(|step: u8| 30.0 * f64::from(step) - 175.0);
                let parts = quaternion([course, pitch, roll].map(f64::to_radians));
                assert_near(away(quaternion(angles(parts)), parts), 0.0, 1e-7);
            }
        }
    }
}

prop_compose! {
    fn vector(largest: f32)(parts in [-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0]) -> [f32; 3] {
        parts.map(|part| largest * part)
    }
}

proptest! {
    #[test]
    fn angles_and_quaternion_are_each_others_inverse(
        course in -3.1_f64..3.1, pitch in -1.5_f64..1.5, roll in -3.1_f64..3.1,
    ) {
        let parts = quaternion([course, pitch, roll]);
        prop_assert!(away(quaternion(angles(parts)), parts) < 1e-9);
        let [again, up, over] = angles(parts);
        prop_assert!((up - pitch).abs() < 1e-7);
        let bound = 1e-9 / pitch.cos();
        prop_assert!((again - course).abs() < bound && (over - roll).abs() < bound);
    }

    #[test]
    fn blows_of_up_to_a_turn_and_a_half_are_followed(
        start in [-3.0_f64..3.0, -1.5_f64..1.5, -3.0_f64..3.0],
        blows in prop::collection::vec(vector(5.4), 1..20),
    ) {
        let mut attitude = Attitude::new(quaternion(start));
        let mut expected = quaternion(start);
        for blow in &blows {
            attitude.turn(blow);
            attitude.normalise();
            expected = product(expected, rotation(wide(*blow)));
        }
        // 6e-8 of each, in each of its pieces.
        prop_assert!(away(attitude.parts(), expected) < 2e-6 * blows.len() as f64);
    }

    #[test]
    fn a_correction_turns_the_frame(
        start in [-3.0_f64..3.0, -1.5_f64..1.5, -3.0_f64..3.0], by in vector(0.3),
    ) {
        let mut attitude = Attitude::new(quaternion(start));
        attitude.correct(&by);
        let expected = product(rotation(wide(by)), quaternion(start));
        prop_assert!(away(attitude.parts(), expected) < 1e-7);
    }

    #[test]
    fn its_length_stays_one(turns in prop::collection::vec(vector(1.0), 1..2000)) {
        let mut attitude = Attitude::default();
        for turn in &turns {
            attitude.turn(turn);
            attitude.normalise();
            prop_assert!((length(&attitude.parts()) - 1.0).abs() < 1e-8);
        }
    }
}

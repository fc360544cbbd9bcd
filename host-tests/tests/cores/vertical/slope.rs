//! What the accelerometers' biases make of the azimuth of a body that climbs: a level that is off by ε below body x turns
//! it by ε·tan P.

use core::f64::consts::{PI, SQRT_2};

use orientation::units::{DEGREE, MetresPerSecondSquared, SpecificForce};

use super::world::{Body, Known, keep, keep_acting, precise};
use crate::support::assert_near;

/// Bias of the accelerometer to the right, 1σ, and the actual one, m/s²: 1.5 σ.
const SIGMA: f64 = 0.1;
const BIAS: f64 = 1.5 * SIGMA;
/// Gravity, m/s².
const GRAVITY: f64 = 9.815;
/// When the body has its azimuth, 1 mrad, and when it has found the level of its last slope, s.
const HANDED: f64 = 40.0;
const CLIMBED: f64 = 200.0;

/// How much of a way of ten seconds that begins at this time, s, a body has behind it.
fn part(time: f64, start: f64) -> f64 {
    ((time - start) / 10.0).clamp(0.0, 1.0)
}

/// A body that goes from one pitch to another, °, and turns by so many degrees; at its end.
fn climbed<const FROM: i32, const TO: i32, const TURN: i32>() -> Known {
    end_of(|time| {
        let part = part(time, HANDED + 5.0);
        let [from, to, turn] = [FROM, TO, TURN].map(|angle| f64::from(angle) * DEGREE);
        [0.5 + part * turn, from + part * (to - from), 0.0]
    })
}

/// A body that was upright for half a minute; at its end.
fn stood_up() -> Known {
    end_of(|time| {
        let part = part(time, HANDED + 5.0) - part(time, HANDED + 45.0);
        [0.5, 90.0 * DEGREE * part, 0.0]
    })
}

/// A body with this attitude.
fn body(attitude: fn(f64) -> [f64; 3]) -> Body {
    let mut body =
        Body { attitude, force_biases: [0.0, BIAS, 0.0], handed: Some(HANDED), ..precise(CLIMBED) };
    body.setting.force_bias_sigma = MetresPerSecondSquared(SIGMA);
    body
}

/// What is known of it at its end.
fn end_of(attitude: fn(f64) -> [f64; 3]) -> Known {
    keep(&body(attitude), |_, _| true).pop().expect("it was kept")
}

/// Error of the azimuth and its 1σ, rad.
fn azimuth(known: &Known) -> [f64; 2] {
    let sigma = known.report.azimuth.expect("it is held").sigma.0;
    [known.azimuth.expect("it is held").abs(), sigma]
}

/// Holds error and σ of the azimuth to ε·tan P, from the one slope to the other.
fn assert_off(known: &Known, from: f64, to: f64) {
    let [from, to] = [from, to].map(|pitch| (pitch * DEGREE).tan());
    let [error, sigma] = azimuth(known);
    assert_near(error, BIAS / GRAVITY * (to - from).abs(), 1e-3);
    assert_near(sigma, (SIGMA / GRAVITY * (to - from)).hypot(1e-3), 1e-4);
}

#[test]
fn the_azimuth_of_a_body_that_climbs_has_the_error_of_its_level_in_sigma() {
    assert_off(&climbed::<0, 20, 0>(), 0.0, 20.0);
    assert_off(&climbed::<0, -40, 0>(), 0.0, -40.0);
    assert_off(&climbed::<0, 75, 0>(), 0.0, 75.0);
}

#[test]
fn an_azimuth_that_was_found_on_a_slope_has_it_on_another_slope_and_not_there() {
    assert_off(&climbed::<30, 30, 0>(), 30.0, 30.0);
    assert_off(&climbed::<30, 0, 0>(), 30.0, 0.0);
    assert_off(&climbed::<30, -30, 180>(), 30.0, -30.0);
}

/// What is to the right lies to the left then.
#[test]
fn an_azimuth_that_was_found_on_a_slope_has_it_after_a_roll() {
    let known = end_of(|time| [0.5, 30.0 * DEGREE, PI * part(time, HANDED + 5.0)]);
    let [error, sigma] = azimuth(&known);
    let slope = (30.0 * DEGREE).tan() / GRAVITY;
    assert_near(error, 2.0 * BIAS * slope, 1e-3);
    assert_near(sigma, (2.0 * SIGMA * slope).hypot(1e-3), 1e-4);
}

#[test]
fn an_azimuth_on_a_slope_has_the_errors_of_the_old_accelerometers_and_of_the_new_ones() {
    let body = body(|_| [0.5, 30.0 * DEGREE, 0.0]);
    let exchanged = |time: f64| time > HANDED + 20.0;
    let (mut is_new, sigma) = (false, MetresPerSecondSquared(SIGMA));
    let known = keep_acting(
        &body,
        |time, sample| {
            // The new ones are off by as much to the other side.
            if let Some([_, right, _]) = sample.force.as_mut().filter(|_| exchanged(time)) {
                *right = SpecificForce::from_m_per_s2(right.m_per_s2() - 2.0 * BIAS);
            }
            true
        },
        |time, keeper| {
            if exchanged(time) && !core::mem::replace(&mut is_new, true) {
                keeper.exchange_forces(sigma);
            }
        },
    );
    let [error, sigma] = azimuth(known.last().expect("it was kept"));
    let slope = (30.0 * DEGREE).tan() / GRAVITY;
    assert_near(error, 2.0 * BIAS * slope, 1e-3);
    assert_near(sigma, (SQRT_2 * SIGMA * slope).hypot(1e-3), 1e-4);
}

#[test]
fn an_upright_body_has_no_azimuth_that_is_known_and_has_it_again_when_it_lies() {
    let upright = climbed::<0, 90, 0>().report.azimuth.expect("it is held");
    assert_near(upright.sigma.0, PI, 0.0);
    assert_off(&stood_up(), 0.0, 0.0);
}

//! What may go wrong: the state says so, σ covers it, and it comes back by itself.

use orientation::attitude::Trust;
use orientation::units::{AngleIncrement, DEGREE, SpecificForce, TURN};

use super::world::{Body, Known, coarse, keep, precise};

/// Greatest tilt in σ over a time, s.
fn worst(known: &[Known], times: std::ops::Range<f64>) -> f64 {
    let within = known.iter().filter(|known| times.contains(&known.time));
    within.map(Known::in_sigmas).fold(0.0, f64::max)
}

fn at(known: &[Known], time: f64) -> &Known {
    known.iter().find(|known| known.time >= time - 1e-6).expect("the time was reached")
}

#[test]
fn a_vehicle_that_speeds_up_steadily_does_not_stand() {
    for acceleration in [
        |time: f64| if (50.0..60.0).contains(&time) { [3.0, 0.0, 0.0] } else { [0.0; 3] },
        |time: f64| if (50.0..100.0).contains(&time) { [1.0, 0.0, 0.0] } else { [0.0; 3] },
    ] {
        for body in [coarse(160.0), precise(160.0)] {
            let known = keep(&Body { acceleration, ..body }, |_, _| true);
            assert!(worst(&known, 10.0..160.0) < 3.0, "{} σ", worst(&known, 10.0..160.0));
            assert!(!at(&known, 55.0).report.is_at_rest);
            assert!(at(&known, 130.0).report.is_at_rest);
        }
    }
}

/// Loops of an aeroplane, one after the other, at so many rad/s: what it has turned, rad.
fn looped(time: f64, rate: f64, loops: f64) -> f64 {
    rate * (time - 60.0).clamp(0.0, loops * TURN / rate)
}

/// Acceleration towards the middle of a loop, north, east, down, m/s², on a course of 0.5 rad.
fn towards_middle(turned: f64, size: f64) -> [f64; 3] {
    let along = -size * turned.sin();
    [along * 0.5_f64.cos(), along * 0.5_f64.sin(), -size * turned.cos()]
}

#[test]
fn loops_that_are_flown_cost_no_level() {
    // Two quick ones at 30 m/s and 4 g, a slow one at 2.5 g: the force never points up.
    let quick = Body {
        attitude: |time| [0.5, 0.03 + looped(time, 1.3, 2.0), -0.02],
        acceleration: |time| match looped(time, 1.3, 2.0) {
            turned if turned > 0.0 && turned < 2.0 * TURN => towards_middle(turned, 39.0),
            _ => [0.0; 3],
        },
        ..coarse(120.0)
    };
    let slow = Body {
        attitude: |time| [0.5, 0.03 + looped(time, 0.8, 1.0), -0.02],
        acceleration: |time| match looped(time, 0.8, 1.0) {
            turned if turned > 0.0 && turned < TURN => towards_middle(turned, 24.0),
            _ => [0.0; 3],
        },
        ..coarse(120.0)
    };
    for body in [quick, slow] {
        let of_precise =
            Body { attitude: body.attitude, acceleration: body.acceleration, ..precise(120.0) };
        for body in [body, of_precise] {
            let known = keep(&body, |_, _| true);
            assert!(worst(&known, 10.0..120.0) < 3.0, "{} σ", worst(&known, 10.0..120.0));
            let tilt = known.iter().filter(|known| known.time > 10.0).map(|known| known.tilt);
            assert!(tilt.fold(0.0, f64::max) < 2.0 * DEGREE);
        }
    }
}

#[test]
fn a_slow_turn_is_no_rest_once_biases_are_known() {
    let attitude = |time: f64| [0.5 + 0.1 * DEGREE * (time - 100.0).max(0.0), 0.03, -0.02];
    let slower = |time: f64| [0.5 + 0.01 * DEGREE * (time - 100.0).max(0.0), 0.03, -0.02];
    let bodies = [
        Body { attitude, handed: Some(90.0), ..coarse(300.0) },
        Body { attitude: slower, handed: Some(90.0), ..precise(300.0) },
    ];
    for body in bodies {
        let known = keep(&body, |_, _| true);
        assert!(known.iter().filter(|known| known.time > 103.0).all(|k| !k.report.is_at_rest));
        let last = known.last().expect("samples");
        let azimuth = last.report.azimuth.expect("an azimuth");
        assert!(last.azimuth.expect("an azimuth").abs() < 3.0 * azimuth.sigma.0);
    }
}

#[test]
fn biases_that_hold_the_earths_rate_are_doubted_when_the_body_goes() {
    let attitude = |time: f64| {
        let turned = 0.314_159 * (time - 300.0).clamp(0.0, 10.0);
        [0.5 + turned, 0.03 + if time < 310.0 { 0.0 } else { 0.02 * (time - 310.0).sin() }, -0.02]
    };
    let known = keep(&Body { attitude, ..precise(600.0) }, |_, _| true);
    assert!(worst(&known, 10.0..600.0) < 3.0, "{} σ", worst(&known, 10.0..600.0));
}

#[test]
fn a_bend_at_15_m_per_s_is_kept_within_three_sigma() {
    let attitude = |time: f64| [0.5 + 0.1 * (time - 60.0).clamp(0.0, 20.0), 0.03, -0.02];
    let acceleration = |time: f64| {
        let course = 0.5 + 0.1 * (time - 60.0).clamp(0.0, 20.0);
        let along = match time {
            50.0..55.0 => 3.0,
            100.0..105.0 => -3.0,
            _ => 0.0,
        };
        let across = if (60.0..80.0).contains(&time) { 1.5 } else { 0.0 };
        let (sine, cosine) = course.sin_cos();
        [along * cosine - across * sine, along * sine + across * cosine, 0.0]
    };
    let body = Body { attitude, acceleration, handed: Some(40.0), ..coarse(150.0) };
    let known = keep(&body, |_, _| true);
    assert!(worst(&known, 10.0..150.0) < 3.0, "{} σ", worst(&known, 10.0..150.0));
}

#[test]
fn a_free_fall_is_reported_and_over_at_once() {
    let acceleration =
        |time: f64| if (50.0..60.0).contains(&time) { [0.0, 0.0, 9.815] } else { [0.0; 3] };
    let attitude = |time: f64| [0.5, 0.03 + (time - 50.0).clamp(0.0, 10.0), -0.02];
    let known = keep(&Body { attitude, acceleration, ..coarse(90.0) }, |_, _| true);
    assert_eq!(at(&known, 55.0).report.state.trust, Trust::FreeFall);
    assert_eq!(at(&known, 60.4).report.state.trust, Trust::Level);
    assert!(worst(&known, 10.0..90.0) < 3.0, "{} σ", worst(&known, 10.0..90.0));
}

#[test]
fn a_body_that_falls_when_it_is_switched_on_has_no_level_yet() {
    let acceleration = |time: f64| if time < 5.0 { [0.0, 0.0, 9.815] } else { [0.0; 3] };
    let attitude = |_| [0.5, 0.4, 0.7];
    let known = keep(&Body { attitude, acceleration, ..coarse(30.0) }, |_, _| true);
    assert_eq!(at(&known, 4.0).report.state.trust, Trust::Starting);
    assert!(worst(&known, 5.5..30.0) < 3.0, "{} σ", worst(&known, 5.5..30.0));
}

#[test]
fn forces_that_are_missing_or_clipped_for_half_a_minute_are_reported() {
    let clipped = Some([SpecificForce(i32::MAX), SpecificForce(i32::MIN), SpecificForce(0)]);
    for force in [None, clipped] {
        let known = keep(&coarse(120.0), |time, sample| {
            if (50.0..80.0).contains(&time) {
                sample.force = force;
            }
            true
        });
        assert_eq!(at(&known, 60.0).report.state.trust, Trust::NoForce);
        assert_eq!(at(&known, 80.3).report.state.trust, Trust::Level);
        assert!(worst(&known, 10.0..120.0) < 3.0, "{} σ", worst(&known, 10.0..120.0));
    }
}

#[test]
fn samples_that_are_missing_are_covered() {
    let turning = |time: f64| [0.5 + 0.5 * (time - 40.0).clamp(0.0, 40.0), 0.03, -0.02];
    for missing in [0.015, 0.1, 10.0] {
        for attitude in [coarse(1.0).attitude, turning] {
            let body = Body { attitude, handed: Some(30.0), ..coarse(120.0) };
            let known = keep(&body, |time, _| !(60.0..60.0 + missing).contains(&time));
            let after = 60.5 + missing;
            assert!(worst(&known, after..120.0) < 3.0, "{} σ", worst(&known, after..120.0));
            for known in known.iter().filter(|known| known.time > after) {
                let Some(azimuth) = known.report.azimuth else { continue };
                assert!(known.azimuth.is_some_and(|off| off.abs() < 3.0 * azimuth.sigma.0));
            }
        }
    }
}

#[test]
fn rates_that_are_no_numbers_for_ten_seconds_take_the_azimuth_away() {
    let known = keep(&Body { handed: Some(30.0), ..coarse(90.0) }, |time, sample| {
        if (60.0..70.0).contains(&time) {
            sample.turned[2] = AngleIncrement::from_rad(f64::NAN, &mut 0.0);
        }
        true
    });
    assert_eq!(at(&known, 69.0).report.state.trust, Trust::RotationLost);
    assert!(at(&known, 69.0).report.azimuth.is_none());
    assert!(worst(&known, 10.0..90.0) < 3.0, "{} σ", worst(&known, 10.0..90.0));
    assert_eq!(at(&known, 73.0).report.state.trust, Trust::Level);
}

#[test]
fn a_level_on_its_head_is_put_right_within_three_seconds() {
    // The gyros miss half a turn of pitch.
    let attitude = |time: f64| [0.5, 0.03 + 60.0 * (time - 30.0).clamp(0.0, 0.052), -0.02];
    let known = keep(&Body { attitude, ..coarse(60.0) }, |time, sample| {
        if (30.0..30.06).contains(&time) {
            sample.turned = [AngleIncrement(i32::MAX); 3];
        }
        true
    });
    assert!(worst(&known, 33.5..60.0) < 3.0, "{} σ", worst(&known, 33.5..60.0));
}

#[test]
fn clocks_that_jump_back_or_stand_do_no_harm() {
    let known = keep(&coarse(120.0), |time, sample| {
        if time > 60.0 {
            sample.time.0 -= 50_000_000;
        }
        true
    });
    assert!(worst(&known, 10.0..120.0) < 3.0, "{} σ", worst(&known, 10.0..120.0));
    let known = keep(&coarse(30.0), |_, sample| {
        sample.time.0 = 7;
        true
    });
    assert!(known.iter().all(|known| known.tilt.is_finite()));
}

#[test]
fn increments_and_forces_at_their_limits_break_nothing() {
    for limit in [i32::MAX, i32::MAX - 1, i32::MIN + 1, i32::MIN] {
        let known = keep(&coarse(90.0), |time, sample| {
            if (50.0..51.0).contains(&time) {
                sample.turned = [AngleIncrement(limit); 3];
                sample.force = Some([SpecificForce(limit); 3]);
            }
            true
        });
        assert!(worst(&known, 60.0..90.0) < 3.0, "{limit}: {} σ", worst(&known, 60.0..90.0));
    }
}

//! Lifts that come late or go, gyros that are wrong, samples that are missing.

use orientation::roll::Condition;
use orientation::units::{AngleIncrement, Instant, SpinForce};

use super::world::{Body, assert_followed, follow, worst};

#[test]
fn a_lift_that_comes_after_two_seconds_is_found() {
    for scale in [1e-3, 0.01, -0.02] {
        let lift = |time: f64| if time < 2.0 { 0.0 } else { 20.0 };
        let known = follow(&Body { lift, scale, seconds: 3.0, ..Body::default() }, |_, _| true);
        assert_eq!(known[15_000].state.condition, Condition::Searching);
        assert_followed(&known);
    }
}

#[test]
fn a_lift_that_fades_for_three_tenths_of_a_second_is_held_within_three_sigma() {
    let lift = |time: f64| if (1.0..1.3).contains(&time) { 0.0 } else { 20.0 };
    let known = follow(&Body { lift, ..Body::default() }, |_, _| true);
    assert!(known.iter().any(|known| known.state.condition == Condition::Holding));
    assert!(worst(&known, 0.1) < 3.0, "{} σ", worst(&known, 0.1));
    assert_followed(&known);
}

#[test]
fn a_lift_that_turns_over_pushes_down() {
    let lift = |time: f64| if time < 1.0 { 20.0 } else { -20.0 };
    let known = follow(&Body { lift, ..Body::default() }, |_, _| true);
    assert_followed(&known);
    let last = known.last().and_then(|known| known.lift).expect("a lift");
    assert!((last + 20.0).abs() < 1.0, "{last} m/s²");
}

#[test]
fn a_scale_that_is_three_times_as_wrong_as_was_stated_is_found_all_the_same() {
    for scale in [0.03, -0.03] {
        assert_followed(&follow(&Body { scale, ..Body::default() }, |_, _| true));
        let honest = Body { scale, scale_sigma: 0.03, ..Body::default() };
        let known = follow(&honest, |_, _| true);
        assert_followed(&known);
        assert!(worst(&known, 0.1) < 4.0, "{} σ", worst(&known, 0.1));
    }
}

#[test]
fn a_body_that_begins_to_spin_is_found_within_a_second_and_a_half() {
    // At rest for a second, then 100 turns/s more every second.
    let turns = |time: f64| match time {
        ..1.0 => 0.0,
        ..2.0 => 50.0 * (time - 1.0) * (time - 1.0),
        _ => 100.0 * time - 150.0,
    };
    let rate = |time: f64| 100.0 * (time - 1.0).clamp(0.0, 1.0);
    let known = follow(&Body { turns, rate, seconds: 4.0, ..Body::default() }, |_, _| true);
    assert_eq!(known[9_000].state.condition, Condition::NotSpinning);
    assert!(worst(&known, 2.5) < 4.0, "{} σ", worst(&known, 2.5));
    assert_followed(&known);
}

#[test]
fn a_spin_that_goes_from_50_to_150_turns_is_followed() {
    let turns = |time: f64| match time {
        ..1.0 => 50.0 * time,
        ..3.0 => 50.0 * time + 25.0 * (time - 1.0) * (time - 1.0),
        _ => 150.0 * time - 200.0,
    };
    let rate = |time: f64| 50.0 + 50.0 * (time - 1.0).clamp(0.0, 2.0);
    let known = follow(&Body { turns, rate, seconds: 4.0, ..Body::default() }, |_, _| true);
    assert!(worst(&known, 0.1) < 4.0, "{} σ", worst(&known, 0.1));
    assert_followed(&known);
}

#[test]
fn a_spin_that_stops_says_so_and_goes_on() {
    let turns = |time: f64| match time {
        ..1.0 => 100.0 * time,
        ..2.0 => 100.0,
        _ => 100.0 * time - 100.0,
    };
    let rate = |time: f64| if (1.0..2.0).contains(&time) { 0.0 } else { 100.0 };
    let known = follow(&Body { turns, rate, seconds: 3.5, ..Body::default() }, |_, _| true);
    assert_eq!(known[19_000].state.condition, Condition::NotSpinning);
    assert!(worst(&known, 0.1) < 4.0, "{} σ", worst(&known, 0.1));
    assert_followed(&known);
}

#[test]
fn a_body_that_spins_the_other_way_is_followed() {
    let body = Body { turns: |time| -100.0 * time, rate: |_| -100.0, ..Body::default() };
    let known = follow(&body, |_, _| true);
    assert!(worst(&known, 0.1) < 4.0, "{} σ", worst(&known, 0.1));
    assert_followed(&known);
}

#[test]
fn samples_that_are_missing_cost_nothing_lasting() {
    for missing in [1, 10, 500] {
        let known =
            follow(&Body::default(), |place, _| !(10_000..10_000 + missing).contains(&place));
        assert!(worst(&known, 0.1) < 4.0, "{missing}: {} σ", worst(&known, 0.1));
        assert_followed(&known);
    }
}

#[test]
fn a_sample_that_is_missing_now_and_then_keeps_no_turn_from_counting() {
    for each in [5, 37] {
        let known = follow(&Body::default(), |place, _| place % each != 0);
        assert!(worst(&known, 0.1) < 4.0, "{each}: {} σ", worst(&known, 0.1));
        assert_eq!(known.last().map(|known| known.state.condition), Some(Condition::Locked));
        assert!(known.iter().skip(1000).all(|known| known.error.abs() < 0.02));
    }
}

#[test]
fn a_gyro_that_clips_loses_the_lock_for_a_moment_only() {
    for clipped in [1, 10, 500] {
        let known = follow(&Body::default(), |place, sample| {
            if (10_000..10_000 + clipped).contains(&place) {
                sample.turned[0] = AngleIncrement::from_rad(f64::NAN, &mut 0.0);
            }
            true
        });
        assert!(worst(&known, 0.1) < 4.0, "{clipped}: {} σ", worst(&known, 0.1));
        assert_followed(&known);
    }
}

#[test]
fn forces_that_are_lost_are_said_to_be() {
    for lost in [1, 10, 500] {
        let known = follow(&Body::default(), |place, sample| {
            if (10_000..10_000 + lost).contains(&place) {
                sample.force = (place % 2 == 0).then_some([SpinForce(i32::MAX), SpinForce(0)]);
            }
            true
        });
        let is_said = known.iter().any(|known| known.state.condition == Condition::ForceLost);
        assert_eq!(is_said, lost == 500);
        assert!(worst(&known, 0.1) < 4.0, "{lost}: {} σ", worst(&known, 0.1));
        assert_followed(&known);
    }
}

#[test]
fn a_blow_is_forgotten_at_the_next_turns() {
    let known = follow(&Body::default(), |place, sample| {
        if place == 10_000 {
            sample.force = Some([SpinForce(2_000_000_000), SpinForce(-2_000_000_000)]);
        }
        true
    });
    assert!(known[11_500..].iter().all(|known| known.state.condition == Condition::Locked));
    assert_followed(&known);
}

#[test]
fn forces_of_a_mirrored_sensor_are_not_followed() {
    let swapped = follow(&Body::default(), |_, sample| {
        sample.force = sample.force.map(|[y, z]| [z, y]);
        true
    });
    let mirrored = follow(&Body::default(), |_, sample| {
        sample.force = sample.force.map(|[y, z]| [y, SpinForce(-z.0)]);
        true
    });
    for known in [swapped, mirrored] {
        assert!(known.iter().skip(1000).all(|known| known.state.condition != Condition::Locked));
    }
}

#[test]
fn clocks_that_jump_do_no_harm() {
    let stands = |_: usize| 7;
    let back = |place: usize| if place < 10_000 { 2_000_000 + 100 * place } else { 100 * place };
    for clock in [stands, back] {
        let known = follow(&Body::default(), |place, sample| {
            sample.time = Instant(clock(place) as u64);
            true
        });
        assert_followed(&known);
    }
}

//! What the sensors of a spinning body show of their faults: each is named, or within σ.

use std::f64::consts::TAU;

use hal_mock::noise::Generator;
use host::methods::asked::Asked;
use host::methods::spin::errors::wrapped;
use host::methods::spin::{Replay, replay};
use host::recording::{Body, Header, SpinRow};
use orientation::roll::{Accelerometer, Condition, State};

use crate::support::program::{code, meridian, object};

/// Samples a second, and seconds.
const RATE_HZ: f64 = 10_000.0;
const SECONDS: f64 = 1.2;
/// Turns a second at the start, by what part of that they grow in a second, and the roll at the start, rad.
const TURNS_PER_S: f64 = 83.0;
const GROWTH: f64 = 0.04;
const START_RAD: f64 = 1.0;
/// Lift and noise of a force, m/s², and noise of the gyro, rad/s.
const LIFT: f64 = 25.0;
const NOISE: f64 = 0.5;
const GYRO_NOISE: f64 = 0.01;

fn roll_rad(time_s: f64) -> f64 {
    START_RAD + TAU * TURNS_PER_S * (time_s + 0.5 * GROWTH * time_s * time_s)
}

/// A healthy flight, in closed form.
fn rows() -> Vec<SpinRow> {
    let mut chance = Generator::new(7);
    let row = |index: usize| {
        let time_s = index as f64 / RATE_HZ;
        let rate_rad_s = TAU * TURNS_PER_S * (1.0 + GROWTH * time_s);
        let (sine, cosine) = roll_rad(time_s).sin_cos();
        let pull = 0.02 * rate_rad_s * rate_rad_s;
        let forces = [LIFT * cosine - pull, -LIFT * sine - 0.5 * pull];
        SpinRow {
            line: index as u64 + 1,
            time_s,
            rate_rad_s: rate_rad_s + GYRO_NOISE * chance.gaussian(),
            force_m_s2: forces.map(|force| force + NOISE * chance.gaussian()),
            across_rad_s: None,
        }
    };
    (0..(SECONDS * RATE_HZ) as usize).map(row).collect()
}

fn replayed(rows: Vec<SpinRow>) -> Replay {
    let header = Header { rate_hz: Some(RATE_HZ), ..Header::default() };
    replay(&header, &Body::Spin(rows), &Asked::default()).expect("it is of a spinning body")
}

/// That the roll at the end is stated, and true.
#[track_caller]
fn assert_true(replay: &Replay, rows: &[SpinRow]) {
    assert_eq!(replay.refusal(), None);
    let end = &replay.answer().end;
    let error = wrapped(end.roll_rad - roll_rad(rows.last().expect("there are rows").time_s));
    let sigma = end.sigma_rad.expect("it is stated");
    assert!(error.abs() < 4.0 * sigma, "{error} {sigma}");
}

#[test]
fn an_accelerometer_that_is_dead_is_named() {
    let named = [(0, Accelerometer::Y, "along y"), (1, Accelerometer::Z, "along z")];
    for (axis, stuck, words) in named {
        let mut rows = rows();
        for row in &mut rows {
            row.force_m_s2[axis] = 0.0;
        }
        let replay = replayed(rows);
        let reason = replay.refusal().expect("it is refused");
        assert!(reason.contains(words) && reason.contains("check supply"), "{reason}");
        let state = replay.answer().end.state;
        assert_eq!(state.condition, Condition::AccelerometerStuck(stuck));
    }
}

#[test]
fn an_accelerometer_that_sticks_for_a_while_is_reported_and_the_gyro_holds_the_roll() {
    let mut rows = rows();
    let stuck = rows[6000].force_m_s2[1];
    for row in &mut rows[6000..8000] {
        row.force_m_s2[1] = stuck;
    }
    let replay = replayed(rows.clone());
    let is_reported =
        |(_, state): &(f64, State)| matches!(state.condition, Condition::AccelerometerStuck(_));
    assert!(replay.answer().states.iter().any(is_reported));
    assert_true(&replay, &rows);
}

#[test]
fn forces_that_go_round_the_other_way_never_give_a_roll() {
    let mirrors: [fn([f64; 2]) -> [f64; 2]; 3] =
        [|[y, z]| [z, y], |[y, z]| [-y, z], |[y, z]| [y, -z]];
    for mirrored in mirrors {
        let mut rows = rows();
        for row in &mut rows {
            row.force_m_s2 = mirrored(row.force_m_s2);
        }
        let replay = replayed(rows);
        // Not even in the first turns.
        assert!(replay.answer().sigmas_rad.iter().all(|sigma| sigma.is_nan()));
        let reason = replay.refusal().expect("it is refused");
        assert!(reason.contains("against the gyro") && reason.contains("swapped"), "{reason}");
    }
}

#[test]
fn a_gyro_that_sticks_is_named_and_distinguished_from_one_that_is_coarse() {
    let mut stuck = rows();
    let rate = stuck[5000].rate_rad_s;
    stuck[5000..].iter_mut().for_each(|row| row.rate_rad_s = rate);
    let reason = replayed(stuck).refusal().expect("it is refused");
    assert!(reason.contains("gyro about x") && reason.contains("stuck"), "{reason}");
    let mut always = rows();
    for row in &mut always {
        row.rate_rad_s = rate;
    }
    let reason = replayed(always).refusal().expect("it is refused");
    assert!(reason.contains("gx_rad_s") && reason.contains("100 %"), "{reason}");
    // One that shows whole tenths of a rad/s stands for some fifty samples at each.
    let mut coarse = rows();
    for row in &mut coarse {
        let smooth = TAU * TURNS_PER_S * (1.0 + GROWTH * row.time_s);
        row.rate_rad_s = (10.0 * smooth).round() / 10.0;
    }
    assert_true(&replayed(coarse.clone()), &coarse);
}

#[test]
fn a_gyro_that_is_dead_in_between_does_not_leave_half_a_turn_unsaid() {
    for (from, length) in [(3000, 40), (5000, 130), (7000, 700), (9000, 2000)] {
        let mut rows = rows();
        for row in &mut rows[from..from + length] {
            row.rate_rad_s = 0.0;
        }
        let truth = rows.clone();
        let replay = replayed(rows);
        let answer = replay.answer();
        for (row, (roll, sigma)) in
            truth.iter().zip(answer.rolls_rad.iter().zip(&answer.sigmas_rad))
        {
            let error = wrapped(roll - roll_rad(row.time_s)).abs();
            assert!(sigma.is_nan() || error < 5.0 * sigma, "{}: {error} {sigma}", row.line);
        }
        assert_true(&replay, &truth);
    }
}

#[test]
fn first_samples_that_are_zero_cost_a_turn_and_nothing_else() {
    for zeros in [1, 3, 10, 60] {
        let mut rows = rows();
        for row in &mut rows[..zeros] {
            row.force_m_s2 = [0.0; 2];
        }
        let replay = replayed(rows.clone());
        assert_true(&replay, &rows);
        let sigma = replay.answer().end.sigma_rad.expect("it is stated");
        assert!(sigma < 1e-3, "{zeros}: {sigma}");
    }
}

#[test]
fn an_axis_that_leans_widens_sigma_by_half_of_that_and_one_that_is_too_large_does_not() {
    let healthy = replayed(rows()).answer().end.sigma_rad.expect("it is stated");
    let (lean, mut leaning) = (2.0_f64.to_radians(), rows());
    for row in &mut leaning {
        let [y, z] = row.force_m_s2;
        row.force_m_s2 = [y, z + lean * y];
    }
    let replay = replayed(leaning.clone());
    assert_true(&replay, &leaning);
    let sigma = replay.answer().end.sigma_rad.expect("it is stated");
    assert!((sigma / (0.5 * lean) - 1.0).abs() < 0.1, "{sigma}");
    let mut large = rows();
    for row in &mut large {
        row.force_m_s2[1] *= 1.1;
    }
    let replay = replayed(large.clone());
    assert_true(&replay, &large);
    let sigma = replay.answer().end.sigma_rad.expect("it is stated");
    assert!(sigma < 1.5 * healthy, "{sigma} {healthy}");
}

#[test]
fn a_flight_whose_board_gave_the_roll_up_is_refused_with_exit_code_1_and_its_reason() {
    let arguments = ["run", "spin", "--flight-seconds", "3", "--fault"];
    for fault in ["forward-gyro-silent", "up-accelerometer-silent"] {
        let output = meridian(&[&arguments[..], &[fault, "--json"]].concat());
        let object = object(&output);
        assert_eq!(code(&output), 1, "{fault}: {object}");
        assert_eq!(object["status"], "refused", "{fault}: {object}");
        let reason = object["reason"].as_str().unwrap_or_default();
        assert!(reason.starts_with("no roll: "), "{fault}: {reason}");
        assert!(object.get("roll_rad_end").is_none(), "{fault}: {object}");
    }
}

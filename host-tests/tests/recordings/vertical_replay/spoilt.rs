//! Recordings with something wrong in them: the state says so, σ covers it, and the level comes back.

use host::methods::asked::Asked;
use host::methods::vertical::{Replay, replay};
use host::recording::{Body, ImuRow, read_from};

use super::{Recorded, recorded};

fn met(replay: &Replay, state: &str) -> f64 {
    replay.states.iter().find(|met| met.state == state).map_or(0.0, |met| met.seconds)
}

/// Changes the rows whose times lie in a span, s.
fn spoilt(span: [f64; 2], mut change: impl FnMut(&mut ImuRow)) -> Recorded {
    let mut recorded = recorded("imu-broad-06");
    let [from, to] = span;
    for row in recorded.rows.iter_mut().filter(|row| (from..to).contains(&row.time_s)) {
        change(row);
    }
    recorded
}

/// How much of the tilt, in a span of time, lies within three σ, per cent.
fn covered(recorded: &Recorded, replay: &Replay, [from, to]: [f64; 2]) -> f64 {
    let errors = recorded.errors(replay);
    let inside = errors.off.iter().filter(|off| (from..to).contains(&off.time_s));
    let tilts: Vec<bool> = inside
        .flat_map(|off| off.tilts_deg.map(|tilt| tilt.abs() <= 3.0 * off.sigma_deg))
        .collect();
    100.0 * tilts.iter().filter(|is_in| **is_in).count() as f64 / tilts.len() as f64
}

/// Where the vertical points on the body's axes.
fn down([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z]
}

#[test]
fn gyros_that_clip_lose_the_level_and_it_comes_back_at_rest() {
    // They show no more than 3 rad/s of a rotation of up to 8; then the body stands as it is.
    let (limit, until) = (3.0, 45.0);
    let mut recorded = spoilt([0.0, until], |row| {
        row.sample.rates_rad_s = row.sample.rates_rad_s.map(|rate| rate.clamp(-limit, limit));
    });
    let stands = recorded.rows.iter().position(|row| row.time_s >= until).expect("it is longer");
    let last = recorded.truth[stands].expect("it is known there");
    for index in stands..recorded.rows.len() {
        let rest = recorded.rows[index - stands].sample;
        let sample = &mut recorded.rows[index].sample;
        sample.rates_rad_s = rest.rates_rad_s;
        sample.force_m_s2 = down(last).map(|part| -9.81 * part);
        recorded.truth[index] = Some(last);
    }
    let replay = recorded.replayed();
    println!("{:?} {:?}", replay.states, replay.last);
    assert!(met(&replay, "rotation lost") > 1.0, "{:?}", replay.states);
    assert_eq!(replay.refusal, None);
    assert!(replay.last.level_sigma.0 < 1.5_f64.to_radians(), "{:?}", replay.last);
    let errors = recorded.errors(&replay);
    let worst = errors.off.iter().filter(|off| off.time_s > until + 5.0);
    let worst = worst.map(|off| off.inclination_deg).fold(0.0, f64::max);
    assert!(worst < 1.0, "{worst}°");
    let inside = covered(&recorded, &replay, [0.0, 70.0]);
    println!("{inside:.1} % within 3 σ");
    assert!(inside >= 90.0, "{inside} %");
}

/// Inclination RMSE of VQF, °, on the excerpts of [`super::TRIALS`] with gyros that show 12 rad/s · tanh(rate / 12 rad/s)
/// (`compare_vqf.py excerpts MERIDIAN 12`).
const SOFT: [f64; 6] = [0.859, 1.625, 20.216, 0.415, 41.696, 3.279];

#[test]
fn gyros_that_are_soft_at_their_limit_err_like_the_floor_and_are_doubted() {
    let limit = 12.0;
    let mut within = Vec::new();
    for ((name, _), floor) in super::TRIALS.into_iter().zip(SOFT) {
        let mut recorded = recorded(name);
        for row in &mut recorded.rows {
            row.sample.rates_rad_s =
                row.sample.rates_rad_s.map(|rate| limit * (rate / limit).tanh());
        }
        let replay = recorded.replayed();
        let inclination = recorded.errors(&replay).inclination_rmse_deg;
        println!("{name}: {inclination:.3}°, VQF {floor}°");
        // Where the floor itself is lost, σ alone is asked for.
        assert!(floor > 10.0 || inclination < 1.2 * floor, "{name}: {inclination}°");
        within.push(covered(&recorded, &replay, [0.0, f64::INFINITY]));
    }
    let within = within.iter().sum::<f64>() / within.len() as f64;
    println!("{within:.1} % within 3 σ");
    // Within 3 σ were 17 % where nothing but the filter's own covariance was believed.
    assert!(within >= 80.0, "{within} %");
}

#[test]
fn accelerometers_that_clip_are_left_out_and_reported() {
    let recorded = spoilt([40.0, 45.0], |row| row.sample.force_m_s2 = [39.0, 39.0, -39.0]);
    let replay = recorded.replayed();
    assert!(met(&replay, "no force") > 4.0, "{:?}", replay.states);
    assert!(covered(&recorded, &replay, [40.0, 70.0]) >= 95.0);
}

#[test]
fn a_free_fall_is_reported_and_costs_no_level() {
    let recorded = spoilt([40.0, 41.0], |row| row.sample.force_m_s2 = [0.01, -0.02, 0.03]);
    let replay = recorded.replayed();
    assert!(met(&replay, "free fall") > 0.5, "{:?}", replay.states);
    assert!(covered(&recorded, &replay, [40.0, 70.0]) >= 95.0);
}

#[test]
fn gaps_numbers_that_are_none_and_stuck_gyros_are_errors_that_name_the_line() {
    const NAMES: &str = "# kind: imu\nt_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
    let row = |index: u32, rate: &str| {
        format!("{:.2},{rate},1e-3,2e-3,0.1,0.2,-9.8\n", 0.01 * f64::from(index))
    };
    let all: Vec<String> = (0..9).map(|index| row(index, "1e-3")).collect();
    let refused = |rows: &[String]| {
        let text = format!("{NAMES}{}", rows.concat());
        read_from("walk.csv", text.as_bytes()).expect_err("it is refused").to_string()
    };
    let mut gap = all.clone();
    gap.drain(3..7);
    assert!(refused(&gap).contains("line 6, column t_s"), "{}", refused(&gap));
    let mut none = all.clone();
    none[4] = row(4, "nan");
    assert!(refused(&none).contains("line 7, column gx_rad_s"), "{}", refused(&none));
    let stuck = spoilt([20.0, 50.0], |row| row.sample.rates_rad_s[1] = 0.25);
    let error = replay(&stuck.header, &Body::Imu(stuck.rows), &Asked::default());
    let error = error.expect_err("a gyro is stuck").to_string();
    assert!(error.starts_with("column gy_rad_s: the same value for 30.0 s from line"), "{error}");
}

#[test]
fn few_rows_are_refused_without_a_panic() {
    for count in [1, 2, 10] {
        let recorded = recorded("imu-broad-06");
        let body = Body::Imu(recorded.rows[..count].to_vec());
        let replay = replay(&recorded.header, &body, &Asked::default()).expect("it replays");
        assert_eq!(replay.refusal.as_deref(), Some("no level was found"));
        assert_eq!(replay.moments.len(), count);
    }
}

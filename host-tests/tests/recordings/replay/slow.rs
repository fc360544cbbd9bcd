//! A base that moves slowly, put into the recordings of one that stands.

use hal_mock::noise::Generator;
use host::recording::{Body, Header, StageRow};
use orientation::earth::Latitude;

use crate::support::files::recording;

use super::{ALL, of_rows};

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.81;
/// 1σ of the noise of an ordinary accelerometer, 100 µg/√Hz at 100 Hz, which hides a slow tilting, m/s².
const FORCE_NOISE_M_S2: f64 = 1e-2;
/// Rates of a base that turns about the vertical, °/min.
const TURNING_DEG_MIN: [f64; 8] = [0.003, -0.01, 0.03, -0.06, 0.1, -0.2, 0.5, -1.0];
/// Rates of a base that tilts, °/h.
const TILTING_DEG_H: [f64; 8] = [0.02, -0.05, 0.1, -0.2, 0.4, -0.8, 1.6, -3.0];

/// What a row's base has done since the first row.
struct Motion {
    azimuth_rad: f64,
    latitude: Latitude,
    /// Time, s.
    since: f64,
    /// Rate, rad/s.
    rate: f64,
}

/// A way in which a base moves, put into a row.
type Moves = fn(&mut StageRow, &Motion);

/// About the vertical: the horizontal Earth rate comes from another direction, and an axis that is not level feels the
/// rate.
fn turns(row: &mut StageRow, motion: &Motion) {
    let axis = motion.azimuth_rad + row.stage_rad;
    let turned = motion.rate * motion.since;
    row.rate_rad_s += motion.latitude.horizontal_rate().0 * ((axis + turned).cos() - axis.cos());
    row.rate_rad_s -= motion.rate * row.force_m_s2[0] / GRAVITY;
}

/// Towards its right side: the gyro feels the rate, and the vertical Earth rate through the tilt, the accelerometer
/// gravity.
fn rolls(row: &mut StageRow, motion: &Motion) {
    let (sine, cosine) = row.stage_rad.sin_cos();
    let tilt = motion.rate * motion.since;
    row.force_m_s2[0] -= GRAVITY * tilt * sine;
    row.force_m_s2[1] -= GRAVITY * tilt * cosine;
    row.rate_rad_s += motion.rate * cosine - motion.latitude.vertical_rate().0 * tilt * sine;
}

/// Upwards at its nose: the same a quarter of a turn on.
fn pitches(row: &mut StageRow, motion: &Motion) {
    let (sine, cosine) = row.stage_rad.sin_cos();
    let tilt = motion.rate * motion.since;
    row.force_m_s2[0] += GRAVITY * tilt * cosine;
    row.force_m_s2[1] -= GRAVITY * tilt * sine;
    row.rate_rad_s += motion.rate * sine + motion.latitude.vertical_rate().0 * tilt * cosine;
}

/// The rows of a stage whose base moves at a rate in rad/s, and how long they are, s.
fn moved(
    header: &Header,
    rows: &[StageRow],
    azimuth_deg: f64,
    rate: f64,
    moves: Moves,
) -> (Vec<StageRow>, f64) {
    let mut noise = Generator::stream(1, 0);
    let latitude_deg = header.latitude_deg.expect("it has a latitude");
    let latitude = Latitude::from_degrees(latitude_deg).expect("it is one");
    let azimuth_rad = azimuth_deg.to_radians();
    let since = |row: &StageRow| row.time_s - rows[0].time_s;
    let mut moved = rows.to_vec();
    for row in &mut moved {
        let since = since(row);
        moves(row, &Motion { azimuth_rad, latitude, since, rate });
        row.force_m_s2 = row.force_m_s2.map(|force| force + FORCE_NOISE_M_S2 * noise.gaussian());
    }
    (moved, since(&rows[rows.len() - 1]))
}

/// By how much, °, what is assumed in these words puts north off at the most, for a rate in its unit.
fn most(assumed: &[String], words: &str, rate: f64) -> Option<f64> {
    let line = assumed.iter().find(|line| line.starts_with(words))?;
    let number = |from: &str, to: &str| -> Option<f64> {
        line.split_once(from)?.1.split_once(to)?.0.parse().ok()
    };
    number("put north ", "° off")
        .or_else(|| Some(number("north is ", "° off")? * rate / number("by each ", " ")?))
}

/// Moves every recording's base at every rate: what is answered is right, or stated with its size. How many were reported.
fn assert_stated(words: &str, rates: &[f64], rad_s: f64, moves: Moves, turned: f64) -> usize {
    let mut reported = 0;
    for name in ALL {
        let (header, body, truth) = recording(name).into_parts();
        let truth_deg = truth.azimuth_deg.expect("it carries a truth");
        let Body::Stage(rows) = body else { continue };
        for rate in rates {
            let (rows, seconds) = moved(&header, &rows, truth_deg, rate * rad_s, moves);
            let truth_deg = truth_deg + turned * (rate * rad_s * seconds).to_degrees();
            let replayed = of_rows(&header, rows, truth_deg).expect("it replays");
            let Some((error, sigma)) = replayed.answer() else { continue };
            let error = error.abs();
            if error > 5.0 * sigma {
                let most = most(&replayed.replay.assumed, words, rate.abs());
                let most = most.unwrap_or_else(|| panic!("{name}, {rate}: {error}° in silence"));
                assert!(error < most + 4.0 * sigma, "{name}, {rate}: {error}° beyond {most}°");
                reported += 1;
            }
        }
    }
    reported
}

#[test]
fn a_base_that_turns_slowly_is_seen_or_in_sigma_or_assumed_not_to_with_its_size() {
    let rad_s = 1f64.to_radians() / 60.0;
    let reported = assert_stated("no slow turn of the base", &TURNING_DEG_MIN, rad_s, turns, 1.0);
    assert!(reported > 2, "only {reported} are wrong at all");
}

#[test]
fn a_base_that_tilts_slowly_is_seen_or_in_sigma_or_assumed_not_to_with_its_size() {
    let rad_s = 1f64.to_radians() / 3600.0;
    let reported = [rolls, pitches].map(|moves: Moves| {
        assert_stated("no slow tilting of the base", &TILTING_DEG_H, rad_s, moves, 0.0)
    });
    assert!(reported.iter().sum::<usize>() > 2, "only {reported:?} are wrong at all");
}

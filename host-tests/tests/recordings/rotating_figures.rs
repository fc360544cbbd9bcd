//! What the figures of a rotating recording show: phasors against closed forms, and spectra in which the
//! platform's unevenness stands before, and not after, the misalignment is taken off.

use std::f64::consts::{FRAC_PI_2, TAU};

use host::methods::rotating::part::Part;
use host::methods::rotating::turns::{
    freed, phasor, phasors, rate_hz, spectrum, turn_hz, whole_turns,
};
use host::recording::{Body, RotatingRow};
use host::spectrum::Line;

use crate::support::files::recording;

/// Rows of a platform at `speed` rad/s, 50 a second, whose gyro shows 3 cos θ − 4 sin θ on a drift.
fn even_rows(speed: f64, count: u32) -> Vec<RotatingRow> {
    let row = |index: u32| {
        let time_s = 7.0 + 0.02 * f64::from(index);
        let stage_rad = 1.0 + speed * 0.02 * f64::from(index);
        let signal = 3.0 * stage_rad.cos() - 4.0 * stage_rad.sin();
        let rate_rad_s = 100.0 + 0.01 * time_s + signal;
        let force_m_s2 = 0.0;
        RotatingRow {
            line: 1,
            time_s,
            stage_rad,
            stage_rate_rad_s: speed,
            rate_rad_s,
            force_m_s2,
            across_m_s2: None,
            force_is_new: true,
        }
    };
    (0..count).map(row).collect()
}

fn gyro(row: &RotatingRow) -> f64 {
    row.rate_rad_s
}

#[test]
fn a_phasor_is_the_signals_whatever_its_drift_and_the_sense_of_the_turn() {
    for speed in [FRAC_PI_2, -FRAC_PI_2] {
        let rows = even_rows(speed, 1000);
        let found = phasor(&rows, &gyro).expect("the platform turns");
        assert!((found.re - 3.0).abs() < 1e-9 && (found.im - 4.0).abs() < 1e-9, "{found}");
        assert!((turn_hz(&rows) - speed / TAU).abs() < 1e-12);
        assert!((rate_hz(&rows) - 50.0).abs() < 1e-9);
    }
}

#[test]
fn each_whole_turn_has_its_phasor_and_the_rest_has_none() {
    let rows = even_rows(-FRAC_PI_2, 900);
    let turns = phasors(&rows, &gyro);
    assert_eq!((whole_turns(&rows), turns.len()), (4, 4));
    for (index, (time, at)) in turns.iter().enumerate() {
        assert!((time - (9.0 + 4.0 * index as f64)).abs() < 0.03, "{time}");
        assert!((at.re - 3.0).abs() < 1e-6 && (at.im - 4.0).abs() < 1e-6, "{at}");
    }
}

#[test]
fn what_does_not_turn_has_no_phasor_and_no_spectrum() {
    assert_eq!(phasor(&even_rows(0.0, 100), &gyro), None);
    assert_eq!((whole_turns(&[]), turn_hz(&[]), rate_hz(&[])), (0, 0.0, 0.0));
    assert_eq!(spectrum(&even_rows(1.0, 10), &gyro), []);
}

#[test]
fn a_part_is_cut_by_its_times_and_says_what_it_is() {
    let rows = even_rows(-FRAC_PI_2, 900);
    let part = Part::between(&rows, 9.0, 11.0, false);
    assert_eq!(part.rows.len(), 100);
    assert_eq!(part.to_string(), "counter-clockwise at 0.250 Hz, rate-modulated");
    assert_eq!(Part::between(&rows, 40.0, 30.0, true).rows, []);
}

/// The gyro's recording.
fn recorded() -> Vec<RotatingRow> {
    match recording("rotating-gyro").body {
        Body::Rotating(rows) => rows,
        other => panic!("is {}", other.kind()),
    }
}

/// The amplitude at a frequency, of the nearest line.
fn at(lines: &[Line], frequency: f64) -> f64 {
    let distance = |line: &Line| (line.frequency_hz - frequency).abs();
    let nearest = lines.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.expect("there are lines").amplitude
}

/// −sin of the 0.8° of which the recordings of a turning platform are made.
const MISALIGNMENT: f64 = -0.013_962_2;

#[test]
fn the_deliberate_unevenness_leaves_the_spectrum_with_the_misalignment() {
    let rows = recorded();
    let modulated = Part::between(&rows, 0.0, 87.5, false);
    let after = |row: &RotatingRow| row.rate_rad_s - MISALIGNMENT * row.stage_rate_rad_s;
    let modulation = 0.83 * turn_hz(modulated.rows);
    let [before, after] = [
        at(&spectrum(modulated.rows, &gyro), modulation),
        at(&spectrum(modulated.rows, &after), modulation),
    ];
    assert!(after < 2e-3 * before, "{before} {after}");
    let platform = at(&spectrum(modulated.rows, &|row| row.stage_rate_rad_s), modulation);
    assert!((platform * MISALIGNMENT.abs() / before - 1.0).abs() < 2e-3, "{platform} {before}");
}

#[test]
fn at_even_rotation_the_line_of_the_turn_becomes_the_earth_rate() {
    let rows = recorded();
    let even = Part::between(&rows, 87.6, 175.2, true);
    let after = |row: &RotatingRow| row.rate_rad_s - MISALIGNMENT * row.stage_rate_rad_s;
    let turn = turn_hz(even.rows);
    assert!((turn - 0.137).abs() < 1e-4, "{turn}");
    let horizontal = 7.292_115e-5 * 55.75_f64.to_radians().cos();
    let [before, after] =
        [at(&spectrum(even.rows, &gyro), turn), at(&spectrum(even.rows, &after), turn)];
    // Tilt and g-sensitivity are left, 3/4 of a degree at most.
    assert!((after / horizontal - 1.0).abs() < 0.02, "{after} {horizontal}");
    assert!((before / horizontal - 1.0).abs() > 0.05, "{before} {horizontal}");
}

#[test]
fn what_a_sensor_shows_of_the_platforms_rate_and_its_derivative_is_taken_off() {
    let modulated = |row: RotatingRow| {
        let turn = 3.0 * row.time_s;
        let felt = 0.01 * turn.sin() - 0.002 * 3.0 * turn.cos();
        RotatingRow { stage_rate_rad_s: turn.sin(), rate_rad_s: 0.5 + felt, ..row }
    };
    let rows: Vec<RotatingRow> = even_rows(1.0, 500).into_iter().map(modulated).collect();
    let left = freed(&rows, 0.01, -0.002);
    // The central difference misses (3 · 0.02)²/6 of the derivative.
    assert!(left[1..499].iter().all(|row| (row.rate_rad_s - 0.5).abs() < 4e-6));
    assert_eq!(freed(&[], 1.0, 1.0), []);
}

//! `campaign keep`: Burov's classes half an hour after their alignment as `ACCURACY.md` prints them, its limit, an
//! azimuth that is stored on a base that turns, and what it prints.

use std::f64::consts::{LN_2, PI};

use host::campaign::keep::limit::{adjacent_variance, stored_sigma};
use host::campaign::keep::{self, Row};
use host::campaign::statistics::NORMAL_COVERAGE;
use host::campaign::statistics::Spread;
use host::methods::stops::samples::Converter;
use host::output::azimuth_error;
use orientation::alignment::Azimuth;
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::units::{DEGREE_PER_HOUR, Radians, RadiansPerSecond, Seconds};
use proptest::prelude::*;

use crate::support::campaign::{Extent, campaigns};
use crate::support::program::{assert_drawn, object, page};

proptest! {
    #[test]
    fn the_drift_of_each_noise_is_its_closed_form(a in 1.0..500.0_f64, b in 1.0..2000.0_f64) {
        let of = |n, bias, k, r| adjacent_variance(&GyroNoise::from_field_units(n, bias, k, r), a, b);
        let unit = DEGREE_PER_HOUR * DEGREE_PER_HOUR;
        let [a_h, b_h] = [a / 3600.0, b / 3600.0];
        let close = |found: f64, expected: f64| (found / unit / expected - 1.0).abs() < 1e-9;
        prop_assert!(close(of(0.02, 0.0, 0.0, 0.0), 0.0004 * (1.0 / a_h + 1.0 / b_h)));
        prop_assert!(close(of(0.0, 0.0, 2.0, 0.0), 4.0 * (a_h + b_h) / 3.0));
        prop_assert!(close(of(0.0, 0.0, 0.0, 3.0), 9.0 * (a_h + b_h).powi(2) / 4.0));
        // Two adjacent means of the same length: twice the Allan variance.
        let flicker = adjacent_variance(&GyroNoise::from_field_units(0.0, 0.5, 0.0, 0.0), a, a);
        prop_assert!(close(flicker, 2.0 * 0.25 * 2.0 * LN_2 / PI));
    }
}

#[test]
fn the_limit_of_a_perfect_gyro_is_what_was_handed_over() {
    assert_eq!(stored_sigma(&GyroNoise::default(), 0.003, 60.0, 1800.0), 0.003);
}

const RATE_HZ: f64 = 50.0;

/// Azimuth, °, after a rest of 60 s with an azimuth of 70°, and ten minutes of turning at a rate, rad/s, with gyros
/// of one bias, rad/s, that the keeper is not reported.
fn stored(latitude_deg: f64, bias: f64, turning: f64) -> f64 {
    let latitude = Latitude::from_degrees(latitude_deg).expect("it is one");
    let noise = GyroNoise::from_field_units(0.001, 0.0, 0.0, 0.0);
    let gyro =
        Gyro { noise, bias_sigma: RadiansPerSecond::from_degrees_per_hour(30.0), scale_sigma: 0.0 };
    let mut keeper = Keeper::new(&Setting::precise(latitude, Seconds(1.0 / RATE_HZ), gyro));
    let mut path = Converter::default();
    let mut azimuth = 70.0_f64.to_radians();
    let mut push = |keeper: &mut Keeper, index: u32, turning: f64| {
        let middle = azimuth + 0.5 * turning / RATE_HZ;
        azimuth += turning / RATE_HZ;
        let level = latitude.horizontal_rate();
        let earth = [level.0 * middle.cos(), -level.0 * middle.sin(), -latitude.vertical_rate().0];
        let turned = [earth[0] + bias, earth[1] + bias, earth[2] + bias + turning];
        let force = [0.0, 0.0, -latitude.gravity().0];
        let time_s = f64::from(index + 1) / RATE_HZ;
        keeper.push(&path.sample(time_s, turned.map(|rate| rate / RATE_HZ), force));
    };
    let rest = (60.0 * RATE_HZ) as u32;
    for index in 0..rest {
        push(&mut keeper, index, 0.0);
    }
    keeper.hand_over(Azimuth { angle: Radians::from_degrees(70.0), sigma: Radians(1e-4) });
    for index in rest..rest + (600.0 * RATE_HZ) as u32 {
        push(&mut keeper, index, turning);
    }
    keeper.report().azimuth.expect("it was handed over").angle.degrees()
}

#[test]
fn a_base_keeps_its_azimuth_at_rest_and_through_turns_whatever_bias_and_latitude() {
    for latitude_deg in [-70.0, 0.0, 48.0] {
        for bias in [0.0, 25.0 * DEGREE_PER_HOUR] {
            for turning in [0.0_f64, 0.1, -0.02] {
                let azimuth = stored(latitude_deg, bias, turning);
                let off = azimuth_error(azimuth, 70.0 + (600.0 * turning).to_degrees());
                println!("{latitude_deg}° {bias:.1e} {turning}: {off:+.5}°");
                // 25 °/h would be 4.2° in ten minutes, and the Earth 1.9° at least.
                assert!(off.abs() < 0.02, "{latitude_deg}° {bias} {turning}: {off}°");
            }
        }
    }
}

#[test]
fn the_command_prints_every_class_and_draws() {
    let arguments = ["campaign", "keep", "--runs", "1", "--json"];
    let (output, page) = page(&arguments);
    let object = object(&output);
    assert_eq!(object["campaign"], "keep");
    let classes = object["classes"].as_array().expect("there are classes");
    assert_eq!(classes.len(), keep::COUNT);
    for class in classes {
        assert_eq!(class["growth"].as_array().map(Vec::len), Some(30), "{class}");
        assert!(class["azimuth"]["rms_deg"].is_f64() && class["azimuth_limit_deg"].is_f64());
    }
    let titles = ["Table 1", "Azimuth: very lightweight", "Pitch and roll: light", "σ(t)"];
    assert_drawn(&page, &titles);
}

/// Vehicles of each class: the RMS is then known to 5 %, the coverage of all to 1.5 points.
const RUNS: usize = 200;
/// Classes; the rows after them stand for comparison.
const CLASSES: usize = 5;

/// As `ACCURACY.md` has it.
fn line(row: &Row) -> String {
    let covered = |spread: &Spread| {
        let [one, two, three] = spread.coverage_percent;
        format!("{one:.1}, {two:.1}, {three:.1} %")
    };
    format!(
        "| {} | {:.2}° | {:.3}° | {:.3}° | {:.3}° | {} | {:.2}° | {:.3}° | {} |",
        row.class,
        row.wanted_azimuth_deg,
        row.azimuth_driving.rms_deg,
        row.azimuth.rms_deg,
        row.azimuth_limit_deg,
        covered(&row.azimuth),
        row.wanted_level_deg,
        row.level.rms_deg,
        covered(&row.level),
    )
}

/// The coverage over all classes, per cent.
fn over_all(rows: &[Row], of: impl Fn(&Row) -> Spread) -> [f64; 3] {
    [0, 1, 2].map(|index| {
        rows.iter().map(|row| of(row).coverage_percent[index]).sum::<f64>() / rows.len() as f64
    })
}

campaigns! { each_class_keeps_azimuth_pitch_and_roll_as_its_row_wants_and_sigma_covers_them; }

fn each_class_keeps_azimuth_pitch_and_roll_as_its_row_wants_and_sigma_covers_them(extent: Extent) {
    let runs = extent.of(RUNS);
    let rows: Vec<Row> = (0..CLASSES).map(|case| keep::row(case, runs, &|| {})).collect();
    extent.assert_in_accuracy(&rows.iter().map(line).collect::<Vec<_>>());
    for row in &rows {
        assert!(row.is_wanted && row.is_met && row.lost == 0, "{row:?}");
    }
    for covered in [over_all(&rows, |row| row.azimuth), over_all(&rows, |row| row.level)] {
        for (covered, normal) in covered.iter().zip(NORMAL_COVERAGE) {
            let chance = extent.share(3.0, normal, CLASSES * runs);
            assert!((covered - normal).abs() <= chance, "{covered} {normal} ± {chance}");
        }
    }
}

//! The campaign of a turning platform: its errors after each stage over azimuths and unevenness phases, and a
//! molecular-electronic sensor at one speed and two, as `ACCURACY.md` prints them.

use std::f64::consts::TAU;

use host::campaign::rotating::world::{Integrating, LATITUDE_DEG};
use host::campaign::rotating::{molecular, refusals, stages};
use host::campaign::statistics::Precision;

use crate::support::campaign::{Extent, campaigns};

/// Runs of a flat gyro, and of a sensor with two speeds, which take twenty times as long.
const RUNS: [usize; 2] = [500, 60];

campaigns! {
    a_flat_gyro_reaches_its_limit_after_every_stage_of_compensation;
    two_speeds_free_a_molecular_electronic_sensor_of_its_g_sensitivity;
}

fn percent(precision: &Precision) -> String {
    let [one, two, three] = precision.coverage_percent;
    format!("{one:.1}, {two:.1}, {three:.1} %")
}

fn a_flat_gyro_reaches_its_limit_after_every_stage_of_compensation(extent: Extent) {
    let runs = extent.of(RUNS[0]);
    let found = stages::rows(runs, &|| {});
    each_stage_leaves_what_equations_md_says_of_it(&found);
    the_raw_error_is_greatest_where_the_unevenness_acts_across_the_azimuth(&found);
    let mut rows = Vec::new();
    for row in &found {
        let precision = &row.precision;
        assert_eq!(precision.refused, 0, "{precision:?}");
        let [raw, misalignment, senses, full] =
            [0, 1, 2, 3].map(|index| row.stages.get(index).map_or(f64::NAN, |s| s.rms_deg));
        // The platform's own motion leaves 0.002°, which only the quietest gyro shows.
        let most = if row.n_deg_sqrt_h < 0.001 { 0.15 } else { 0.05 };
        assert!(precision.ratio < 1.0 + extent.rms(most, runs), "{precision:?}");
        assert!(precision.ratio > 1.0 - extent.rms(0.08, runs), "{precision:?}");
        assert!(precision.worst_sigmas < 4.5, "{precision:?}");
        rows.push(format!(
            "| N {} | {raw:.1}° | {misalignment:.2}° | {senses:.2}° | {full:.4}° | {:.4}° | {:.3} | {} |",
            row.n_deg_sqrt_h,
            precision.limit_deg,
            precision.ratio,
            percent(precision)
        ));
    }
    extent.assert_in_accuracy(&rows);
}

fn each_stage_leaves_what_equations_md_says_of_it(rows: &[stages::Row]) {
    let [quiet, real] = rows else { panic!("two gyros") };
    let left: Vec<f64> = quiet.stages.iter().map(|stage| stage.greatest_deg).collect();
    println!("{left:?}");
    assert!((34.0..38.0).contains(&left[0]), "raw: {left:?}");
    assert!((0.3..0.7).contains(&left[1]), "without the unevenness: {left:?}");
    assert!((0.3..0.5).contains(&left[2]), "both senses: {left:?}");
    assert!(left[3] < 0.03, "everything: {left:?}");
    assert_eq!(quiet.precision.refused + real.precision.refused, 0);
    // 0.579° at N 0.02, in closed form for 2 · 27 turns.
    let hours: f64 = 54.0 / 0.137 / 3600.0;
    let earth = 15.041_067 * 55.75_f64.to_radians().cos();
    let closed = (2.0_f64.sqrt() * 0.02 / earth / hours.sqrt()).to_degrees();
    assert!((real.precision.limit_deg / closed - 1.0).abs() < 0.01, "{}", real.precision.limit_deg);
    assert!((closed - 0.579).abs() < 0.001, "{closed}");
}

fn the_raw_error_is_greatest_where_the_unevenness_acts_across_the_azimuth(rows: &[stages::Row]) {
    // The part that turns with the platform is 0.5857 of the horizontal Earth rate.
    for (acts_deg, error_deg) in &rows[0].raw {
        let (sine, cosine) = acts_deg.to_radians().sin_cos();
        let expected = (0.5857 * sine).atan2(1.0 + 0.5857 * cosine).to_degrees();
        assert!((error_deg - expected).abs() < 2.0, "{acts_deg}° {error_deg}° {expected}°");
    }
}

fn two_speeds_free_a_molecular_electronic_sensor_of_its_g_sensitivity(extent: Extent) {
    // What the misalignment's own error leaves comes on top, with or without a g-sensitivity; the noise is 5/3 of the
    // limit.
    let (runs, aligned, leaning, noise) = match extent {
        Extent::Whole => (RUNS[1], [0.01, 0.03], [0.02, 0.03], 2.5),
        Extent::Tenth => (8, [0.01, 0.012], [0.1, 0.06], 3.5),
    };
    let mut rows = Vec::new();
    for row in molecular::rows(runs, &|| {}) {
        let precision = &row.precision;
        assert_eq!(precision.refused, 0, "{precision:?}");
        assert!(precision.worst_sigmas < 4.5, "{row:?}");
        assert!(row.predicted_rms_deg <= row.bound_deg, "{row:?}");
        let [two_speeds, off] = if row.coupling_deg == 0.0 { aligned } else { leaning };
        assert!(row.two_speeds_rms_deg < two_speeds, "{row:?}");
        assert!(row.off_prediction_deg < off, "{row:?}");
        assert!(row.noise_ratio < noise, "{row:?}");
        rows.push(format!(
            "| {}° | {} | {:.4}° | {:.4}° | {:.4}° | {:.2} | {:.3} |",
            row.coupling_deg,
            row.ratio,
            row.one_speed_rms_deg,
            row.predicted_rms_deg,
            row.two_speeds_rms_deg,
            row.noise_ratio,
            precision.ratio
        ));
    }
    extent.assert_in_accuracy(&rows);
}

#[test]
fn a_ratio_and_a_lag_are_those_of_the_sensor_that_is_made_of_them() {
    let made = Integrating { ratio: 0.1, toward_deg: 90.0, lag_deg: 45.0, speed_hz: 0.5 / TAU };
    let [along, across] = made.force_rad_s2_g();
    let horizontal = 7.292_115e-5 * LATITUDE_DEG.to_radians().cos();
    // ρ = κ β/(w Ω_h).
    let ratio = across * 0.3_f64.to_radians().sin() / 0.5 / horizontal;
    assert!((ratio - 0.1).abs() < 1e-9 && along.abs() < 1e-12 * across, "{ratio}");
    assert!((made.sensor().lag_s - 2.0).abs() < 1e-9);
}

#[test]
fn whatever_goes_wrong_is_refused_and_nothing_is_wrong() {
    for row in refusals::rows(2, &|| {}) {
        println!("{}: {:?}", row.case, row.reason);
        assert_eq!((row.wrong, row.refused), (0, row.runs), "{row:?}");
        assert_ne!(row.reason.as_deref(), Some("the time allowed ran out"), "{row:?}");
    }
}

//! Dynamic north finding by simulation: the figures of equations.md §4.

use std::f64::consts::TAU;

use bench::campaign::rotating::world::{Integrating, LATITUDE_DEG};
use bench::campaign::rotating::{molecular, refusals, stages};
use bench::campaign::statistics::Precision;

#[test]
fn each_stage_leaves_what_equations_md_says_of_it() {
    let rows = stages::rows(60, || {});
    let [quiet, real] = &rows[..] else { panic!("two gyros") };
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
    is_at_the_limit(&real.precision);
}

/// Within what chance makes of sixty runs (3.3 σ of an RMS of two sides each: 30 %).
fn is_at_the_limit(precision: &Precision) {
    assert!((0.7..1.3).contains(&precision.ratio), "{precision:?}");
    assert!(precision.worst_sigmas < 4.5, "{precision:?}");
}

#[test]
fn the_raw_error_is_greatest_where_the_unevenness_acts_across_the_azimuth() {
    let rows = stages::rows(60, || {});
    // The part that turns with the platform is 0.5857 of the horizontal Earth rate.
    for (acts_deg, error_deg) in &rows[0].raw {
        let (sine, cosine) = acts_deg.to_radians().sin_cos();
        let expected = (0.5857 * sine).atan2(1.0 + 0.5857 * cosine).to_degrees();
        assert!((error_deg - expected).abs() < 2.0, "{acts_deg}° {error_deg}° {expected}°");
    }
}

#[test]
fn one_speed_is_off_by_what_equations_md_predicts_and_two_are_not() {
    for row in molecular::rows(8, || {}) {
        println!("{row:?}");
        assert!(row.predicted_rms_deg <= row.bound_deg, "{row:?}");
        assert_eq!(row.precision.refused, 0, "{row:?}");
        let is_aligned = row.coupling_deg == 0.0;
        // What the coupling's own error leaves comes on top, with or without a g-sensitivity.
        assert!(row.off_prediction_deg < if is_aligned { 0.012 } else { 0.06 }, "{row:?}");
        assert!(row.two_speeds_rms_deg < if is_aligned { 0.01 } else { 0.1 }, "{row:?}");
        // 5/3 of the limit, as eight runs show it.
        assert!(row.noise_ratio < 3.5, "{row:?}");
        assert!(row.precision.worst_sigmas < 4.5, "{row:?}");
    }
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
    for row in refusals::rows(2, || {}) {
        println!("{}: {:?}", row.case, row.reason);
        assert_eq!((row.wrong, row.refused), (0, row.runs), "{row:?}");
        assert_ne!(row.reason.as_deref(), Some("the time allowed ran out"), "{row:?}");
    }
}

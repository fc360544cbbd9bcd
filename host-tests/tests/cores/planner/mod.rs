//! The planner: Burov's formula to its printed figures, the project's own optimum against an
//! independent covariance.

mod covariance;
mod least;

use covariance::rate_sigma;
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::planner::burov::{self, Autocompensation};
use orientation::planner::order::Order;
use orientation::planner::prediction::{self, Visit};
use orientation::planner::{Conditions, Plan, PlanError, Rotation, for_sigma, for_time};
use orientation::units::{DEGREE_PER_HOUR, RadiansPerSecond, Seconds};
use proptest::prelude::*;
use serde_json::Value;

/// Burov's device: N 0.001 °/√h, R 0.127 °/h².
fn device() -> GyroNoise {
    GyroNoise::from_field_units(0.001, 0.0, 0.0, 0.127)
}

/// A gyro's noise from N in °/√h, B in °/h, K in °/h/√h and R in °/h².
fn noise_of([n, b, k, r]: [f64; 4]) -> GyroNoise {
    GyroNoise::from_field_units(n, b, k, r)
}

fn conditions(noise: GyroNoise, rotation: Rotation) -> Conditions {
    Conditions { noise, rotation, shortest: Seconds(0.5), fewest: 8, orders: &Order::COMPARED }
}

#[test]
fn burovs_formula_gives_the_reference_positions_and_errors() {
    let text = include_str!("../../../data/vectors/planner.json");
    let vectors: Value = serde_json::from_str(text).expect("it is JSON");
    let cases = vectors["cases"].as_array().expect("there are cases");
    assert_eq!(cases.len(), 6);
    for case in cases {
        let of = |key: &str| case[key].as_f64().expect("a number");
        let noise = GyroNoise::from_field_units(
            of("N_deg_sqrt_h"),
            0.0,
            of("K_deg_h_sqrt_h"),
            of("R_deg_h2"),
        )
        .with_quantisation(of("Q_arcsec"));
        let best = burov::best(&noise, Seconds(of("t_gc_s")), Seconds(of("t_rot_s")))
            .expect("there is time");
        assert_eq!(f64::from(best.positions), of("n_opt"));
        let error = best.rate_error.degrees_per_hour();
        let expected = of("rate_error_deg_h");
        assert!((error / expected - 1.0).abs() < 1e-6, "{error} against {expected}");
    }
}

#[test]
fn the_papers_device_reaches_0_0676_degrees_times_the_secant_of_the_latitude() {
    let Autocompensation { positions, rate_error, .. } =
        burov::best(&device(), Seconds(300.0), Seconds(2.0)).expect("there is time");
    assert_eq!(positions, 11);
    assert!((rate_error.degrees_per_hour() - 3.6505e-3).abs() < 5e-8);
    for (n, expected) in [(10, 3.65150e-3), (12, 3.65291e-3)] {
        let error =
            burov::rate_error(&device(), n, Seconds(300.0), Seconds(2.0)).expect("there is time");
        assert!((error.degrees_per_hour() - expected).abs() < 5e-9, "{n}");
    }
    let flicker = burov::flicker_floor(&GyroNoise::from_field_units(0.0, 0.007, 0.0, 0.0));
    assert!((flicker.degrees_per_hour() - 4.650e-3).abs() < 5e-7);
    let total = rate_error.0.hypot(flicker.0);
    assert!((total / DEGREE_PER_HOUR - 5.912e-3).abs() < 5e-7);
    let equator = Latitude::from_degrees(0.0).expect("it is one").horizontal_rate();
    assert!(((3.0 * total / equator.0).to_degrees() - 0.0676).abs() < 5e-5);
}

#[test]
fn rotations_that_leave_no_time_have_no_error_and_no_noise_no_plan() {
    assert_eq!(burov::rate_error(&device(), 152, Seconds(300.0), Seconds(2.0)), None);
    assert_eq!(burov::rate_error(&device(), 1, Seconds(300.0), Seconds(2.0)), None);
    assert_eq!(burov::best(&device(), Seconds(1.5), Seconds(2.0)), None);
    let rotation = Rotation::fixed(Seconds(2.0));
    assert_eq!(for_time(&conditions(device(), rotation), Seconds(5.0)), Err(PlanError::TooShort));
    let silent = conditions(GyroNoise::default(), rotation);
    assert_eq!(for_time(&silent, Seconds(300.0)), Err(PlanError::NoNoise));
}

proptest! {
    #[test]
    fn the_least_time_is_the_inverse_of_the_best_error(
        n in 1e-4..0.2_f64, k in 0.0..1.0_f64, r in 0.0..2.0_f64, rotation in 0.5..5.0_f64,
        seconds in 30.0..2000.0_f64,
    ) {
        let noise = GyroNoise::from_field_units(n, 0.0, k, r);
        let rotation = Seconds(rotation);
        let best = burov::best(&noise, Seconds(seconds), rotation);
        let wanted = best.expect("there is time").rate_error;
        let found = burov::least_time(&noise, wanted, rotation).expect("it is within reach");
        prop_assert!(found.rate_error <= wanted);
        prop_assert!(found.seconds.0 <= seconds * (1.0 + 1e-9));
        // No shorter time does.
        for part in [0.999, 0.99, 0.95, 0.9, 0.8, 0.6, 0.4] {
            let shorter = burov::best(&noise, Seconds(part * found.seconds.0), rotation);
            prop_assert!(shorter.is_none_or(|best| best.rate_error > wanted));
        }
    }

    #[test]
    fn burovs_best_is_the_best_of_all_positions(
        n in 1e-4..0.2_f64, k in 0.0..1.0_f64, r in 0.0..2.0_f64, q in 0.0..1.0_f64,
        seconds in 10.0..400.0_f64,
    ) {
        let noise = GyroNoise::from_field_units(n, 0.0, k, r).with_quantisation(q);
        let (seconds, rotation) = (Seconds(seconds), Seconds(1.0));
        let error = |n| burov::rate_error(&noise, n, seconds, rotation);
        let of = |n| error(n).map_or(f64::INFINITY, |error| error.0);
        let least = (2..410).map(of).fold(f64::INFINITY, f64::min);
        let best = burov::best(&noise, seconds, rotation).expect("there is time");
        prop_assert_eq!(best.rate_error.0, least);
    }

    #[test]
    fn a_prediction_in_single_precision_is_right_to_a_thousandth(
        n in 1e-4..0.2_f64, b in 0.0..10.0_f64, k in 0.0..10.0_f64, r in 0.0..10.0_f64,
        order in 0..Order::COMPARED.len(), passes in 1_usize..6, dwell in 1.0..60.0_f64,
    ) {
        let noise = GyroNoise::from_field_units(n, b * n, k * n, r * n);
        let order = Order::COMPARED[order];
        let rotation = Rotation { rest: Seconds(0.5), speed: RadiansPerSecond(0.35), wraps: false };
        let (seconds, none) = (Seconds(0.0), RadiansPerSecond(0.0));
        let plan = Plan { order, passes, dwell: Seconds(dwell), seconds, rate_sigma: none };
        let visits: Vec<Visit> = plan.visits(&rotation).collect();
        let found = prediction::rate_sigma(&noise, dwell, visits.iter().copied()).expect("it is determined");
        let expected = rate_sigma(&noise, &visits);
        prop_assert!((found / expected - 1.0).abs() < 1e-3, "{found} against {expected}");
    }
}

/// The gyros of the issue: fibre-optic under a temperature gradient, and a drifting one.
const GYROS: [[f64; 4]; 2] = [[0.001, 0.007, 0.0, 0.127], [0.06, 1.0, 0.5, 2.0]];

#[test]
fn the_planned_schedule_is_better_than_one_pass_of_four_positions() {
    for (gyro, gain) in GYROS.into_iter().zip([1.1, 1.5]) {
        let conditions = conditions(noise_of(gyro), Rotation::fixed(Seconds(2.0)));
        let four = Conditions { fewest: 4, ..conditions };
        let one = Plan::of(&four, Order::Quadrature, 1, Seconds(300.0)).expect("it fits");
        let planned = for_time(&conditions, Seconds(300.0)).expect("there is time");
        assert!(one.rate_sigma.0 > gain * planned.rate_sigma.0, "{gyro:?}: {planned:?}");
        assert!(planned.positions() <= 64 && planned.dwell.0 > 1.0);
    }
}

#[test]
fn no_order_and_no_number_of_passes_beats_the_plan() {
    for gyro in GYROS.into_iter().chain([[0.02, 0.0, 0.0, 0.0], [0.02, 0.3, 2.0, 0.0]]) {
        for rotation in [
            Rotation::fixed(Seconds(2.0)),
            Rotation { rest: Seconds(0.7), speed: RadiansPerSecond(0.35), wraps: false },
        ] {
            let conditions = conditions(noise_of(gyro), rotation);
            let planned = for_time(&conditions, Seconds(300.0)).expect("there is time");
            for order in Order::COMPARED {
                let tried = (1..=21)
                    .filter_map(|passes| Plan::of(&conditions, order, passes, Seconds(300.0)));
                let least = tried.map(|plan| plan.rate_sigma.0).fold(f64::INFINITY, f64::min);
                // The passes are tried in steps: half a per cent may be left.
                assert!(least > 0.995 * planned.rate_sigma.0, "{gyro:?} {order:?}: {planned:?}");
            }
        }
    }
}

#[test]
fn the_time_for_a_wanted_accuracy_is_the_least_or_said_to_be_out_of_reach() {
    for gyro in GYROS {
        let conditions = conditions(noise_of(gyro), Rotation::fixed(Seconds(2.0)));
        let wanted =
            1.3 * for_time(&conditions, Seconds(300.0)).expect("there is time").rate_sigma.0;
        let found = for_sigma(&conditions, RadiansPerSecond(wanted), Seconds(3600.0))
            .expect("it is within reach");
        assert!(found.rate_sigma.0 <= wanted && found.seconds.0 < 300.0, "{found:?}");
        let shorter =
            for_time(&conditions, Seconds(0.97 * found.seconds.0)).expect("there is time");
        assert!(shorter.rate_sigma.0 > wanted, "{found:?} {shorter:?}");
        let unreachable = for_sigma(&conditions, RadiansPerSecond(0.1 * wanted), Seconds(300.0));
        assert!(matches!(unreachable, Err(PlanError::OutOfReach(least)) if least.0 > 0.1 * wanted));
    }
}

#[test]
fn positions_stay_within_one_turn_and_passes_visit_every_direction_alike() {
    for order in Order::COMPARED {
        for passes in 1..5 {
            let count = passes * order.length();
            let (mut cosines, mut sines) = (0.0, 0.0);
            for index in 0..count {
                let angle = order.angle(index, passes);
                assert!((0.0..core::f64::consts::TAU).contains(&angle.0));
                cosines += angle.0.cos();
                sines += angle.0.sin();
            }
            assert!(cosines.abs() < 1e-9 && sines.abs() < 1e-9, "{order:?}");
        }
    }
}

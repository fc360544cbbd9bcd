//! The schedules of `meridian plan` are the best of all: no order and no number of passes does better.

use host::planning::{Request, SHORTEST, Wanted};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::planner::order::Order;
use orientation::planner::{Conditions, FEWEST, POSITIONS, Plan, Rotation};
use orientation::units::Seconds;

/// Time of a rotation, s.
const ROTATION: f64 = 2.0;

/// N, B, K and R of gyros, in the units of data sheets, and a 1σ that each reaches, °.
const GYROS: [([f64; 4], f64); 6] = [
    ([0.001, 0.007, 0.0, 0.127], 0.3),
    ([0.001, 0.007, 0.0, 0.127], 0.03),
    ([0.02, 0.1, 0.0, 0.0], 0.5),
    ([0.02, 0.1, 0.0, 0.0], 5.0),
    ([0.02, 0.29, 1.9, 0.0], 0.3),
    ([0.15, 0.5, 3.0, 1.0], 4.0),
];

fn latitude() -> Latitude {
    Latitude::from_degrees(48.0).expect("a latitude")
}

/// The least 1σ, °, that any order and number of passes gives a gyro in a time.
fn least(noise: GyroNoise, seconds: f64) -> f64 {
    let rotation = Rotation::fixed(Seconds(ROTATION));
    let orders = &Order::COMPARED;
    let conditions =
        Conditions { noise, rotation, shortest: Seconds(SHORTEST), fewest: FEWEST, orders };
    let all = orders.iter().flat_map(|order| (1..=POSITIONS).map(move |passes| (order, passes)));
    all.filter_map(|(order, passes)| Plan::of(&conditions, *order, passes, Seconds(seconds)))
        .map(|plan| plan.sigma(latitude()).degrees())
        .fold(f64::INFINITY, f64::min)
}

fn planned(noise: GyroNoise, wanted: Wanted) -> host::planning::Optimum {
    let request = Request { noise, latitude: latitude(), rotation: ROTATION, wanted };
    request.plan().expect("it can be reached").optimum
}

#[test]
fn nothing_reaches_a_wanted_sigma_in_less_time_than_what_is_planned() {
    for ([n, b, k, r], wanted) in GYROS {
        let noise = GyroNoise::from_field_units(n, b, k, r);
        let found = planned(noise, Wanted::Sigma(wanted.to_radians()));
        assert!(found.sigma_deg <= wanted * (1.0 + 1e-9), "{found:?}");
        for part in [0.9999, 0.99, 0.95, 0.9, 0.8] {
            let sigma = least(noise, part * found.seconds);
            assert!(sigma > wanted, "{wanted}° take {}: {part} of it give {sigma}°", found.seconds);
        }
    }
}

#[test]
fn nothing_gives_a_smaller_sigma_in_a_time_than_what_is_planned() {
    for ([n, b, k, r], _) in GYROS {
        let noise = GyroNoise::from_field_units(n, b, k, r);
        for seconds in [60.0, 300.0, 1200.0] {
            let found = planned(noise, Wanted::Seconds(seconds)).sigma_deg;
            let sigma = least(noise, seconds);
            assert!((found / sigma - 1.0).abs() < 1e-9, "{seconds} s: {found}° for {sigma}°");
        }
    }
}

//! The planner.
use orientation::noise::model::GyroNoise;
use orientation::planner::order::Order;
use orientation::planner::{Conditions, Plan, Rotation, for_sigma, for_time};
use orientation::units::DEGREE_PER_HOUR;

#[test]
fn scratch() {
    for (noise, total, rot) in [
        (GyroNoise::from_field_units(0.001, 0.007, 0.0, 0.127), 300.0, Rotation::fixed(2.0)),
        (GyroNoise::from_field_units(0.06, 1.0, 0.5, 2.0), 300.0, Rotation::fixed(2.0)),
        (GyroNoise::from_field_units(0.06, 1.0, 0.5, 2.0), 300.0, Rotation::fixed(1.0)),
        (
            GyroNoise::from_field_units(0.06, 1.0, 0.5, 2.0),
            300.0,
            Rotation { rest: 0.7, speed: 0.35 },
        ),
        (
            GyroNoise::from_field_units(0.001, 0.007, 0.0, 0.127),
            300.0,
            Rotation { rest: 0.7, speed: 0.35 },
        ),
        (
            GyroNoise::from_field_units(0.001, 0.007, 0.0, 0.0),
            300.0,
            Rotation { rest: 0.7, speed: 0.35 },
        ),
        (
            GyroNoise::from_field_units(0.02, 0.0, 0.0, 0.0),
            300.0,
            Rotation { rest: 0.7, speed: 0.35 },
        ),
    ] {
        let c = Conditions { noise, rotation: rot, shortest: 0.5, fewest: 4 };
        let one = Plan::of(&c, Order::Quadrature, 1, total).unwrap();
        let c = Conditions { fewest: 8, ..c };
        println!("one {:.4}", one.rate_sigma / DEGREE_PER_HOUR / 15.041067 * 57.29578);
        for order in Order::COMPARED {
            let mut b: Option<Plan> = None;
            for p in 1..33 {
                if let Some(x) = Plan::of(&c, order, p, total) {
                    if b.is_none_or(|b| x.rate_sigma < b.rate_sigma) {
                        b = Some(x)
                    }
                }
            }
            if let Some(b) = b {
                println!(
                    "  {:?} {} {:.2} ratio {:.4}",
                    order,
                    b.passes,
                    b.dwell,
                    one.rate_sigma / b.rate_sigma
                );
            }
        }
        let plan = for_time(&c, total).unwrap();
        println!(
            " -> {:?} {} ratio {:.4}",
            plan.order,
            plan.passes,
            one.rate_sigma / plan.rate_sigma
        );
        let plan = for_sigma(&c, 1.5 * plan.rate_sigma, 3600.0).unwrap();
        println!(" -> {:?} {} {}", plan.order, plan.passes, plan.seconds);
    }
}

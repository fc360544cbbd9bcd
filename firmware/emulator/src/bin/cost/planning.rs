//! Cost of a plan: the best schedule for a time, and the time for a required σ.

use orientation::noise::model::GyroNoise;
use orientation::planner::order::Order;
use orientation::planner::{Conditions, Plan, PlanError, Rotation, burov, for_sigma, for_time};
use orientation::units::{RadiansPerSecond, Seconds};

use crate::report::Report;
use firmware::budget::PLAN_INSTRUCTIONS;
use measure::counter::{Cost, Counter};
use measure::stack::stack_of;

/// Noise of the gyros that are planned for: N in °/√h, B in °/h, K in °/h/√h and R in °/h².
const GYROS: [[f64; 4]; 2] = [[0.001, 0.007, 0.0, 0.127], [0.06, 1.0, 0.5, 2.0]];
/// Total time, s.
const SECONDS: f64 = 300.0;
/// Ratio of the required σ to that of this time: worse, so that less time suffices.
const RELAXED: f64 = 1.3;
/// Longest time that is considered for a required σ, s.
const LONGEST: f64 = 1800.0;

/// Measures the greatest cost of the gyros for either question, and of Burov's formula.
pub fn report(counter: &Counter, report: &mut Report) {
    let [time, sigma, burov] = GYROS
        .map(|gyro| costs(counter, gyro, report))
        .into_iter()
        .fold([0; 3], |most: [u64; 3], costs| {
            core::array::from_fn(|index| most[index].max(costs[index]))
        });
    report.budget("plan for a time, all orders", time, PLAN_INSTRUCTIONS);
    report.budget("plan for a wanted sigma", sigma, PLAN_INSTRUCTIONS);
    report.budget("Burov's best positions", burov, PLAN_INSTRUCTIONS);
}

/// Stack of a plan, bytes.
pub fn stack() -> usize {
    let conditions = conditions(GYROS[1]);
    stack_of(|| plan(&conditions).is_ok()).0
}

/// Instructions of a plan for a time, of one for a σ, and of Burov's formula.
fn costs(counter: &Counter, gyro: [f64; 4], report: &mut Report) -> [u64; 3] {
    let conditions = conditions(gyro);
    let (time, planned) = counter.measure(|| plan(&conditions));
    let wanted = RELAXED * planned.map_or(0.0, |plan| plan.rate_sigma.0);
    let (sigma, found) =
        counter.measure(|| for_sigma(&conditions, RadiansPerSecond(wanted), Seconds(LONGEST)));
    report.require("both plans were made", planned.is_ok() && found.is_ok());
    let (burov, best) =
        counter.measure(|| burov::best(&conditions.noise, Seconds(SECONDS), Seconds(2.0)));
    report.require("Burov's best was found", best.is_some());
    [time, sigma, burov].map(Cost::instructions)
}

/// Plan that is measured, not inlined.
#[inline(never)]
fn plan(conditions: &Conditions) -> Result<Plan, PlanError> {
    for_time(conditions, Seconds(SECONDS))
}

/// Conditions for a gyro with this noise.
fn conditions([n, b, k, r]: [f64; 4]) -> Conditions {
    Conditions {
        noise: GyroNoise::from_field_units(n, b, k, r),
        rotation: Rotation::fixed(Seconds(2.0)),
        shortest: Seconds(1.0),
        fewest: 8,
        orders: &Order::COMPARED,
    }
}

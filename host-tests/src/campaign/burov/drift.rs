//! Schedules under drift: the planned one against a single pass of four positions.

use orientation::planner::order::Order;
use orientation::planner::{Conditions, Plan, Rotation, for_time};
use orientation::units::Seconds;
use serde::Serialize;

use super::{Grade, Trial, latitude};
use crate::campaign::statistics::Precision;
use crate::campaign::{Tick, over};

/// Total time, s.
const SECONDS: f64 = 300.0;
/// Time of a rotation, s.
const ROTATION: f64 = 2.0;

/// The gyros: fibre-optic in a temperature gradient, and one that drifts in every way.
pub const GYROS: [Grade; 2] = [
    super::devices::EXAMPLE,
    Grade { n_deg_sqrt_h: 0.06, b_deg_h: 1.0, k_deg_h_sqrt_h: 0.5, r_deg_h2: 2.0 },
];

/// A schedule under drift, over many runs.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Gyro of the row.
    pub gyro: Grade,
    /// The order of positions.
    pub order: &'static str,
    /// Number of positions.
    pub positions: usize,
    /// Time in each, s.
    pub dwell_s: f64,
    /// 1σ of the azimuth as it was predicted, °.
    pub predicted_deg: f64,
    /// What the runs gave.
    #[serde(flatten)]
    pub precision: Precision,
}

/// Both schedules for one gyro.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The planned schedule.
    pub planned: Row,
    /// One pass of 0, 180, 90, 270°.
    pub one_pass: Row,
    /// RMS of the one pass over that of the plan.
    pub gain: f64,
}

/// Compares the schedules for a gyro over `runs` runs each; none where there is no plan.
#[must_use]
pub fn compare(gyro: Grade, runs: usize, tick: Tick<'_>) -> Option<Comparison> {
    let rotation = Rotation::fixed(Seconds(ROTATION));
    let conditions = gyro.conditions(rotation);
    let four = Conditions { fewest: 4, ..conditions };
    let planned = for_time(&conditions, Seconds(SECONDS)).ok()?;
    let one_pass = Plan::of(&four, Order::Quadrature, 1, Seconds(SECONDS))?;
    let row = |plan| row(&Trial { grade: gyro, plan, rotation }, runs, tick);
    let [planned, one_pass] = [planned, one_pass].map(row);
    let gain = one_pass.precision.rms_deg / planned.precision.rms_deg;
    // Without a run of either, where the campaign was interrupted, there is nothing to compare.
    let is_run = [&planned, &one_pass].iter().all(|row| row.precision.runs > 0);
    is_run.then_some(Comparison { planned, one_pass, gain })
}

fn row(trial: &Trial, runs: usize, tick: Tick<'_>) -> Row {
    let answers = over(runs, tick, |seed| trial.answer(seed));
    let plan = &trial.plan;
    Row {
        gyro: trial.grade,
        order: plan.order.name(),
        positions: plan.positions(),
        dwell_s: plan.dwell.0,
        predicted_deg: plan.sigma(latitude()).degrees(),
        precision: Precision::of(&answers),
    }
}

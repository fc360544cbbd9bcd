//! Schedules for a gyro: Burov's and the project's own, side by side.

use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::planner::burov::{self, Autocompensation};
use orientation::planner::order::Order;
use orientation::planner::{
    Conditions, FEWEST, POSITIONS, Plan, PlanError, Rotation, for_sigma, for_time,
};
use orientation::units::{DEGREES_PER_RADIAN, RadiansPerSecond, Seconds};
use serde::Serialize;
use thiserror::Error;

use crate::output::significant;

/// Shortest dwell that is planned, s.
pub const SHORTEST: f64 = 1.0;
/// Longest time that is planned for a wanted σ.
const LONGEST: Seconds = burov::LONGEST;

/// What is asked of a schedule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// The best in a total time, s.
    Seconds(f64),
    /// The least time for a full azimuth of this 1σ, rad.
    Sigma(f64),
}

/// A gyro, a place, a stage and what is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The gyro's noise.
    pub noise: GyroNoise,
    /// Latitude of the place.
    pub latitude: Latitude,
    /// Time of one rotation, s, whatever its angle.
    pub rotation: f64,
    /// Time or accuracy that is wanted.
    pub wanted: Wanted,
}

/// Burov's schedule: the number of positions of the least rate error, as [`orientation::planner::burov`] has it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OfBurov {
    /// Number of positions n.
    pub positions: u32,
    /// Time in each, s.
    pub dwell_s: f64,
    /// Total time, s.
    pub seconds: f64,
    /// Its rate error Δω(n), 1σ, °/h.
    pub rate_error_deg_h: f64,
    /// B√(2 ln 2/π), which Δω(n) leaves out, °/h.
    pub flicker_deg_h: f64,
    /// Both together over `Ω_h`: the 1σ of an azimuth whose half is known and which is read off one
    /// axis, °.
    pub one_axis_sigma_deg: f64,
    /// √2 of that: the 1σ of a full azimuth from one gyro, °.
    pub sigma_deg: f64,
}

/// The schedule of the least σ for the fit of this project.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Optimum {
    /// The order of positions.
    pub order: &'static str,
    /// How often it is gone through.
    pub passes: usize,
    /// Number of positions.
    pub positions: usize,
    /// Time in each, s.
    pub dwell_s: f64,
    /// Total time, s.
    pub seconds: f64,
    /// 1σ of each horizontal rate component, °/h.
    pub rate_error_deg_h: f64,
    /// 1σ of a full azimuth as noise leaves it, °.
    pub sigma_deg: f64,
}

/// A schedule with what it gives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Planned {
    /// The project's own, the answer, at the top of the object.
    #[serde(flatten)]
    pub optimum: Optimum,
    /// Burov's schedule; none where his model cannot reach what is wanted.
    pub burov: Option<OfBurov>,
    /// The least 1σ of a full azimuth that his model reaches in a day, °, where it cannot.
    pub burov_least_sigma_deg: Option<f64>,
    /// One pass of 0, 180, 90, 270° in the same time as the optimum, 1σ of a full azimuth, °.
    pub one_pass_sigma_deg: Option<f64>,
}

/// Why nothing was planned.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Unplanned {
    /// The time does not hold the fewest positions.
    #[error(
        "the time holds no schedule: {FEWEST} dwells of {SHORTEST} s and their rotations are the least"
    )]
    TooShort,
    /// Neither N nor Q is given.
    #[error(
        "N and Q are zero, or next to it: without noise of its own any dwell is long enough; give --arw"
    )]
    NoNoise,
    /// A day does not do; the least 1σ of a full azimuth, °.
    #[error("out of reach: {0:.4}° (1σ) is the least that a day and {POSITIONS} positions give")]
    OutOfReach(f64),
    /// Too near to a pole.
    #[error("beyond ±85° too little of the Earth rate is horizontal")]
    NoNorth,
}

/// What the planner of the core is given about a gyro on a stage that turns so.
pub(crate) fn conditions(noise: GyroNoise, rotation: Rotation) -> Conditions {
    let orders = &Order::COMPARED;
    Conditions { noise, rotation, shortest: Seconds(SHORTEST), fewest: FEWEST, orders }
}

/// Halvings of a time in the search for the least: to a millionth.
const HALVINGS: usize = 20;

/// Every number of passes of every order that a stage can turn through.
fn schedules(conditions: &Conditions) -> impl Iterator<Item = (Order, usize)> {
    let orders = conditions.orders.iter();
    orders.flat_map(|order| (1..=POSITIONS / order.length()).map(|passes| (*order, passes)))
}

/// The schedule of the least σ in a total time, of all: the planner of the core, which has less time, tries a few numbers of
/// passes.
///
/// # Errors
/// As [`for_time`].
pub(crate) fn best(conditions: &Conditions, seconds: Seconds) -> Result<Plan, PlanError> {
    let found = for_time(conditions, seconds)?;
    let plans = schedules(conditions)
        .filter_map(|(order, passes)| Plan::of(conditions, order, passes, seconds));
    Ok(plans.fold(found, |best, plan| if plan.rate_sigma < best.rate_sigma { plan } else { best }))
}

/// The schedule of the least time for a 1σ of a rate component, of all.
///
/// # Errors
/// As [`for_sigma`].
fn quickest(conditions: &Conditions, wanted: RadiansPerSecond) -> Result<Plan, PlanError> {
    let found = for_sigma(conditions, wanted, LONGEST)?;
    let quicker = |best: Plan, (order, passes)| {
        let reaching = |seconds| {
            let plan = Plan::of(conditions, order, passes, Seconds(seconds));
            plan.filter(|plan| plan.rate_sigma <= wanted)
        };
        let Some(mut enough) = reaching(best.seconds.0) else { return best };
        let mut too_little = 0.0;
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(too_little, enough.seconds.0);
            match reaching(middle) {
                Some(plan) => enough = plan,
                None => too_little = middle,
            }
        }
        enough
    };
    Ok(schedules(conditions).fold(found, quicker))
}

impl Request {
    /// Plans positions and dwells.
    ///
    /// # Errors
    /// Why there is no schedule.
    pub fn plan(&self) -> Result<Planned, Unplanned> {
        if !self.latitude.has_north() {
            return Err(Unplanned::NoNorth);
        }
        let optimum = self.optimum()?;
        let four = Conditions { fewest: 4, ..self.conditions() };
        let one_pass = Plan::of(&four, Order::Quadrature, 1, optimum.seconds);
        let (burov, burov_least_sigma_deg) = match self.burov()? {
            Ok(best) => (Some(self.of_burov(&best)), None),
            Err(least) => (None, Some(self.degrees(least))),
        };
        Ok(Planned {
            burov,
            burov_least_sigma_deg,
            optimum: self.described(&optimum),
            one_pass_sigma_deg: one_pass.map(|plan| self.degrees(plan.rate_sigma.0)),
        })
    }

    /// What the planner of the core is given.
    pub(crate) fn conditions(&self) -> Conditions {
        conditions(self.noise, Rotation::fixed(Seconds(self.rotation)))
    }

    fn degrees(&self, rate_sigma: f64) -> f64 {
        rate_sigma / self.latitude.horizontal_rate().0 * DEGREES_PER_RADIAN
    }

    fn optimum(&self) -> Result<Plan, Unplanned> {
        let conditions = self.conditions();
        let plan = match self.wanted {
            Wanted::Seconds(seconds) => best(&conditions, Seconds(seconds)),
            Wanted::Sigma(sigma) => {
                let wanted = RadiansPerSecond(sigma * self.latitude.horizontal_rate().0);
                quickest(&conditions, wanted)
            }
        };
        plan.map_err(|error| match error {
            PlanError::TooShort => Unplanned::TooShort,
            PlanError::NoNoise => Unplanned::NoNoise,
            PlanError::OutOfReach(rate) => Unplanned::OutOfReach(self.degrees(rate.0)),
        })
    }

    /// Burov's schedule, or the least rate error of either of two components, rad/s.
    fn burov(&self) -> Result<Result<Autocompensation, f64>, Unplanned> {
        let rotation = Seconds(self.rotation);
        match self.wanted {
            Wanted::Seconds(seconds) => {
                let best = burov::best(&self.noise, Seconds(seconds), rotation);
                best.map(Ok).ok_or(Unplanned::TooShort)
            }
            Wanted::Sigma(sigma) => {
                let rate = sigma * self.latitude.horizontal_rate().0;
                let flicker = burov::flicker_floor(&self.noise);
                let left = (0.5 * rate * rate - flicker.0 * flicker.0).max(0.0).sqrt();
                let found = burov::least_time(&self.noise, RadiansPerSecond(left), rotation);
                Ok(found.map_err(|least| std::f64::consts::SQRT_2 * least.0.hypot(flicker.0)))
            }
        }
    }

    fn of_burov(&self, best: &Autocompensation) -> OfBurov {
        let flicker = burov::flicker_floor(&self.noise);
        let one_axis = self.degrees(best.rate_error.0.hypot(flicker.0));
        OfBurov {
            positions: best.positions,
            dwell_s: best.dwell.0,
            seconds: best.seconds.0,
            rate_error_deg_h: best.rate_error.degrees_per_hour(),
            flicker_deg_h: flicker.degrees_per_hour(),
            one_axis_sigma_deg: one_axis,
            sigma_deg: std::f64::consts::SQRT_2 * one_axis,
        }
    }

    fn described(&self, plan: &Plan) -> Optimum {
        Optimum {
            order: plan.order.name(),
            passes: plan.passes,
            positions: plan.positions(),
            dwell_s: plan.dwell.0,
            seconds: plan.seconds.0,
            rate_error_deg_h: plan.rate_sigma.degrees_per_hour(),
            sigma_deg: self.degrees(plan.rate_sigma.0),
        }
    }
}

/// Time for which a schedule is suggested where none is asked for, s.
const SUGGESTED_SECONDS: f64 = 300.0;
/// Time of a rotation in it, s.
const SUGGESTED_ROTATION: f64 = 2.0;

/// The schedule that suits a gyro, in five minutes at the equator, and in words: σ times sec φ elsewhere; none for a gyro
/// of which nothing is known.
#[must_use]
pub fn suggestion(noise: GyroNoise) -> Option<(Planned, String)> {
    let latitude = Latitude::from_degrees(0.0)?;
    let wanted = Wanted::Seconds(SUGGESTED_SECONDS);
    let request = Request { noise, latitude, rotation: SUGGESTED_ROTATION, wanted };
    let planned = request.plan().ok()?;
    let Planned { burov, optimum, .. } = &planned;
    let burov = burov.map(|burov| {
        let OfBurov { positions, rate_error_deg_h: error, .. } = burov;
        let error = significant(error, 4);
        format!("; Burov's autocompensation: {positions} positions, rate error {error} °/h")
    });
    let words = format!(
        "in {SUGGESTED_SECONDS} s with {SUGGESTED_ROTATION} s a rotation: {} positions of {:.2} s \
             ({}), azimuth {:.4}°·sec φ (1σ){}",
        optimum.positions,
        optimum.dwell_s,
        optimum.order,
        optimum.sigma_deg,
        burov.unwrap_or_default()
    );
    Some((planned, words))
}

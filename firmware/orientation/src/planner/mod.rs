//! Which positions, in which order, for how long: what a gyro's noise makes best.
//!
//! [`burov`] is the paper's optimisation of autocompensation, exactly. [`for_time`] and
//! [`for_sigma`] are the real optimum for this project's estimator: the covariance of the fit
//! itself, under the measured noise, is compared over orders of positions, passes and the time that
//! the stage needs to turn.

pub mod burov;
pub mod order;
pub mod outlook;

use crate::align::POSITIONS;
use crate::earth::Latitude;
use crate::noise::model::GyroNoise;
use crate::units::TURN;
use order::Order;
use outlook::{Outlook, Visit, outlook};

/// How long the stage takes to turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// What every rotation takes, s, ≥ 0: slopes, settling.
    pub rest: f64,
    /// Rate between the slopes, rad/s, > 0; infinite where rotations of any angle take alike.
    pub speed: f64,
    /// Whether it takes the shorter way round: with slip rings, or with two frames.
    pub wraps: bool,
}

impl Rotation {
    /// Every rotation takes so many seconds.
    #[must_use]
    pub fn fixed(seconds: f64) -> Self {
        Self { rest: seconds, speed: f64::INFINITY, wraps: false }
    }

    /// Time for a rotation by `angle` rad; none for none.
    #[must_use]
    pub fn seconds(&self, angle: f64) -> f64 {
        let angle = angle.abs();
        let way = if self.wraps { angle.min(TURN - angle) } else { angle };
        if angle == 0.0 { 0.0 } else { self.rest + way / self.speed }
    }
}

/// What a plan is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// The gyro's noise.
    pub noise: GyroNoise,
    /// How the stage turns.
    pub rotation: Rotation,
    /// Shortest dwell, s, > 0: what the filter needs.
    pub shortest: f64,
    /// Fewest positions: fewer than eight leave too few degrees of freedom to notice a disturbed
    /// dwell.
    pub fewest: usize,
    /// The orders that the stage can turn through.
    pub orders: &'static [Order],
}

/// Positions in their order, and what comes of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Their order.
    pub order: Order,
    /// How often it is gone through.
    pub passes: usize,
    /// Time in each position, s.
    pub dwell: f64,
    /// Total time with the rotations, s.
    pub seconds: f64,
    /// 1σ that noise leaves to each horizontal component of the Earth rate, rad/s.
    pub rate_sigma: f64,
}

/// Why there is no plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanError {
    /// The time does not hold the fewest positions.
    TooShort,
    /// The accuracy is out of reach; the least 1σ of a rate component within the time, rad/s.
    OutOfReach(f64),
    /// The gyro's noise is not known: everything is zero.
    NoNoise,
}

/// Passes that are tried before the best is refined; the positions bound them.
const PASSES: [usize; 8] = [1, 2, 3, 4, 6, 8, 11, 16];
/// Most steps towards the time that a wanted accuracy takes.
const STEPS: usize = 12;
/// Time by which a plan may exceed the least that does, relative.
const CLOSE: f64 = 0.01;

impl Plan {
    /// Number of positions.
    #[must_use]
    pub fn positions(&self) -> usize {
        self.passes * self.order.length()
    }

    /// Stage angle of a position, rad.
    #[must_use]
    pub fn angle(&self, index: usize) -> f64 {
        self.order.angle(index, self.passes)
    }

    /// 1σ of a full azimuth at a latitude as noise leaves it, rad.
    #[must_use]
    pub fn sigma(&self, latitude: Latitude) -> f64 {
        self.rate_sigma / latitude.horizontal_rate()
    }

    /// These passes in this total time; `None` where they do not fit.
    #[must_use]
    pub fn of(conditions: &Conditions, order: Order, passes: usize, seconds: f64) -> Option<Self> {
        let positions = passes * order.length();
        let turning = turning(&conditions.rotation, order, passes);
        let dwell = (seconds - turning) / positions as f64;
        if dwell < conditions.shortest || !(conditions.fewest..=POSITIONS).contains(&positions) {
            return None;
        }
        let plan = Self { order, passes, dwell, seconds, rate_sigma: 0.0 };
        let Outlook { rate_sigma, .. } =
            outlook(&conditions.noise, plan.visits(&conditions.rotation))?;
        Some(Self { rate_sigma, ..plan })
    }

    /// The visits with their times.
    pub fn visits<'a>(
        &'a self,
        rotation: &'a Rotation,
    ) -> impl Iterator<Item = Visit> + Clone + 'a {
        let mut start = 0.0;
        let mut before = self.angle(0);
        (0..self.positions()).map(move |index| {
            let angle = self.angle(index);
            start += rotation.seconds(angle - before);
            before = angle;
            let visit = Visit { angle, start, seconds: self.dwell, rate: 0.0 };
            start += self.dwell;
            visit
        })
    }
}

/// Time that a schedule spends turning, s.
fn turning(rotation: &Rotation, order: Order, passes: usize) -> f64 {
    let angle = |index| order.angle(index, passes);
    (1..passes * order.length())
        .map(|index| rotation.seconds(angle(index) - angle(index - 1)))
        .sum()
}

/// The better of two plans.
fn better(one: Option<Plan>, other: Option<Plan>) -> Option<Plan> {
    match (one, other) {
        (Some(one), Some(other)) if other.rate_sigma < one.rate_sigma => Some(other),
        (None, other) => other,
        (one, _) => one,
    }
}

/// The best passes of one order in a total time.
fn best_of(conditions: &Conditions, order: Order, seconds: f64) -> Option<Plan> {
    let tried = PASSES.map(|passes| Plan::of(conditions, order, passes, seconds));
    let best = tried.into_iter().reduce(better).flatten()?;
    let near = [-2_isize, -1, 1, 2].map(|step| best.passes.saturating_add_signed(step));
    let near = near.map(|passes| Plan::of(conditions, order, passes, seconds));
    near.into_iter().fold(Some(best), better)
}

/// The schedule of the least σ in a total time.
///
/// # Errors
/// [`PlanError::TooShort`], [`PlanError::NoNoise`].
pub fn for_time(conditions: &Conditions, seconds: f64) -> Result<Plan, PlanError> {
    if conditions.noise == GyroNoise::default() {
        return Err(PlanError::NoNoise);
    }
    let plans = conditions.orders.iter().map(|order| best_of(conditions, *order, seconds));
    plans.reduce(better).flatten().ok_or(PlanError::TooShort)
}

/// The shortest schedule, at most `longest` seconds, whose 1σ of a rate component is `wanted` rad/s;
/// a wanted azimuth times `Ω_h`. It takes at most 1 % longer than the least time of its order.
///
/// # Errors
/// [`PlanError::OutOfReach`] where `longest` does not do, and those of [`for_time`].
pub fn for_sigma(conditions: &Conditions, wanted: f64, longest: f64) -> Result<Plan, PlanError> {
    let most = for_time(conditions, longest)?;
    if most.rate_sigma > wanted {
        return Err(PlanError::OutOfReach(most.rate_sigma));
    }
    let found = shortened(conditions, most, wanted);
    // What is best in the longest time need not be so in this one.
    match for_time(conditions, found.seconds) {
        Ok(other) if other.order != found.order => Ok(shortened(conditions, other, wanted)),
        _ => Ok(found),
    }
}

/// The shortest plan of the same order that still reaches `wanted`, as `most` does.
fn shortened(conditions: &Conditions, most: Plan, wanted: f64) -> Plan {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..STEPS {
        let span = high.seconds - low;
        if span <= CLOSE * high.seconds {
            break;
        }
        // White noise falls as 1/√t: aim where that leads, but well within what is left.
        let ratio = high.rate_sigma / wanted;
        let aimed = high.seconds * ratio * ratio * (1.0 + 0.5 * CLOSE);
        let middle = aimed.max(low + 0.1 * span).min((1.0 - 0.9 * CLOSE) * high.seconds);
        match best_of(conditions, most.order, middle) {
            Some(plan) if plan.rate_sigma <= wanted => high = plan,
            _ => low = middle,
        }
    }
    high
}

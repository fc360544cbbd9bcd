//! Which positions, in which order, for how long: what a gyro's noise makes best.
//!
//! [`burov`] is the paper's optimisation of autocompensation, exactly. [`for_time`] and
//! [`for_sigma`] are the real optimum for this project's estimator: the covariance of the fit
//! itself, under the measured noise, is compared over orders of positions, passes and the time that
//! the stage needs to turn.

pub mod burov;
pub mod order;
pub mod prediction;

use crate::align::POSITIONS;
use crate::earth::Latitude;
use crate::noise::model::GyroNoise;
use crate::units::TURN;
use order::{Order, PARTS};
use prediction::{Visit, rate_sigma};

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

    /// Time from one position to another, s; positions in twenty-fourths of a turn, each of which takes
    /// `per_part` seconds.
    fn between(&self, from: u8, to: u8, per_part: f64) -> f64 {
        let parts = to.abs_diff(from);
        let way = if self.wraps { parts.min(PARTS - parts) } else { parts };
        if parts == 0 { 0.0 } else { self.rest + f64::from(way) * per_part }
    }

    /// Time for a twenty-fourth of a turn between the slopes, s.
    fn part_seconds(&self) -> f64 {
        TURN / f64::from(PARTS) / self.speed
    }

    /// Time for a rotation by `angle` rad, at most a turn; none for none.
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
    /// Fewest positions, usually [`FEWEST`].
    pub fewest: usize,
    /// The orders that the stage can turn through.
    pub orders: &'static [Order],
}

impl Conditions {
    /// Whether there is noise that a longer dwell averages, as far as single precision sees it.
    fn check(&self) -> Result<(), PlanError> {
        let has_noise = self.noise.own_variance(1.0) > LEAST_VARIANCE;
        if has_noise { Ok(()) } else { Err(PlanError::NoNoise) }
    }
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
    /// Neither N nor Q is known: without noise of its own any dwell is long enough.
    NoNoise,
}

/// Part of σ that another order must come down to, to be looked at in a second search.
const WORTH_IT: f64 = 0.99;
/// Fewest positions of a schedule: fewer leave too few degrees of freedom to notice a disturbed dwell.
pub const FEWEST: usize = 8;
/// Least variance of a mean over a second, (rad/s)²: 10⁻⁸ °/√h.
const LEAST_VARIANCE: f64 = 1e-23;
/// Passes that are tried before the best is refined; the positions bound them.
const PASSES: [usize; 8] = [1, 2, 3, 4, 6, 8, 11, 16];
/// Time with which the search for a wanted accuracy begins, s.
const USUAL: f64 = 300.0;
/// Factor by which the time grows at least while the accuracy is not reached.
const STRIDE: f64 = 1.2;
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
    #[inline(never)]
    pub fn of(conditions: &Conditions, order: Order, passes: usize, seconds: f64) -> Option<Self> {
        let positions = passes * order.length();
        if !(conditions.fewest..=POSITIONS).contains(&positions) {
            return None;
        }
        let turning = turning(&conditions.rotation, order, passes);
        let dwell = (seconds - turning) / positions as f64;
        if dwell < conditions.shortest {
            return None;
        }
        let plan = Self { order, passes, dwell, seconds, rate_sigma: 0.0 };
        let visits = plan.visits(&conditions.rotation);
        rate_sigma(&conditions.noise, dwell, visits).map(|rate_sigma| Self { rate_sigma, ..plan })
    }

    /// The visits with their times.
    pub fn visits<'a>(&'a self, rotation: &Rotation) -> impl Iterator<Item = Visit> + 'a {
        let (rotation, per_part) = (*rotation, rotation.part_seconds());
        let mut start = 0.0;
        let mut before = self.order.part(0, self.passes);
        (0..self.positions()).map(move |index| {
            let part = self.order.part(index, self.passes);
            start += rotation.between(before, part, per_part);
            before = part;
            let visit = Visit::planned(part, start, self.dwell);
            start += self.dwell;
            visit
        })
    }
}

/// Time that a schedule spends turning, s.
fn turning(rotation: &Rotation, order: Order, passes: usize) -> f64 {
    let per_part = rotation.part_seconds();
    let part = |index| order.part(index, passes);
    let rotations = 1..passes * order.length();
    rotations.map(|index| rotation.between(part(index - 1), part(index), per_part)).sum()
}

/// The better of two plans.
fn better(one: Option<Plan>, other: Option<Plan>) -> Option<Plan> {
    match (one, other) {
        (Some(one), Some(other)) if other.rate_sigma < one.rate_sigma => Some(other),
        (None, other) => other,
        (one, _) => one,
    }
}

/// The best of some passes of one order in a total time. σ² falls with the passes as drift cancels and
/// rises with the rotations, so the first rise ends the search.
fn best_of(conditions: &Conditions, order: Order, seconds: f64) -> Option<Plan> {
    let mut best: Option<Plan> = None;
    for passes in PASSES {
        match (Plan::of(conditions, order, passes, seconds), best) {
            (Some(plan), Some(least)) if plan.rate_sigma >= least.rate_sigma => break,
            (Some(plan), _) => best = Some(plan),
            (None, Some(_)) => break,
            (None, None) => {}
        }
    }
    best
}

/// The best passes next to `plan`'s in a total time, one step at a time.
fn climbed(conditions: &Conditions, plan: &Plan, seconds: f64) -> Option<Plan> {
    let of = |passes| Plan::of(conditions, plan.order, passes, seconds);
    let mut best = of(plan.passes);
    for step in [-1_isize, 1] {
        let mut passes = plan.passes;
        loop {
            passes = passes.saturating_add_signed(step);
            match (of(passes), best) {
                (Some(next), Some(least)) if next.rate_sigma < least.rate_sigma => {
                    best = Some(next);
                }
                // With less time the passes that were best may not fit.
                (Some(next), None) => best = Some(next),
                (None, None) if step < 0 && passes > 0 => {}
                _ => break,
            }
        }
        if best.is_some_and(|best| best.passes != plan.passes) {
            break;
        }
    }
    best
}

/// The schedule of the least σ in a total time.
///
/// # Errors
/// [`PlanError::TooShort`], [`PlanError::NoNoise`].
pub fn for_time(conditions: &Conditions, seconds: f64) -> Result<Plan, PlanError> {
    conditions.check()?;
    let plans = conditions.orders.iter().map(|order| best_of(conditions, *order, seconds));
    let best = plans.reduce(better).flatten().ok_or(PlanError::TooShort)?;
    Ok(climbed(conditions, &best, seconds).unwrap_or(best))
}

/// The shortest schedule, at most `longest` seconds, whose 1σ of a rate component is `wanted` rad/s;
/// a wanted azimuth times `Ω_h`. It takes at most 1 % longer than the least time of its order.
///
/// # Errors
/// [`PlanError::OutOfReach`] where `longest` does not do, and those of [`for_time`].
pub fn for_sigma(conditions: &Conditions, wanted: f64, longest: f64) -> Result<Plan, PlanError> {
    conditions.check()?;
    let usual = conditions.orders.first().copied();
    let begun = usual.and_then(|order| best_of(conditions, order, longest.min(USUAL)));
    let begun = begun.map_or_else(|| for_time(conditions, longest), Ok)?;
    let enough = lengthened(conditions, begun, wanted, longest)?;
    let found = shortened(conditions, enough, wanted);
    // What is best in one time need not be so in another.
    let orders = conditions.orders.iter().map(|order| Plan {
        order: *order,
        passes: (found.positions() / order.length()).max(1),
        ..found
    });
    let other =
        orders.map(|plan| climbed(conditions, &plan, found.seconds)).reduce(better).flatten();
    Ok(match other {
        Some(other) if other.rate_sigma < WORTH_IT * found.rate_sigma => {
            shortened(conditions, other, wanted)
        }
        _ => found,
    })
}

/// Where white noise leads from a plan's time towards `wanted`, and a little further.
fn aimed(plan: &Plan, wanted: f64) -> f64 {
    let ratio = plan.rate_sigma / wanted;
    plan.seconds * ratio * ratio * (1.0 + 0.5 * CLOSE)
}

/// A plan that reaches `wanted`, in more and more time.
fn lengthened(
    conditions: &Conditions,
    mut plan: Plan,
    wanted: f64,
    longest: f64,
) -> Result<Plan, PlanError> {
    while plan.rate_sigma > wanted {
        if plan.seconds >= longest {
            return Err(PlanError::OutOfReach(plan.rate_sigma));
        }
        let seconds = aimed(&plan, wanted).max(STRIDE * plan.seconds).min(longest);
        let next = climbed(conditions, &plan, seconds);
        plan =
            if seconds < longest { next } else { better(next, for_time(conditions, longest).ok()) }
                .ok_or(PlanError::TooShort)?;
    }
    Ok(plan)
}

/// The shortest plan of the same order that still reaches `wanted`, as `high` does.
fn shortened(conditions: &Conditions, mut high: Plan, wanted: f64) -> Plan {
    let mut low = 0.0;
    for _ in 0..STEPS {
        let span = high.seconds - low;
        if span <= CLOSE * high.seconds {
            break;
        }
        let most = (1.0 - 0.9 * CLOSE) * high.seconds;
        let middle = aimed(&high, wanted).max(low + 0.1 * span).min(most);
        match climbed(conditions, &high, middle) {
            Some(plan) if plan.rate_sigma <= wanted => high = plan,
            _ => low = middle,
        }
    }
    high
}

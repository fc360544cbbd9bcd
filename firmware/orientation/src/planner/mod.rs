//! Planner: which positions, in which order and for how long suit a gyro's noise best.
//!
//! ```text
//!  Q N B K R ─▶ orders × passes × dwell ─▶ prediction: σ of the fit ─least─▶ Plan
//!  time of a rotation ──▲   total time, or wanted σ ──▲
//! ```
//!
//! More positions cancel more of a gyro's drift (autocompensation), but each rotation costs time in
//! which nothing is measured. [`burov`] is Burov's optimum of the two. [`for_time`] and [`for_sigma`]
//! optimise the fit of [`crate::alignment::stepwise`] itself: with J the derivatives of the dwells'
//! means and C the covariance of their noise, the variance of an azimuth is
//!
//! ```text
//! σ_A² = [(Jᵀ C⁻¹ J)⁻¹]_AA
//! ```
//!
//! It is compared over orders of positions, numbers of passes and the time that the stage needs to
//! turn.

pub mod burov;
pub mod order;
pub mod prediction;

use crate::earth::Latitude;
use crate::noise::GyroNoise;
use crate::units::{Radians, RadiansPerSecond, Seconds, TURN};
use order::{Order, PARTS};
use prediction::{Visit, rate_sigma};

/// Greatest number of positions of a plan, and of an alignment on the board.
pub const POSITIONS: usize = 64;

/// Time that the stage takes for a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rotation {
    /// Constant part of every rotation, ≥ 0: acceleration, deceleration and settling.
    pub rest: Seconds,
    /// Rate between the ramps, > 0; infinite where the time does not depend on the angle.
    pub speed: RadiansPerSecond,
    /// Whether the stage takes the shorter way round: with slip rings, or with two frames.
    pub wraps: bool,
}

impl Rotation {
    /// Rotation time of a stage on which every rotation takes `seconds`, whatever the angle.
    #[must_use]
    pub fn fixed(seconds: Seconds) -> Self {
        Self { rest: seconds, speed: RadiansPerSecond(f64::INFINITY), wraps: false }
    }

    /// Time from one position to another, s, for positions in twenty-fourths of a turn, each of
    /// which takes `per_part` seconds.
    fn between(&self, from: u8, to: u8, per_part: f64) -> f64 {
        let parts = to.abs_diff(from);
        let way = if self.wraps { parts.min(PARTS - parts) } else { parts };
        if parts == 0 { 0.0 } else { self.rest.0 + f64::from(way) * per_part }
    }

    /// Time for a twenty-fourth of a turn at full speed, s.
    fn part_seconds(&self) -> f64 {
        TURN / f64::from(PARTS) / self.speed.0
    }

    /// Time for a rotation by `angle`, at most a turn in magnitude; zero for an angle of zero.
    pub fn seconds(&self, angle: Radians) -> Seconds {
        let angle = angle.0.abs();
        let way = if self.wraps { angle.min(TURN - angle) } else { angle };
        Seconds(if angle == 0.0 { 0.0 } else { self.rest.0 + way / self.speed.0 })
    }
}

/// Conditions that a plan is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Noise model of the gyro.
    pub noise: GyroNoise,
    /// Rotation time of the stage.
    pub rotation: Rotation,
    /// Shortest dwell, > 0, which the filter's settling requires.
    pub shortest: Seconds,
    /// Fewest positions of a plan, usually [`FEWEST`].
    pub fewest: usize,
    /// Orders of positions that the stage can turn through.
    pub orders: &'static [Order],
}

impl Conditions {
    /// Checks that there is noise that a longer dwell averages, within the resolution of single
    /// precision.
    fn check(&self) -> Result<(), PlanError> {
        let has_noise = self.noise.own_variance(1.0) > LEAST_VARIANCE;
        if has_noise { Ok(()) } else { Err(PlanError::NoNoise) }
    }
}

/// A schedule of positions, with the accuracy that it will reach.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Plan {
    /// Order of the positions.
    pub order: Order,
    /// Number of passes through the order.
    pub passes: usize,
    /// Time in each position.
    pub dwell: Seconds,
    /// Total time including the rotations.
    pub seconds: Seconds,
    /// Standard deviation that noise leaves to each horizontal component of the Earth rate, 1σ.
    pub rate_sigma: RadiansPerSecond,
}

/// Reason for which there is no plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanError {
    /// The time does not hold the fewest positions with the shortest dwell.
    TooShort,
    /// The accuracy is out of reach; the value is the least 1σ of a rate component within the time.
    OutOfReach(RadiansPerSecond),
    /// Neither N nor Q is known: without white noise any dwell is long enough.
    NoNoise,
}

/// Ratio of σ below which another order is worth a second search.
const WORTH_IT: f64 = 0.99;
/// Fewest positions of a schedule: fewer leave too few degrees of freedom to detect a disturbed
/// dwell.
pub const FEWEST: usize = 8;
/// Least variance of a mean over a second, (rad/s)²: that of 10⁻⁸ °/√h.
const LEAST_VARIANCE: f64 = 1e-23;
/// Numbers of passes that are tried before the best is refined; [`POSITIONS`] bounds them.
const PASSES: [usize; 8] = [1, 2, 3, 4, 6, 8, 11, 16];
/// Time with which the search for a wanted accuracy begins, s.
const USUAL: f64 = 300.0;
/// Least factor by which the time grows while the accuracy is not reached.
const STRIDE: f64 = 1.2;
/// Greatest number of steps towards the time that a wanted accuracy takes.
const STEPS: usize = 12;
/// Relative time by which a plan may exceed the least sufficient one.
const CLOSE: f64 = 0.01;

impl Plan {
    /// Number of positions in all passes.
    #[must_use]
    pub fn positions(&self) -> usize {
        self.passes * self.order.length()
    }

    /// Stage angle of the position with this index, [0, 2π).
    pub(crate) fn angle(&self, index: usize) -> Radians {
        self.order.angle(index, self.passes)
    }

    /// Standard deviation of a full azimuth at a latitude due to noise, 1σ.
    pub fn sigma(&self, latitude: Latitude) -> Radians {
        Radians(self.rate_sigma.0 / latitude.horizontal_rate().0)
    }

    /// Plan of `passes` of `order` in a total time; `None` where they do not fit.
    #[must_use]
    #[inline(never)]
    pub fn of(
        conditions: &Conditions,
        order: Order,
        passes: usize,
        seconds: Seconds,
    ) -> Option<Self> {
        let positions = passes * order.length();
        if !(conditions.fewest..=POSITIONS).contains(&positions) {
            return None;
        }
        let turning = turning(&conditions.rotation, order, passes);
        let dwell = Seconds((seconds.0 - turning) / positions as f64);
        if dwell < conditions.shortest {
            return None;
        }
        let plan = Self { order, passes, dwell, seconds, rate_sigma: RadiansPerSecond(0.0) };
        let visits = plan.visits(&conditions.rotation);
        let rate_sigma = rate_sigma(&conditions.noise, dwell.0, visits).map(RadiansPerSecond);
        rate_sigma.map(|rate_sigma| Self { rate_sigma, ..plan })
    }

    /// Dwells of the plan with their times; the first begins at zero.
    pub fn visits<'a>(&'a self, rotation: &Rotation) -> impl Iterator<Item = Visit> + 'a {
        let (rotation, per_part) = (*rotation, rotation.part_seconds());
        let mut start = 0.0;
        let mut before = self.order.part(0, self.passes);
        (0..self.positions()).map(move |index| {
            let part = self.order.part(index, self.passes);
            start += rotation.between(before, part, per_part);
            before = part;
            let visit = Visit::planned(part, start, self.dwell.0);
            start += self.dwell.0;
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

/// The plan of the smaller rate error, where there is one.
fn better(one: Option<Plan>, other: Option<Plan>) -> Option<Plan> {
    match (one, other) {
        (Some(one), Some(other)) if other.rate_sigma < one.rate_sigma => Some(other),
        (None, other) => other,
        (one, _) => one,
    }
}

/// Best number of passes of one order in a total time. σ² falls with the passes as drift cancels,
/// and rises with the rotations, so the first rise ends the search.
fn best_of(conditions: &Conditions, order: Order, seconds: Seconds) -> Option<Plan> {
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

/// Best number of passes in a total time by local search from `plan`'s, one pass at a time.
fn climbed(conditions: &Conditions, plan: &Plan, seconds: Seconds) -> Option<Plan> {
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
                // With less time the best number of passes of the other plan may not fit.
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

/// Schedule of the least σ in a total time.
///
/// # Errors
/// [`PlanError::TooShort`], [`PlanError::NoNoise`].
pub fn for_time(conditions: &Conditions, seconds: Seconds) -> Result<Plan, PlanError> {
    conditions.check()?;
    let plans = conditions.orders.iter().map(|order| best_of(conditions, *order, seconds));
    let best = plans.reduce(better).flatten().ok_or(PlanError::TooShort)?;
    Ok(climbed(conditions, &best, seconds).unwrap_or(best))
}

/// Shortest schedule, at most `longest`, whose 1σ of a rate component is `wanted` (a
/// wanted azimuth times `Ω_h`). It takes at most 1 % longer than the least time of its order.
///
/// # Errors
/// [`PlanError::OutOfReach`] where `longest` is not enough, and the errors of [`for_time`].
pub fn for_sigma(
    conditions: &Conditions,
    wanted: RadiansPerSecond,
    longest: Seconds,
) -> Result<Plan, PlanError> {
    conditions.check()?;
    let usual = conditions.orders.first().copied();
    let begun = usual.and_then(|order| best_of(conditions, order, Seconds(longest.0.min(USUAL))));
    let begun = begun.map_or_else(|| for_time(conditions, longest), Ok)?;
    let enough = lengthened(conditions, begun, wanted, longest)?;
    let found = shortened(conditions, enough, wanted);
    // The order that is best in one time need not be best in another, so the others are tried in
    // the time found.
    let orders = conditions.orders.iter().map(|order| Plan {
        order: *order,
        passes: (found.positions() / order.length()).max(1),
        ..found
    });
    let other =
        orders.map(|plan| climbed(conditions, &plan, found.seconds)).reduce(better).flatten();
    Ok(match other {
        Some(other) if other.rate_sigma.0 < WORTH_IT * found.rate_sigma.0 => {
            shortened(conditions, other, wanted)
        }
        _ => found,
    })
}

/// Time at which white noise alone would bring the plan to `wanted`, and 0.5 % more, s.
fn aimed(plan: &Plan, wanted: RadiansPerSecond) -> f64 {
    let ratio = plan.rate_sigma.0 / wanted.0;
    plan.seconds.0 * ratio * ratio * (1.0 + 0.5 * CLOSE)
}

/// Plan that reaches `wanted`, by increasing its time up to `longest`.
fn lengthened(
    conditions: &Conditions,
    mut plan: Plan,
    wanted: RadiansPerSecond,
    longest: Seconds,
) -> Result<Plan, PlanError> {
    while plan.rate_sigma > wanted {
        if plan.seconds >= longest {
            return Err(PlanError::OutOfReach(plan.rate_sigma));
        }
        let seconds = aimed(&plan, wanted).max(STRIDE * plan.seconds.0).min(longest.0);
        let seconds = Seconds(seconds);
        let next = climbed(conditions, &plan, seconds);
        plan =
            if seconds < longest { next } else { better(next, for_time(conditions, longest).ok()) }
                .ok_or(PlanError::TooShort)?;
    }
    Ok(plan)
}

/// Shortest plan of the same order that still reaches `wanted`, as `high` does.
fn shortened(conditions: &Conditions, mut high: Plan, wanted: RadiansPerSecond) -> Plan {
    let mut low = 0.0;
    for _ in 0..STEPS {
        let span = high.seconds.0 - low;
        if span <= CLOSE * high.seconds.0 {
            break;
        }
        let most = (1.0 - 0.9 * CLOSE) * high.seconds.0;
        let middle = aimed(&high, wanted).max(low + 0.1 * span).min(most);
        match climbed(conditions, &high, Seconds(middle)) {
            Some(plan) if plan.rate_sigma <= wanted => high = plan,
            _ => low = middle,
        }
    }
    high
}

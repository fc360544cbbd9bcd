//! Where the stage goes and how long it stays.

use heapless::Vec;

use crate::align::{CAPACITY, POSITIONS};
use crate::planner::order::Order;
use crate::planner::{FEWEST, Plan};
use crate::signal::dwell::Dwell;

/// One position: a stage angle and how long to stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Stage angle, rad, not wrapped: the cables are.
    pub angle: f64,
    /// Length of the dwell, s.
    pub seconds: f64,
}

/// Which positions to visit.
#[allow(
    clippy::large_enum_variant,
    reason = "without an allocator the list lives here; a session holds one schedule"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// These, in this order.
    Listed(Vec<Position, CAPACITY>),
    /// What the planner made of the gyro's noise.
    Planned(Plan),
    /// Sokolov's: equal steps from `start` towards growing rate. The first steps go clockwise until
    /// the rate has changed significantly; where it fell, the rest go on from `start` the other way.
    TowardMaximum {
        /// Angle of the first position, rad.
        start: f64,
        /// Step Δ, rad, positive.
        step: f64,
        /// Number of positions n.
        positions: usize,
        /// Length of each dwell, s.
        seconds: f64,
    },
}

/// When to stop before the last position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum StopRule {
    /// Never: all positions are visited.
    #[default]
    AllPositions,
    /// Sokolov's: when the rate's difference to the previous position is negative. Noise alone makes
    /// it fire early.
    SignChange,
    /// When that difference is negative by this many of its standard deviations.
    Significant(f64),
    /// When the standard deviation, as predicted from the gyro's noise and as observed in the dwells,
    /// is that which was asked for. The session goes on beyond its schedule until then, and gives up
    /// as soon as it sees that the time will not do.
    Accuracy {
        /// Time allowed from the session's beginning or, where there is a survey, from its end, s.
        seconds: f64,
    },
}

impl StopRule {
    /// Whether to stop, for the last difference δ and its standard deviation, rad/s.
    #[must_use]
    pub fn stops(self, difference: f64, sigma: f64) -> bool {
        match self {
            Self::AllPositions | Self::Accuracy { .. } => false,
            Self::SignChange => difference < 0.0,
            Self::Significant(bound) => difference < -bound * sigma,
        }
    }
}

/// Significance, in σ, with which the direction of growing rate is decided.
const DIRECTION_BOUND: f64 = 3.0;

impl Schedule {
    /// These positions in this order; `None` where they are more than [`CAPACITY`].
    #[must_use]
    pub fn listed(positions: &[Position]) -> Option<Self> {
        Vec::from_slice(positions).ok().map(Self::Listed)
    }

    /// Equal steps over the full circle, from zero, the last one step before a whole turn; [`POSITIONS`] at most.
    #[must_use]
    pub fn circle(positions: usize, seconds: f64) -> Self {
        let step = core::f64::consts::TAU / positions.max(1) as f64;
        let list = (0..positions.min(POSITIONS))
            .map(|index| Position { angle: index as f64 * step, seconds })
            .collect();
        Self::Listed(list)
    }

    /// The same, and at its end the first position once more, a whole turn on: what drifts or creeps in step with the
    /// stage differs there from what it was at the beginning. Without the repeat where [`POSITIONS`] are stated.
    #[must_use]
    pub fn closed_circle(positions: usize, seconds: f64) -> Self {
        let mut schedule = Self::circle(positions, seconds);
        if let Self::Listed(list) = &mut schedule
            && list.len() < POSITIONS
        {
            // A list holds as many at least.
            let _ = list.push(Position { angle: core::f64::consts::TAU, seconds });
        }
        schedule
    }

    /// How many positions there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Listed(list) => list.len(),
            Self::Planned(plan) => plan.positions(),
            Self::TowardMaximum { positions, .. } => *positions,
        }
    }

    /// How many positions there are once so many dwells are done and it goes on: whole passes.
    #[must_use]
    pub fn len_beyond(&self, dwells: usize) -> usize {
        let length = self.len();
        let pass = match self {
            Self::Planned(_) => Order::Quadrature.length(),
            _ => length.max(1),
        };
        let more = dwells.saturating_sub(length);
        (length + more.next_multiple_of(pass)).min(POSITIONS)
    }

    /// Whether so many dwells make up whole passes, so that what has been seen so far is as good in
    /// every direction and drift has been cancelled.
    #[must_use]
    pub fn is_balanced(&self, dwells: usize) -> bool {
        let pass = match self {
            Self::Planned(plan) if plan.order != Order::Pairs => plan.order.length(),
            _ => self.len(),
        };
        if dwells < self.len() {
            dwells >= FEWEST && dwells.is_multiple_of(pass)
        } else {
            dwells == self.len_beyond(dwells)
        }
    }

    /// The position with this index; beyond the end a planned schedule goes on with 0, 180, 90, 270°
    /// and a list begins anew.
    #[must_use]
    pub fn position(&self, index: usize) -> Option<Position> {
        match self {
            Self::Listed(list) => list.get(index % list.len().max(1)).copied(),
            Self::Planned(plan) => {
                let angle = match index.checked_sub(plan.positions()) {
                    None => plan.angle(index),
                    Some(beyond) => Order::Quadrature.angle(beyond, 1),
                };
                Some(Position { angle, seconds: plan.dwell })
            }
            Self::TowardMaximum { .. } => None,
        }
    }

    /// Whether there is no position.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Shortest dwell, s.
    #[must_use]
    pub fn shortest(&self) -> f64 {
        match self {
            Self::Listed(list) => list.iter().map(|p| p.seconds).fold(f64::INFINITY, f64::min),
            Self::Planned(plan) => plan.dwell,
            Self::TowardMaximum { seconds, .. } => *seconds,
        }
    }

    /// Sum of all dwells, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        match self {
            Self::Listed(list) => list.iter().map(|p| p.seconds).sum(),
            Self::Planned(plan) => plan.positions() as f64 * plan.dwell,
            Self::TowardMaximum { seconds, positions, .. } => *positions as f64 * seconds,
        }
    }

    /// The position after these dwells; `sigma` is the standard deviation of a difference, rad/s.
    #[must_use]
    pub fn next(&self, dwells: &[Dwell], sigma: f64) -> Option<Position> {
        match self {
            Self::Listed(_) | Self::Planned(_) => {
                self.position(dwells.len()).filter(|_| dwells.len() < self.len())
            }
            Self::TowardMaximum { start, step, positions, seconds } => {
                let steps = steps_towards(dwells, sigma);
                let angle = start + steps * step;
                (dwells.len() < *positions).then_some(Position { angle, seconds: *seconds })
            }
        }
    }

    /// The last difference δ in the direction of the turn; none where the last two dwells are not
    /// neighbours.
    #[must_use]
    pub fn last_difference(&self, dwells: &[Dwell], sigma: f64) -> Option<f64> {
        let [.., before, last] = dwells else { return None };
        let turned_back = match self {
            Self::Listed(_) | Self::Planned(_) => false,
            Self::TowardMaximum { .. } => {
                turning_point(dwells, sigma).is_none_or(|turn| dwells.len() <= turn + 2)
            }
        };
        (!turned_back).then_some(last.rate - before.rate)
    }
}

/// Index of the first dwell whose rate differs significantly from that of the first.
fn turning_point(dwells: &[Dwell], sigma: f64) -> Option<usize> {
    let first = dwells.first()?.rate;
    dwells.iter().position(|dwell| (dwell.rate - first).abs() > DIRECTION_BOUND * sigma)
}

/// In steps from the start, where to go next.
fn steps_towards(dwells: &[Dwell], sigma: f64) -> f64 {
    let visited = dwells.len() as f64;
    match turning_point(dwells, sigma) {
        Some(turn) if dwells[turn].rate < dwells[0].rate => turn as f64 - visited,
        _ => visited,
    }
}

//! Schedule of the stage: positions and lengths of the dwells, and the rules by which it ends
//! early.

use heapless::Vec;

use crate::alignment::stepwise::CAPACITY;
use crate::planner::order::Order;
use crate::planner::{FEWEST, POSITIONS, Plan};
use crate::signal::Dwell;
use crate::units::{Radians, RadiansPerSecond, Seconds};

/// One position: stage angle and length of the dwell.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Position {
    /// Stage angle, not wrapped to one turn: cables are not.
    pub angle: Radians,
    /// Length of the dwell.
    pub seconds: Seconds,
}

/// Sequence of positions to visit.
#[must_use]
#[allow(
    clippy::large_enum_variant,
    reason = "without an allocator the list lives here; a session holds one schedule"
)]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Schedule {
    /// A list of positions, visited in its order.
    Listed(Vec<Position, CAPACITY>),
    /// A plan that the planner made for the gyro's noise.
    Planned(Plan),
    /// Search for the maximum (Sokolov 2019): equal steps from `start` towards growing rate. The
    /// first steps go clockwise until the rate has changed significantly; if it fell, the rest
    /// continue from `start` in the other direction.
    TowardMaximum {
        /// Angle of the first position.
        start: Radians,
        /// Step Δ, positive.
        step: Radians,
        /// Number of positions n.
        positions: usize,
        /// Length of each dwell.
        seconds: Seconds,
    },
}

/// Rule by which a session stops before the last position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StopRule {
    /// All positions are visited.
    #[default]
    AllPositions,
    /// Stop when the rate's difference to the previous position is negative (Sokolov 2019). Noise
    /// alone makes it fire early.
    SignChange,
    /// Stop when that difference is negative by this many of its standard deviations.
    Significant(f64),
    /// Stop when the standard deviation, as predicted from the gyro's noise and as observed in the
    /// dwells, is the required one. The session continues beyond its schedule until then, and gives
    /// up as soon as the time cannot suffice.
    Accuracy {
        /// Time allowed from the beginning of the session or, with a survey, from the survey's end.
        seconds: Seconds,
    },
}

impl StopRule {
    /// Whether the rule stops the session, for the last difference δ and its standard deviation.
    #[must_use]
    pub fn stops(self, difference: RadiansPerSecond, sigma: RadiansPerSecond) -> bool {
        match self {
            Self::AllPositions | Self::Accuracy { .. } => false,
            Self::SignChange => difference.0 < 0.0,
            Self::Significant(bound) => difference.0 < -bound * sigma.0,
        }
    }
}

/// Significance, in σ, at which the direction of growing rate is decided.
const DIRECTION_BOUND: f64 = 3.0;

impl Schedule {
    /// Schedule of these positions in this order; `None` with more than [`CAPACITY`].
    #[must_use]
    pub fn listed(positions: &[Position]) -> Option<Self> {
        Vec::from_slice(positions).ok().map(Self::Listed)
    }

    /// Schedule of equal steps over the full circle from zero, the last one a step before a whole
    /// turn; at most [`POSITIONS`].
    pub fn circle(positions: usize, seconds: Seconds) -> Self {
        let step = core::f64::consts::TAU / positions.max(1) as f64;
        let list = (0..positions.min(POSITIONS))
            .map(|index| Position { angle: Radians(index as f64 * step), seconds })
            .collect();
        Self::Listed(list)
    }

    /// Schedule of [`Self::circle`] with the first position repeated at the end, a whole turn on: a
    /// drift synchronous with the stage shows as the difference of the two. The repeat is omitted
    /// where there is no room.
    pub fn closed_circle(positions: usize, seconds: Seconds) -> Self {
        let mut schedule = Self::circle(positions, seconds);
        if let Self::Listed(list) = &mut schedule
            && list.len() < POSITIONS
        {
            // The list has room for at least one more position.
            let _ = list.push(Position { angle: Radians(core::f64::consts::TAU), seconds });
        }
        schedule
    }

    /// Number of positions.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Listed(list) => list.len(),
            Self::Planned(plan) => plan.positions(),
            Self::TowardMaximum { positions, .. } => *positions,
        }
    }

    /// Number of positions when the session continues after this many dwells: whole passes, at most
    /// [`POSITIONS`].
    pub(super) fn len_beyond(&self, dwells: usize) -> usize {
        let length = self.len();
        let pass = match self {
            Self::Planned(_) => Order::Quadrature.length(),
            _ => length.max(1),
        };
        let more = dwells.saturating_sub(length);
        (length + more.next_multiple_of(pass)).min(POSITIONS)
    }

    /// Whether this many dwells make up whole passes, so that the accuracy is equal in all
    /// directions and drift has cancelled.
    pub(super) fn is_balanced(&self, dwells: usize) -> bool {
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

    /// Position with this index. Beyond the end a planned schedule continues with 0, 180, 90, 270°,
    /// and a list begins anew; `None` for a search, whose positions depend on the dwells.
    pub(crate) fn position(&self, index: usize) -> Option<Position> {
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

    /// Length of the shortest dwell.
    pub(crate) fn shortest(&self) -> Seconds {
        Seconds(match self {
            Self::Listed(list) => list.iter().map(|p| p.seconds.0).fold(f64::INFINITY, f64::min),
            Self::Planned(plan) => plan.dwell.0,
            Self::TowardMaximum { seconds, .. } => seconds.0,
        })
    }

    /// Sum of all dwell lengths.
    pub fn seconds(&self) -> Seconds {
        Seconds(match self {
            Self::Listed(list) => list.iter().map(|p| p.seconds.0).sum(),
            Self::Planned(plan) => plan.positions() as f64 * plan.dwell.0,
            Self::TowardMaximum { seconds, positions, .. } => *positions as f64 * seconds.0,
        })
    }

    /// Position after these dwells; `sigma` is the standard deviation of a difference.
    /// `None` at the end.
    pub(crate) fn next(&self, dwells: &[Dwell], sigma: RadiansPerSecond) -> Option<Position> {
        match self {
            Self::Listed(_) | Self::Planned(_) => {
                self.position(dwells.len()).filter(|_| dwells.len() < self.len())
            }
            Self::TowardMaximum { start, step, positions, seconds } => {
                let steps = steps_towards(dwells, sigma);
                let angle = Radians(start.0 + steps * step.0);
                (dwells.len() < *positions).then_some(Position { angle, seconds: *seconds })
            }
        }
    }

    /// Latest difference δ in the direction of motion; `None` where the last two dwells are
    /// not neighbours.
    pub(super) fn last_difference(
        &self,
        dwells: &[Dwell],
        sigma: RadiansPerSecond,
    ) -> Option<RadiansPerSecond> {
        let [.., before, last] = dwells else { return None };
        let turned_back = matches!(self, Self::TowardMaximum { .. })
            && turning_point(dwells, sigma).is_none_or(|turn| dwells.len() <= turn + 2);
        (!turned_back).then_some(RadiansPerSecond(last.rate.0 - before.rate.0))
    }
}

/// Index of the first dwell whose rate differs significantly from that of the first one.
fn turning_point(dwells: &[Dwell], sigma: RadiansPerSecond) -> Option<usize> {
    let first = dwells.first()?.rate.0;
    dwells.iter().position(|dwell| (dwell.rate.0 - first).abs() > DIRECTION_BOUND * sigma.0)
}

/// Next position, in steps from the start.
fn steps_towards(dwells: &[Dwell], sigma: RadiansPerSecond) -> f64 {
    let visited = dwells.len() as f64;
    match turning_point(dwells, sigma) {
        Some(turn) if dwells[turn].rate < dwells[0].rate => turn as f64 - visited,
        _ => visited,
    }
}

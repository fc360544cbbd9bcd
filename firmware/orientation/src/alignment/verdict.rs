//! Verdict of an alignment: an azimuth with its standard deviation, or the reason for none.

use super::refusal::Refusal;
use crate::units::Radians;

/// An azimuth that passed every test.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Azimuth {
    /// Azimuth of body x from true north, clockwise from above, [0, 2π).
    pub angle: Radians,
    /// Standard deviation of the azimuth, 1σ: the whole error budget.
    pub sigma: Radians,
}

impl Azimuth {
    /// Whether both numbers are finite and σ is above zero.
    #[must_use]
    pub fn is_possible(&self) -> bool {
        self.angle.0.is_finite() && self.sigma.0.is_finite() && self.sigma.0 > 0.0
    }
}

/// An azimuth beside the least standard deviation that its data allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// The azimuth with its 1σ.
    pub azimuth: Azimuth,
    /// Cramér–Rao bound of the 1σ for the same data and unknowns.
    pub limit: Radians,
}

/// Outcome of an alignment.
pub type Verdict = Result<Solution, Refusal>;

/// An azimuth that passed every test, or the reason for none.
pub type Judged = Result<Azimuth, Refusal>;

//! Answers of a search: the best azimuth, and the arc of accepted ones.

/// The best azimuth and the cost of finding it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// Azimuth of the first position in grid steps of 10″, 0 to 129 599; the lowest on a tie.
    pub index: i32,
    /// Exact objective at that index, in table units (squared for sums of squares).
    pub objective: u128,
    /// Azimuth of the first position in rad, [0, 2π), interpolated below the grid: the minimum of
    /// the continuous objective (for [`LeastAbsolute`](super::Criterion::LeastAbsolute) within one
    /// step of `index`). Without noise it is within 0.5″ of the truth.
    pub azimuth: f64,
    /// Number of exact evaluations.
    pub evaluations: u32,
}

/// Smallest arc that covers the accepted set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// No azimuth meets the limit: the limit is below the noise.
    Nothing,
    /// Smallest arc that covers the accepted indices (the complement of their largest gap; of equal
    /// gaps the arc with the lowest first index).
    Arc {
        /// First index of the arc, clockwise, in grid steps of 10″.
        first: i32,
        /// Middle of the arc, rounded towards the first index, in grid steps of 10″.
        middle: i32,
        /// Steps from the first to the last index; 0 when one index is accepted.
        width: i32,
    },
    /// Every azimuth meets the limit: the limit does not select one.
    Everything,
}

/// Accepted azimuths and the cost of finding them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acceptance {
    /// The accepted set.
    pub accepted: Accepted,
    /// Number of exact evaluations.
    pub evaluations: u32,
}

//! Orders in which positions are visited so that drift cancels.

use core::f64::consts::TAU;

/// An order of positions; a *pass* is its least repeatable part.
///
/// A sum over positions 180° apart that alternate keeps what turns with the stage and loses what
/// drifts; mirrored orders lose a linear drift exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// 0°, 180°, 90°, 270°: Burov's four positions.
    Quadrature,
    /// 0°, 180°, 90°, 270° and back again; at the turning points nothing rotates.
    ThereAndBack,
    /// 0°, 180°, 180°, 0°, 90°, 270°, 270°, 90°: each pair mirrored in itself.
    Mirrored,
    /// 0°, 90°, 180°, 270° and back again: the least turning, for a slow stage.
    Sweep,
    /// 0° and 180° in turn for the first half, then 90° and 270°.
    Pairs,
    /// 0°, 120°, 240°: three positions.
    Thirds,
    /// This many equal steps over the circle.
    Circle(u8),
    /// 0°, 180°: two positions, which leave two azimuths unless its half is known.
    Opposite,
}

/// Quarter turns of a pass.
const QUADRATURE: [u8; 4] = [0, 2, 1, 3];
/// Quarter turns there and back.
const THERE_AND_BACK: [u8; 8] = [0, 2, 1, 3, 3, 1, 2, 0];
/// Quarter turns in the order of their angle, there and back.
const SWEEP: [u8; 8] = [0, 1, 2, 3, 3, 2, 1, 0];
/// Quarter turns, mirrored.
const MIRRORED: [u8; 8] = [0, 2, 2, 0, 1, 3, 3, 1];

impl Order {
    /// The orders that the planner compares.
    pub const COMPARED: [Self; 7] = [
        Self::Quadrature,
        Self::ThereAndBack,
        Self::Mirrored,
        Self::Sweep,
        Self::Pairs,
        Self::Thirds,
        Self::Circle(8),
    ];

    /// Those of them that need four headings only, as two frames have.
    pub const QUARTERS: [Self; 5] =
        [Self::Quadrature, Self::ThereAndBack, Self::Mirrored, Self::Sweep, Self::Pairs];

    /// Positions in a pass.
    #[must_use]
    pub fn length(self) -> usize {
        match self {
            Self::Quadrature | Self::Pairs => 4,
            Self::ThereAndBack | Self::Mirrored | Self::Sweep => 8,
            Self::Thirds => 3,
            Self::Circle(steps) => usize::from(steps.max(1)),
            Self::Opposite => 2,
        }
    }

    /// Stage angle of a position in so many passes, rad, [0, 2π).
    #[must_use]
    pub fn angle(self, index: usize, passes: usize) -> f64 {
        let quarters = |quarter: u8| 0.25 * TAU * f64::from(quarter);
        match self {
            Self::Quadrature => quarters(QUADRATURE[index % 4]),
            Self::ThereAndBack => quarters(THERE_AND_BACK[index % 8]),
            Self::Mirrored => quarters(MIRRORED[index % 8]),
            Self::Sweep => quarters(SWEEP[index % 8]),
            Self::Pairs => {
                let second = u8::from(index % (4 * passes.max(1)) >= 2 * passes);
                quarters(second + 2 * (index % 2) as u8)
            }
            Self::Thirds => TAU / 3.0 * (index % 3) as f64,
            Self::Circle(steps) => {
                let steps = usize::from(steps.max(1));
                TAU / steps as f64 * (index % steps) as f64
            }
            Self::Opposite => quarters(2 * (index % 2) as u8),
        }
    }

    /// Its name, as it is printed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quadrature => "0, 180, 90, 270°",
            Self::ThereAndBack => "0, 180, 90, 270° and back",
            Self::Mirrored => "0, 180, 180, 0, 90, 270, 270, 90°",
            Self::Sweep => "0, 90, 180, 270° and back",
            Self::Pairs => "0, 180° in turn, then 90, 270°",
            Self::Thirds => "0, 120, 240°",
            Self::Circle(_) => "equal steps over the circle",
            Self::Opposite => "0, 180°",
        }
    }
}

//! Orders in which positions are visited so that drift cancels (Burov).

use crate::units::{Radians, TURN};

/// Order of positions; a *pass* is its smallest repeatable part.
///
/// A sum over positions 180° apart, taken alternately, keeps the signal that turns with the stage
/// and cancels drift; mirrored orders cancel a linear drift exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Order {
    /// Order 0°, 180°, 90°, 270°: Burov's four positions.
    Quadrature,
    /// Order 0°, 180°, 90°, 270° and back again; at its turning points the stage does not rotate.
    ThereAndBack,
    /// Order 0°, 180°, 180°, 0°, 90°, 270°, 270°, 90°: each pair mirrored in itself.
    Mirrored,
    /// Order 0°, 90°, 180°, 270° and back again: the least rotation, for a slow stage.
    Sweep,
    /// Order of 0° and 180° alternately for the first half, then of 90° and 270°.
    Pairs,
    /// Order 0°, 120°, 240°: three positions.
    Thirds,
    /// Order of eight equal steps over the circle, repeated.
    Eighths,
}

/// Number of parts of a turn in which every position is a whole number: halves, thirds, quarters
/// and eighths.
pub(crate) const PARTS: u8 = 24;

/// The two pairs of opposite positions, in twenty-fourths of a turn.
const PAIRS: [[u8; 2]; 2] = [[0, 12], [6, 18]];

impl Order {
    /// Orders that the planner compares.
    pub const COMPARED: [Self; 7] = [
        Self::Quadrature,
        Self::ThereAndBack,
        Self::Mirrored,
        Self::Sweep,
        Self::Pairs,
        Self::Thirds,
        Self::Eighths,
    ];

    /// Orders that need four headings only, as a two-frame mount has.
    pub const QUARTERS: [Self; 5] =
        [Self::Quadrature, Self::ThereAndBack, Self::Mirrored, Self::Sweep, Self::Pairs];

    /// Positions of a pass in twenty-fourths of a turn; for [`Self::Pairs`] one of each pair.
    const fn pass(self) -> &'static [u8] {
        match self {
            Self::Quadrature | Self::Pairs => &[0, 12, 6, 18],
            Self::ThereAndBack => &[0, 12, 6, 18, 18, 6, 12, 0],
            Self::Mirrored => &[0, 12, 12, 0, 6, 18, 18, 6],
            Self::Sweep => &[0, 6, 12, 18, 18, 12, 6, 0],
            Self::Thirds => &[0, 8, 16],
            Self::Eighths => &[0, 3, 6, 9, 12, 15, 18, 21],
        }
    }

    /// Number of positions in a pass.
    #[must_use]
    pub const fn length(self) -> usize {
        self.pass().len()
    }

    /// Position with this index in a schedule of `passes`, in twenty-fourths of a turn, 0 to 23.
    pub(crate) fn part(self, index: usize, passes: usize) -> u8 {
        if self == Self::Pairs {
            let second = index % (4 * passes.max(1)) >= 2 * passes;
            return PAIRS[usize::from(second)][index % 2];
        }
        let pass = self.pass();
        pass[index % pass.len()]
    }

    /// Stage angle of the position with this index in a schedule of `passes`, [0, 2π).
    pub fn angle(self, index: usize, passes: usize) -> Radians {
        Radians(f64::from(self.part(index, passes)) * (TURN / f64::from(PARTS)))
    }

    /// Name of the order, as it is printed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quadrature => "0, 180, 90, 270°",
            Self::ThereAndBack => "0, 180, 90, 270° and back",
            Self::Mirrored => "0, 180, 180, 0, 90, 270, 270, 90°",
            Self::Sweep => "0, 90, 180, 270° and back",
            Self::Pairs => "0, 180° in turn, then 90, 270°",
            Self::Thirds => "0, 120, 240°",
            Self::Eighths => "eight equal steps over the circle",
        }
    }
}

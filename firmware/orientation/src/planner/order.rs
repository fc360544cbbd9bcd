//! Orders in which positions are visited so that drift cancels.

use crate::units::TURN;

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
    /// Eight equal steps over the circle, again and again.
    Eighths,
}

/// Parts of a turn in which every position is a whole number: halves, thirds, quarters and eighths.
pub const PARTS: u8 = 24;

/// Burov's four positions.
const QUADRATURE: [u8; 4] = [0, 12, 6, 18];
/// There and back.
const THERE_AND_BACK: [u8; 8] = [0, 12, 6, 18, 18, 6, 12, 0];
/// Pairs, mirrored.
const MIRRORED: [u8; 8] = [0, 12, 12, 0, 6, 18, 18, 6];
/// In the order of their angle, there and back.
const SWEEP: [u8; 8] = [0, 6, 12, 18, 18, 12, 6, 0];
/// A quarter apart, then the other two.
const PAIRS: [[u8; 2]; 2] = [[0, 12], [6, 18]];
/// A third apart.
const THIRDS: [u8; 3] = [0, 8, 16];
/// An eighth apart.
const EIGHTHS: [u8; 8] = [0, 3, 6, 9, 12, 15, 18, 21];

impl Order {
    /// The orders that the planner compares.
    pub const COMPARED: [Self; 7] = [
        Self::Quadrature,
        Self::ThereAndBack,
        Self::Mirrored,
        Self::Sweep,
        Self::Pairs,
        Self::Thirds,
        Self::Eighths,
    ];

    /// Those of them that need four headings only, as two frames have.
    pub const QUARTERS: [Self; 5] =
        [Self::Quadrature, Self::ThereAndBack, Self::Mirrored, Self::Sweep, Self::Pairs];

    /// The positions of a pass in twenty-fourths of a turn; of [`Self::Pairs`] those of one of each.
    const fn pass(self) -> &'static [u8] {
        match self {
            Self::Quadrature | Self::Pairs => &QUADRATURE,
            Self::ThereAndBack => &THERE_AND_BACK,
            Self::Mirrored => &MIRRORED,
            Self::Sweep => &SWEEP,
            Self::Thirds => &THIRDS,
            Self::Eighths => &EIGHTHS,
        }
    }

    /// Positions in a pass.
    #[must_use]
    pub const fn length(self) -> usize {
        self.pass().len()
    }

    /// A position in so many passes, in twenty-fourths of a turn, 0 to 23.
    #[must_use]
    pub fn part(self, index: usize, passes: usize) -> u8 {
        if self == Self::Pairs {
            let second = index % (4 * passes.max(1)) >= 2 * passes;
            return PAIRS[usize::from(second)][index % 2];
        }
        let pass = self.pass();
        pass[index % pass.len()]
    }

    /// Stage angle of a position in so many passes, rad, [0, 2π).
    #[must_use]
    pub fn angle(self, index: usize, passes: usize) -> f64 {
        f64::from(self.part(index, passes)) * (TURN / f64::from(PARTS))
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
            Self::Eighths => "eight equal steps over the circle",
        }
    }
}

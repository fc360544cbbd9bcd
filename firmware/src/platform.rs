//! The platforms that may carry the instrument.

use core::fmt;

/// What carries the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Platform {
    /// A stage that turns the gyro about one axis and stops at positions.
    Stage,
    /// A mount of two frames about horizontal axes, on which the gyro stands at four headings.
    TwoFrame,
    /// A stage that turns all the time, on a slip ring.
    Turntable,
    /// A vehicle that drives from stop to stop, with three gyros.
    Vehicle,
    /// A body in fast rotation about its longitudinal axis, with three gyros and two
    /// accelerometers.
    Spin,
}

impl Platform {
    /// All platforms.
    pub const ALL: [Self; 5] =
        [Self::Stage, Self::TwoFrame, Self::Turntable, Self::Vehicle, Self::Spin];

    /// The name of the platform on the command line, and of the feature for its image.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stage => "stage",
            Self::TwoFrame => "two-frame",
            Self::Turntable => "turntable",
            Self::Vehicle => "vehicle",
            Self::Spin => "spin",
        }
    }

    /// Whether an azimuth is determined on it, for which its latitude must be known: on all but a spinning body.
    #[must_use]
    pub const fn has_azimuth(self) -> bool {
        !matches!(self, Self::Spin)
    }
}

impl fmt::Display for Platform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

//! The values that a quantity may take, and how a message bears them.

use std::fmt;

/// The values that a quantity may take, both ends included unless said.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    low: f64,
    high: f64,
    above_low: bool,
    unit: &'static str,
}

impl Range {
    /// From `-limit` to `limit`.
    pub const fn symmetric(limit: f64, unit: &'static str) -> Self {
        Self { low: -limit, high: limit, above_low: false, unit }
    }

    /// From zero to `high`.
    pub const fn from_zero(high: f64, unit: &'static str) -> Self {
        Self { low: 0.0, high, above_low: false, unit }
    }

    /// Above zero, to `high`.
    pub const fn above_zero(high: f64, unit: &'static str) -> Self {
        Self { low: 0.0, high, above_low: true, unit }
    }

    /// In which other unit a number beyond the range may stand.
    pub(super) fn mistaken(&self) -> &'static str {
        match self.unit {
            " rad/s" => ": °/s or °/h?",
            " rad" => ": degrees?",
            " m/s²" => ": mg?",
            " m" => ": mm?",
            " s" => ": ms or µs?",
            _ => "",
        }
    }

    /// Whether the value lies inside; NaN does not.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value) && !(self.above_low && value <= self.low)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high, above_low, unit } = self;
        let above = if *above_low { "above " } else { "" };
        if low + high == 0.0 {
            write!(f, "±{high}{unit}")
        } else {
            write!(f, "{above}{low} to {high}{unit}")
        }
    }
}

/// A number as a message bears it: one with very many zeros is written with an exponent.
#[derive(Clone, Copy, Debug)]
pub struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = self;
        if *value == 0.0 || (1e-9..1e15).contains(&value.abs()) {
            write!(f, "{value}")
        } else {
            write!(f, "{value:e}")
        }
    }
}

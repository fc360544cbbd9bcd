//! The parts of a recording: where the platform's rate was modulated, and where it turned evenly one way round.

use std::fmt;

use super::turns::turn_hz;
use crate::recording::RotatingRow;

/// A part of a recording that was taken for one.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// Whether the platform turned evenly; its rate is modulated for the axis misalignment.
    pub is_even: bool,
    /// The samples.
    pub rows: &'a [RotatingRow],
}

impl<'a> Part<'a> {
    /// The rows from one time to before another, s.
    #[must_use]
    pub fn between(rows: &'a [RotatingRow], from_s: f64, to_s: f64, is_even: bool) -> Self {
        let before = |seconds: f64| rows.partition_point(|row| row.time_s < seconds);
        let from = before(from_s);
        Self { is_even, rows: &rows[from..before(to_s).max(from)] }
    }
}

impl fmt::Display for Part<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let speed = turn_hz(self.rows);
        let way = if speed < 0.0 { "counter-clockwise" } else { "clockwise" };
        let how = if self.is_even { "" } else { ", rate-modulated" };
        write!(f, "{way} at {:.3} Hz{how}", speed.abs())
    }
}

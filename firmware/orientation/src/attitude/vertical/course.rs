//! Motion of the body since its heading was handed over, or since the start.

use super::sums::Window;

/// Longest rest that is counted, s.
const MEMORY: f32 = 600.0;

/// Motion of the body since its heading was handed over, or since the start, as far as it affects the
/// heading's error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Course {
    /// Net rotation about the vertical, rad, whole turns included.
    pub turned: f32,
    /// Time of motion since the last rest, s.
    pub moved: f32,
    /// Length of that rest, s, at most ten minutes.
    pub stood: f32,
    /// Angle error per unit ramp of the bias, rad per rad/s².
    pub ramp: f32,
}

impl Course {
    /// Adds a window of motion.
    pub(super) fn drive(&mut self, window: &Window) {
        self.turned += window.about;
        self.moved += window.seconds;
        self.ramp += window.seconds * (self.moved + 0.5 * self.stood);
    }

    /// Adds a time at rest, s.
    pub(super) fn stand(&mut self, seconds: f32) {
        if self.moved > 0.0 {
            (self.moved, self.stood) = (0.0, 0.0);
        }
        self.stood = (self.stood + seconds).min(MEMORY);
    }
}

//! What the body did since its heading was handed over.

use super::sums::Window;

/// For how long a rest is remembered, s.
const MEMORY: f32 = 600.0;

/// What the body did since its heading was handed over.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// Turned about the vertical, rad, whole turns included.
    pub turned: f32,
    /// For how long it has moved since it stood last, s.
    pub moved: f32,
    /// For how long it stood then, s, ten minutes at most.
    pub stood: f32,
    /// What a bias that grows by 1 rad/s² has turned unseen, rad.
    pub ramp: f32,
}

impl Course {
    pub(super) fn drive(&mut self, window: &Window) {
        self.turned += window.about;
        self.moved += window.seconds;
        self.ramp += window.seconds * (self.moved + 0.5 * self.stood);
    }

    pub(super) fn stand(&mut self, seconds: f32) {
        if self.moved > 0.0 {
            (self.moved, self.stood) = (0.0, 0.0);
        }
        self.stood = (self.stood + seconds).min(MEMORY);
    }
}

//! What becomes of rotation that nobody saw: samples that are missing, and gyros at the limit of their range.

use super::filter::TURN;
use super::sums::{Rested, Window};
use super::{Trust, Vertical};
use crate::math::rotation::{difference, dot, scaled, sum};
use crate::signal::InertialSample;
use crate::signal::increment::STEP;
use crate::units::{AngleIncrement, Instant};

/// Part of the rate lately that a rate within a gap may be beside the mean of its ends.
const GAP_PART: f32 = 0.3;
/// Tilt, 1σ, with which nothing of the level is left, rad: it is taken from the forces anew.
const ALL: f32 = 0.3;
/// Least rate that may be hidden behind a gyro's limit, rad/s.
const LEAST_CLIPPED: f32 = 1.0;

impl Vertical {
    /// Samples are missing: the rate between is taken for the mean of those at either end.
    #[inline(never)]
    pub(super) fn bridge(&mut self, elapsed: f32, sample: &InertialSample) {
        let missing = elapsed - self.period;
        let end = Instant(sample.time.0.saturating_sub((self.period * 1e6) as u64));
        self.tick(Instant(end.0.saturating_sub((missing * 1e6) as u64)));
        let rate =
            |turned: &[AngleIncrement; 3]| turned.map(|part| part.0 as f32 * STEP / self.period);
        let (before, after) = (rate(&self.before.turned), rate(&sample.turned));
        let mean = scaled(&sum(&before, &after), 0.5);
        let jump = difference(&after, &before);
        let lost = 0.5 * libm::sqrtf(dot(&jump, &jump)) + GAP_PART * self.before.lately;
        self.advance(&scaled(&mean, missing), missing);
        self.since = end;
        self.lose(lost * missing);
    }

    /// A gyro stood at the limit of its range: what it turned beyond is not known.
    #[inline(never)]
    pub(super) fn clip(&mut self, now: Instant) {
        self.tick(now);
        // What is lost of one clip goes one way: it adds up, not its squares.
        let before = self.before.clipped;
        self.before.clipped += self.before.lately.max(LEAST_CLIPPED) * self.period;
        self.lose_square(self.before.clipped * self.before.clipped - before * before);
    }

    /// A rotation of this size, rad, may have been lost.
    fn lose(&mut self, angle: f32) {
        self.lose_square(angle * angle);
    }

    fn lose_square(&mut self, variance: f32) {
        self.filter.doubt(0, variance);
        self.filter.doubt(1, variance);
        self.filter.doubt(TURN, variance);
        if self.filter.tilt_sigma() > ALL && self.trust != Trust::Starting {
            self.is_lost = true;
            self.trust = Trust::RotationLost;
        }
        self.rest.disturb();
        self.rested = Rested::default();
        self.window = Window::default();
    }
}

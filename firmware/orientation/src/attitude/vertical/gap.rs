//! Rotation that was not measured: missing samples, and gyros at the limit of their range.

use super::filter::{Filter, TURN};
use super::judge::{Findings, Task};
use super::stretch::Stretch;
use super::sums::{Rested, Sums, Window};
use super::{Trust, Vertical};
use crate::math::quaternion::Vector;
use crate::math::rotation::{difference, length, scaled, sum, transposed, turned};
use crate::signal::InertialSample;
use crate::signal::increment::{Increment, STEP};
use crate::units::{AngleIncrement, Instant};

/// Deviation of the rate within a gap from the mean of its ends, as a part of the recent rate
/// beyond the biases.
const GAP_PART: f32 = 0.3;
/// Longest gap through which a body goes on resting that rested before it, s: whatever moved it
/// would have to move it and bring it to rest again within that time.
const STANDING: f32 = 1.0;
/// Rate of a turn of which nothing is seen, as of a vehicle that manoeuvres, 1σ, rad/s: what is measured before and after a
/// gap bounds the rate within it for as long as a resting body goes on resting, and not beyond.
const UNSEEN: f32 = 0.35;
/// Standard deviation of the tilt at which the level is lost, 1σ, rad: it is set anew by the
/// forces.
const ALL: f32 = 0.3;
/// Rate that a shock may hide beyond a gyro's limit, rad/s.
const BLOW: f32 = 10.0;
/// Recent rate from which the limit is about that rate, and only a part of it may be hidden, rad/s.
const TURNING: f32 = 0.2;
/// Part of the recent rate that may be hidden.
const HIDDEN: f32 = 0.5;
/// Longest gap that is bridged, s.
const LONGEST: f32 = 60.0;
/// Standard deviation of an unknown angle, 1σ, rad.
const ANY_ANGLE: f32 = 6.3;

impl Vertical {
    /// Bridges missing samples: the rate in the gap is the mean of those at both ends, or none of
    /// a body at rest. In a gap of more than a second it may have been any.
    #[inline(never)]
    pub(super) fn bridge(&mut self, elapsed: f32, sample: &InertialSample) {
        let missing = elapsed - self.period;
        if missing > LONGEST {
            return self.reset(sample.time);
        }
        let end = Instant(sample.time.0.saturating_sub((self.period * 1e6) as u64));
        self.tick(Instant(end.0.saturating_sub((missing * 1e6) as u64)));
        self.since = end;
        let rate =
            |turned: &[AngleIncrement; 3]| turned.map(|part| part.0 as f32 * STEP / self.period);
        let (before, after) = (rate(&self.before.turned), rate(&sample.turned));
        if self.is_at_rest() && missing <= STANDING {
            return self.rest_through(&after, missing);
        }
        let mean = scaled(&sum(&before, &after), 0.5);
        let jump = difference(&after, &before);
        let lost = 0.5 * length(&jump) + GAP_PART * self.before.lately;
        self.advance(&scaled(&mean, missing), missing);
        self.lose(lost * missing + UNSEEN * (missing - STANDING).max(0.0));
    }

    /// Continues a rest after missing samples, with these rates, rad/s. A body that has set off
    /// meanwhile has turned by half of what those rates would turn it; whether it has is left to rest
    /// detection.
    fn rest_through(&mut self, after: &Vector, missing: f32) {
        let still = sum(&self.bias, &turned(&transposed(&self.matrix), &self.frame));
        let lost = 0.5 * missing * length(&difference(after, &still));
        self.inflate_attitude(lost * lost);
    }

    /// Resets everything but the biases, which are kept with the variance of a switch-on.
    fn reset(&mut self, now: Instant) {
        let sigmas = self.priors.map(|prior| libm::sqrtf(prior + self.unknown));
        self.filter = Filter::new(sigmas, &self.expected);
        self.axes = [[0.0; 3]; 3];
        self.task = Task::Nothing;
        self.findings = Findings::default();
        self.increment = Increment::default();
        self.force = Sums::default();
        self.stretch = Stretch::default();
        self.since = Instant(now.0.saturating_sub((self.period * 1e6) as u64));
        self.lose(ANY_ANGLE);
    }

    /// Accounts for a gyro at the limit of its range: rotation beyond it is unknown.
    #[inline(never)]
    pub(super) fn clip(&mut self, now: Instant) {
        self.tick(now);
        // Rotation lost in one saturation has one sign: the angles add up, not their squares.
        let before = self.before.clipped;
        let lately = self.before.lately;
        let hidden = if lately > TURNING { HIDDEN * lately } else { BLOW };
        self.before.clipped += hidden * self.period;
        self.lose_square(self.before.clipped * self.before.clipped - before * before);
    }

    /// Accounts for a possible loss of rotation of this size, rad.
    fn lose(&mut self, angle: f32) {
        self.lose_square(angle * angle);
    }

    /// Inflates attitude variances, rad².
    fn inflate_attitude(&mut self, variance: f32) {
        self.filter.inflate_level(variance);
        self.filter.inflate(TURN, variance);
    }

    /// Inflates attitude variances, rad², and discards the averages in progress.
    fn lose_square(&mut self, variance: f32) {
        self.inflate_attitude(variance);
        if self.filter.tilt_sigma() > ALL && self.trust != Trust::Starting {
            self.is_lost = true;
            self.trust = Trust::RotationLost;
        }
        self.rest.disturb();
        self.rested = Rested::default();
        self.window = Window::default();
    }
}

//! Rotation that was not measured: missing samples, and gyros at the limit of their range.

use super::filter::{Filter, TURN};
use super::judge::{Findings, Task};
use super::stretch::Stretch;
use super::sums::{Rested, Sums};
use super::{Trust, Vertical};
use crate::math::quaternion::Vector;
use crate::math::rotation::{difference, dot, length, scaled, sum, transposed, turned};
use crate::signal::InertialSample;
use crate::signal::increment::{Increment, STEP};
use crate::units::{AngleIncrement, Instant};

/// Deviation of the rate within a gap from the mean of its ends, as a part of the recent rate
/// beyond the biases.
const GAP_PART: f32 = 0.3;
/// Longest time without samples, of one gap or of several between two looks for rest, through which a body goes on resting,
/// s: whatever moved it would have to move it and bring it to rest again within that time.
const STANDING: f32 = 1.0;
/// Angular acceleration of a body that manoeuvres, 1σ, rad/s²: speeding up for half of a gap and slowing down for the other,
/// it turns by a quarter of this times the square of the gap beside what the ends show.
const MANOEUVRE: f32 = 0.5;
/// Standard deviation of the tilt at which the level is lost, 1σ, rad: it is set anew by the
/// forces.
const ALL: f32 = 0.3;
/// Rate that a shock may hide beyond a gyro's limit, rad/s.
const BLOW: f32 = 10.0;
/// Recent rate from which the limit is about that rate, and only a part of it may be hidden, rad/s.
const TURNING: f32 = 0.2;
/// Part of the recent rate that may be hidden beyond the limit.
const HIDDEN: f32 = 1.0;
/// Longest gap that is bridged, s.
const LONGEST: f32 = 60.0;
/// Standard deviation of an unknown angle, 1σ, rad.
const ANY_ANGLE: f32 = 6.3;

impl Vertical {
    /// Bridges missing samples: the rate in the gap is the mean of those at both ends, or none of
    /// a body at rest. The longer the gap, the more a body that moves may have turned beside that.
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
        if self.is_at_rest() && self.window.missing + missing <= STANDING {
            return self.rest_through([&before, &after], missing);
        }
        let mean = scaled(&sum(&before, &after), 0.5);
        let jump = difference(&after, &before);
        let lost = 0.5 * length(&jump) + GAP_PART * self.before.lately + 0.25 * MANOEUVRE * missing;
        self.advance(&scaled(&mean, missing), missing);
        self.lose(lost * missing);
    }

    /// Continues a rest through missing samples, with these rates before and after them, rad/s. A body that has set off
    /// meanwhile has turned by half of what those rates would turn it; whether it has is left to rest
    /// detection, until whose next look the angles of all gaps have one sign and add up.
    fn rest_through(&mut self, ends: [&Vector; 2], missing: f32) {
        let still = sum(&self.bias, &turned(&transposed(&self.matrix), &self.frame));
        let [before, after] = ends.map(|rate| difference(rate, &still));
        let lost = 0.5 * missing * libm::sqrtf(dot(&before, &before) + dot(&after, &after));
        self.window.missing += missing;
        let variance = add_lost(&mut self.window.lost, lost);
        self.inflate_attitude(variance);
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

    /// Accounts for a gyro at the limit of its range: it goes on at its latest rate, and rotation beyond it is unknown.
    #[inline(never)]
    pub(super) fn clip(&mut self, sample: &InertialSample) {
        let latest = self.before.turned;
        self.seen.is_clipped = true;
        self.increment.push(core::array::from_fn(|axis| {
            let turned = sample.turned[axis];
            if turned.is_saturated() { latest[axis] } else { turned }
        }));
        self.tick(sample.time);
        let lately = self.before.lately;
        let hidden = if lately > TURNING { HIDDEN * lately } else { BLOW };
        let variance = add_lost(&mut self.before.clipped, hidden * self.period);
        self.lose_square(variance);
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
        self.break_off();
        self.rest.disturb();
        self.rested = Rested::default();
    }
}

/// Adds an angle that may have been lost, rad, to others of one cause, and returns what it adds to their variance, rad²: they
/// have one sign, so that the angles add up, not their squares.
fn add_lost(sum: &mut f32, angle: f32) -> f32 {
    let before = *sum;
    *sum += angle;
    *sum * *sum - before * before
}

//! Where gravity must be if the filter is wrong: the force, low-passed in the gyros' frame.
//!
//! It errs by what the body accelerates, and by what the gyros turn too much within seconds, but it never strays farther:
//! the floor on which the filter stands. Where it is beside the filter's vertical by more than motion and the level's σ
//! explain, the gyros are worse than they are stated to be, or a turn was not seen, and σ grows.
//!
//! A body on wheels may also be in a bend: its σ grows within seconds, to a fifth of what the two are apart. A body that
//! is tumbled about, in a hand or by waves, or that was seen to turn quicker than wheels turn it, is in none, and its
//! gyros are worked hardest: its level is at once as uncertain as the two are apart, for half a minute the gyros' scale
//! is believed no more than gravity shows of it, and what leans for long is a bias. Where hardly any of the mean force
//! holds the body up, the filter's vertical is none, and the floor's takes its place.
//!
//! Source of the low-pass in the gyros' frame: D. Laidig and T. Seel, VQF, Information Fusion 2023.

use super::motion::{BAND, Motion};
use super::stretch::Stretch;
use super::{GRAVITY, Vector};
use crate::math::rotation::dot;

/// Standard deviations by which the floor may be beside the filter's vertical.
const FLOOR: f32 = 5.0;
/// Mean square that they may be apart at most, of a body that is tumbled about, in those of gravity: one that gained
/// 70 m/s on a level course within the band is no such body.
const FARTHEST: f32 = 0.5;
/// Standard deviations that are too many if they last: those of a bias.
const BIAS_SIGMAS: f32 = 2.5;
/// Part of gravity that may be missing in the mean of what holds the body up, before the level is taken from the floor:
/// a loop that is flown misses less.
const MISSING: f32 = 0.5;
/// Time in which the variance of a level that is not tumbled about grows by what the floor is beside it unexplained, s.
const WIDENING: f32 = 2.0;
/// For how long a doubt lasts, s.
const DOUBT: f32 = 30.0;
/// Variance of the level, rad², from which a doubt makes the gyros' scale uncertain, and the greatest factor of its
/// variance: a gyro that is soft at its limit errs by a tenth.
const STRAINED: f32 = 1e-5;
const STRAIN: f32 = 400.0;

/// The floor, watched stretch by stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Floor {
    /// Mean force on the level frame, north, east, down, m/s².
    mean: Vector,
    /// Mean part of gravity that is missing of what holds the body up.
    missing: f32,
    /// Variance of the level that is doubted lately, rad².
    doubt: f32,
}

/// What the floor has to say.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdict {
    /// By how much the variance of the level grows, rad².
    pub(super) more: f32,
    /// Whether the level leans as a gyro's bias would make it, more than what is known of the biases.
    pub(super) is_biased: bool,
}

impl Floor {
    /// Watches a stretch in which there was a force of this size, m/s².
    pub(super) fn watch(&mut self, stretch: &Stretch, size: f32) {
        let part = stretch.seconds / BAND;
        for (mean, impulse) in self.mean.iter_mut().zip(stretch.impulse) {
            *mean += impulse * (1.0 / BAND) - part * *mean;
        }
        let [.., down] = stretch.impulse;
        // What holds the body up should be gravity, or what it feels at all: a body that falls misses nothing.
        let missing = size.min(GRAVITY) + down / stretch.forced;
        self.missing += part * (missing * (1.0 / GRAVITY) - self.missing);
    }

    /// Compares with the filter's vertical, good to this variance, rad², of a body that moves so.
    pub(super) fn compare(&mut self, tilt: f32, motion: &Motion, seconds: f32) -> Verdict {
        let [north, east, _] = self.mean;
        let square = GRAVITY * GRAVITY;
        let beside = 0.5 * (north * north + east * east) / square;
        let explained = tilt + motion.greatest() / (BAND * BAND * square);
        let most = FLOOR * FLOOR * explained;
        self.doubt *= 1.0 - (seconds / DOUBT).min(1.0);
        if !motion.is_tumbled() {
            let more = (beside - most).max(0.0) * (seconds / WIDENING).min(1.0);
            return Verdict { more, is_biased: false };
        }
        if beside > most.min(FARTHEST) {
            self.doubt = self.doubt.max(beside);
        }
        let is_biased = beside > BIAS_SIGMAS * BIAS_SIGMAS * explained;
        Verdict { more: (self.doubt - tilt).max(0.0), is_biased }
    }

    /// By what factor the variance of the gyros' scale is greater than stated.
    pub(super) fn strain(&self) -> f32 {
        (self.doubt / STRAINED).clamp(1.0, STRAIN)
    }

    /// Mean force on the level frame, north, east, down, m/s².
    pub(super) fn mean(&self) -> Vector {
        self.mean
    }

    /// The mean force, if hardly any of it holds the body up as the filter has it; it is vertical from then on.
    pub(super) fn take_level(&mut self) -> Option<Vector> {
        if self.missing < MISSING {
            return None;
        }
        let size = libm::sqrtf(dot(&self.mean, &self.mean));
        self.doubt = self.doubt.max(self.missing);
        self.missing = 0.0;
        Some(core::mem::replace(&mut self.mean, [0.0, 0.0, -size]))
    }

    /// The body stands, on a level that is taken anew.
    pub(super) fn stand(&mut self) {
        *self = Self { doubt: self.doubt, ..Self::default() };
    }
}

//! Independent check of the vertical: the force, low-passed in the gyros' frame (the floor).
//!
//! It is wrong by the acceleration of the body, and by the gyros' errors within seconds, but its
//! error never grows beyond that: the filter is compared with it. Where it deviates from the
//! filter's vertical by more than motion and the level's σ explain, the gyros are worse than
//! configured, or a rotation was missed, and σ is inflated.
//!
//! A wheeled vehicle may also be in a bend: its σ then grows within seconds, to a fifth of the
//! deviation. A body that tumbles, in a hand or on waves, or that turned faster than wheels turn
//! it, is in no bend, and its gyros are stressed most: its level is at once as uncertain as the
//! deviation, for half a minute the gyros' scale is trusted no more than gravity confirms, and a
//! lasting deviation is attributed to a bias. Where hardly any of the mean force supports the body,
//! the filter's vertical is invalid and the floor's replaces it.
//!
//! Source of the low-pass in the gyros' frame: D. Laidig and T. Seel, VQF, Information Fusion 2023.

use super::motion::{BAND, GRAVITY, Motion};
use super::stretch::Stretch;
use crate::math::quaternion::Vector;
use crate::math::rotation::length;

/// Significance, in σ, at which the floor deviates from the filter's vertical.
const FLOOR: f32 = 5.0;
/// Greatest mean squared deviation for a tumbling body, in units of gravity squared: a body that
/// gained 70 m/s on a level course within the band does not tumble.
const FARTHEST: f32 = 0.5;
/// Significance, in σ, of a lasting deviation that is attributed to a bias.
const BIAS_SIGMAS: f32 = 2.5;
/// Part of gravity missing in the mean supporting force, beyond which the level is taken from the
/// floor; a looping aircraft misses less.
const MISSING: f32 = 0.5;
/// Time in which the level's variance of a body that does not tumble grows by the unexplained
/// deviation, s.
const WIDENING: f32 = 2.0;
/// Decay time of an inflation, s.
const INFLATION_SECONDS: f32 = 30.0;
/// Variance of the level, rad², from which an inflation makes the gyros' scale uncertain.
const STRAINED: f32 = 1e-5;
/// Greatest factor on the variance of the gyros' scale: a gyro near saturation errs by a tenth.
const STRAIN: f32 = 400.0;

/// Low-passed force, updated stretch by stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Floor {
    /// Mean force on the level frame, north, east, down, m/s².
    pub(super) mean: Vector,
    /// Mean part of gravity that is missing in the supporting force.
    missing: f32,
    /// Recent inflation of the level's variance, rad².
    inflation: f32,
}

/// Result of the comparison.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdict {
    /// Growth of the level's variance, rad².
    pub(super) more: f32,
    /// Whether the deviation indicates a gyro bias larger than its uncertainty.
    pub(super) is_biased: bool,
}

impl Floor {
    /// Adds a stretch with a mean force of this magnitude, m/s².
    pub(super) fn watch(&mut self, stretch: &Stretch, size: f32) {
        let part = stretch.seconds / BAND;
        for (mean, impulse) in self.mean.iter_mut().zip(stretch.impulse) {
            *mean += impulse * (1.0 / BAND) - part * *mean;
        }
        let [.., down] = stretch.impulse;
        // The supporting force should be gravity, or the felt force where that is less: a falling
        // body misses nothing.
        let missing = size.min(GRAVITY) + down / stretch.forced;
        self.missing += part * (missing * (1.0 / GRAVITY) - self.missing);
    }

    /// Compares with the filter's vertical, which has this variance, rad², for a body with this
    /// motion.
    pub(super) fn compare(&mut self, tilt: f32, motion: &Motion, seconds: f32) -> Verdict {
        let [north, east, _] = self.mean;
        let square = GRAVITY * GRAVITY;
        let beside = 0.5 * (north * north + east * east) / square;
        let explained = tilt + motion.greatest() / (BAND * BAND * square);
        let most = FLOOR * FLOOR * explained;
        self.inflation *= 1.0 - (seconds / INFLATION_SECONDS).min(1.0);
        if !motion.is_tumbled() {
            let more = (beside - most).max(0.0) * (seconds / WIDENING).min(1.0);
            return Verdict { more, is_biased: false };
        }
        if beside > most.min(FARTHEST) {
            self.inflation = self.inflation.max(beside);
        }
        let is_biased = beside > BIAS_SIGMAS * BIAS_SIGMAS * explained;
        Verdict { more: (self.inflation - tilt).max(0.0), is_biased }
    }

    /// Factor by which the variance of the gyros' scale exceeds the configured one.
    pub(super) fn strain(&self) -> f32 {
        (self.inflation / STRAINED).clamp(1.0, STRAIN)
    }

    /// Takes the mean force where hardly any of it supports the body on the filter's vertical;
    /// afterwards it counts as vertical.
    pub(super) fn take_level(&mut self) -> Option<Vector> {
        if self.missing < MISSING {
            return None;
        }
        let size = length(&self.mean);
        self.inflation = self.inflation.max(self.missing);
        self.missing = 0.0;
        Some(core::mem::replace(&mut self.mean, [0.0, 0.0, -size]))
    }

    /// Restarts for a body at rest, whose level is set anew.
    pub(super) fn stand(&mut self) {
        *self = Self { inflation: self.inflation, ..Self::default() };
    }
}

//! Plausibility check of the spin gyro: increments that saturate, that jump as no body does, or
//! that repeat.

use super::setting::Setting;
use crate::units::AngleIncrement;

/// Number of identical samples after which a noisy gyro counts as stuck.
const STILL: u32 = 32;
/// Factor by which that number must exceed the longest earlier repetition.
const LONGER: u32 = 2;
/// Surplus of changed samples from which the gyro counts as live.
const LIVES: u16 = 128;
/// Greatest surplus that is counted.
const MOST: u16 = 512;
/// Number of successive jumps after which they are accepted; enough to detect first
/// whether the gyro is stuck at the new value.
const MOST_JUMPS: u16 = 128;
/// Noise, in steps, from which a live gyro does not repeat itself.
const LIVELY: f64 = 8.0;
/// Least jump, rad per sample.
const JUMP: f64 = 1e-3;
/// Least jump, in standard deviations of the noise.
const JUMP_SIGMAS: f64 = 12.0;
/// Least jump, as a divisor of the rate.
const JUMP_PART: u32 = 16;

/// State of the plausibility check.
#[derive(Clone, Debug, Default)]
pub(super) struct Plausibility {
    /// Latest increment that was accepted.
    pub(super) before: AngleIncrement,
    /// Latest increment, accepted or not, and its number of repetitions.
    shown: AngleIncrement,
    still: u32,
    /// Longest earlier repetition: a coarse gyro that turns slowly repeats itself too.
    longest: u32,
    /// Surplus of changed over repeated samples.
    lives: u16,
    /// Number of successive jumps, less plausible samples meanwhile; at the start no jump can be
    /// recognised.
    jumped: u16,
    /// Least change that may be a jump, in steps of an increment.
    least: u32,
    /// Length of the run of samples with unknown rotation, before the latest one and with it.
    lost: [u16; 2],
    /// Whether the gyro's noise excludes repetitions.
    is_lively: bool,
    /// Whether all checks are passed, and whether the gyro never changed by more than a step.
    is_calm: bool,
    is_dull: bool,
}

impl Plausibility {
    /// Check before the first sample.
    pub(super) fn new(setting: &Setting) -> Self {
        let noise = setting.angle_random_walk.0 * libm::sqrt(setting.sample_seconds.0);
        Self {
            jumped: MOST_JUMPS,
            least: (JUMP.max(JUMP_SIGMAS * noise) / AngleIncrement::STEP) as u32,
            is_lively: noise > LIVELY * AngleIncrement::STEP,
            is_dull: true,
            ..Self::default()
        }
    }

    /// Increment that is assumed for the body, for the gyro's reading.
    #[inline]
    pub(super) fn take(&mut self, turned: AngleIncrement) -> AngleIncrement {
        let change = turned.0.wrapping_sub(self.shown.0).unsigned_abs();
        let off = turned.0.wrapping_sub(self.before.0).unsigned_abs();
        self.shown = turned;
        if self.is_calm && off <= self.least && (change <= 1) == self.is_dull {
            self.still = self.still.wrapping_add(u32::from(self.is_dull));
            self.before = turned;
        } else {
            self.weigh(change, off);
        }
        self.before
    }

    /// Checks an unusual increment, or one that follows such.
    #[inline(never)]
    fn weigh(&mut self, change: u32, off: u32) {
        let is_stuck = self.is_stuck();
        if change <= 1 {
            self.still = self.still.saturating_add(1);
            self.lives = self.lives.saturating_sub(u16::from(!is_stuck));
        } else {
            self.longest = if is_stuck { self.longest } else { self.longest.max(self.still) };
            self.still = 0;
            self.lives += u16::from(self.lives < MOST);
        }
        if off > self.least || self.is_stuck() {
            self.gate(off);
        } else {
            self.jumped = self.jumped.saturating_sub(1);
            self.accept();
        }
        self.is_dull = self.lives == 0;
        let is_usual = self.is_dull || (self.lives == MOST && self.still == 0);
        self.is_calm = is_usual && self.jumped == 0 && !self.is_lost();
    }

    /// Accepts the latest increment.
    fn accept(&mut self) {
        self.before = self.shown;
        self.lost = [0; 2];
    }

    /// Handles an increment that may be wrong.
    fn gate(&mut self, off: u32) {
        let is_jump = off > self.least.max(self.before.0.unsigned_abs() / JUMP_PART);
        self.jumped = self.jumped.saturating_add(u16::from(is_jump));
        let is_stuck = self.is_stuck();
        if !self.shown.is_saturated() && !is_stuck && (!is_jump || self.jumped > MOST_JUMPS) {
            return self.accept();
        }
        let [_, known] = self.lost;
        // A stuck gyro is detected late, so the repetitions count as lost.
        let late = if known == 0 && is_stuck { self.still as u16 } else { 1 };
        self.lost = [known, known.saturating_add(late)];
    }

    /// Whether the rotation of the latest sample is unknown.
    #[inline]
    pub(super) fn is_lost(&self) -> bool {
        self.lost[1] > 0
    }

    /// Lengths of the run with unknown rotation, before the latest sample and with it.
    pub(super) fn lost(&self) -> [f32; 2] {
        self.lost.map(f32::from)
    }

    /// Deviation of a reading that may be right, in steps of an increment: zero where it is stuck
    /// or saturated.
    pub(super) fn off(&self) -> f32 {
        let is_wrong = self.shown.is_saturated() || self.is_stuck();
        if is_wrong { 0.0 } else { self.shown.0.wrapping_sub(self.before.0).unsigned_abs() as f32 }
    }

    /// Whether the gyro repeats one identical value.
    pub(super) fn is_stuck(&self) -> bool {
        let longer = LONGER.saturating_mul(self.longest);
        self.is_lively && self.lives >= LIVES && self.still >= STILL.max(longer)
    }

    /// Number of repetitions; `None` for a live gyro, or a saturated one.
    pub(super) fn stuck(&self) -> Option<u32> {
        (self.is_stuck() && !self.shown.is_saturated()).then_some(self.still)
    }
}

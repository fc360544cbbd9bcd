//! Whether the gyro can be believed: increments that clip, that jump as no body does, or that stay what they are.

use super::Setting;
use crate::units::AngleIncrement;

/// Samples without any change after which a gyro that has noise is stuck.
const STILL: u32 = 32;
/// How many times as many they are as ever before.
const LONGER: u32 = 2;
/// Samples that must have changed, more than not, before it is known to live, and the most that are counted.
const LIVES: u16 = 128;
const MOST: u16 = 512;
/// Jumps on end after which they are believed: enough to see first whether it is stuck where it jumped to.
const PATIENCE: u16 = 128;
/// Steps of noise from which a gyro that lives does not repeat itself.
const LIVELY: f64 = 8.0;
/// Least jump, rad in a sample, standard deviations of the noise, and part of the rate.
const JUMP: f64 = 1e-3;
const JUMP_SIGMAS: f64 = 12.0;
const JUMP_PART: u32 = 16;

/// The gyro's increments, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Timing {
    /// The latest that was believed.
    before: AngleIncrement,
    /// The latest, believed or not, and how many were as it is.
    shown: AngleIncrement,
    still: u32,
    /// The most that were alike before: a coarse gyro that turns slowly repeats itself too.
    longest: u32,
    /// Samples that changed, less those that did not.
    lives: u16,
    /// Jumps on end, less what was good meanwhile. At the beginning none is known to be one.
    jumped: u16,
    /// Change from which an increment may be a jump, in its steps.
    least: u32,
    /// Samples on end of which the rotation is not known, before the latest and with it.
    lost: [u16; 2],
    /// Whether its noise keeps a gyro that lives from repeating itself.
    is_lively: bool,
    /// Whether all of this is as it should be, of a gyro that lives or of one that never did.
    is_calm: bool,
    is_dull: bool,
}

impl Timing {
    pub(super) fn new(setting: &Setting) -> Self {
        let noise = setting.angle_random_walk * libm::sqrt(setting.sample_seconds);
        Self {
            before: AngleIncrement(0),
            shown: AngleIncrement(0),
            still: 0,
            longest: 0,
            lives: 0,
            jumped: PATIENCE,
            least: (JUMP.max(JUMP_SIGMAS * noise) / AngleIncrement::STEP) as u32,
            lost: [0; 2],
            is_lively: noise > LIVELY * AngleIncrement::STEP,
            is_calm: false,
            is_dull: true,
        }
    }

    /// What the body is taken to turn where the gyro shows this.
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

    /// Takes one that is not as usual, or comes after such.
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
            self.doubt(off);
        } else {
            self.jumped = self.jumped.saturating_sub(1);
            self.believe();
        }
        self.is_dull = self.lives == 0;
        let is_usual = self.is_dull || (self.lives == MOST && self.still == 0);
        self.is_calm = is_usual && self.jumped == 0 && !self.is_lost();
    }

    fn believe(&mut self) {
        self.before = self.shown;
        self.lost = [0; 2];
    }

    /// Takes one that may not be what the body turned.
    fn doubt(&mut self, off: u32) {
        let is_jump = off > self.least.max(self.before.0.unsigned_abs() / JUMP_PART);
        self.jumped = self.jumped.saturating_add(u16::from(is_jump));
        let is_stuck = self.is_stuck();
        if !self.shown.is_saturated() && !is_stuck && (!is_jump || self.jumped > PATIENCE) {
            return self.believe();
        }
        let [_, known] = self.lost;
        // That it is stuck is seen late.
        let late = if known == 0 && is_stuck { self.still as u16 } else { 1 };
        self.lost = [known, known.saturating_add(late)];
    }

    /// What the body was taken to turn in the latest sample.
    pub(super) fn before(&self) -> AngleIncrement {
        self.before
    }

    /// Whether the rotation of the latest sample is not known.
    #[inline]
    pub(super) fn is_lost(&self) -> bool {
        self.lost[1] > 0
    }

    /// Of how many samples on end it is not, before the latest and with it.
    pub(super) fn lost(&self) -> [f32; 2] {
        self.lost.map(f32::from)
    }

    /// How far the gyro shows something else that may be right, in its steps: neither stuck nor clipped.
    pub(super) fn off(&self) -> f32 {
        let is_wrong = self.shown.is_saturated() || self.is_stuck();
        if is_wrong { 0.0 } else { self.shown.0.wrapping_sub(self.before.0).unsigned_abs() as f32 }
    }

    /// Whether the gyro shows the same again and again.
    pub(super) fn is_stuck(&self) -> bool {
        let longer = LONGER.saturating_mul(self.longest);
        self.is_lively && self.lives >= LIVES && self.still >= STILL.max(longer)
    }

    /// For how many samples it has shown the same; none of one that lives, or that clips.
    pub(super) fn stuck(&self) -> Option<u32> {
        (self.is_stuck() && !self.shown.is_saturated()).then_some(self.still)
    }
}

//! Whether the gyro can be believed: increments that clip, that jump as no body does, or that stay what they are.

use super::Setting;
use crate::units::AngleIncrement;

/// Samples without any change after which a gyro that has noise is stuck.
const STILL: u32 = 32;
/// Samples without any change that are remembered at most, and how many times as many are those of a gyro that is stuck.
const LONGEST: u32 = 256;
const LONGER: u32 = 2;
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
pub(super) struct Pace {
    /// The latest that was believed.
    before: AngleIncrement,
    /// The latest, believed or not, and how many were as it is.
    shown: AngleIncrement,
    still: u32,
    /// The most that were alike, up to [`LONGEST`]: a coarse gyro that turns slowly repeats itself too.
    longest: u32,
    /// Jumps on end, less what was good meanwhile. At the beginning none is known to be one.
    jumped: u16,
    /// Change from which an increment may be a jump, in its steps.
    least: u32,
    /// Samples of which the rotation is not known, on end.
    lost: u16,
    /// Whether its noise keeps a gyro that lives from repeating itself.
    is_lively: bool,
}

/// What becomes of an increment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Believed {
    /// What the body is taken to have turned.
    pub(super) turned: AngleIncrement,
    /// Samples on end of which the rotation is not known, before this one and with it.
    pub(super) lost: [u16; 2],
    /// Whether that is so because the gyro shows the same again and again: it was right when it began to.
    pub(super) is_stuck: bool,
    /// How far it shows something else, in its steps: that may be right.
    pub(super) off: u32,
}

impl Believed {
    #[inline]
    fn right(turned: AngleIncrement) -> Self {
        Self { turned, lost: [0; 2], is_stuck: false, off: 0 }
    }
}

impl Pace {
    pub(super) fn new(setting: &Setting) -> Self {
        let noise = setting.angle_random_walk * libm::sqrt(setting.sample_seconds);
        Self {
            before: AngleIncrement(0),
            shown: AngleIncrement(0),
            still: 0,
            longest: 0,
            jumped: PATIENCE,
            least: (JUMP.max(JUMP_SIGMAS * noise) / AngleIncrement::STEP) as u32,
            lost: 0,
            is_lively: noise > LIVELY * AngleIncrement::STEP,
        }
    }

    /// Takes an increment.
    #[inline]
    pub(super) fn take(&mut self, turned: AngleIncrement) -> Believed {
        let change = turned.0.wrapping_sub(self.shown.0).unsigned_abs();
        let off = turned.0.wrapping_sub(self.before.0).unsigned_abs();
        self.shown = turned;
        if change <= 1 {
            self.still = self.still.saturating_add(1);
        } else if self.still > 0 {
            self.longest = self.longest.max(self.still.min(LONGEST));
            self.still = 0;
        }
        if off > self.least || self.is_stuck() {
            return self.doubt(turned);
        }
        self.before = turned;
        self.jumped = self.jumped.saturating_sub(1);
        self.lost = 0;
        Believed::right(turned)
    }

    /// Takes one that may not be what the body turned.
    #[inline(never)]
    fn doubt(&mut self, turned: AngleIncrement) -> Believed {
        let off = turned.0.wrapping_sub(self.before.0).unsigned_abs();
        let is_jump = off > self.least.max(self.before.0.unsigned_abs() / JUMP_PART);
        let is_clipped = turned.is_saturated();
        self.jumped = if is_jump { self.jumped.saturating_add(1) } else { self.jumped };
        if !is_clipped && !self.is_stuck() && (!is_jump || self.jumped > PATIENCE) {
            self.before = turned;
            self.lost = 0;
            return Believed::right(turned);
        }
        let (known, is_stuck) = (self.lost, self.is_stuck());
        // That it is stuck is seen late.
        let late = if known == 0 && is_stuck { self.still as u16 } else { 1 };
        self.lost = self.lost.saturating_add(late);
        let off = if is_clipped || is_stuck { 0 } else { off };
        Believed { turned: self.before, lost: [known, self.lost], is_stuck, off }
    }

    /// What the body is taken to turn in a sample.
    pub(super) fn before(&self) -> AngleIncrement {
        self.before
    }

    /// Whether the gyro shows the same again and again.
    #[inline]
    fn is_stuck(&self) -> bool {
        self.is_lively && self.still >= STILL.max(LONGER * self.longest)
    }

    /// For how many samples it has shown the same; none of one that lives or has no noise to tell by.
    pub(super) fn stuck(&self) -> Option<u32> {
        (self.is_stuck() && !self.shown.is_saturated()).then_some(self.still)
    }
}

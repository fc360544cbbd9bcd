//! The angle that the gyro shows, corrected: whole turns and 2⁻⁴⁰ of one in an integer.

use crate::units::{Angle, AngleIncrement, TURN};

/// Bits of a turn's fraction.
const FRACTION: u32 = 40;
/// Bits of what is carried below it.
const CARRIED: u32 = 24;
/// One step of an increment in 2⁻⁶⁴ turns, of a gyro without scale error: 34 bits.
const STEP: f64 = AngleIncrement::STEP / TURN * 18_446_744_073_709_551_616.0;
/// Greatest increment that is believed, in its steps: a radian a sample.
const GREATEST: i32 = 1 << 28;

/// A roll: whole turns since the first sample, and what is more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Roll {
    /// Whole turns, rounded down.
    pub turns: i32,
    /// What is more.
    pub angle: Angle,
}

impl Roll {
    /// All of it, rad, not wrapped.
    #[must_use]
    pub fn rad(self) -> f64 {
        f64::from(self.turns) * TURN + self.angle.rad()
    }
}

/// The angle at work.
#[derive(Clone, Debug)]
pub(super) struct PhaseAccumulator {
    /// 2⁻⁴⁰ of a turn.
    angle: i64,
    /// What is less, 2⁻⁶⁴ of a turn.
    carried: i64,
    /// One step of an increment, scale error taken off, 2⁻⁶⁴ of a turn.
    step: i64,
    /// What the latest sample turned, 2⁻⁴⁰ of a turn.
    turned: i64,
}

impl PhaseAccumulator {
    pub(super) fn new() -> Self {
        Self { angle: 0, carried: 0, step: STEP as i64, turned: 0 }
    }

    /// Turns by what the gyro shows.
    #[inline]
    pub(super) fn turn(&mut self, shown: AngleIncrement) {
        let steps = if shown.0.abs() > GREATEST { GREATEST * shown.0.signum() } else { shown.0 };
        let whole = i64::from(steps) * self.step + self.carried;
        self.turned = whole >> CARRIED;
        self.carried = whole & ((1 << CARRIED) - 1);
        self.angle = self.angle.wrapping_add(self.turned);
    }

    /// Turns by so many samples of the same increment, in its steps.
    pub(super) fn pass(&mut self, shown: f32, samples: f32) {
        let turns = f64::from(shown) * f64::from(samples) * self.step as f64;
        self.angle = self.angle.wrapping_add((turns / f64::from(1 << CARRIED)) as i64);
    }

    /// Takes off another part of what the gyro shows.
    pub(super) fn scale(&mut self, part: f64) {
        self.step = (STEP * (1.0 - part)) as i64;
    }

    /// Turns further by an angle, rad.
    pub(super) fn correct(&mut self, angle: f64) {
        let steps = angle / TURN * (1u64 << FRACTION) as f64;
        self.angle = self.angle.wrapping_add(steps as i64);
    }

    /// Sets the angle to one of the turn, rad, by the shorter way.
    pub(super) fn set(&mut self, angle: Angle) {
        let off = (angle - self.angle()).0.cast_signed();
        self.angle = self.angle.wrapping_add(i64::from(off) << (FRACTION - 32));
    }

    /// The angle within its turn.
    #[inline]
    pub(super) fn angle(&self) -> Angle {
        Angle((self.angle >> (FRACTION - 32)) as u32)
    }

    pub(super) fn roll(&self) -> Roll {
        Roll { turns: (self.angle >> FRACTION) as i32, angle: self.angle() }
    }

    /// All of the angle, 2⁻⁴⁰ of a turn.
    #[inline]
    pub(super) fn whole(&self) -> i64 {
        self.angle
    }

    /// What the latest sample turned, 2⁻³² of a turn.
    #[inline]
    pub(super) fn step(&self) -> i32 {
        (self.turned >> (FRACTION - 32)) as i32
    }

    /// From one angle to another, rad.
    pub(super) fn between(from: i64, to: i64) -> f32 {
        to.wrapping_sub(from) as f32 * (TURN / (1u64 << FRACTION) as f64) as f32
    }
}

/// Sine and cosine of an angle, to 4e-7.
#[inline]
pub(super) fn sine_and_cosine(angle: Angle) -> [f32; 2] {
    // The nearest quarter, and what is left: an eighth of a turn to either side.
    let quarter = angle.0.wrapping_add(1 << 29) >> 30;
    let left = angle.0.wrapping_sub(quarter << 30).cast_signed();
    let x = left as f32 * (Angle::STEP as f32);
    let square = x * x;
    let sine = x * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0)));
    let cosine =
        1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40320.0)));
    match quarter & 3 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    }
}

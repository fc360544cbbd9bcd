//! Corrected gyro angle: whole turns and 2⁻⁴⁰ of a turn in an integer.

use crate::units::{Angle, AngleIncrement, TURN};

/// Number of bits of a turn's fraction.
const FRACTION: u32 = 40;
/// Number of bits carried below the fraction.
const CARRIED: u32 = 24;
/// Size of an increment's step without scale error, in 2⁻⁶⁴ of a turn: 34 bits.
const STEP: f64 = AngleIncrement::STEP / TURN * 18_446_744_073_709_551_616.0;
/// Greatest increment that is applied, in its steps: one radian per sample.
const GREATEST: i32 = 1 << 28;

/// Roll: whole turns since the first sample, and the angle within the turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Roll {
    /// Number of whole turns, rounded down.
    pub turns: i32,
    /// Angle within the turn.
    pub angle: Angle,
}

impl Roll {
    /// Total angle, rad, not wrapped.
    #[must_use]
    pub fn rad(self) -> f64 {
        f64::from(self.turns) * TURN + self.angle.rad()
    }
}

/// Accumulator of the angle.
#[derive(Clone, Debug)]
pub(super) struct PhaseAccumulator {
    /// Angle, in 2⁻⁴⁰ of a turn.
    angle: i64,
    /// Remainder below it, in 2⁻⁶⁴ of a turn.
    carried: i64,
    /// Size of an increment's step with the scale error removed, in 2⁻⁶⁴ of a turn.
    step: i64,
    /// Rotation of the latest sample, in 2⁻⁴⁰ of a turn.
    turned: i64,
}

impl PhaseAccumulator {
    /// Accumulator at zero, without scale error.
    pub(super) fn new() -> Self {
        Self { angle: 0, carried: 0, step: STEP as i64, turned: 0 }
    }

    /// Adds an increment of the gyro.
    #[inline]
    pub(super) fn turn(&mut self, shown: AngleIncrement) {
        let steps = if shown.0.abs() > GREATEST { GREATEST * shown.0.signum() } else { shown.0 };
        let whole = i64::from(steps) * self.step + self.carried;
        self.turned = whole >> CARRIED;
        self.carried = whole & ((1 << CARRIED) - 1);
        self.angle = self.angle.wrapping_add(self.turned);
    }

    /// Adds this many samples of the same increment, given in its steps.
    pub(super) fn pass(&mut self, shown: f32, samples: f32) {
        let turns = f64::from(shown) * f64::from(samples) * self.step as f64;
        self.angle = self.angle.wrapping_add((turns / f64::from(1 << CARRIED)) as i64);
    }

    /// Sets the part of the gyro's reading that is removed as scale error.
    pub(super) fn scale(&mut self, part: f64) {
        self.step = (STEP * (1.0 - part)) as i64;
    }

    /// Adds an angle, rad.
    pub(super) fn correct(&mut self, angle: f64) {
        let steps = angle / TURN * (1u64 << FRACTION) as f64;
        self.angle = self.angle.wrapping_add(steps as i64);
    }

    /// Sets the angle within the turn, by the shorter way.
    pub(super) fn set(&mut self, angle: Angle) {
        let off = (angle - self.angle()).0.cast_signed();
        self.angle = self.angle.wrapping_add(i64::from(off) << (FRACTION - 32));
    }

    /// Angle within the turn.
    #[inline]
    pub(super) fn angle(&self) -> Angle {
        Angle((self.angle >> (FRACTION - 32)) as u32)
    }

    /// Turns and angle.
    pub(super) fn roll(&self) -> Roll {
        Roll { turns: (self.angle >> FRACTION) as i32, angle: self.angle() }
    }

    /// Total angle, in 2⁻⁴⁰ of a turn.
    #[inline]
    pub(super) fn whole(&self) -> i64 {
        self.angle
    }

    /// Rotation of the latest sample, in 2⁻³² of a turn.
    #[inline]
    pub(super) fn step(&self) -> i32 {
        (self.turned >> (FRACTION - 32)) as i32
    }

    /// Difference of two total angles, rad.
    pub(super) fn between(from: i64, to: i64) -> f32 {
        to.wrapping_sub(from) as f32 * (TURN / (1u64 << FRACTION) as f64) as f32
    }
}

/// Sine and cosine of an angle, to 4e-7.
#[inline]
pub(super) fn sine_and_cosine(angle: Angle) -> [f32; 2] {
    // Nearest quarter turn, and the remainder of at most an eighth of a turn to either side.
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

//! Attitude that is propagated for hours in integers: a quaternion in steps of 2⁻⁶².
//!
//! A software `f64` product takes ninety instructions on a Cortex-M4, a product of 32 by 32 bits
//! with a 64-bit sum takes one. A quaternion of `f32` would lose every rotation below 6e-8, which
//! is the size of the Earth's rotation between two samples. Here a rotation is given as `f32`, with
//! a relative error of 6e-8, or as increments of angle, and nothing of it is lost.

use core::array;

use crate::math::rotation::{self, dot};
use crate::units::AngleIncrement;

/// Value of one, in steps of the stored components.
const ONE: i64 = 1 << 62;
/// Size of a step of the components' upper words.
const UPPER: f32 = 1.0 / (1u32 << 30) as f32;
/// Bits of the steps, of which 2ᴮ are a radian, in which half a rotation is taken.
const FINE: u32 = 35;
/// Largest rotation applied at once, rad: up to it the series are accurate to 3e-11, and half of it is less than 2³¹ steps.
const LARGEST: f32 = 0.1;
/// Bits of the steps of a small rotation: of the Earth's rotation in 20 ms, a step is 6e-7.
const FINER: u32 = 41;
/// Largest rotation that is taken in the finer steps, rad.
const SMALL: f32 = LARGEST / (1 << (FINER - FINE)) as f32;
/// No increment about any axis.
const NONE: [AngleIncrement; 3] = [AngleIncrement(0); 3];
/// Greatest number of pieces of a rotation: a turn and a half.
const PIECES: u32 = 100;
/// Distance from the vertical within which a body counts as standing on end, rad: rounding then
/// leaves 1e-8 of course and roll.
const ON_END: f64 = 1e-8;

/// Rotation from body axes (forward, right, down) to those of a frame, as a quaternion (w, x, y,
/// z).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attitude([i64; 4]);

/// A vector in single precision.
pub(crate) type Vector = [f32; 3];

/// A 3×3 matrix in single precision, row by row.
pub type Matrix = [Vector; 3];

impl Default for Attitude {
    fn default() -> Self {
        Self([ONE, 0, 0, 0])
    }
}

impl Attitude {
    /// Attitude from a unit quaternion (w, x, y, z).
    #[must_use]
    pub fn new(parts: [f64; 4]) -> Self {
        Self(parts.map(|part| libm::round(part * ONE as f64) as i64))
    }

    /// Components of the quaternion (w, x, y, z).
    #[must_use]
    pub fn parts(&self) -> [f64; 4] {
        self.0.map(|part| part as f64 / ONE as f64)
    }

    /// Rotates the body about its own axes by a rotation vector, rad; rotation beyond a turn and a
    /// half is ignored.
    pub fn turn(&mut self, rotation: &[f32; 3]) {
        let square = dot(rotation, rotation);
        if square <= LARGEST * LARGEST {
            return self.turn_at_once(&NONE, rotation, rotation, square);
        }
        let length = libm::sqrtf(square);
        let pieces = ((length / LARGEST) as u32).saturating_add(1);
        let part = if pieces > PIECES { LARGEST / length } else { 1.0 / pieces as f32 };
        for _ in 0..pieces.min(PIECES) {
            let piece = rotation.map(|turned| part * turned);
            self.turn_at_once(&NONE, &piece, &piece, part * part * square);
        }
    }

    /// Rotates the body about its own axes by increments, and by a vector beside them, rad. Up to 0.1 rad of both,
    /// increments are taken in integers, with a relative error of 1e-9: a sum of turns is off by no scale factor.
    pub fn turn_by(&mut self, increments: &[AngleIncrement; 3], beside: &[f32; 3]) {
        const STEP: f32 = AngleIncrement::STEP as f32;
        let rotation = array::from_fn(|axis| increments[axis].0 as f32 * STEP + beside[axis]);
        let square = dot(&rotation, &rotation);
        if square <= LARGEST * LARGEST {
            self.turn_at_once(increments, beside, &rotation, square);
        } else {
            self.turn(&rotation);
        }
    }

    /// Rotates by increments and a vector beside them, given their sum, which is up to [`LARGEST`], and its squared
    /// length.
    fn turn_at_once(
        &mut self,
        increments: &[AngleIncrement; 3],
        beside: &[f32; 3],
        rotation: &[f32; 3],
        square: f32,
    ) {
        if square <= SMALL * SMALL {
            self.turn_in_steps::<FINER>(halves::<FINER>(increments, beside), rotation, square);
        } else {
            self.turn_in_steps::<FINE>(halves::<FINE>(increments, beside), rotation, square);
        }
    }

    /// Rotates by a rotation vector, given half of it in steps of 2⁻ᴮ rad, and its squared length.
    #[inline]
    fn turn_in_steps<const BITS: u32>(&mut self, half: [i32; 3], rotation: &[f32; 3], square: f32) {
        let steps = (1u64 << BITS) as f32;
        let less = nearest(steps * square * (0.125 - square * (1.0 / 384.0)));
        let shorter = steps * square * (1.0 / 48.0 - square * (1.0 / 3840.0));
        let [x, y, z] = array::from_fn(|axis| half[axis] - nearest(shorter * rotation[axis]));
        let [a, b, c, d] = self.upper();
        let times = |one: i32, other: i32| i64::from(one) * i64::from(other);
        // Products are in steps of 2⁻³⁰ by 2⁻ᴮ.
        let shift = 30 + BITS - 62;
        let [w, i, j, k] = &mut self.0;
        *w -= (times(a, less) + times(b, x) + times(c, y) + times(d, z)) >> shift;
        *i += (times(a, x) - times(b, less) + times(c, z) - times(d, y)) >> shift;
        *j += (times(a, y) - times(b, z) - times(c, less) + times(d, x)) >> shift;
        *k += (times(a, z) + times(b, y) - times(c, x) - times(d, less)) >> shift;
    }

    /// Rotates the frame by a small rotation vector on its own axes, rad, to correct an attitude
    /// error.
    pub fn correct(&mut self, rotation: &[f32; 3]) {
        let mut inverse = self.inverted();
        inverse.turn(&rotation.map(|part| -part));
        *self = inverse.inverted();
    }

    /// Inverse rotation.
    fn inverted(&self) -> Self {
        let Self([w, x, y, z]) = *self;
        Self([w, -x, -y, -z])
    }

    /// Renormalises the quaternion: rounding changes its norm by at most 1e-9 a rotation.
    pub fn normalise(&mut self) {
        let upper = self.upper();
        let square: i64 = upper.iter().map(|&part| i64::from(part) * i64::from(part)).sum();
        // Half of the deficit of the norm, in steps of 2⁻³¹ up to ±2⁻⁵; a larger deficit never
        // occurs.
        let missing = (((1i64 << 60) - square) >> 30).clamp(-(1 << 26), 1 << 26) as i32;
        for (part, upper) in self.0.iter_mut().zip(upper) {
            *part += (i64::from(upper) * i64::from(missing)) << 1;
        }
    }

    /// Rotation matrix, to 1e-7.
    #[must_use]
    pub fn rough_matrix(&self) -> Matrix {
        rotation::matrix(self.rough())
    }

    /// Rotation matrix in double precision, to the deviation of the norm from one.
    #[must_use]
    pub fn matrix(&self) -> rotation::Matrix {
        rotation::matrix(self.parts())
    }

    /// Components in single precision.
    fn rough(&self) -> [f32; 4] {
        let [a, b, c, d] = self.upper();
        [a as f32 * UPPER, b as f32 * UPPER, c as f32 * UPPER, d as f32 * UPPER]
    }

    /// Components in steps of 2⁻³⁰, rounded to nearest.
    #[inline]
    fn upper(&self) -> [i32; 4] {
        let [w, x, y, z] = self.0;
        let upper = |part: i64| ((part + (1 << 31)) >> 32) as i32;
        [upper(w), upper(x), upper(y), upper(z)]
    }
}

/// Half of increments and of a vector beside them, rad, in steps of 2⁻ᴮ rad.
#[inline]
fn halves<const BITS: u32>(increments: &[AngleIncrement; 3], beside: &[f32; 3]) -> [i32; 3] {
    const CUT: u32 = 24;
    // Half an increment in these steps, with bits that are cut off, to 1e-9.
    let half = const { (AngleIncrement::STEP * (1u128 << (BITS - 1 + CUT)) as f64 + 0.5) as i64 };
    let steps = (1u64 << (BITS - 1)) as f32;
    array::from_fn(|axis| {
        let product = i64::from(increments[axis].0) * half + (1 << (CUT - 1));
        (product >> CUT) as i32 + nearest(steps * beside[axis])
    })
}

/// The nearest integer.
#[inline]
fn nearest(number: f32) -> i32 {
    (number + 0.5f32.copysign(number)) as i32
}

/// Course, pitch and roll, rad, of a quaternion (w, x, y, z) from body axes to north, east, down.
/// For a body that stands on end, where course and roll are one angle, the roll is zero.
#[must_use]
pub fn angles([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let (east, north) = (2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z));
    let pitch = libm::asin((2.0 * (w * y - x * z)).clamp(-1.0, 1.0));
    if east * east + north * north < ON_END * ON_END {
        let course = libm::atan2(2.0 * (w * z - x * y), 1.0 - 2.0 * (x * x + z * z));
        return [course, pitch, 0.0];
    }
    let course = libm::atan2(east, north);
    let roll = libm::atan2(2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y));
    [course, pitch, roll]
}

/// Course, pitch and roll, rad, of a rotation matrix from body axes to north, east, down, as [`angles`] has them: of an
/// attitude's to within 3·10⁻⁶ rad, where pitch is within 80°. It takes a tenth of the instructions.
#[must_use]
pub fn angles_of([[north, ..], [east, ..], [forward, right, down]]: &Matrix) -> [f32; 3] {
    let (course, roll) = (libm::atan2f(*east, *north), libm::atan2f(*right, *down));
    [course, libm::asinf((-forward).clamp(-1.0, 1.0)), roll]
}

/// Quaternion (w, x, y, z) of course, pitch and roll, rad.
#[must_use]
pub fn quaternion(angles: [f64; 3]) -> [f64; 4] {
    let [(c, d), (e, f), (g, h)] = angles.map(|angle| {
        let (sine, cosine) = libm::sincos(0.5 * angle);
        (cosine, sine)
    });
    [c * e * g + d * f * h, c * e * h - d * f * g, c * f * g + d * e * h, d * e * g - c * f * h]
}

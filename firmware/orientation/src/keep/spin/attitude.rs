//! The attitude of a spinning body as the paper's Fig. 2 has it: the roll that the gyros carry is overridden by
//! the corrected one, and course and pitch go on from the gyros.

use super::Spin;
use super::phase_accumulator::sine_and_cosine;
use crate::signal::SpinSample;
use crate::units::{Angle, AngleIncrement, wrapped};

/// Samples over which what lies across the spin is summed before course and pitch are told.
const SAMPLES: u32 = 16;
/// Greatest pitch at which there is a course, rad: 89°.
const STEEPEST: f64 = 1.553;

/// Course and pitch; the roll is [`Spin::roll`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Attitude {
    course: f64,
    pitch: f64,
    /// Turned upwards and to the right since they were told, in steps of an increment.
    up: f32,
    right: f32,
    count: u32,
}

impl Attitude {
    /// Begins with course, clockwise from north, and pitch, nose up, rad.
    #[must_use]
    pub fn begin(course: f64, pitch: f64) -> Self {
        Self { course, pitch, ..Self::default() }
    }

    /// Takes a sample after the roll has taken it.
    #[inline]
    pub fn push(&mut self, sample: &SpinSample, spin: &Spin) {
        let [_, y, z] = sample.turned;
        // The roll in the middle of the sample.
        let half = (spin.step() >> 1).cast_unsigned();
        let [sine, cosine] = sine_and_cosine(Angle(spin.roll().angle.0.wrapping_sub(half)));
        if !y.is_saturated() && !z.is_saturated() {
            let (y, z) = (y.0 as f32, z.0 as f32);
            self.up += z * cosine + y * sine;
            self.right += z * sine - y * cosine;
        }
        self.count += 1;
        if self.count == SAMPLES {
            self.tell();
        }
    }

    /// Tells course and pitch what they turned.
    #[inline(never)]
    fn tell(&mut self) {
        let [up, right] =
            [self.up, self.right].map(|steps| f64::from(steps) * AngleIncrement::STEP);
        (self.up, self.right, self.count) = (0.0, 0.0, 0);
        let middle = self.pitch + 0.5 * up;
        self.pitch += up;
        if middle.abs() < STEEPEST {
            self.course = wrapped(self.course + right / libm::cos(middle));
        }
    }

    /// Course, rad, [0, 2π).
    #[must_use]
    pub fn course(&self) -> f64 {
        self.course
    }

    /// Pitch, rad.
    #[must_use]
    pub fn pitch(&self) -> f64 {
        self.pitch
    }
}

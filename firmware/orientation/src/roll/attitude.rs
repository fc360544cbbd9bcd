//! Attitude of a spinning body (Nekrasova 2017, Fig. 2): the roll from the gyro is replaced by the
//! corrected one, and course and pitch are propagated by the transverse gyros.

use super::phase_accumulator::sine_and_cosine;
use super::spin::Spin;
use crate::signal::SpinSample;
use crate::units::{Angle, AngleIncrement, Radians, wrapped};

/// Number of samples over which the transverse rotation is summed before course and pitch are
/// updated.
const SAMPLES: u32 = 16;
/// Greatest pitch up to which a course is propagated, rad: 89°.
const STEEPEST: f32 = 1.553;
/// Steps of an [`Angle`] in a radian.
const STEPS: f32 = (1.0 / Angle::STEP) as f32;

/// Course and pitch of a spinning body; the roll is [`Spin::roll`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Attitude {
    /// Course, clockwise from north.
    pub course: Radians,
    /// Pitch, nose up positive.
    pub pitch: Radians,
    /// Rotation upwards and to the right since the last update, in steps of an increment.
    up: f32,
    right: f32,
    /// Samples since the last update.
    count: u32,
}

impl Attitude {
    /// Begins with course, clockwise from north, and pitch, nose up, both in rad.
    pub(crate) fn begin(course: Radians, pitch: Radians) -> Self {
        Self { course, pitch, ..Self::default() }
    }

    /// Takes a sample, after the roll has been updated with it.
    #[inline]
    pub(crate) fn push(&mut self, sample: &SpinSample, spin: &Spin) {
        let [_, y, z] = sample.turned;
        // Roll in the middle of the sample.
        let half = (spin.step() >> 1).cast_unsigned();
        let [sine, cosine] = sine_and_cosine(Angle(spin.roll().angle.0.wrapping_sub(half)));
        if !y.is_saturated() && !z.is_saturated() {
            let (y, z) = (y.0 as f32, z.0 as f32);
            self.up += z * cosine + y * sine;
            self.right += z * sine - y * cosine;
        }
        self.count += 1;
        if self.count == SAMPLES {
            self.update();
        }
    }

    /// Updates course and pitch with the summed rotation.
    #[inline(never)]
    fn update(&mut self) {
        let [up, right] = [self.up, self.right].map(|steps| steps * AngleIncrement::STEP as f32);
        (self.up, self.right, self.count) = (0.0, 0.0, 0);
        let middle = self.pitch.0 as f32 + 0.5 * up;
        self.pitch.0 += f64::from(up);
        if middle.abs() < STEEPEST {
            // Within a quarter of a turn, so that it fits.
            let middle = Angle(((middle * STEPS) as i32).cast_unsigned());
            let [_, cosine] = sine_and_cosine(middle);
            self.course = Radians(wrapped(self.course.0 + f64::from(right / cosine)));
        }
    }
}

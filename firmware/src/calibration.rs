//! The encoder's own error over a turn, as it was calibrated, taken off every reading.
//!
//! Eccentricity of the magnet shows once per turn, ellipticity twice. The sines are micromath's: they
//! err by less than 2·10⁻³, of a correction of at most some tenths of a degree that is 1″.

use micromath::F32Ext;
use orientation::units::{Angle, TURN};

/// Radians of one step of an [`Angle`].
const STEP: f32 = (TURN / 4_294_967_296.0) as f32;
/// Steps of an [`Angle`] in one radian.
const STEPS: f32 = (4_294_967_296.0 / TURN) as f32;
/// Change of the angle, in steps, below which the correction is kept: a turn's 2¹⁴-th part. A
/// correction of 0.1° changes by less than 0.3″ over it.
const KEPT: u32 = 1 << 18;

/// What the encoder shows beyond the true angle: Σ aₖ sin kθ + bₖ cos kθ, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Harmonics {
    /// a and b once per turn, rad.
    pub first: [f32; 2],
    /// a and b twice per turn, rad.
    pub second: [f32; 2],
}

impl Harmonics {
    /// The error at an angle that the encoder shows, in steps of an [`Angle`].
    fn error(&self, shown: Angle) -> i32 {
        let theta = shown.0.cast_signed() as f32 * STEP;
        let [sine, cosine] = [F32Ext::sin(theta), F32Ext::cos(theta)];
        let [sine2, cosine2] = [2.0 * sine * cosine, 1.0 - 2.0 * sine * sine];
        let [a1, b1] = self.first;
        let [a2, b2] = self.second;
        ((a1 * sine + b1 * cosine + a2 * sine2 + b2 * cosine2) * STEPS) as i32
    }
}

/// A calibrated encoder's correction, which is computed anew only when the angle has changed.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    harmonics: Harmonics,
    at: Angle,
    error: i32,
}

impl Calibration {
    /// The correction for these harmonics.
    #[must_use]
    pub fn new(harmonics: Harmonics) -> Self {
        Self { harmonics, at: Angle(0), error: harmonics.error(Angle(0)) }
    }

    /// The true angle of what the encoder shows.
    pub fn correct(&mut self, shown: Angle) -> Angle {
        if (shown - self.at).0.cast_signed().unsigned_abs() > KEPT {
            self.at = shown;
            self.error = self.harmonics.error(shown);
        }
        Angle(shown.0.wrapping_sub(self.error.cast_unsigned()))
    }
}

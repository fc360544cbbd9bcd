//! Correction of an encoder by its calibrated harmonic errors.
//!
//! An eccentric magnet gives an error once per turn, an elliptic field one twice per turn. The
//! sines are computed by micromath in single precision with an absolute error below 2·10⁻³; of a
//! correction of at most some tenths of a degree that is about 1″, far below the azimuth's σ.

use micromath::F32Ext;
use orientation::units::{Angle, TURN};
use serde::{Deserialize, Serialize};

/// Size of one step of an [`Angle`], rad: 2π/2³².
const STEP: f32 = (TURN / 4_294_967_296.0) as f32;
/// Steps of an [`Angle`] in one radian.
const STEPS: f32 = (4_294_967_296.0 / TURN) as f32;
/// Change of the angle below which the last correction is used again, in steps: 2⁻¹⁴ of a turn,
/// 79″. A correction with an amplitude of 0.1° changes by less than 0.3″ over it.
const KEPT: u32 = 1 << 18;

/// Error of an encoder's reading against the true angle: Σ aₖ sin kθ + bₖ cos kθ, rad, k = 1, 2,
/// with θ the angle that the encoder shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Harmonics {
    /// Amplitudes a₁ and b₁ of the error once per turn, rad.
    pub first: [f32; 2],
    /// Amplitudes a₂ and b₂ of the error twice per turn, rad.
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

/// The correction of a calibrated encoder. The sines are computed again only when the angle has
/// changed by more than 79″.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    /// The calibrated error.
    harmonics: Harmonics,
    /// The angle at which the error was computed last.
    at: Angle,
    /// The error at that angle, in steps of an [`Angle`].
    error: i32,
}

impl Calibration {
    /// Creates the correction for a calibrated error.
    #[must_use]
    pub fn new(harmonics: Harmonics) -> Self {
        Self { harmonics, at: Angle(0), error: harmonics.error(Angle(0)) }
    }

    /// The true angle that belongs to a reading of the encoder.
    pub fn correct(&mut self, shown: Angle) -> Angle {
        if (shown - self.at).0.cast_signed().unsigned_abs() > KEPT {
            self.at = shown;
            self.error = self.harmonics.error(shown);
        }
        Angle(shown.0.wrapping_sub(self.error.cast_unsigned()))
    }
}

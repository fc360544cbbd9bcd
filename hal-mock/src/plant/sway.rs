//! Sway of the base: a few sinusoids of its attitude, as of a vehicle on soft tyres or a moored ship.

use crate::earth::Attitude;
use crate::instruments::BaseMotion;

/// Most sinusoids.
pub const COMPONENTS: usize = 3;

/// One sinusoid: each angle is amplitude·sin(2πft + phase), t from the start of the clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SwayComponent {
    /// Amplitude of the azimuth, °.
    pub azimuth_deg: f64,
    /// Amplitude of the pitch, °.
    pub pitch_deg: f64,
    /// Amplitude of the roll, °.
    pub roll_deg: f64,
    /// Frequency f, Hz; zero switches the component off.
    pub frequency_hz: f64,
    /// Phase at the start, rad.
    pub phase_rad: f64,
}

/// The sway of a base; the default stands still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SwayConfiguration {
    /// The sinusoids, in any order; they add up.
    pub components: [SwayComponent; COMPONENTS],
}

impl SwayConfiguration {
    /// Whether the base moves at all.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.components.iter().any(|component| component.frequency_hz > 0.0)
    }

    /// Lean and its rates at a time in s.
    pub(crate) fn at(&self, time_s: f64) -> BaseMotion {
        let (mut lean, mut rates_rad_s) = ([0.0; 3], [0.0; 3]);
        for c in self.components.iter().filter(|c| c.frequency_hz > 0.0) {
            let angular = core::f64::consts::TAU * c.frequency_hz;
            let (sine, cosine) = libm::sincos(angular * time_s + c.phase_rad);
            let amplitudes = [c.azimuth_deg, c.pitch_deg, c.roll_deg].map(f64::to_radians);
            for (axis, amplitude) in amplitudes.into_iter().enumerate() {
                lean[axis] += amplitude * sine;
                rates_rad_s[axis] += amplitude * angular * cosine;
            }
        }
        let [azimuth_rad, pitch_rad, roll_rad] = lean;
        BaseMotion { lean: Attitude { azimuth_rad, pitch_rad, roll_rad }, rates_rad_s }
    }
}

//! Conversion of the converter's code to the sensor's quantity by one integer multiplication.

use orientation::units::AngularRate;

use super::configuration::Gain;

/// Reference inside the chip, V (section 7.5).
pub const INTERNAL_REFERENCE_VOLTS: f64 = 2.5;

/// Codes in half of the full range.
const CODES: f64 = 2_147_483_648.0;
/// Smallest multiplier: it has 31 significant bits.
const LEAST_MULTIPLIER: f64 = 1_073_741_824.0;
/// Greatest shift for which the sum of product and rounding fits 64 bits.
const GREATEST_SHIFT: u32 = 62;

/// The value of one code as multiplier / 2^shift, in nrad/s or in steps of another unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    multiplier: i32,
    shift: u32,
    /// Half of the last bit that remains after the shift, for rounding.
    half: i64,
}

impl Scale {
    /// The scale of a gyro with a scale factor of `volts_per_rad_per_s` V per rad/s (negative for a
    /// reversed axis), behind a converter with a reference of `reference_volts` V and `gain`.
    ///
    /// The factor is rounded to nearest at 31 bits: relative error ≤ 2⁻³¹. `None` if no scale
    /// exists (zero, not finite) or one code is outside 2⁻³² … 2³⁰ nrad/s.
    #[must_use]
    pub const fn new(volts_per_rad_per_s: f64, reference_volts: f64, gain: Gain) -> Option<Self> {
        Self::of_steps(volts_per_rad_per_s * 1e-9, reference_volts, gain)
    }

    /// The scale of a sensor with `volts_per_step` V per step of its own unit; `None` as for a
    /// gyro.
    #[must_use]
    pub const fn of_steps(volts_per_step: f64, reference_volts: f64, gain: Gain) -> Option<Self> {
        let volts_per_code = reference_volts / (gain.factor() * CODES);
        let factor = volts_per_code / volts_per_step;
        let Some((magnitude, shift)) = normalised(factor.abs()) else { return None };
        let multiplier = if factor < 0.0 { -magnitude } else { magnitude };
        Some(Self { multiplier, shift, half: 1 << (shift - 1) })
    }

    /// The rate of a code, to the nearest nrad/s (ties upwards), saturated at the ends of
    /// [`AngularRate`]. Error ≤ 0.5 nrad/s + |rate| · 2⁻³¹ (tested against `f64`).
    /// Some 30 instructions of a Cortex-M4.
    pub const fn rate(self, code: i32) -> AngularRate {
        AngularRate(self.steps(code))
    }

    /// Converts a code to steps of the sensor's unit, rounded to nearest and saturated at 32 bits.
    #[must_use]
    pub const fn steps(self, code: i32) -> i32 {
        let steps = (code as i64 * self.multiplier as i64 + self.half) >> self.shift;
        if steps > i32::MAX as i64 {
            i32::MAX
        } else if steps < i32::MIN as i64 {
            i32::MIN
        } else {
            steps as i32
        }
    }
}

/// A positive factor as a 31-bit multiplier and the shift that undoes it.
const fn normalised(factor: f64) -> Option<(i32, u32)> {
    let mut value = factor;
    let mut shift = 0;
    while value < LEAST_MULTIPLIER && shift < GREATEST_SHIFT {
        value *= 2.0;
        shift += 1;
    }
    let fits = shift > 0 && value >= LEAST_MULTIPLIER && value < CODES;
    // Just below 2³¹ the conversion saturates, which is still within the bound.
    if fits { Some(((value + 0.5) as i32, shift)) } else { None }
}

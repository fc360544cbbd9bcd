//! A value that changes smoothly, with its rate of change: what motion is put together from.

use core::ops::{Add, Mul};

use crate::stage::minimum_jerk;

/// A value and its derivative in time, per second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Smooth {
    /// The value, any unit.
    pub(super) value: f64,
    /// Change of the value per second.
    pub(super) rate: f64,
}

impl Smooth {
    /// From one value to another of least jerk: it and two derivatives are steady throughout.
    pub(super) fn blend(from: f64, to: f64, seconds: f64, elapsed_s: f64) -> Self {
        let state = minimum_jerk(from, to, seconds, elapsed_s);
        Self { value: state.angle_rad, rate: state.rate_rad_s }
    }

    /// amplitude·sin(2πft + phase).
    pub(super) fn wave(amplitude: f64, frequency_hz: f64, phase_rad: f64, elapsed_s: f64) -> Self {
        if amplitude == 0.0 {
            return Self::default();
        }
        let angular = core::f64::consts::TAU * frequency_hz;
        let (sine, cosine) = libm::sincos(angular * elapsed_s + phase_rad);
        Self { value: amplitude * sine, rate: amplitude * angular * cosine }
    }

    /// A spring that is struck: sin(2πft)·exp(−t/τ), whose first half period comes in gently.
    pub(super) fn bounce(frequency_hz: f64, decay_s: f64, elapsed_s: f64) -> Self {
        // Twenty time constants leave 2·10⁻⁹.
        if !(0.0..20.0 * decay_s).contains(&elapsed_s) {
            return Self::default();
        }
        let left = libm::exp(-elapsed_s / decay_s);
        let dying = Self { value: left, rate: -left / decay_s };
        let onset = Self::blend(0.0, 1.0, 0.5 / frequency_hz, elapsed_s);
        Self::wave(1.0, frequency_hz, 0.0, elapsed_s) * dying * onset
    }

    /// This value and its rate times a constant factor.
    pub(super) fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, rate: self.rate * factor }
    }
}

impl Add for Smooth {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, rate: self.rate + other.rate }
    }
}

impl Mul for Smooth {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            rate: self.rate * other.value + self.value * other.rate,
        }
    }
}

//! Sensor errors that show in the circle of the transverse forces.
//!
//! An accelerometer axis that leans by δ towards the other shifts the phase by δ/2 and adds a
//! component rotating against the lift, of which δ/2 is perpendicular to it; the forces do not show
//! which of the two leans. A scale error adds a component along the lift and shifts nothing. A gyro
//! whose rate varies by h twice a turn adds h/4 against the lift, and h/4 three times a turn, which
//! no accelerometer error does; its angle is off by up to h/2.

use super::fit::Fit;
use super::harmonics::Complex;

/// Fading of the averages at each evaluation.
const FADING: f32 = 1.0 / 1024.0;
/// Squared significance limit of one number.
const ONE: f32 = 6.0;
/// Squared significance limit of two numbers together.
const TWO: f32 = 9.0;

/// Running averages over the evaluations.
#[derive(Clone, Debug, Default)]
pub(super) struct Circle {
    /// Part of the counter-rotating force that is perpendicular to the lift, relative to the lift.
    lean: f32,
    /// Part rotating three times a turn, relative to the lift.
    swell: Complex,
    /// Inverse variance of either part of [`Self::swell`].
    weight: f32,
}

impl Circle {
    /// Adds an evaluation with this noise variance of a sample, both forces together, (m/s²)².
    pub(super) fn take(&mut self, fit: &Fit, noise: f32) {
        let inverse = 1.0 / fit.lift.power();
        let swell = fit.lift.against(fit.ripple.thrice()).scaled(inverse);
        let ellipse = (fit.ripple.against() * fit.lift).scaled(inverse) + swell.conjugate();
        let weight = 2.0 * fit.count / (noise * inverse);
        self.weight += weight - FADING * self.weight;
        let gain = weight / self.weight;
        self.lean += gain * (ellipse.im - self.lean);
        self.swell += (swell - self.swell).scaled(gain);
    }

    /// Contribution to the roll's variance, rad².
    pub(super) fn variance(&self) -> f32 {
        if self.weight <= 0.0 {
            return 0.0;
        }
        let chance = 1.0 / self.weight;
        let lean = self.lean * self.lean - 2.0 * ONE * chance;
        let swell = self.swell.power() - TWO * chance;
        lean.max(0.0) + 2.0 * swell.max(0.0)
    }
}

//! What the circle of the forces tells of the sensors.
//!
//! An accelerometer that leans by δ towards the other turns the phase by δ/2 and adds a part against the lift of which
//! δ/2 stands across it; which of the two leans is not told. One that is too large adds a part along it and turns
//! nothing. A gyro whose rate swells by h twice a turn adds h/4 against the lift, and h/4 three times a turn, which no
//! accelerometer does; its angle is off by up to h/2.

use super::complex::Complex;
use super::fit::Fit;

/// How much of what was seen is forgotten at each look.
const FORGOTTEN: f32 = 1.0 / 1024.0;
/// Squares of standard deviations that chance may make: of one number, and of two together.
const ONE: f32 = 6.0;
const TWO: f32 = 9.0;

/// Means over the looks.
#[derive(Clone, Debug, Default)]
pub(super) struct Circle {
    /// What stands across the lift of what goes round against it, part of the lift.
    lean: f32,
    /// What goes round three times a turn, part of the lift.
    swell: Complex,
    /// One over the variance of either part of [`Self::swell`].
    weight: f32,
}

impl Circle {
    /// Takes what a look shows, with such a noise of a sample, both forces together, (m/s²)².
    pub(super) fn take(&mut self, fit: &Fit, noise: f32) {
        let inverse = 1.0 / fit.lift.power();
        let swell = fit.lift.against(fit.ripple.thrice()).scaled(inverse);
        let ellipse = fit.ripple.against().times(fit.lift).scaled(inverse) + swell.conjugate();
        let weight = 2.0 * fit.count / (noise * inverse);
        self.weight += weight - FORGOTTEN * self.weight;
        let gain = weight / self.weight;
        self.lean += gain * (ellipse.imaginary - self.lean);
        self.swell += (swell - self.swell).scaled(gain);
    }

    /// What it adds to the roll's variance, rad².
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

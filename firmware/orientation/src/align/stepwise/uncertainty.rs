//! Where the standard deviation comes from: the limit, the budget, what tilt and κ leave.

use super::super::budget::Budget;
use super::super::direction::{Amplitude, Direction, dot, product, quadratic};
use super::super::regression::{COLUMNS, Column, Regression};
use super::{Fit, Model, Problem, block};
use crate::math::chi_square_tail;
use crate::signal::dwell::Dwell;

/// Probability of the residuals below which their excess over the stated noise raises σ: with few
/// degrees of freedom, where a disturbed dwell hides easily, and with more.
const EXCESS_PROBABILITY: [f64; 2] = [0.02, 1e-3];
/// Degrees of freedom that are few.
pub const FEW_DEGREES: usize = 3;

/// A symmetric 2×2 covariance of the components, in units of `Ω_h`².
pub(super) type Covariance = [[f64; 2]; 2];

impl Problem<'_> {
    /// The bound that noise sets for these columns when all stationary time counts fully, and the
    /// same with the Earth rate free.
    #[inline(never)]
    pub(super) fn limits(&self, model: &Model) -> Option<[f64; 2]> {
        let regression = self.regression(&self.setting.noise, |_| 1.0);
        let components = self.noise_components(&regression.solve(&model.columns())?);
        let sigma = |direction: Direction| libm::sqrt(direction.variance);
        Some([components.direction(model.amplitude).map(sigma)?, components.free().map(sigma)?])
    }

    /// Splits the variance: what the dwells' noise does through the gain, what tilt and κ do, and
    /// the rest, which is the amplitude's prior.
    #[inline(never)]
    pub(super) fn budget(
        &self,
        coloured: &Regression<COLUMNS>,
        model: &Model,
        direction: &Direction,
    ) -> Option<Budget> {
        let through = |covariance: &Covariance| quadratic(covariance, direction.gain).max(0.0);
        let of = |regression: &Regression<COLUMNS>, model: &Model| {
            regression.solve(&model.columns()).map(|solution| through(&block(&solution.covariance)))
        };
        let white = self.regression(&self.setting.noise.white_part(), Dwell::taper_factor);
        let cold = Model { temperature: Column::Absent, ..*model };
        let all = of(coloured, model)?;
        let drifting = of(coloured, &cold)?.min(all);
        let noise = of(&white, &Model { time: Column::Absent, ..cold })?.min(drifting);
        let [kappa, tilt] = self.component_errors().map(|covariance| through(&covariance));
        let amplitude = (direction.variance - all - kappa - tilt).max(0.0);
        let share = self.scale_share();
        Some(Budget {
            noise: libm::sqrt(noise),
            drift: libm::sqrt(drifting - noise),
            temperature: libm::sqrt(all - drifting),
            displacement: 0.0,
            scale: libm::sqrt(amplitude * share),
            latitude: libm::sqrt(amplitude * (1.0 - share)),
            g_sensitivity: libm::sqrt(kappa),
            accelerometer: libm::sqrt(tilt),
            encoder: self.setting.encoder_sigma,
        })
    }

    /// Which part of the amplitude's variance is the scale factor's.
    fn scale_share(&self) -> f64 {
        let share = self.setting.scale_sigma / self.setting.amplitude_sigma().max(1e-30);
        if self.setting.amplitude_sigma() > 0.0 { share * share } else { 1.0 }
    }

    /// Covariance of the components from κ and from the tilt: both turn with the stage as the Earth
    /// rate does, so the dwells cannot tell them from it.
    ///
    /// A tilt phasor F shifts them by `(Ω_v + κ)F/Ω_h`, as complex numbers. In two frames it meets
    /// `k_s` alone; the other parts of κ meet the vertical force ([`super::super::mount`]).
    pub(super) fn component_errors(&self) -> [Covariance; 2] {
        let rate = self.setting.latitude.horizontal_rate();
        let (force, across) = if self.setting.mount.is_on_base {
            (1.0, 0.0)
        } else {
            (self.tilt.magnitude(), self.setting.g_sensitivity[1])
        };
        let kappa = self.setting.g_sensitivity_sigma * force / rate;
        let real = (self.setting.latitude.vertical_rate() + self.setting.g_sensitivity[0]) / rate;
        let imaginary = across / rate;
        let rows = [[real, -imaginary], [imaginary, real]];
        let tilt = rows.map(|row| {
            let half = product(&self.tilt.covariance, row);
            [dot(rows[0], half), dot(rows[1], half)]
        });
        [[[kappa * kappa, 0.0], [0.0, kappa * kappa]], tilt]
    }

    /// 1σ of the Earth-rate ratio that `free` found: all of the components', scale and latitude.
    pub(super) fn ratio_sigma(&self, free: &Direction) -> f64 {
        let amplitude = self.setting.amplitude_sigma();
        libm::sqrt(free.amplitude_variance + amplitude * amplitude)
    }
}

/// By how much residuals of this chi-square scatter more than the stated noise, as a factor of its
/// standard deviation; one where that may be chance.
fn excess(chi_square: f64, degrees: usize) -> f64 {
    let least = EXCESS_PROBABILITY[usize::from(degrees > FEW_DEGREES)];
    let freedom = degrees as f64;
    let is_chance = degrees == 0 || chi_square_tail(chi_square, freedom) >= least;
    if is_chance { 1.0 } else { libm::sqrt(chi_square / freedom) }
}

impl Fit {
    /// Raises what the dwells' noise contributes where they scatter more than it explains.
    pub(super) fn allow_for_excess(&mut self) {
        let factor = excess(self.chi_square, self.degrees);
        self.budget.noise *= factor;
        self.budget.drift *= factor;
    }

    /// Whether the horizontal Earth rate was left free.
    #[must_use]
    pub fn earth_rate_is_free(&self) -> bool {
        self.model.amplitude == Amplitude::Free
    }
}

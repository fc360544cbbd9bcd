//! Where the standard deviation comes from: the limit, the budget, what tilt and κ leave.

use super::super::budget::Budget;
use super::super::direction::{Amplitude, Direction, dot, product, quadratic};
use super::super::regression::{COLUMNS, Column, Regression};
use super::{Bent, Fit, Model, Problem, Trial, block};
use crate::math::chi_square_tail;
use crate::noise::model::GyroNoise;
use crate::signal::dwell::Dwell;

/// Probability of the residuals below which their excess over the stated noise raises σ: with few degrees of
/// freedom, where it would do so by far, and with more.
const EXCESS_PROBABILITY: [f64; 2] = [0.02, 0.05];
/// Degrees of freedom that are few.
pub const FEW_DEGREES: usize = 3;

/// A symmetric 2×2 covariance of the components, in units of `Ω_h`².
pub(super) type Covariance = [[f64; 2]; 2];

impl Problem<'_> {
    /// The bound that noise sets for these columns when all stationary time counts fully, and the
    /// same with the Earth rate free.
    #[inline(never)]
    pub(super) fn limits(&self, model: &Model, bent: &Bent) -> Option<[f64; 2]> {
        let regression = self.regression(&self.setting.noise, |_| 1.0, bent);
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
        bent: &Bent,
    ) -> Option<Budget> {
        let through = |covariance: &Covariance| quadratic(covariance, direction.gain).max(0.0);
        let of = |regression: &Regression<COLUMNS>, model: &Model| {
            regression.solve(&model.columns()).map(|solution| through(&block(&solution.covariance)))
        };
        let white = self.regression(&self.setting.noise.white_part(), Dwell::taper_factor, bent);
        let cold = Model { temperature: Column::Absent, ..*model };
        let all = of(coloured, model)?;
        let drifting = of(coloured, &cold)?.min(all);
        let noise = of(&white, &Model { time: Column::Absent, ..cold })?.min(drifting);
        let [kappa, tilt, base] = self.component_errors().map(|covariance| through(&covariance));
        let amplitude = (direction.variance - all - kappa - tilt - base).max(0.0);
        let share = self.scale_share();
        Some(Budget {
            noise: libm::sqrt(noise),
            drift: libm::sqrt(drifting - noise + base),
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

    /// Covariance of the components from κ, from the tilt, and from a base that tilts: all turn with the stage
    /// as the Earth rate does, so the dwells cannot tell them from it.
    ///
    /// A tilt phasor F shifts them by `(Ω_v + κ)F/Ω_h`, as complex numbers. In two frames it meets
    /// `k_s` alone; the other parts of κ meet the vertical force ([`super::super::mount`]).
    pub(super) fn component_errors(&self) -> [Covariance; 3] {
        let rate = self.setting.latitude.horizontal_rate();
        let (force, across) = if self.setting.mount.is_on_base {
            (1.0, 0.0)
        } else {
            (self.tilt.magnitude(), self.setting.g_sensitivity[1])
        };
        let kappa = self.setting.kappa_sigma(libm::sqrt(self.white)) * force / rate;
        let real = (self.setting.latitude.vertical_rate() + self.setting.g_sensitivity[0]) / rate;
        let imaginary = across / rate;
        let rows = [[real, -imaginary], [imaginary, real]];
        let tilt = rows.map(|row| {
            let half = product(&self.tilt.covariance, row);
            [dot(rows[0], half), dot(rows[1], half)]
        });
        [[[kappa * kappa, 0.0], [0.0, kappa * kappa]], tilt, self.tilting(rate)]
    }

    /// Covariance of the components from what a base that tilts may turn beyond the rate found: forward by the
    /// imaginary part of F′ and right by its real part, which is west of the column.
    fn tilting(&self, rate: f64) -> Covariance {
        let [[a, b], [_, d]] = self.tilt.rate_covariance;
        let scale = 1.0 / (rate * rate * self.tilt.upward() * self.tilt.upward());
        [[d * scale, -b * scale], [-b * scale, a * scale]]
    }

    /// 1σ of the Earth-rate ratio that `free` found: all of the components', scale and latitude.
    pub(super) fn ratio_sigma(&self, free: &Direction) -> f64 {
        let amplitude = self.setting.amplitude_sigma();
        libm::sqrt(free.amplitude_variance + amplitude * amplitude)
    }
}

/// Probability of the residuals below which a drift that no key states is sought for them.
const DRIFT_PROBABILITY: f64 = 0.01;
/// Rounds in which a drift is sought that explains the residuals: each doubles or halves the step of its K.
const DRIFT_ROUNDS: usize = 12;

impl Problem<'_> {
    /// Raises σ where the dwells scatter more than their noise says and a drift that no key states explains it: a
    /// random walk stands out in the residuals least where it turns the azimuth most. The azimuth is then that which
    /// such a walk leaves.
    #[inline(never)]
    pub fn allow_for_drift(&self, fit: &mut Fit) {
        // On an arc any drift looks like the Earth.
        let is_likely = fit.earth_rate_is_free() && fit.probability() < DRIFT_PROBABILITY;
        let Some(trial) = is_likely.then(|| self.drifting(fit)).flatten() else { return };
        let more = trial.direction.variance - fit.sigma() * fit.sigma();
        if more > 0.0 {
            fit.budget.drift = libm::sqrt(fit.budget.drift * fit.budget.drift + more);
            fit.direction.azimuth = trial.direction.azimuth;
        }
    }

    /// The fit under the random walk that makes chi-square what it should be.
    fn drifting(&self, fit: &Fit) -> Option<Trial> {
        let bent = fit.bent(fit.model.hypothesis);
        let span = self.dwells.last()?.end() - self.dwells.first()?.start();
        let rate = self.setting.latitude.horizontal_rate();
        let own = self.white_variance(self.dwells.first()?) * rate * rate / span;
        let stated = self.setting.noise;
        let (mut power, mut factor) = (own, 4.0);
        let mut found = None;
        for _ in 0..DRIFT_ROUNDS {
            let walk = libm::sqrt(stated.rate_random_walk * stated.rate_random_walk + power);
            let noise = GyroNoise { rate_random_walk: walk, ..stated };
            let trial =
                self.trial(&self.regression(&noise, Dwell::taper_factor, &bent), &fit.model)?;
            let is_enough = trial.chi_square <= trial.degrees as f64;
            if is_enough {
                found = Some(trial);
                factor = libm::sqrt(factor);
                power /= factor;
            } else {
                power *= factor;
            }
        }
        found
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
        self.excess = 1.0;
        self.allow_for(excess(self.chi_square, self.degrees));
    }

    /// Probability of the residuals.
    fn probability(&self) -> f64 {
        chi_square_tail(self.chi_square, self.degrees as f64)
    }

    /// Raises it by so much, as a factor, if that is not done yet.
    pub fn allow_for(&mut self, excess: f64) {
        let more = (excess / self.excess).max(1.0);
        self.excess *= more;
        self.budget.noise *= more;
        self.budget.drift *= more;
    }

    /// Whether the horizontal Earth rate was left free.
    #[must_use]
    pub fn earth_rate_is_free(&self) -> bool {
        self.model.amplitude == Amplitude::Free
    }
}

//! Standard deviation of the azimuth: its Cramér–Rao bound, its budget, and the contributions of
//! tilt and κ.

use super::hypothesis::{MISSED, OBSERVABLE, WRONG, separation};
use super::{
    Bent, Equations, FEWEST, Fit, Hypothesis, Model, Problem, Protection, Trial, square, taper_of,
};
use crate::alignment::budget::Budget;
use crate::alignment::stepwise::direction::{Direction, dot, product, quadratic};
use crate::alignment::stepwise::setting::Amplitude;
use crate::alignment::stepwise::tilt::TiltRate;
use crate::math::{Column, chi_square_tail};
use crate::noise::GyroNoise;
use crate::units::{Radians, RadiansPerRootSecond, RateRandomWalk};

/// Probability of the residuals below which their excess over the stated noise raises σ: with few
/// degrees of freedom, where the factor would be large, and with more.
const EXCESS_PROBABILITY: [f64; 2] = [0.02, 0.05];
/// Number of degrees of freedom up to which they count as few.
pub(crate) const FEW_DEGREES: usize = 3;

/// A symmetric 2×2 covariance of the components, in units of `Ω_h`².
pub(super) type Covariance = [[f64; 2]; 2];

impl Problem<'_> {
    /// Cramér–Rao bound for these columns when all stationary time counts fully, rad, and the bound
    /// with the Earth rate free, at the Earth's own rate.
    #[inline(never)]
    pub(super) fn limits(&self, model: &Model, bent: &Bent) -> Option<[f64; 2]> {
        let regression = self.regression(self.setting.site.noise.model(), |_| 1.0, bent);
        let components = self.noise_components(&regression.solve(&model.columns())?);
        let sigma = |direction: Direction| libm::sqrt(direction.variance_at_earth_rate());
        Some([components.direction(model.amplitude).map(sigma)?, components.free().map(sigma)?])
    }

    /// Splits the variance into the dwells' noise through the gain, tilt and κ, and the rest, which
    /// belongs to the amplitude's prior.
    #[inline(never)]
    pub(super) fn budget(
        &self,
        coloured: &Equations,
        model: &Model,
        direction: &Direction,
        bent: &Bent,
    ) -> Option<Budget> {
        let through = |covariance: &Covariance| quadratic(covariance, direction.gain).max(0.0);
        let of = |regression: &Equations, model: &Model| {
            regression
                .solve(&model.columns())
                .map(|solution| through(&square(&solution.covariance, 0)))
        };
        let white = self.regression(&self.setting.site.noise.model().white_part(), taper_of, bent);
        let cold = Model { temperature: Column::Absent, ..*model };
        let all = of(coloured, model)?;
        let drifting = of(coloured, &cold)?.min(all);
        let noise = of(&white, &Model { time: Column::Absent, ..cold })?.min(drifting);
        let [kappa, tilt, base] = self.component_errors().map(|covariance| through(&covariance));
        let amplitude = (direction.variance - all - kappa - tilt - base).max(0.0);
        let share = self.scale_share();
        Some(Budget {
            noise: Radians(libm::sqrt(noise)),
            drift: Radians(libm::sqrt(drifting - noise + base)),
            temperature: Radians(libm::sqrt(all - drifting)),
            displacement: Radians(0.0),
            scale: Radians(libm::sqrt(amplitude * share)),
            latitude: Radians(libm::sqrt(amplitude * (1.0 - share))),
            g_sensitivity: Radians(libm::sqrt(kappa)),
            accelerometer: Radians(libm::sqrt(tilt)),
            encoder: self.setting.site.encoder_sigma,
        })
    }

    /// Part of the amplitude's variance that is due to the scale factor.
    fn scale_share(&self) -> f64 {
        let share = self.setting.site.scale_sigma / self.setting.site.amplitude_sigma().max(1e-30);
        if self.setting.site.amplitude_sigma() > 0.0 { share * share } else { 1.0 }
    }

    /// Covariances of the components from κ, from the tilt, and from a tilting base: all rotate
    /// with the stage as the Earth rate does, so the dwells cannot separate them from it.
    ///
    /// A tilt phasor F shifts the components by `(Ω_v + κ)F/Ω_h`, as complex numbers. On a
    /// two-frame mount it acts through `k_s` alone; the other parts of κ act on the vertical force
    /// ([`crate::alignment::stepwise::mount`]).
    pub(super) fn component_errors(&self) -> [Covariance; 3] {
        let rate = self.setting.site.latitude.horizontal_rate().0;
        let (force, across) = if self.setting.mount.is_on_base {
            (1.0, 0.0)
        } else {
            (self.tilt.magnitude(), self.setting.site.g_sensitivity[1].0)
        };
        let walk = RadiansPerRootSecond(libm::sqrt(self.white));
        let kappa = self.setting.site.kappa_sigma(walk).0 * force / rate;
        let real = (self.setting.site.latitude.vertical_rate().0
            + self.setting.site.g_sensitivity[0].0)
            / rate;
        let imaginary = across / rate;
        let rows = [[real, -imaginary], [imaginary, real]];
        let tilt = rows.map(|row| {
            let half = product(&self.tilt.covariance, row);
            [dot(rows[0], half), dot(rows[1], half)]
        });
        let base = self.tilting(&self.tilt.rate.covariance);
        [[[kappa * kappa, 0.0], [0.0, kappa * kappa]], tilt, base]
    }

    /// Covariance of the components from that of a base's tilt rate: the base rotates about forward
    /// by the imaginary part of F′ and about right by its real part, which is opposite to the sign
    /// of the east column.
    pub(super) fn tilting(&self, [[a, b], [_, d]]: &Covariance) -> Covariance {
        let rate = self.setting.site.latitude.horizontal_rate().0;
        let scale = 1.0 / (rate * rate * self.tilt.upward() * self.tilt.upward());
        [[d * scale, -b * scale], [-b * scale, a * scale]]
    }

    /// Standard deviation, 1σ, of the Earth-rate ratio of `free`: that of the components, of scale
    /// and of latitude.
    pub(super) fn ratio_sigma(&self, free: &Direction) -> f64 {
        let amplitude = self.setting.site.amplitude_sigma();
        libm::sqrt(free.amplitude_variance + amplitude * amplitude)
    }
}

/// Probability of the residuals below which they count as an anomaly.
const ANOMALOUS_PROBABILITY: f64 = 0.01;
/// Deviation of the Earth-rate ratio, in σ, that counts as an anomaly (p = 0.01).
const ANOMALOUS_RATIO: f64 = 2.58;
/// Number of rounds in the search for a drift that explains the residuals: each doubles or halves
/// the step of its K.
const DRIFT_ROUNDS: usize = 12;

impl Problem<'_> {
    /// Raises σ to a fifth of the greatest error under every alternative. Where there is an anomaly
    /// (an excluded outlier, unlikely residuals or Earth rate, an unconfigured trend), the
    /// alternatives that matter only then count too: a random walk, and another Earth rate.
    #[inline(never)]
    pub(crate) fn protect(&self, fit: &mut Fit, has_outliers: bool) {
        let Protection { always, anomalous } = fit.protection;
        let is_anomalous = has_outliers || fit.is_anomalous();
        let mut level =
            self.tilting_protection(fit).max(if is_anomalous { anomalous.0 } else { always.0 });
        if is_anomalous && self.dwells.len() >= FEWEST {
            let most = OBSERVABLE * fit.direction.variance;
            let trials = [self.drifting(fit), self.with_any_earth_rate(fit)].into_iter().flatten();
            for trial in trials.filter(|trial| trial.direction.variance < most) {
                let apart = separation(trial.direction.azimuth, fit.direction.azimuth);
                level = level.max(apart + MISSED * libm::sqrt(trial.direction.variance));
            }
        }
        fit.raise(level / WRONG, |budget| &mut budget.drift);
    }

    /// Greatest error of the azimuth for a tilting base that the forces indicate but do not prove,
    /// rad.
    fn tilting_protection(&self, fit: &Fit) -> f64 {
        let TiltRate { value: [real, imaginary], covariance } = self.tilt.unproven;
        let rate = self.setting.site.latitude.horizontal_rate().0;
        let scale = 1.0 / (rate * self.tilt.upward());
        let apart = dot(fit.direction.gain, [imaginary * scale, -real * scale]).abs();
        let variance = quadratic(&self.tilting(&covariance), fit.direction.gain).max(0.0);
        apart + MISSED * libm::sqrt(variance + fit.direction.variance)
    }

    /// Fit without prior knowledge of the Earth rate; `None` for two positions, which do not
    /// determine it.
    fn with_any_earth_rate(&self, fit: &Fit) -> Option<Trial> {
        if fit.model.is_single_axis {
            return None;
        }
        let bent = fit.bent(fit.model.hypothesis);
        let regression = self.coloured(&bent);
        let free = Model { amplitude: Amplitude::Free, ..fit.model };
        self.trial(&regression, &free)
    }

    /// Fit of a steady base under the random walk that brings chi-square to its expectation: an
    /// unconfigured drift.
    fn drifting(&self, fit: &Fit) -> Option<Trial> {
        // On an arc any drift looks like the Earth rate.
        if !self.is_circle(&self.coloured(&Bent::default())) {
            return None;
        }
        let (model, bent) = if fit.model.hypothesis == Hypothesis::Steady {
            (fit.model, fit.bent)
        } else {
            let model = Model { amplitude: fit.model.amplitude, ..self.base() };
            (model, Bent { along: fit.bent.along, ..Bent::default() })
        };
        let span = self.dwells.last()?.end().0 - self.dwells.first()?.start().0;
        let rate = self.setting.site.latitude.horizontal_rate().0;
        let own = self.white_variance(self.dwells.first()?) * rate * rate / span;
        let stated = *self.setting.site.noise.model();
        let (mut power, mut factor) = (own, 4.0);
        let mut found = None;
        for _ in 0..DRIFT_ROUNDS {
            let walk = libm::sqrt(stated.rate_random_walk.0 * stated.rate_random_walk.0 + power);
            let noise = GyroNoise { rate_random_walk: RateRandomWalk(walk), ..stated };
            let trial = self.trial(&self.regression(&noise, taper_of, &bent), &model)?;
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

/// Factor on the noise's standard deviation for residuals of this chi-square; one where the excess
/// may be chance.
fn excess(chi_square: f64, degrees: usize) -> f64 {
    let least = EXCESS_PROBABILITY[usize::from(degrees > FEW_DEGREES)];
    let freedom = degrees as f64;
    let is_chance = degrees == 0 || chi_square_tail(chi_square, freedom) >= least;
    if is_chance { 1.0 } else { libm::sqrt(chi_square / freedom) }
}

impl Fit {
    /// Raises the noise contributions where the dwells scatter more than stated.
    pub(super) fn allow_for_excess(&mut self) {
        self.excess = 1.0;
        self.allow_for(excess(self.chi_square, self.degrees));
    }

    /// Raises σ to at least this, rad, by this part of it.
    #[inline(never)]
    pub(super) fn raise(&mut self, least: f64, part: fn(&mut Budget) -> &mut Radians) {
        let sigma = self.sigma().0;
        let lacking = (least * least - sigma * sigma).max(0.0);
        let part = part(&mut self.budget);
        part.0 = libm::sqrt(part.0 * part.0 + lacking);
    }

    /// Whether an anomaly shows in the residuals, the Earth rate or the model.
    fn is_anomalous(&self) -> bool {
        self.model.time == Column::Free
            || self.model.hypothesis != Hypothesis::Steady
            || chi_square_tail(self.chi_square, self.degrees as f64) < ANOMALOUS_PROBABILITY
            || (self.ratio - 1.0).abs() > ANOMALOUS_RATIO * self.ratio_sigma
    }

    /// Raises the noise contributions to this factor in all, if they are below it.
    pub(crate) fn allow_for(&mut self, excess: f64) {
        let more = (excess / self.excess).max(1.0);
        self.excess *= more;
        self.budget.noise.0 *= more;
        self.budget.drift.0 *= more;
    }

    /// Whether the horizontal Earth rate was left free.
    #[must_use]
    pub fn earth_rate_is_free(&self) -> bool {
        self.model.amplitude == Amplitude::Free
    }
}

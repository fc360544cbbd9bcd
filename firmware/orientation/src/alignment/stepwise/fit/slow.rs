//! Observability of a slow motion of the base in the dwells.

use super::{Bent, FEWEST, Fit, Hypothesis, Model, Problem};
use crate::alignment::slow::SlowMotion;
use crate::alignment::stepwise::direction::quadratic;
use crate::alignment::stepwise::level;
use crate::alignment::stepwise::tilt::TiltRate;
use crate::math::COLUMNS;
use crate::units::{RadiansPerSecond, Seconds};

/// Rotation rate so slow that the azimuth follows it linearly, rad/h.
const SLOW: f64 = 1e-4;

impl Problem<'_> {
    /// Slow rotation of the base about the vertical beside the result of [`Self::fit`]; `None`
    /// where the fit has already estimated such a rotation.
    pub(crate) fn slow_turn(&self, fit: &Fit) -> Option<SlowMotion> {
        if fit.model.hypothesis == Hypothesis::Yawing {
            return None;
        }
        let azimuth = |rate: f64| {
            let bent = Bent { rate, ..fit.bent(fit.model.hypothesis) };
            let regression = self.coloured(&bent);
            Some(self.trial(&regression, &fit.model)?.direction.azimuth)
        };
        let lever = (azimuth(SLOW)? - azimuth(-SLOW)?) / (2.0 * SLOW) * 3600.0;
        let is_shown =
            self.dwells.len() >= FEWEST && self.is_circle(&self.coloured(&Bent::default()));
        let sigma = if is_shown { self.rate_sigma(fit) } else { None };
        let sigma = RadiansPerSecond(sigma.unwrap_or(f64::INFINITY));
        Some(SlowMotion { sigma, lever: Seconds(lever) })
    }

    /// Standard deviation of the base's rate with the Earth rate free, 1σ, rad/s; `None` where the
    /// dwells do not determine it.
    fn rate_sigma(&self, fit: &Fit) -> Option<f64> {
        let model = Model { hypothesis: Hypothesis::Yawing, ..fit.model };
        let bent = fit.bent(Hypothesis::Yawing);
        let regression = self.coloured(&bent);
        let solution = regression.solve(&model.columns())?;
        let variance = solution.covariance[COLUMNS - 2][COLUMNS - 2];
        Some(libm::sqrt(variance) * fit.excess / 3600.0)
    }

    /// Slow tilting of the base in the forces of these dwells; `None` where a tilt rate is already
    /// compensated.
    pub(crate) fn slow_tilting(&self, fit: &Fit) -> Option<SlowMotion> {
        if self.tilt.rate != TiltRate::default() {
            return None;
        }
        let shown = level::tilting(self.setting, self.dwells.iter().copied());
        let Some(shown) = shown.filter(|_| self.tilt.measured) else {
            let lever = Seconds(1.0 / self.setting.site.latitude.horizontal_rate().0);
            return Some(SlowMotion { sigma: RadiansPerSecond(f64::INFINITY), lever });
        };
        let [[a, _], [_, b]] = shown.covariance;
        let sigma = libm::sqrt(a.max(b)) / self.tilt.upward();
        let shift = quadratic(&self.tilting(&shown.covariance), fit.direction.gain).max(0.0);
        let lever = Seconds(libm::sqrt(shift) / sigma);
        Some(SlowMotion { sigma: RadiansPerSecond(sigma), lever })
    }
}

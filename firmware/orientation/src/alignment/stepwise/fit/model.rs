//! Selection of the fit's columns: trends where the data require them, and the Earth rate free
//! where that costs little.

use super::{Equations, Hypothesis, Problem, Trial};
use crate::alignment::stepwise::different_positions;
use crate::alignment::stepwise::setting::Amplitude;
use crate::math::{COLUMNS, Column, Solution};

/// Chi-square of one degree of freedom that noise exceeds with a probability of 0.001.
const TREND_CHI_SQUARE: f64 = 10.83;
/// Greatest factor by which a trend may raise the standard deviation of the azimuth.
const TREND_COST: f64 = 1.5;
/// Degrees of freedom that must remain beside a trend: with fewer, one disturbed dwell looks the
/// same.
const TREND_DEGREES: usize = 3;
/// Ramp below which it is neglected, in units of `Ω_h` per hour.
const LEAST_RAMP: f64 = 1e-9;
/// Prior 1σ of either component of the Earth rate with two positions, in units of `Ω_h`: wide
/// enough to carry no information, yet finite.
const UNKNOWN_COMPONENT: f64 = 100.0;
/// Greatest factor by which a free Earth rate may raise the standard deviation of the azimuth.
const FREE_COST: f64 = 1.02;

/// Columns of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Column of time, with its prior where the ramp R is configured.
    pub time: Column,
    /// Column of temperature.
    pub temperature: Column,
    /// Prior knowledge of the horizontal Earth rate that is used.
    pub amplitude: Amplitude,
    /// Whether the dwells stand at two positions only, which determine one component and the
    /// constant.
    pub is_single_axis: bool,
    /// Reduction of chi-square by a trend that the azimuth cannot afford; zero where there is none.
    pub rejected_trend: f64,
    /// Additional motion or error that is fitted.
    pub hypothesis: Hypothesis,
}

impl Trial {
    /// Whether the azimuth can afford what a trend has made of the trial without it.
    fn is_affordable(&self, before: &Self) -> bool {
        let most = TREND_COST * TREND_COST * before.direction.variance;
        self.direction.variance <= most && self.degrees >= TREND_DEGREES
    }
}

impl Model {
    /// Whether it has the same trends as another model.
    pub(super) fn is_as_plain_as(&self, other: &Self) -> bool {
        self.time == other.time && self.temperature == other.temperature
    }

    /// Use of each column in the regression.
    pub(super) fn columns(&self) -> [Column; COLUMNS] {
        let component =
            if self.is_single_axis { Column::Prior(UNKNOWN_COMPONENT) } else { Column::Free };
        let [one, other] = self.hypothesis.columns();
        [component, component, Column::Free, self.time, self.temperature, one, other]
    }

    /// Degrees of freedom of a solution for these columns. Two positions determine one component of
    /// two; a known Earth rate leaves one degree of freedom to both.
    pub(super) fn degrees(&self, solution: &Solution<COLUMNS>) -> usize {
        match (self.is_single_axis, self.amplitude) {
            (true, _) => solution.degrees.saturating_sub(1),
            (false, Amplitude::Known(_)) => solution.degrees + 1,
            (false, Amplitude::Free) => solution.degrees,
        }
    }
}

impl Problem<'_> {
    /// Selects the columns, and whether the Earth rate stays free; `None` where the positions
    /// determine nothing.
    #[inline(never)]
    pub(super) fn choose(&self, regression: &Equations) -> Option<Model> {
        // Trends are tested with the Earth rate free where that costs little: a wrong scale or
        // latitude is no trend.
        let mut model = self.freed(regression, &self.base())?;
        self.add_trend(regression, &mut model)?;
        self.freed(regression, &model)
    }

    /// Model with the Earth rate free where that costs little, otherwise with its prior.
    pub(super) fn freed(&self, regression: &Equations, model: &Model) -> Option<Model> {
        let held = Model { amplitude: self.setting.known_amplitude(), ..*model };
        let free = Model { amplitude: Amplitude::Free, ..*model };
        let cost = |trial: &Trial| trial.direction.variance_at_earth_rate();
        let known = cost(&self.trial(regression, &held)?);
        match self.trial(regression, &free) {
            Some(trial) if cost(&trial) <= FREE_COST * FREE_COST * known => Some(free),
            _ => Some(held),
        }
    }

    /// Model without trends that the data would have to show: a configured ramp enters with its
    /// prior.
    pub(super) fn base(&self) -> Model {
        let ramp = self.setting.site.noise.model().rate_ramp.0 * 3600.0
            / self.setting.site.latitude.horizontal_rate().0;
        Model {
            time: if ramp > LEAST_RAMP { Column::Prior(ramp) } else { Column::Absent },
            temperature: Column::Absent,
            amplitude: self.setting.known_amplitude(),
            is_single_axis: different_positions(self.dwells) < 3,
            rejected_trend: 0.0,
            hypothesis: Hypothesis::Steady,
        }
    }

    /// Adds temperature and time where chi-square requires them and the azimuth can afford them;
    /// one that it cannot afford is stored in [`Model::rejected_trend`].
    fn add_trend(&self, regression: &Equations, model: &mut Model) -> Option<()> {
        let is_warm = self.is_warm();
        for _ in 0..2 {
            let before = self.trial(regression, model)?;
            let mut best: Option<(Model, Trial, f64)> = None;
            for candidate in candidates(model, is_warm).into_iter().flatten() {
                let Some(trial) = self.trial(regression, &candidate) else { continue };
                let gain = before.chi_square - trial.chi_square;
                if gain > TREND_CHI_SQUARE && best.is_none_or(|(.., most)| gain >= most) {
                    best = Some((candidate, trial, gain));
                }
            }
            match best {
                Some((trend, trial, _)) if trial.is_affordable(&before) => *model = trend,
                Some((.., gain)) => model.rejected_trend = gain,
                None => {}
            }
        }
        Some(())
    }

    /// Whether every dwell has a temperature.
    fn is_warm(&self) -> bool {
        self.dwells.iter().all(|dwell| dwell.temperature.get().is_some())
    }
}

/// Models with one additional trend.
fn candidates(model: &Model, is_warm: bool) -> [Option<Model>; 2] {
    let cold = is_warm && model.temperature == Column::Absent;
    let steady = model.time == Column::Absent;
    [
        cold.then_some(Model { temperature: Column::Free, ..*model }),
        steady.then_some(Model { time: Column::Free, ..*model }),
    ]
}

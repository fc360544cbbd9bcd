//! Which columns the fit uses: trends where the data ask for them, the Earth rate free where that
//! costs nothing.

use super::super::direction::{Amplitude, Direction};
use super::super::regression::{Column, Regression};
use super::{COLUMNS, Problem};

/// Chi-square of one degree of freedom that noise exceeds with a probability of 0.001.
const TREND_CHI_SQUARE: f64 = 10.83;
/// By how much a trend may raise the standard deviation of the azimuth.
const TREND_COST: f64 = 1.5;
/// By how much leaving the Earth rate free may raise the standard deviation of the azimuth.
const FREE_COST: f64 = 1.02;

/// Which columns a fit used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Time, with its prior where the ramp R is known.
    pub time: Column,
    /// Temperature.
    pub temperature: Column,
    /// The horizontal Earth rate.
    pub amplitude: Amplitude,
}

impl Model {
    pub(super) fn columns(&self) -> [Column; COLUMNS] {
        [Column::Free, Column::Free, Column::Free, self.time, self.temperature]
    }
}

impl Problem<'_> {
    /// The direction that a model finds.
    pub(super) fn direction(
        &self,
        regression: &Regression<COLUMNS>,
        model: &Model,
    ) -> Option<Direction> {
        self.components(&regression.solve(&model.columns())?).direction(model.amplitude)
    }

    /// Chooses the columns and whether the Earth rate stays free.
    pub(super) fn choose(&self, regression: &Regression<COLUMNS>) -> Option<Model> {
        let mut model = self.base();
        self.add_trend(regression, &mut model)?;
        let free = Model { amplitude: Amplitude::Free, ..model };
        let known = self.direction(regression, &model)?.variance;
        if let Some(direction) = self.direction(regression, &free)
            && direction.variance <= FREE_COST * FREE_COST * known
        {
            return Some(free);
        }
        Some(model)
    }

    /// The model before any trend is looked for: a known ramp enters with its prior.
    fn base(&self) -> Model {
        let ramp = self.setting.noise.rate_ramp * 3600.0 / self.setting.latitude.horizontal_rate();
        Model {
            time: if ramp > 0.0 { Column::Prior(ramp) } else { Column::Absent },
            temperature: Column::Absent,
            amplitude: Amplitude::Known(self.setting.amplitude_sigma()),
        }
    }

    /// Adds temperature and then time where chi-square asks for it and the azimuth can afford it.
    fn add_trend(&self, regression: &Regression<COLUMNS>, model: &mut Model) -> Option<()> {
        for _ in 0..2 {
            let before = regression.solve(&model.columns())?.chi_square;
            let variance = self.direction(regression, model)?.variance;
            let mut best = (*model, TREND_CHI_SQUARE);
            for candidate in self.candidates(model).into_iter().flatten() {
                let Some(solution) = regression.solve(&candidate.columns()) else { continue };
                let Some(direction) = self.direction(regression, &candidate) else { continue };
                let affordable = direction.variance <= TREND_COST * TREND_COST * variance;
                if affordable && before - solution.chi_square > best.1 {
                    best = (candidate, before - solution.chi_square);
                }
            }
            *model = best.0;
        }
        Some(())
    }

    fn candidates(&self, model: &Model) -> [Option<Model>; 2] {
        let measured = self.dwells.iter().all(|dwell| dwell.temperature.is_some());
        let cold = measured && model.temperature == Column::Absent;
        let steady = model.time == Column::Absent;
        [
            cold.then_some(Model { temperature: Column::Free, ..*model }),
            steady.then_some(Model { time: Column::Free, ..*model }),
        ]
    }
}

//! Which columns the fit uses: trends where the data ask for them, the Earth rate free where that
//! costs nothing.

use super::super::direction::{Amplitude, Direction};
use super::super::regression::{COLUMNS, Column, Regression};
use super::Problem;

/// Chi-square of one degree of freedom that noise exceeds with a probability of 0.001.
const TREND_CHI_SQUARE: f64 = 10.83;
/// By how much a trend may raise the standard deviation of the azimuth.
const TREND_COST: f64 = 1.5;
/// Degrees of freedom that must remain beside a trend: with fewer, one disturbed dwell looks alike.
const TREND_DEGREES: usize = 3;
/// Ramp below which there is none, in units of `Ω_h` per hour.
const LEAST_RAMP: f64 = 1e-9;
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
    /// By how much a trend that the azimuth cannot afford would lower chi-square; zero where there
    /// is none.
    pub rejected_trend: f64,
}

/// What one candidate trend would do.
struct Trial {
    model: Model,
    gain: f64,
    affordable: bool,
}

impl Model {
    pub(super) fn columns(&self) -> [Column; COLUMNS] {
        [Column::Free, Column::Free, Column::Free, self.time, self.temperature]
    }
}

impl Problem<'_> {
    /// The direction that a model finds.
    fn direction(&self, regression: &Regression<COLUMNS>, model: &Model) -> Option<Direction> {
        self.components(&regression.solve(&model.columns())?).direction(model.amplitude)
    }

    /// Chooses the columns and whether the Earth rate stays free.
    ///
    /// The cost of freedom is judged for one amplitude: that a weak Earth rate has a wide azimuth
    /// is no reason to believe in a strong one.
    pub(super) fn choose(&self, regression: &Regression<COLUMNS>) -> Option<Model> {
        let mut model = self.base();
        self.add_trend(regression, &mut model)?;
        let free = Model { amplitude: Amplitude::Free, ..model };
        let cost =
            |direction: Direction| direction.variance * direction.amplitude * direction.amplitude;
        let known = cost(self.direction(regression, &model)?);
        match self.direction(regression, &free).map(cost) {
            Some(cost) if cost <= FREE_COST * FREE_COST * known => Some(free),
            _ => Some(model),
        }
    }

    /// The model before any trend is looked for: a known ramp enters with its prior.
    fn base(&self) -> Model {
        let ramp = self.setting.noise.rate_ramp * 3600.0 / self.setting.latitude.horizontal_rate();
        Model {
            time: if ramp > LEAST_RAMP { Column::Prior(ramp) } else { Column::Absent },
            temperature: Column::Absent,
            amplitude: Amplitude::Known(self.setting.amplitude_sigma()),
            rejected_trend: 0.0,
        }
    }

    /// Adds temperature and time where chi-square asks for them and the azimuth can afford them;
    /// one that it cannot afford is kept in mind.
    fn add_trend(&self, regression: &Regression<COLUMNS>, model: &mut Model) -> Option<()> {
        for _ in 0..2 {
            let solution = regression.solve(&model.columns())?;
            let before = (solution.chi_square, self.direction(regression, model)?.variance);
            let trials = candidates(model, self.is_warm());
            let best = trials
                .into_iter()
                .flatten()
                .filter_map(|candidate| self.trial(regression, candidate, before))
                .filter(|trial| trial.gain > TREND_CHI_SQUARE)
                .max_by(|a, b| a.gain.total_cmp(&b.gain));
            match best {
                Some(trial) if trial.affordable => *model = trial.model,
                Some(trial) => model.rejected_trend = trial.gain,
                None => {}
            }
        }
        Some(())
    }

    /// What a candidate does to chi-square and to the azimuth's variance, both given without it.
    fn trial(
        &self,
        regression: &Regression<COLUMNS>,
        model: Model,
        (chi_square, variance): (f64, f64),
    ) -> Option<Trial> {
        let solution = regression.solve(&model.columns())?;
        let after = self.components(&solution).direction(model.amplitude)?;
        let cheap = after.variance <= TREND_COST * TREND_COST * variance;
        Some(Trial {
            model,
            gain: chi_square - solution.chi_square,
            affordable: cheap && solution.degrees >= TREND_DEGREES,
        })
    }

    /// Whether every dwell has a temperature.
    fn is_warm(&self) -> bool {
        self.dwells.iter().all(|dwell| dwell.temperature.get().is_some())
    }
}

/// The models with one more trend.
fn candidates(model: &Model, is_warm: bool) -> [Option<Model>; 2] {
    let cold = is_warm && model.temperature == Column::Absent;
    let steady = model.time == Column::Absent;
    [
        cold.then_some(Model { temperature: Column::Free, ..*model }),
        steady.then_some(Model { time: Column::Free, ..*model }),
    ]
}

//! Maximum-likelihood azimuth from dwells at several stage angles.
//!
//! Each dwell is a row: its mean rate, less the vertical Earth rate and the g-sensitivity that the
//! tilt turns into it, on the sensitive axis' north and east parts, a constant, and where they are
//! needed time and temperature. Nothing is differenced. The rows are whitened for the gyro's
//! noise, so the covariance of the fit is the Cramér–Rao bound of what went in.

mod hypothesis;
mod model;
mod slow;
mod uncertainty;

pub use hypothesis::{HeadingStep, Hypothesis, Protection};
pub use model::Model;
pub use uncertainty::FEW_DEGREES;

use super::budget::Budget;
use super::direction::{Amplitude, Components, Direction, dot, inverted, product, quadratic};
use super::level::Tilt;
use super::regression::{COLUMNS, Regression, Solution};
use super::setting::Setting;
use crate::noise::model::GyroNoise;
use crate::noise::whitener::Whitener;
use crate::signal::dwell::Dwell;
use crate::signal::sway::SwayNoise;
use uncertainty::Covariance;

/// A dwell in the regression: north and east part of the sensitive axis, constant, time since the
/// first dwell (h), temperature above that of the first dwell (°C), two of a [`Hypothesis`] and, last, the
/// left side.
type Row = [f64; COLUMNS + 1];

/// An azimuth with all that is known about it.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Columns used.
    pub model: Model,
    /// The solution.
    pub direction: Direction,
    /// Where its standard deviation comes from.
    pub budget: Budget,
    /// Cramér–Rao bound of these columns for all stationary time of these dwells, rad.
    pub limit: f64,
    /// The same bound with the Earth rate free, rad.
    pub limit_free: f64,
    /// `Ω̂_h/Ω_h` with the Earth rate free; of two positions, which do not show it, without meaning.
    pub ratio: f64,
    /// 1σ of the ratio: noise, tilt, g-sensitivity and scale.
    pub ratio_sigma: f64,
    /// Chi-square of the residuals.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub degrees: usize,
    /// By how much more than their noise the dwells scatter, as a factor that is in the budget.
    pub excess: f64,
    /// The step of the heading that the dwells show most.
    pub step: Option<HeadingStep>,
    /// How far the azimuth may be off under what else may explain the dwells.
    pub protection: Protection,
    /// Chi-square with the Earth rate free, where that was asked for.
    free_chi_square: f64,
    coefficients: [f64; COLUMNS],
    /// What the columns of its hypothesis follow.
    bent: Bent,
}

/// Fewest dwells that tell one hypothesis from another.
const FEWEST: usize = 8;
/// Rounds in which a hypothesis follows the azimuth that it changes: each leaves the square of the change.
const ROUNDS: usize = 3;

/// What the columns of a hypothesis follow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bent {
    hypothesis: Hypothesis,
    /// The azimuth of a fit, as the Earth rate's components north and east along body x, in units of `Ω_h`.
    along: [f64; 2],
    /// Rate at which the base is known to turn about the vertical, rad/h.
    rate: f64,
    /// By how much the heading is known to step, rad.
    turn: f64,
}

impl Bent {
    /// What the heading of a dwell lacks of the last dwell's for the step, rad.
    fn turn_before(&self, dwell: &Dwell) -> f64 {
        match self.hypothesis {
            Hypothesis::Stepped { after } if dwell.middle < after => self.turn,
            _ => 0.0,
        }
    }
}

/// What a model makes of the dwells.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    direction: Direction,
    amplitude: Amplitude,
    chi_square: f64,
    degrees: usize,
    /// The first coefficient of the hypothesis.
    coefficient: f64,
}

/// A fit, and what only its residuals need: the covariance of its coefficients.
pub type Found = (Fit, [[f64; COLUMNS]; COLUMNS]);

/// A residual of one dwell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Measured less fitted rate, with the drift still in it, rad/s.
    pub rate: f64,
    /// What its predecessors do not explain, in its standard deviation.
    pub normalised: f64,
    /// The same, allowing for what the dwell itself pulled the fit (leverage).
    pub studentised: f64,
}

/// The dwells of an alignment and what is known about them.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// The place and the instrument.
    pub setting: &'a Setting,
    /// The tilt.
    pub tilt: &'a Tilt,
    /// N², known or estimated, (rad/s)²·s.
    pub white: f64,
    /// The dwells that take part, in the order of time.
    pub dwells: &'a [&'a Dwell],
}

impl Problem<'_> {
    /// Fits the azimuth; `None` where the positions do not determine it.
    #[must_use]
    #[inline(never)]
    pub fn fit(&self) -> Option<Found> {
        let regression = self.steady();
        let model = self.choose(&regression)?;
        let mut found = self.fit_model(&regression, &model, &Bent::default())?;
        // On an arc, and with few dwells, any of them looks like any other.
        if self.dwells.len() < FEWEST || !self.is_circle(&regression) {
            return Some(found);
        }
        let known = Model { amplitude: self.setting.known_amplitude(), ..model };
        let open = Model { amplitude: Amplitude::Free, ..model };
        let trials = self.trial(&regression, &known).zip(self.trial(&regression, &open));
        let Some((steady, free)) = trials else { return Some(found) };
        found.0.free_chi_square = free.chi_square;
        let model = self.weigh(&mut found.0, &steady);
        Some(model.and_then(|model| self.fit_under(&model, &found.0)).unwrap_or(found))
    }

    /// Whether the positions show the Earth rate; what a trend costs does not matter.
    pub(super) fn is_circle(&self, steady: &Regression<COLUMNS>) -> bool {
        let model = self.freed(steady, &self.base());
        model.is_some_and(|model| model.amplitude == Amplitude::Free)
    }

    /// The regression of a base that stands.
    pub(super) fn steady(&self) -> Regression<COLUMNS> {
        self.regression(&self.setting.noise, Dwell::taper_factor, &Bent::default())
    }

    /// Fits with a hypothesis, again and again: its columns follow the azimuth and the rate, which it changes.
    #[inline(never)]
    fn fit_under(&self, model: &Model, steady: &Fit) -> Option<Found> {
        let mut bent = Bent { hypothesis: model.hypothesis, ..steady.bent };
        for _ in 0..ROUNDS {
            let regression = self.regression(&self.setting.noise, Dwell::taper_factor, &bent);
            let trial = self.trial(&regression, model)?;
            bent.along = trial.direction.along();
            if model.hypothesis == Hypothesis::Yawing {
                bent.rate += trial.coefficient;
            }
        }
        let regression = self.regression(&self.setting.noise, Dwell::taper_factor, &bent);
        let found = self.fit_model(&regression, &self.freed(&regression, model)?, &bent)?;
        let Fit { step, protection, .. } = *steady;
        Some((Fit { step, protection, ..found.0 }, found.1))
    }

    /// What a model makes of the dwells; nothing where they do not determine it.
    #[inline(never)]
    fn trial(&self, regression: &Regression<COLUMNS>, model: &Model) -> Option<Trial> {
        let solution = regression.solve(&model.columns())?;
        let components = self.components(&solution);
        let direction = components.direction(model.amplitude)?;
        let (sine, cosine) = libm::sincos(direction.azimuth);
        let wanted = direction.components([cosine, sine], components.vertical);
        let change = [0, 1].map(|i| wanted[i] - components.value[i]);
        let information = inverted(&components.covariance)?;
        Some(Trial {
            direction,
            amplitude: model.amplitude,
            chi_square: solution.chi_square + quadratic(&information, change),
            degrees: model.degrees(&solution),
            coefficient: solution.coefficients[COLUMNS - 2],
        })
    }

    /// The fit of a model.
    #[inline(never)]
    fn fit_model(
        &self,
        regression: &Regression<COLUMNS>,
        model: &Model,
        bent: &Bent,
    ) -> Option<Found> {
        let mut solution = regression.solve(&model.columns())?;
        let components = self.components(&solution);
        let direction = components.direction(model.amplitude)?;
        let free = components.free()?;
        let [limit, limit_free] = self.limits(model, bent)?;
        let mut fit = Fit {
            model: *model,
            direction,
            budget: self.budget(regression, model, &direction, bent)?,
            limit,
            limit_free,
            ratio: free.amplitude,
            ratio_sigma: self.ratio_sigma(&free),
            chi_square: 0.0,
            degrees: 0,
            excess: 1.0,
            free_chi_square: 0.0,
            step: None,
            protection: Protection::default(),
            coefficients: solution.coefficients,
            bent: match model.hypothesis {
                Hypothesis::Steady => Bent { along: direction.along(), ..*bent },
                _ => *bent,
            },
        };
        let noise = self.noise_components(&solution);
        fit.constrain(&mut solution, &components, &noise);
        fit.allow_for_excess();
        Some((fit, solution.covariance))
    }

    /// Gives each dwell its residual, in their order, for what [`Self::fit`] found.
    pub fn residuals(&self, (fit, covariance): &Found, mut each: impl FnMut(Residual)) {
        let horizontal = self.setting.latitude.horizontal_rate();
        let bent = fit.bent(fit.model.hypothesis);
        self.whiten(&self.setting.noise, Dwell::taper_factor, &bent, &mut |row, white| {
            let rate = remainder(row, &fit.coefficients) * horizontal;
            let normalised = remainder(white, &fit.coefficients);
            let leverage = leverage(white, covariance);
            let studentised = normalised / libm::sqrt((1.0 - leverage).max(0.05));
            each(Residual { rate, normalised, studentised });
        });
    }

    /// The row of a dwell: its columns and, last, its left side, all in units of `Ω_h`; and what turning the
    /// azimuth does to the rate, ∂/∂A, in these units.
    fn row(&self, dwell: &Dwell, bent: &Bent) -> (Row, f64) {
        let mount = &self.setting.mount;
        let tilt = self.tilt.at(dwell.middle);
        let axis = (mount.axis)(&tilt, dwell);
        let force = (mount.force)(&tilt, dwell);
        let latitude = self.setting.latitude;
        let first = self.dwells[0];
        let [forward, right] = tilt.turning(tilt.rate.value);
        let left = dwell.rate - first.rate + latitude.vertical_rate() * axis[2]
            - dot(self.setting.g_sensitivity, force)
            - (axis[0] * forward + axis[1] * right);
        let yaw = bent.rate * self.hours_to_end(dwell) - bent.turn_before(dwell);
        let left = left - bent.rate / 3600.0 * axis[2];
        let axis = turned(axis, yaw);
        let celsius = |dwell: &Dwell| dwell.temperature.get().unwrap_or(0.0);
        let warmer = celsius(dwell) - celsius(first);
        let hours = (dwell.middle - first.middle) / 3600.0;
        let [north, east] = bent.along;
        let turning = -east * axis[0] - north * axis[1];
        let [one, other] = bent.hypothesis.row(self, dwell, axis, turning);
        let left = left / latitude.horizontal_rate();
        ([axis[0], -axis[1], 1.0, hours, warmer, one, other, left], turning)
    }

    /// Time from the end of the last dwell to a dwell, h; negative.
    fn hours_to_end(&self, dwell: &Dwell) -> f64 {
        let end = self.dwells.last().map_or(0.0, |last| last.end());
        (dwell.middle - end) / 3600.0
    }

    /// The two components of the Earth rate in a solution, and the vertical one's, as noise alone
    /// leaves them.
    fn noise_components(&self, solution: &Solution<COLUMNS>) -> Components {
        let [a, b, ..] = solution.coefficients;
        let slope = libm::tan(self.setting.latitude.rad());
        let vertical = [slope * self.tilt.real, slope * self.tilt.imaginary];
        let covariance = block(&solution.covariance);
        Components { value: [a, b], covariance, vertical, half: self.setting.half }
    }

    /// The same, with what tilt and κ leave uncertain.
    fn components(&self, solution: &Solution<COLUMNS>) -> Components {
        let mut components = self.noise_components(solution);
        for errors in self.component_errors() {
            for (i, row) in errors.iter().enumerate() {
                for (j, error) in row.iter().enumerate() {
                    components.covariance[i][j] += error;
                }
            }
        }
        components
    }

    /// Variance of a dwell's mean without drift, in units of `Ω_h`².
    pub(super) fn white_variance(&self, dwell: &Dwell) -> f64 {
        let rate = self.setting.latitude.horizontal_rate();
        let sway = self.setting.sway.angle_mean_variance(dwell.seconds);
        (self.own_variance(dwell) * dwell.taper + sway) / (rate * rate)
    }

    /// What the dwell would have measured on a level stage without the fit's trends, in units of
    /// `Ω_h` and less a constant.
    pub(super) fn level_ratio(&self, fit: &Fit, dwell: &Dwell) -> f64 {
        let (sine, cosine) = libm::sincos(dwell.stage.rad());
        let Direction { azimuth, amplitude, .. } = fit.direction;
        let (east, north) = libm::sincos(azimuth);
        remainder(&self.row(dwell, &fit.bent(fit.model.hypothesis)).0, &fit.coefficients)
            + amplitude * (north * cosine - east * sine)
    }

    /// Variance of an untapered mean that no other dwell shares, (rad/s)²: white noise, and what a
    /// subtracted sway leaves.
    fn own_variance(&self, dwell: &Dwell) -> f64 {
        let seconds = dwell.seconds;
        let noise = || {
            let rounding = self.setting.noise.rounding_variance(seconds);
            self.white / seconds + rounding + self.setting.sway.residual_mean_variance(seconds)
        };
        dwell.stated_variance.get().unwrap_or_else(noise)
    }

    fn whitener(&self, noise: &GyroNoise) -> Whitener<{ COLUMNS + 1 }> {
        let scale = 1.0 / self.setting.latitude.horizontal_rate();
        let shortest = self.dwells.iter().map(|dwell| dwell.seconds).fold(f64::INFINITY, f64::min);
        let relative = GyroNoise {
            bias_instability: noise.bias_instability * scale,
            rate_random_walk: noise.rate_random_walk * scale,
            ..GyroNoise::default()
        };
        let sway = SwayNoise {
            angle_variance: self.setting.sway.angle_variance * scale * scale,
            ..self.setting.sway
        };
        Whitener::new(&relative, shortest).with_sway(&sway)
    }

    /// Gives the row of each dwell, and the same with its noise white. One copy in flash serves
    /// all who want them.
    fn whiten(
        &self,
        noise: &GyroNoise,
        taper: fn(&Dwell) -> f64,
        bent: &Bent,
        each: &mut dyn FnMut(&Row, &Row),
    ) {
        let rate = self.setting.latitude.horizontal_rate();
        let mut whitener = self.whitener(noise);
        for dwell in self.dwells {
            let own = self.own_variance(dwell) * taper(dwell);
            let (row, _) = self.row(dwell, bent);
            let mut white = row;
            whitener.whiten(dwell.start(), dwell.end(), own / (rate * rate), &mut white);
            each(&row, &white);
        }
    }

    fn regression(
        &self,
        noise: &GyroNoise,
        taper: fn(&Dwell) -> f64,
        bent: &Bent,
    ) -> Regression<COLUMNS> {
        let mut regression = Regression::default();
        self.whiten(noise, taper, bent, &mut |_, &[a, b, c, d, e, f, g, left]| {
            regression.push(&[a, b, c, d, e, f, g], left);
        });
        regression
    }
}

impl Fit {
    /// A hypothesis about this fit's azimuth.
    fn bent(&self, hypothesis: Hypothesis) -> Bent {
        Bent { hypothesis, ..self.bent }
    }

    /// Standard deviation of the azimuth, rad.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.budget.sigma()
    }

    /// Puts the two components on the chosen direction and lets the other coefficients follow, as
    /// far as noise and not tilt or κ explains the change.
    fn constrain(
        &mut self,
        solution: &mut Solution<COLUMNS>,
        components: &Components,
        noise: &Components,
    ) {
        let (sine, cosine) = libm::sincos(self.direction.azimuth);
        let wanted = self.direction.components([cosine, sine], components.vertical);
        let free = solution.coefficients;
        let change = [wanted[0] - free[0], wanted[1] - free[1]];
        let weights = inverted(&components.covariance).map_or([0.0; 2], |m| product(&m, change));
        for (index, value) in self.coefficients.iter_mut().enumerate() {
            let row = &solution.covariance[index];
            *value = free[index] + row[0] * weights[0] + row[1] * weights[1];
        }
        self.chi_square = solution.chi_square + dot(change, weights);
        self.degrees = self.model.degrees(solution);
        if let Amplitude::Known(_) = self.model.amplitude {
            tighten(solution, noise, self.model.amplitude);
        }
    }
}

impl Dwell {
    /// The taper as a function, to choose between it and none.
    fn taper_factor(&self) -> f64 {
        self.taper
    }
}

/// Leaves the coefficients' covariance as it is once the components, as noise alone leaves them, may
/// only move with azimuth and amplitude.
fn tighten(solution: &mut Solution<COLUMNS>, noise: &Components, amplitude: Amplitude) {
    let free = noise.covariance;
    let (Some(inverse), Some(direction)) = (inverted(&free), noise.direction(amplitude)) else {
        return;
    };
    let held = direction.components_covariance(noise.vertical);
    let follow: [[f64; 2]; COLUMNS] = core::array::from_fn(|index| {
        product(&inverse, [solution.covariance[index][0], solution.covariance[index][1]])
    });
    let lost = [0, 1].map(|i| [0, 1].map(|j| free[i][j] - held[i][j]));
    for (row, left) in solution.covariance.iter_mut().zip(follow) {
        for (value, right) in row.iter_mut().zip(follow) {
            *value -= dot(left, product(&lost, right));
        }
    }
}

/// An axis of a base that is turned by `yaw`, rad clockwise: as seen from where it stands in the end.
fn turned([forward, right, down]: [f64; 3], yaw: f64) -> [f64; 3] {
    if yaw == 0.0 {
        return [forward, right, down];
    }
    let (sine, cosine) = libm::sincos(yaw);
    [cosine * forward - sine * right, sine * forward + cosine * right, down]
}

/// Left side less the columns' part of it.
fn remainder(row: &Row, coefficients: &[f64; COLUMNS]) -> f64 {
    let fitted: f64 = row.iter().zip(coefficients).map(|(x, c)| x * c).sum();
    row[COLUMNS] - fitted
}

/// The block of the two components.
fn block(covariance: &[[f64; COLUMNS]; COLUMNS]) -> Covariance {
    let [[a, b, ..], [c, d, ..], ..] = *covariance;
    [[a, b], [c, d]]
}

/// xᵀ Cov x of a whitened row.
fn leverage(row: &Row, covariance: &[[f64; COLUMNS]; COLUMNS]) -> f64 {
    let mut sum = 0.0;
    for i in 0..COLUMNS {
        for j in 0..COLUMNS {
            sum += row[i] * row[j] * covariance[i][j];
        }
    }
    sum
}

//! Maximum-likelihood azimuth from dwells at several stage angles: multi-position static alignment.
//!
//! Each dwell is a row: its mean rate, less the vertical Earth rate and the g-sensitivity that act
//! through the tilt, on the sensitive axis' north and east parts, a constant, and where needed time
//! and temperature (the measurement model of Sokolov 2019, Zᵢ = `Ω_h` cos(A + θᵢ) + S + Wᵢ,
//! extended by tilt and trends). Nothing is differenced, because differencing colours the noise.
//! The rows are whitened for the gyro's noise, so the covariance of the fit is the Cramér–Rao bound
//! of its data.

mod hypothesis;
mod model;
mod slow;
mod uncertainty;

pub use hypothesis::{HeadingStep, Hypothesis, Protection};
pub(crate) use model::Model;
pub(crate) use uncertainty::FEW_DEGREES;

use super::direction::{Components, Direction, dot, inverted, product, quadratic};
use super::level::square;
use super::setting::{Amplitude, Setting};
use super::tilt::Tilt;
use crate::alignment::budget::Budget;
use crate::math::{COLUMNS, Regression, Solution};
use crate::noise::GyroNoise;
use crate::noise::whitener::Whitener;
use crate::signal::{Dwell, SwayNoise};
use crate::units::{Radians, RadiansPerSecond, RateRandomWalk};

/// Row of a dwell in the regression: north and east part of the sensitive axis, constant, time
/// since the first dwell (h), temperature above that of the first dwell (°C), two columns of a
/// [`Hypothesis`] and, last, the left side.
type Row = [f64; COLUMNS + 1];

/// Whitened rows of the dwells.
type Equations = Regression<COLUMNS>;

/// Taper factor of a dwell.
type Taper = fn(&Dwell) -> f64;

/// Fitted azimuth with its uncertainty and diagnostics.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Columns that were used.
    pub model: Model,
    /// Azimuth and Earth-rate ratio of the solution.
    pub direction: Direction,
    /// Error budget of the azimuth.
    pub budget: Budget,
    /// Cramér–Rao bound for these columns and all stationary time of these dwells, 1σ.
    pub limit: Radians,
    /// Cramér–Rao bound with the Earth rate free, 1σ.
    pub limit_free: Radians,
    /// Earth-rate ratio `Ω̂_h/Ω_h` with the Earth rate free; not meaningful for two positions,
    /// which do not determine it.
    pub ratio: f64,
    /// 1σ of the ratio: noise, tilt, g-sensitivity and scale.
    pub ratio_sigma: f64,
    /// Chi-square of the residuals.
    pub chi_square: f64,
    /// Degrees of freedom of chi-square.
    pub degrees: usize,
    /// Factor by which the dwells scatter more than their noise; it is included in the budget.
    pub excess: f64,
    /// Most likely heading step in the dwells.
    pub step: Option<HeadingStep>,
    /// Greatest error of the azimuth under alternative explanations of the dwells.
    pub protection: Protection,
    /// Chi-square with the Earth rate free; zero where hypotheses were not compared.
    free_chi_square: f64,
    /// Coefficients of the fit, in units of `Ω_h`.
    coefficients: [f64; COLUMNS],
    /// Linearisation point of the hypothesis columns.
    bent: Bent,
}

/// Fewest dwells that distinguish between hypotheses.
const FEWEST: usize = 8;
/// Number of rounds in which a hypothesis is linearised at the azimuth that it changes: each leaves
/// the square of the change.
const ROUNDS: usize = 3;

/// Linearisation point of the hypothesis columns.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bent {
    /// Hypothesis whose columns are formed.
    hypothesis: Hypothesis,
    /// Components of the Earth rate north and east along body x at the azimuth of a fit, in units
    /// of `Ω_h`.
    along: [f64; 2],
    /// Rate of rotation of the base about the vertical that is already subtracted, rad/h.
    rate: f64,
    /// Heading step that is already subtracted, rad.
    turn: f64,
}

impl Bent {
    /// Heading of the last dwell less that of this dwell due to the step, rad.
    fn turn_before(&self, dwell: &Dwell) -> f64 {
        match self.hypothesis {
            Hypothesis::Stepped { after } if dwell.middle.0 < after => self.turn,
            _ => 0.0,
        }
    }
}

/// Result of one model.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    /// Azimuth and Earth-rate ratio.
    direction: Direction,
    /// Prior knowledge of the Earth rate that was used.
    amplitude: Amplitude,
    /// Chi-square of the residuals.
    chi_square: f64,
    /// Degrees of freedom.
    degrees: usize,
    /// First coefficient of the hypothesis.
    coefficient: f64,
}

/// Fit with the covariance of its coefficients, which only its residuals need.
pub(crate) type Found = (Fit, [[f64; COLUMNS]; COLUMNS]);

/// Residual of one dwell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Measured less fitted rate, including the correlated drift.
    pub rate: RadiansPerSecond,
    /// Innovation of the whitening filter, normalised by its standard deviation.
    pub normalised: f64,
    /// Innovation normalised with the dwell's own influence on the fit (leverage) taken into
    /// account.
    pub studentised: f64,
}

/// What a fit and the dwells before say of one dwell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Rate that the whole model gives: Earth rate, tilt, constant, trends, and the drift that the
    /// dwells before show.
    pub rate: RadiansPerSecond,
    /// Standard deviation of the dwell's own noise about it, 1σ: white noise, and drift that no
    /// dwell before shows.
    pub sigma: RadiansPerSecond,
}

/// Dwells of an alignment with everything that their fit needs.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'a> {
    /// Site and instrument.
    pub setting: &'a Setting,
    /// Tilt of the platform.
    pub tilt: &'a Tilt,
    /// White-noise power N², known or estimated, (rad/s)²·s.
    pub white: f64,
    /// Dwells that take part, in the order of time.
    pub dwells: &'a [&'a Dwell],
}

impl Problem<'_> {
    /// Fits the azimuth; `None` where the positions do not determine it.
    #[inline(never)]
    pub(crate) fn fit(&self) -> Option<Found> {
        let regression = self.coloured(&Bent::default());
        let model = self.choose(&regression)?;
        let mut found = self.fit_model(&regression, &model, &Bent::default())?;
        // On an arc, and with few dwells, the hypotheses cannot be distinguished.
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

    /// Whether the positions determine the Earth rate, regardless of the cost of a trend.
    pub(super) fn is_circle(&self, steady: &Equations) -> bool {
        let model = self.freed(steady, &self.base());
        model.is_some_and(|model| model.amplitude == Amplitude::Free)
    }

    /// Regression of the dwells for the configured noise.
    fn coloured(&self, bent: &Bent) -> Equations {
        self.regression(self.setting.site.noise.model(), taper_of, bent)
    }

    /// Fits with a hypothesis iteratively: its columns follow the azimuth and the rate, which it
    /// changes.
    #[inline(never)]
    fn fit_under(&self, model: &Model, steady: &Fit) -> Option<Found> {
        let mut bent = Bent { hypothesis: model.hypothesis, ..steady.bent };
        for _ in 0..ROUNDS {
            let regression = self.coloured(&bent);
            let trial = self.trial(&regression, model)?;
            bent.along = trial.direction.along();
            if model.hypothesis == Hypothesis::Yawing {
                bent.rate += trial.coefficient;
            }
        }
        let regression = self.coloured(&bent);
        let found = self.fit_model(&regression, &self.freed(&regression, model)?, &bent)?;
        let Fit { step, protection, .. } = *steady;
        Some((Fit { step, protection, ..found.0 }, found.1))
    }

    /// Result of a model; `None` where the dwells do not determine it.
    #[inline(never)]
    fn trial(&self, regression: &Equations, model: &Model) -> Option<Trial> {
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

    /// Complete fit of a model.
    #[inline(never)]
    fn fit_model(&self, regression: &Equations, model: &Model, bent: &Bent) -> Option<Found> {
        let mut solution = regression.solve(&model.columns())?;
        let components = self.components(&solution);
        let direction = components.direction(model.amplitude)?;
        let free = components.free()?;
        let [limit, limit_free] = self.limits(model, bent)?;
        let mut fit = Fit {
            model: *model,
            direction,
            budget: self.budget(regression, model, &direction, bent)?,
            limit: Radians(limit),
            limit_free: Radians(limit_free),
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
        fit.raise(direction.covering, |budget| &mut budget.noise);
        Some((fit, solution.covariance))
    }

    /// Passes each dwell's residual to `each`, in their order, for the result of [`Self::fit`].
    pub(super) fn residuals(&self, (fit, covariance): &Found, mut each: impl FnMut(Residual)) {
        let horizontal = self.setting.site.latitude.horizontal_rate();
        let bent = fit.bent(fit.model.hypothesis);
        self.whiten(self.setting.site.noise.model(), taper_of, &bent, &mut |row, white| {
            let rate = remainder(row, &fit.coefficients) * horizontal.0;
            let normalised = remainder(white, &fit.coefficients);
            let leverage = leverage(white, covariance);
            let studentised = normalised / libm::sqrt((1.0 - leverage).max(0.05));
            each(Residual { rate: RadiansPerSecond(rate), normalised, studentised });
        });
    }

    /// Passes to `each` what the fit predicts of each dwell, in their order.
    pub(super) fn predictions(&self, fit: &Fit, mut each: impl FnMut(Prediction)) {
        let horizontal = self.setting.site.latitude.horizontal_rate();
        let model = self.setting.site.noise.model();
        let bent = fit.bent(fit.model.hypothesis);
        let mut dwells = self.dwells.iter();
        // A filter that has only seen zeros predicts zero, so what it makes of a one is the weight.
        let mut quiet = self.whitener(model);
        self.whiten(model, taper_of, &bent, &mut |_, white| {
            let Some(dwell) = dwells.next() else { return };
            let weight = self.weight(&mut quiet, dwell);
            let sigma = horizontal.0 / weight;
            let innovation = remainder(white, &fit.coefficients) * sigma;
            let rate = RadiansPerSecond(dwell.rate.0 - innovation);
            each(Prediction { rate, sigma: RadiansPerSecond(sigma) });
        });
    }

    /// Weight of a dwell in the whitened rows, in units of 1/`Ω_h`, by a filter that takes nothing
    /// but zeros.
    fn weight(&self, quiet: &mut Whitener<{ COLUMNS + 1 }>, dwell: &Dwell) -> f64 {
        let rate = self.setting.site.latitude.horizontal_rate();
        let white = self.own_variance(dwell) * taper_of(dwell) / (rate.0 * rate.0);
        let (start, end) = (dwell.start().0, dwell.end().0);
        let mut one = [1.0; COLUMNS + 1];
        quiet.clone().whiten(start, end, white, &mut one);
        quiet.whiten(start, end, white, &mut [0.0; COLUMNS + 1]);
        one[0]
    }

    /// Row of a dwell: its columns and, last, its left side, all in units of `Ω_h`; and the
    /// derivative of the rate with respect to azimuth, ∂/∂A, in these units.
    fn row(&self, dwell: &Dwell, bent: &Bent) -> (Row, f64) {
        let mount = &self.setting.mount;
        let tilt = self.tilt.at(dwell.middle.0);
        let axis = (mount.axis)(&tilt, dwell);
        let force = (mount.force)(&tilt, dwell);
        let latitude = self.setting.site.latitude;
        let [own, across] = self.setting.site.g_sensitivity;
        let first = self.dwells[0];
        let [forward, right] = tilt.turning(tilt.rate.value);
        let left = dwell.rate.0 - first.rate.0 + latitude.vertical_rate().0 * axis[2]
            - dot([own.0, across.0], force)
            - (axis[0] * forward + axis[1] * right);
        let yaw = bent.rate * self.hours_to_end(dwell) - bent.turn_before(dwell);
        let left = left - bent.rate / 3600.0 * axis[2];
        let axis = turned(axis, yaw);
        let celsius = |dwell: &Dwell| dwell.temperature.get().unwrap_or(0.0);
        let warmer = celsius(dwell) - celsius(first);
        let hours = (dwell.middle.0 - first.middle.0) / 3600.0;
        let [north, east] = bent.along;
        let turning = -east * axis[0] - north * axis[1];
        let [one, other] = bent.hypothesis.row(self, dwell, axis, turning);
        let left = left / latitude.horizontal_rate().0;
        ([axis[0], -axis[1], 1.0, hours, warmer, one, other, left], turning)
    }

    /// Time from the end of the last dwell to the middle of a dwell, h; negative.
    fn hours_to_end(&self, dwell: &Dwell) -> f64 {
        let end = self.dwells.last().map_or(0.0, |last| last.end().0);
        (dwell.middle.0 - end) / 3600.0
    }

    /// Components of the horizontal Earth rate in a solution, with the covariance from noise alone,
    /// and those of the vertical one through the tilt.
    fn noise_components(&self, solution: &Solution<COLUMNS>) -> Components {
        let [a, b, ..] = solution.coefficients;
        let slope = libm::tan(self.setting.site.latitude.rad());
        let vertical = [slope * self.tilt.real, slope * self.tilt.imaginary];
        let covariance = square(&solution.covariance, 0);
        Components { value: [a, b], covariance, vertical, half: self.setting.half }
    }

    /// Components with the uncertainty of tilt and κ added to their covariance.
    fn components(&self, solution: &Solution<COLUMNS>) -> Components {
        let mut components = self.noise_components(solution);
        for errors in self.component_errors() {
            let noise = components.covariance;
            components.covariance = [0, 1].map(|i| [0, 1].map(|j| noise[i][j] + errors[i][j]));
        }
        components
    }

    /// Variance of a dwell's mean without drift, in units of `Ω_h`².
    pub(super) fn white_variance(&self, dwell: &Dwell) -> f64 {
        let rate = self.setting.site.latitude.horizontal_rate();
        let sway = self.setting.sway.angle_mean_variance(dwell.seconds.0);
        (self.own_variance(dwell) * dwell.taper + sway) / (rate.0 * rate.0)
    }

    /// Rate that the dwell would have measured on a level stage without the fit's trends, in units
    /// of `Ω_h` and less a constant.
    pub(super) fn level_ratio(&self, fit: &Fit, dwell: &Dwell) -> f64 {
        let (sine, cosine) = libm::sincos(dwell.stage.rad());
        let Direction { azimuth, amplitude, .. } = fit.direction;
        let (east, north) = libm::sincos(azimuth);
        remainder(&self.row(dwell, &fit.bent(fit.model.hypothesis)).0, &fit.coefficients)
            + amplitude * (north * cosine - east * sine)
    }

    /// Variance of an untapered mean that is independent of other dwells, (rad/s)²: white noise,
    /// and the remainder of sway compensation.
    fn own_variance(&self, dwell: &Dwell) -> f64 {
        let seconds = dwell.seconds;
        let noise = || {
            let rounding = self.setting.site.noise.model().rounding_variance(seconds.0);
            self.white / seconds.0 + rounding + self.setting.sway.residual_mean_variance(seconds.0)
        };
        dwell.stated_variance.get().unwrap_or_else(noise)
    }

    /// Whitening filter for this noise, in units of `Ω_h`.
    fn whitener(&self, noise: &GyroNoise) -> Whitener<{ COLUMNS + 1 }> {
        let scale = 1.0 / self.setting.site.latitude.horizontal_rate().0;
        let shortest =
            self.dwells.iter().map(|dwell| dwell.seconds.0).fold(f64::INFINITY, f64::min);
        let relative = GyroNoise {
            bias_instability: RadiansPerSecond(noise.bias_instability.0 * scale),
            rate_random_walk: RateRandomWalk(noise.rate_random_walk.0 * scale),
            ..GyroNoise::default()
        };
        let sway = SwayNoise {
            angle_variance: self.setting.sway.angle_variance * scale * scale,
            ..self.setting.sway
        };
        Whitener::new(&relative, shortest).with_sway(&sway)
    }

    /// Passes the row of each dwell, and the whitened row, to `each`. It is one function for all
    /// callers, so that flash holds one copy.
    fn whiten(
        &self,
        noise: &GyroNoise,
        taper: Taper,
        bent: &Bent,
        each: &mut dyn FnMut(&Row, &Row),
    ) {
        let rate = self.setting.site.latitude.horizontal_rate();
        let mut whitener = self.whitener(noise);
        for dwell in self.dwells {
            let own = self.own_variance(dwell) * taper(dwell);
            let (row, _) = self.row(dwell, bent);
            let mut white = row;
            whitener.whiten(dwell.start().0, dwell.end().0, own / (rate.0 * rate.0), &mut white);
            each(&row, &white);
        }
    }

    /// Regression of the whitened rows.
    fn regression(&self, noise: &GyroNoise, taper: Taper, bent: &Bent) -> Equations {
        let mut regression = Regression::default();
        self.whiten(noise, taper, bent, &mut |_, &[a, b, c, d, e, f, g, left]| {
            regression.push(&[a, b, c, d, e, f, g], left);
        });
        regression
    }
}

impl Fit {
    /// Linearisation point of a hypothesis at this fit's azimuth.
    fn bent(&self, hypothesis: Hypothesis) -> Bent {
        Bent { hypothesis, ..self.bent }
    }

    /// Standard deviation of the azimuth.
    pub fn sigma(&self) -> Radians {
        self.budget.sigma()
    }

    /// Moves the two components onto the chosen direction and lets the other coefficients follow,
    /// as far as noise, and not tilt or κ, explains the change.
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

/// Taper factor of a dwell, as a function that can be replaced by one.
fn taper_of(dwell: &Dwell) -> f64 {
    dwell.taper
}

/// Reduces the coefficients' covariance to that of components that, as far as noise goes, may only
/// move with azimuth and amplitude.
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

/// Axis of a base that is turned by `yaw`, rad clockwise, in the frame in which the base stands at
/// the end.
fn turned([forward, right, down]: [f64; 3], yaw: f64) -> [f64; 3] {
    if yaw == 0.0 {
        return [forward, right, down];
    }
    let (sine, cosine) = libm::sincos(yaw);
    [cosine * forward - sine * right, sine * forward + cosine * right, down]
}

/// Left side less the fitted value.
fn remainder(row: &Row, coefficients: &[f64; COLUMNS]) -> f64 {
    let fitted: f64 = row.iter().zip(coefficients).map(|(x, c)| x * c).sum();
    row[COLUMNS] - fitted
}

/// Leverage xᵀ Cov x of a whitened row.
fn leverage(row: &Row, covariance: &[[f64; COLUMNS]; COLUMNS]) -> f64 {
    let mut sum = 0.0;
    for i in 0..COLUMNS {
        for j in 0..COLUMNS {
            sum += row[i] * row[j] * covariance[i][j];
        }
    }
    sum
}

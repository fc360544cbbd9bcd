//! What else than a base that stands may explain the dwells: a base that turns slowly, one that was turned or
//! an encoder that slipped, an encoder that errs twice a turn, a drift that bends.
//!
//! Each adds columns that follow the azimuth's own, ∂/∂A, of the steady fit. Where chi-square says so they are
//! used or, where nobody can say which side of a step is right, refused. Where it does not, they are weighed:
//! σ grows by what each would change, times its probability.

use super::super::different_positions;
use super::super::direction::Amplitude;
use super::super::regression::Column;
use super::{Fit, Model, Problem, Row, Trial};
use crate::math::chi_square_tail;
use crate::signal::dwell::Dwell;

/// What moves beside the stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Hypothesis {
    /// Nothing.
    #[default]
    Steady,
    /// The base turns about the vertical; its coefficient is the rate, rad/h.
    Yawing,
    /// The encoder errs twice a turn; its coefficients are the error's parts along sin 2θ and cos 2θ, rad.
    Elliptic,
    /// A drift that no key states is no straight line: its coefficient is the curvature, in units of `Ω_h` per h².
    Curved,
    /// The heading is another one after this time, s; its coefficient is the change, rad.
    Stepped {
        /// When, s.
        after: f64,
    },
}

/// A change of heading between two dwells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadingStep {
    /// After which time, s.
    pub after: f64,
    /// By how much, rad: the azimuth that the later dwells show less that of the earlier ones.
    pub angle: f64,
    /// By how much it lowers chi-square.
    pub gain: f64,
}

/// Part of the sessions in which a hypothesis holds, before the dwells are looked at.
const PRIOR: f64 = 0.005;
/// The same of one that nothing in the dwells speaks for.
const UNSEEN: f64 = 3e-4;
/// The same of a drift that bends, where the dwells show one that no key states.
const BENDING: f64 = 0.5;
/// Degrees of freedom that a hypothesis must leave to be believed: with fewer, anything fits.
const FREEDOM: usize = 6;
/// What one doubt may add to the azimuth's variance, in units of it: σ is then twice as great.
const DOUBT: f64 = 3.0;
/// Probability that it must leave to the residuals: it is not the explanation where much remains to explain.
const LEFT: f64 = 0.01;
/// Part of a step's information that is left where the model's columns take all of it.
const LEAST_INFORMATION: f64 = 1e-6;
/// Chi-square by which another hypothesis must explain more than a step before the step is passed over.
const CLEARLY: f64 = 10.0;
/// Chi-square that a trend less is worth, where a hypothesis explains as much without it.
const SPARED: f64 = 6.0;
/// Gain of chi-square from which one more column is believed (p = 0.0001), and two.
const BELIEVED: [f64; 2] = [15.1, 18.4];
/// Gain of chi-square from which one more column is doubtful (p = 0.01), and two.
const DOUBTFUL: [f64; 2] = [6.63, 9.21];
/// The same of a step for each place at which it may be (p = 0.01 over all of them).
const STEP_DOUBTFUL: f64 = 6.63;
/// Gain from which a step is believed for each place at which it may be: p = 0.001 over all of them.
const STEP_BELIEVED: f64 = 10.8;
/// By how much a hypothesis may raise the variance of the azimuth; beyond, the dwells do not show it.
const OBSERVABLE: f64 = 100.0;
/// The same of a step: a circle in which it lies in the middle makes it four times.
const STEP_OBSERVABLE: f64 = 25.0;
/// Fewest positions of a circle that show an elliptic encoder: of four the third harmonic looks like the first.
const ELLIPSE_POSITIONS: usize = 5;
/// The same of an elliptic encoder, which four positions and arcs do not show: a circle doubles it.
const ELLIPSE_OBSERVABLE: f64 = 4.0;

impl Hypothesis {
    /// How its columns enter.
    pub(super) fn columns(self) -> [Column; 2] {
        match self {
            Self::Steady => [Column::Absent; 2],
            Self::Yawing | Self::Curved | Self::Stepped { .. } => [Column::Free, Column::Absent],
            Self::Elliptic => [Column::Free; 2],
        }
    }

    /// Its columns of a dwell, in units of `Ω_h`, for the sensitive axis in the levelled frame and what turning
    /// the azimuth does to the rate, ∂/∂A. The azimuth is then that of the last dwell's end.
    pub(super) fn row(
        self,
        problem: &Problem,
        dwell: &Dwell,
        axis: [f64; 3],
        turning: f64,
    ) -> [f64; 2] {
        match self {
            Self::Steady => [0.0; 2],
            Self::Yawing => {
                let vertical = axis[2] / (3600.0 * problem.setting.latitude.horizontal_rate());
                [problem.hours_to_end(dwell) * turning + vertical, 0.0]
            }
            Self::Curved => {
                let begin = problem.dwells.first().map_or(0.0, |first| first.middle);
                let hours = (dwell.middle - begin) / 3600.0;
                [hours * (hours + problem.hours_to_end(dwell)), 0.0]
            }
            Self::Elliptic => {
                let (sine, cosine) = libm::sincos(2.0 * dwell.stage.rad());
                [sine * turning, cosine * turning]
            }
            Self::Stepped { after } => [if dwell.middle < after { -turning } else { 0.0 }, 0.0],
        }
    }

    /// Gain of chi-square from which it is believed, of so many dwells.
    fn believed(self, dwells: usize) -> f64 {
        match self {
            Self::Steady => f64::INFINITY,
            Self::Yawing | Self::Curved => BELIEVED[0],
            Self::Elliptic => BELIEVED[1],
            Self::Stepped { .. } => STEP_BELIEVED + 2.0 * libm::log(dwells as f64),
        }
    }

    /// Gain from which it is doubtful whether it does not hold (p = 0.01), of so many dwells. A base that turns and a
    /// drift that bends are always: they may change the azimuth by far more than they show.
    fn doubtful(self, dwells: usize) -> f64 {
        match self {
            Self::Steady | Self::Yawing | Self::Curved => 0.0,
            Self::Elliptic => DOUBTFUL[1],
            Self::Stepped { .. } => STEP_DOUBTFUL + 2.0 * libm::log(dwells as f64),
        }
    }

    /// How much wider its azimuth's variance may be.
    fn observable(self) -> f64 {
        match self {
            Self::Elliptic => ELLIPSE_OBSERVABLE,
            Self::Stepped { .. } => STEP_OBSERVABLE,
            _ => OBSERVABLE,
        }
    }
}

/// A hypothesis against the steady fit.
#[derive(Clone, Copy)]
struct Weighed {
    model: Model,
    /// Gain of chi-square, in the scatter that the hypothesis leaves.
    gain: f64,
    /// The gain with the Earth rate free, over that from which the hypothesis is believed.
    belief: f64,
    /// By how much it moves the azimuth, rad, and widens its variance, rad².
    shift: f64,
    widening: f64,
    /// Its first coefficient.
    coefficient: f64,
}

impl Weighed {
    /// What the azimuth's variance lacks while the hypothesis is not believed, rad².
    fn variance(&self, dwells: usize) -> f64 {
        if self.gain < self.model.hypothesis.doubtful(dwells) {
            return 0.0;
        }
        let prior = match self.model.hypothesis {
            // It may be at any of many places, which share the probability.
            Hypothesis::Stepped { .. } => PRIOR / dwells as f64,
            Hypothesis::Curved => BENDING,
            _ if self.gain < DOUBTFUL[0] => UNSEEN,
            _ => PRIOR,
        };
        let odds = prior * libm::exp(0.5 * self.gain.min(50.0));
        odds / (1.0 + odds) * (self.shift * self.shift + self.widening)
    }

    /// What the azimuth's variance lacks where another hypothesis is believed that explains more, rad².
    fn variance_beside(&self, best: &Self) -> f64 {
        let odds = libm::exp(0.5 * (self.gain - best.gain).min(0.0));
        let apart = self.shift - best.shift;
        if self.model.hypothesis == best.model.hypothesis {
            0.0
        } else {
            odds / (1.0 + odds) * apart * apart
        }
    }

    /// Whether the azimuth can be found with it: of a step nobody knows which side is right.
    fn is_model(&self) -> bool {
        !matches!(self.model.hypothesis, Hypothesis::Stepped { .. })
    }

    /// The step of the heading that it is, where that is believed.
    fn step(&self) -> Option<HeadingStep> {
        let Hypothesis::Stepped { after } = self.model.hypothesis else { return None };
        let (angle, gain) = (self.coefficient, self.gain);
        (self.belief >= 1.0).then_some(HeadingStep { after, angle, gain })
    }
}

/// The one that explains most.
fn greatest<'a>(of: impl Iterator<Item = &'a Weighed>) -> Option<&'a Weighed> {
    of.fold(None, |best, one| match best {
        Some(best) if best.gain >= one.gain => Some(best),
        _ => Some(one),
    })
}

impl Problem<'_> {
    /// Weighs every hypothesis against a steady fit; gives the model to fit with, and what the others leave
    /// to the azimuth's variance beside it, rad².
    #[inline(never)]
    pub(super) fn weigh(&self, fit: &mut Fit, steady: &Trial) -> Option<(Model, f64)> {
        let step = |model: &Model| match self.likeliest_step(model, fit) {
            Some(after) => Hypothesis::Stepped { after },
            None => Hypothesis::Steady,
        };
        let drift =
            if fit.model.time == Column::Free { Hypothesis::Curved } else { Hypothesis::Steady };
        let [with, without] = [step(&fit.model), step(&self.base())];
        let without = if with == without { Hypothesis::Steady } else { without };
        let weighed = [Hypothesis::Yawing, Hypothesis::Elliptic, drift, with, without]
            .map(|hypothesis| self.weighed(hypothesis, fit, steady));
        let all = || weighed.iter().flatten();
        let best = greatest(all().filter(|one| one.is_model() && one.belief >= 1.0));
        let step = greatest(all().filter(|one| one.step().is_some()));
        let is_passed = |step: &&Weighed| best.is_some_and(|best| best.gain > step.gain + CLEARLY);
        fit.step = step.filter(|step| !is_passed(step)).and_then(Weighed::step);
        if let Some(best) = best {
            let beside = all().map(|other| other.variance_beside(best)).sum();
            return Some((Model { amplitude: fit.model.amplitude, ..best.model }, beside));
        }
        for one in all().filter(|one| one.belief < 1.0) {
            let part = match one.model.hypothesis {
                Hypothesis::Elliptic => &mut fit.budget.encoder,
                _ => &mut fit.budget.drift,
            };
            let most = DOUBT * steady.direction.variance;
            *part = libm::hypot(*part, libm::sqrt(one.variance(self.dwells.len()).min(most)));
        }
        None
    }

    /// One hypothesis, with the trends of the steady fit or without those that it spares.
    fn weighed(&self, hypothesis: Hypothesis, fit: &Fit, steady: &Trial) -> Option<Weighed> {
        let with = self.weighed_with(&Model { hypothesis, ..fit.model }, fit, steady);
        let plain = Model { hypothesis, ..self.base() };
        if hypothesis == Hypothesis::Curved || fit.model.is_as_plain_as(&plain) {
            return with;
        }
        let spared = self.weighed_with(&plain, fit, steady);
        let spared = spared.map(|weighed| Weighed { gain: weighed.gain + SPARED, ..weighed });
        match (with, spared) {
            (Some(with), Some(spared)) if with.gain > spared.gain => Some(with),
            (with, spared) => spared.or(with),
        }
    }

    /// A model with a hypothesis; none where the dwells cannot show it.
    #[inline(never)]
    fn weighed_with(&self, model: &Model, fit: &Fit, steady: &Trial) -> Option<Weighed> {
        let hypothesis = model.hypothesis;
        let is_hidden = hypothesis == Hypothesis::Elliptic
            && different_positions(self.dwells) < ELLIPSE_POSITIONS;
        if hypothesis == Hypothesis::Steady || is_hidden {
            return None;
        }
        let bent = fit.bent(hypothesis);
        let regression = self.regression(&self.setting.noise, Dwell::taper_factor, &bent);
        let trial = self.trial(&regression, &Model { amplitude: steady.amplitude, ..*model })?;
        let free = self.trial(&regression, &Model { amplitude: Amplitude::Free, ..*model })?;
        let most = hypothesis.observable() * steady.direction.variance;
        if trial.degrees == 0 || trial.direction.variance > most {
            return None;
        }
        let mut shift = trial.direction.azimuth - steady.direction.azimuth;
        if let Hypothesis::Stepped { .. } = hypothesis {
            // Either side may be the right one.
            let before = shift - trial.coefficient;
            shift = if before.abs() > shift.abs() { before } else { shift };
        }
        let is_trusted = !matches!(hypothesis, Hypothesis::Stepped { .. });
        let is_vague = is_trusted && (free.degrees < FREEDOM || free.probability() < LEFT);
        let believed =
            if is_vague { f64::INFINITY } else { hypothesis.believed(self.dwells.len()) };
        Some(Weighed {
            model: *model,
            gain: trial.gain(steady.chi_square),
            belief: free.gain(fit.free_chi_square) / believed,
            shift,
            widening: (trial.direction.variance - steady.direction.variance).max(0.0),
            coefficient: trial.coefficient,
        })
    }

    /// After which time the heading most likely stepped, s: where the residuals of a model show most of the
    /// azimuth behind it, less what the model's own columns take of that; each weighed as if it were white.
    #[inline(never)]
    fn likeliest_step(&self, model: &Model, fit: &Fit) -> Option<f64> {
        let bent = fit.bent(Hypothesis::Steady);
        let regression = self.regression(&self.setting.noise, Dwell::taper_factor, &bent);
        let solution = regression.solve(&model.columns())?;
        let (mut power, mut score, mut shared) = (0.0, 0.0, Row::default());
        let mut best = (0.0, 0.0);
        for pair in self.dwells.windows(2) {
            let (row, turning) = self.row(pair[0], &bent);
            let weight = turning / self.white_variance(pair[0]);
            power += turning * weight;
            score += weight * super::remainder(&row, &solution.coefficients);
            for (sum, value) in shared.iter_mut().zip(&row) {
                *sum += weight * value;
            }
            let information = power - super::leverage(&shared, &solution.covariance);
            let gain = score * score / information.max(LEAST_INFORMATION * power);
            if gain > best.0 {
                best = (gain, 0.5 * (pair[0].middle + pair[1].middle));
            }
        }
        (best.0 > 0.0).then_some(best.1)
    }
}

impl Trial {
    /// Probability of the residuals.
    fn probability(&self) -> f64 {
        chi_square_tail(self.chi_square, self.degrees as f64)
    }

    /// By how much chi-square is less than `before`, in the scatter that is left.
    fn gain(&self, before: f64) -> f64 {
        (before - self.chi_square) / (self.chi_square / self.degrees.max(1) as f64).max(1.0)
    }
}

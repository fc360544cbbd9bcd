//! Alternative explanations of the dwells beside a steady base: a base that rotates slowly, a
//! heading step or encoder slip, an encoder error twice per turn, a curved drift.
//!
//! Each adds columns that follow the azimuth's own, ∂/∂A, of the steady fit. Where chi-square
//! requires one it is used or, where either side of a step may be the right one, refused. Where it
//! remains possible, σ covers it by solution separation, as in integrity monitoring: the distance
//! of its azimuth from the one given, plus an allowance for what may remain unseen.

use super::{Equations, Fit, Model, Problem, ROUNDS, Row, Trial, taper_of};
use crate::alignment::stepwise::different_positions;
use crate::alignment::stepwise::setting::Amplitude;
use crate::math::{Column, chi_square_tail};
use crate::signal::Dwell;
use crate::units::{Radians, Seconds};

/// Motion or error in addition to the steps of the stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Hypothesis {
    /// No additional motion: the base stands.
    #[default]
    Steady,
    /// Rotation of the base about the vertical; the coefficient is its rate, rad/h.
    Yawing,
    /// Encoder error twice per turn; the coefficients are its parts along sin 2θ and cos 2θ, rad.
    Elliptic,
    /// Curved drift that is not configured; the coefficient is its curvature, in units of `Ω_h` per
    /// h².
    Curved,
    /// Drift with changing curvature; the coefficients are the curvature and, per h³, its change.
    Winding,
    /// Heading step after this time, s; the coefficient is its angle, rad.
    Stepped {
        /// Time of the step, s.
        after: f64,
    },
}

/// Heading step between two dwells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadingStep {
    /// Time of the step.
    pub after: Seconds,
    /// Size of the step: azimuth of the later dwells less that of the earlier ones.
    pub angle: Radians,
    /// Reduction of chi-square by the step.
    pub explained: f64,
    /// Reduction of chi-square in units of the scatter that remains.
    pub gain: f64,
    /// Whether the step is significant.
    pub is_believed: bool,
}

/// Degrees of freedom that must remain for a hypothesis to be accepted: with fewer, anything fits.
const FREEDOM: usize = 6;
/// Least probability of the residuals under a hypothesis: it is not the explanation where much
/// remains unexplained.
const LEFT: f64 = 0.01;
/// Least relative information of a step where the model's columns explain it.
const LEAST_INFORMATION: f64 = 1e-6;
/// Chi-square by which another hypothesis must explain more than a step for the step to be
/// disregarded.
const CLEARLY: f64 = 10.0;
/// Chi-square credited for one trend less, where a hypothesis explains as much without it.
const SPARED: f64 = 6.0;
/// Gain of chi-square from which one additional column is accepted (p = 0.0001), and two.
const BELIEVED: [f64; 2] = [15.1, 18.4];
/// Gain of chi-square from which a step is accepted for each place at which it may be: p = 0.0002
/// over all of them.
const STEP_BELIEVED: f64 = 13.8;
/// Greatest factor by which a hypothesis may raise the variance of the azimuth; beyond it the
/// dwells do not determine both.
pub(super) const OBSERVABLE: f64 = 100.0;
/// Chi-square of one degree of freedom from which σ covers a hypothesis that is not accepted: noise
/// exceeds it with a probability of 0.025.
const COVERED: f64 = 5.02;
/// Chi-square from which σ covers a hypothesis whose 1σ would put the azimuth wrong: noise exceeds
/// it with a probability of 0.1.
const FAR_COVERED: f64 = 2.71;
/// Allowance, in σ of an alternative's azimuth, for its being further away than it shows: one of
/// fifty is.
pub(super) const MISSED: f64 = 1.8;
/// Multiple of σ beyond which an azimuth counts as wrong: σ is at least the protection level over
/// this factor.
pub(super) const WRONG: f64 = 5.0;
/// Change of heading, rad, from which a step or a rotation is fitted again with its exact angle:
/// its square is then a tenth of a step that is just detected.
const TURNED: f64 = 0.003;
/// Fewest positions on a circle that show an encoder error twice per turn: with four the third
/// harmonic looks like the first.
const ELLIPSE_POSITIONS: usize = 5;
/// Greatest variance factor of the hypothesis of an encoder error, which four positions and arcs do
/// not show: a circle doubles the variance.
const ELLIPSE_OBSERVABLE: f64 = 4.0;

impl Hypothesis {
    /// Use of the two hypothesis columns.
    pub(super) fn columns(self) -> [Column; 2] {
        match self {
            Self::Steady => [Column::Absent; 2],
            Self::Yawing | Self::Curved | Self::Stepped { .. } => [Column::Free, Column::Absent],
            Self::Elliptic | Self::Winding => [Column::Free; 2],
        }
    }

    /// Columns of a dwell, in units of `Ω_h`, for the sensitive axis in the levelled frame and the
    /// derivative of the rate with respect to azimuth, ∂/∂A. The azimuth is then that at the end of
    /// the last dwell.
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
                let vertical =
                    axis[2] / (3600.0 * problem.setting.site.latitude.horizontal_rate().0);
                [problem.hours_to_end(dwell) * turning + vertical, 0.0]
            }
            Self::Curved | Self::Winding => {
                let begin = problem.dwells.first().map_or(0.0, |first| first.middle.0);
                let (hours, to_end) =
                    ((dwell.middle.0 - begin) / 3600.0, problem.hours_to_end(dwell));
                let curve = hours * to_end;
                [curve, curve * (hours + to_end)]
            }
            Self::Elliptic => {
                let (sine, cosine) = libm::sincos(2.0 * dwell.stage.rad());
                [sine * turning, cosine * turning]
            }
            Self::Stepped { after } => [if dwell.middle.0 < after { -turning } else { 0.0 }, 0.0],
        }
    }

    /// Gain of chi-square from which the hypothesis is accepted, for this number of dwells.
    fn believed(self, dwells: usize) -> f64 {
        match self {
            Self::Steady => f64::INFINITY,
            Self::Yawing | Self::Curved => BELIEVED[0],
            Self::Elliptic | Self::Winding => BELIEVED[1],
            Self::Stepped { .. } => STEP_BELIEVED + 2.0 * libm::log(dwells as f64),
        }
    }

    /// Gain below which the hypothesis is disregarded in a session without other anomalies; for a
    /// step it is increased by the gain that chance achieves over so many dwells. `is_far` is set
    /// where its 1σ would put the azimuth wrong.
    fn least_covered(self, dwells: usize, is_far: bool) -> f64 {
        let one = if is_far { FAR_COVERED } else { COVERED };
        match self {
            Self::Stepped { .. } => one + 2.0 * libm::log(dwells as f64),
            _ => one,
        }
    }

    /// Greatest factor on the azimuth's variance under the hypothesis.
    fn observable(self) -> f64 {
        match self {
            Self::Elliptic => ELLIPSE_OBSERVABLE,
            _ => OBSERVABLE,
        }
    }
}

/// Greatest error of the azimuth under the alternatives, rad: its protection level, the maximum
/// over all of them as in integrity monitoring (solution separation).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Protection {
    /// Level under the alternatives that may remain hidden in any session.
    pub always: Radians,
    /// Level that also includes the alternatives that matter only where an anomaly shows.
    pub anomalous: Radians,
}

/// Comparison of a hypothesis with the steady fit.
#[derive(Clone, Copy)]
struct Weighed {
    /// Model with the hypothesis.
    model: Model,
    /// Reduction of chi-square.
    explained: f64,
    /// Scatter that remains, in units of the stated noise's variance; at least one.
    scatter: f64,
    /// Gain with the Earth rate free, over the gain from which the hypothesis is accepted.
    belief: f64,
    /// Azimuth under the hypothesis, rad, and its 1σ.
    azimuth: f64,
    sigma: f64,
    /// First coefficient of the hypothesis.
    coefficient: f64,
    /// Whether the model keeps the trends of the steady fit and only adds to them.
    is_nested: bool,
}

impl Weighed {
    /// Reduction of chi-square in units of the scatter that remains.
    fn gain(&self) -> f64 {
        self.explained / self.scatter
    }

    /// Greatest error of an azimuth with its 1σ under the hypothesis, rad: limited by its gain
    /// where it only adds to the steady fit; for a step either side may be the right one.
    fn protection(&self, azimuth: f64, sigma: f64) -> f64 {
        let allowed = libm::sqrt(self.gain().max(0.0)) * self.sigma;
        let farthest = if self.is_nested { allowed } else { f64::INFINITY };
        let apart = |other: f64| separation(other, azimuth).min(farthest);
        let after = apart(self.azimuth) + MISSED * self.sigma;
        if self.is_model() {
            return after;
        }
        after.max(apart(self.azimuth - self.coefficient) + MISSED * sigma)
    }

    /// Whether the dwells do not determine the azimuth under the hypothesis: then it is no model,
    /// but σ covers it where it explains them.
    fn is_lost(&self, steady: &Trial) -> bool {
        let most = self.model.hypothesis.observable() * steady.direction.variance;
        self.sigma * self.sigma > most
    }

    /// Whether it explains so much more than another that the other is disregarded.
    fn beats(&self, other: &Self) -> bool {
        self.explained > other.explained + CLEARLY * self.scatter
    }

    /// Whether the azimuth can be found with it; for a step it is undetermined which side is right.
    fn is_model(&self) -> bool {
        !matches!(self.model.hypothesis, Hypothesis::Stepped { .. })
    }

    /// Heading step of the hypothesis, if it is one.
    fn step(&self) -> Option<HeadingStep> {
        let Hypothesis::Stepped { after } = self.model.hypothesis else { return None };
        let Self { coefficient: angle, explained, belief, .. } = *self;
        let (after, angle, is_believed) = (Seconds(after), Radians(angle), belief >= 1.0);
        Some(HeadingStep { after, angle, explained, gain: self.gain(), is_believed })
    }
}

/// Distance between two azimuths, rad, 0 to π.
pub(super) fn separation(one: f64, other: f64) -> f64 {
    let (sine, cosine) = libm::sincos(one - other);
    libm::atan2(sine, cosine).abs()
}

/// Comparison that explains most.
fn greatest<'a>(of: impl Iterator<Item = &'a Weighed>) -> Option<&'a Weighed> {
    of.fold(None, |best, one| match best {
        Some(best) if best.explained >= one.explained => Some(best),
        _ => Some(one),
    })
}

impl Problem<'_> {
    /// Compares every hypothesis with a steady fit and stores its step and protection level;
    /// returns the model to fit with where one is accepted.
    #[inline(never)]
    pub(super) fn weigh(&self, fit: &mut Fit, steady: &Trial) -> Option<Model> {
        let weighed = self.candidates(fit).map(|candidate| self.weighed(candidate, fit, steady));
        let all = || weighed.iter().flatten();
        let best = greatest(all().filter(|one| one.is_model() && one.belief >= 1.0));
        let step = greatest(all().filter(|one| one.step().is_some()));
        let is_beaten = |one: &Weighed| best.is_some_and(|best| best.beats(one));
        fit.step = step.filter(|step| !is_beaten(step)).and_then(Weighed::step);
        let winding = best.and_then(|bent| self.winding(bent, fit, steady));
        let is_winding = winding.as_ref().is_some_and(|winding| winding.gain() > BELIEVED[0]);
        let best = if is_winding { winding.as_ref() } else { best };
        let azimuth = best.map_or(steady.direction.azimuth, |best| best.azimuth);
        let sigma = libm::sqrt(steady.direction.variance);
        let used = best.map_or(Hypothesis::Steady, |best| best.model.hypothesis);
        let beyond = winding.as_ref().filter(|_| !is_winding);
        let beyond = beyond.map_or(0.0, |winding| winding.protection(azimuth, sigma));
        fit.protection = Protection { always: Radians(beyond), anomalous: Radians(beyond) };
        for one in all().filter(|one| one.model.hypothesis != used && !is_beaten(one)) {
            let level = one.protection(azimuth, sigma);
            let is_lost = one.is_lost(steady);
            let is_far = one.sigma > WRONG * sigma && !is_lost;
            let is_covered =
                one.gain() >= one.model.hypothesis.least_covered(self.dwells.len(), is_far);
            if is_covered || !is_lost {
                fit.protection.anomalous = Radians(fit.protection.anomalous.0.max(level));
            }
            if is_covered {
                fit.protection.always = Radians(fit.protection.always.0.max(level));
            }
        }
        best.map(|best| Model { amplitude: fit.model.amplitude, ..best.model })
    }

    /// Hypotheses to be compared; [`Hypothesis::Steady`] fills unused places.
    fn candidates(&self, fit: &Fit) -> [Hypothesis; 5] {
        let step = |model: &Model| match self.likeliest_step(model, fit) {
            Some(after) => Hypothesis::Stepped { after },
            None => Hypothesis::Steady,
        };
        let drift =
            if fit.model.time == Column::Free { Hypothesis::Curved } else { Hypothesis::Steady };
        let [with, without] = [step(&fit.model), step(&self.base())];
        let without = if with == without { Hypothesis::Steady } else { without };
        [Hypothesis::Yawing, Hypothesis::Elliptic, drift, with, without]
    }

    /// Drift with changing curvature, where a curved drift explains most, because a warm-up is no
    /// parabola. Its gain is counted from that of the curved drift.
    fn winding(&self, bent: &Weighed, fit: &Fit, steady: &Trial) -> Option<Weighed> {
        if bent.model.hypothesis != Hypothesis::Curved {
            return None;
        }
        let winding = self.weighed(Hypothesis::Winding, fit, steady)?;
        Some(Weighed { explained: winding.explained - bent.explained, ..winding })
    }

    /// Comparison of one hypothesis, with the trends of the steady fit or without those that it
    /// replaces.
    fn weighed(&self, hypothesis: Hypothesis, fit: &Fit, steady: &Trial) -> Option<Weighed> {
        let with = self.weighed_with(&Model { hypothesis, ..fit.model }, fit, steady);
        let plain = Model { hypothesis, ..self.base() };
        if matches!(hypothesis, Hypothesis::Curved | Hypothesis::Winding)
            || fit.model.is_as_plain_as(&plain)
        {
            return with;
        }
        let spared = self.weighed_with(&plain, fit, steady);
        let spared = spared.map(|weighed| Weighed {
            explained: weighed.explained + SPARED * weighed.scatter,
            ..weighed
        });
        match (with, spared) {
            (Some(with), Some(spared)) if with.explained > spared.explained => Some(with),
            (with, spared) => spared.or(with),
        }
    }

    /// Comparison of one model with a hypothesis; `None` where the dwells cannot show it.
    #[inline(never)]
    fn weighed_with(&self, model: &Model, fit: &Fit, steady: &Trial) -> Option<Weighed> {
        let hypothesis = model.hypothesis;
        let is_hidden = hypothesis == Hypothesis::Elliptic
            && different_positions(self.dwells) < ELLIPSE_POSITIONS;
        if hypothesis == Hypothesis::Steady || is_hidden {
            return None;
        }
        let model = Model { amplitude: steady.amplitude, ..*model };
        let (regression, trial) = self.followed(&model, fit)?;
        let free = self.trial(&regression, &Model { amplitude: Amplitude::Free, ..model })?;
        let weighed = Weighed {
            model,
            explained: steady.chi_square - trial.chi_square,
            scatter: trial.scatter(),
            belief: free.gain(fit.free_chi_square) / hypothesis.believed(self.dwells.len()),
            azimuth: trial.direction.azimuth,
            sigma: libm::sqrt(trial.direction.variance),
            coefficient: trial.coefficient,
            is_nested: fit.model.is_as_plain_as(&model),
        };
        let is_lost = weighed.is_lost(steady);
        if trial.degrees == 0 || is_lost && !weighed.is_model() {
            return None;
        }
        let is_vague = free.degrees < FREEDOM || free.probability() < LEFT;
        let is_no_model = weighed.is_model() && (is_lost || is_vague);
        Some(if is_no_model { Weighed { belief: 0.0, ..weighed } } else { weighed })
    }

    /// Regression with a hypothesis and its result; repeated with the exact rotation where the base
    /// turns by more than ∂/∂A describes.
    fn followed(&self, model: &Model, fit: &Fit) -> Option<(Equations, Trial)> {
        let mut bent = fit.bent(model.hypothesis);
        let hours = -self.dwells.first().map_or(0.0, |first| self.hours_to_end(first));
        let mut rounds = 0;
        loop {
            let regression = self.coloured(&bent);
            let trial = self.trial(&regression, model)?;
            let (known, turn) = match model.hypothesis {
                Hypothesis::Stepped { .. } => (&mut bent.turn, trial.coefficient),
                Hypothesis::Yawing => (&mut bent.rate, trial.coefficient * hours),
                _ => return Some((regression, trial)),
            };
            let coefficient = trial.coefficient + *known;
            if rounds == ROUNDS || turn.abs() < TURNED {
                return Some((regression, Trial { coefficient, ..trial }));
            }
            *known = coefficient;
            bent.along = trial.direction.along();
            rounds += 1;
        }
    }

    /// Time after which a heading step is most likely, s: the greatest correlation of a model's
    /// residuals with the azimuth's column, corrected for the part that the model's columns
    /// explain; dwells are weighted as if white.
    #[inline(never)]
    fn likeliest_step(&self, model: &Model, fit: &Fit) -> Option<f64> {
        let bent = fit.bent(Hypothesis::Steady);
        let noise = self.setting.site.noise.model().white_part();
        let regression = self.regression(&noise, taper_of, &bent);
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
                best = (gain, 0.5 * (pair[0].middle.0 + pair[1].middle.0));
            }
        }
        (best.0 > 0.0).then_some(best.1)
    }
}

impl Trial {
    /// Probability of the residuals' chi-square.
    fn probability(&self) -> f64 {
        chi_square_tail(self.chi_square, self.degrees as f64)
    }

    /// Reduction of chi-square against `before`, in units of the scatter that remains.
    fn gain(&self, before: f64) -> f64 {
        (before - self.chi_square) / self.scatter()
    }

    /// Scatter that remains, in units of the stated noise's variance; at least one.
    fn scatter(&self) -> f64 {
        (self.chi_square / self.degrees.max(1) as f64).max(1.0)
    }
}

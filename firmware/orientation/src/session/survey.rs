//! Knowing the gyro before aligning with it: the stage stands still while the Allan variance is
//! taken, the noise is fitted to it, and the planner makes the schedule.

use heapless::Vec;

use super::prepared::designed;
use super::procedure::ProcedureError;
use super::schedule::{Schedule, StopRule};
use super::{Command, Session};
use crate::align::CAPACITY;
use crate::error::Refusal;
use crate::noise::allan::Allan;
use crate::noise::fit::{Estimate, FitError, NoiseFit};
use crate::noise::model::GyroNoise;
use crate::planner::order::Order;
use crate::planner::{Conditions, FEWEST, PlanError, Rotation, for_sigma, for_time};
use crate::signal::Sample;
use crate::signal::dwell::{Dwell, SampleFault};
use crate::units::{AngularRate, DEGREES_PER_RADIAN, Instant};

/// Part of the accuracy asked for that a plan leaves to what is not noise.
const RESERVE: f64 = 0.95;

/// What is to be learnt of the gyro first, and what the plan is then made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey {
    /// How long the stage stands still, s.
    pub seconds: f64,
    /// How the stage turns.
    pub rotation: Rotation,
    /// The orders of positions that it can turn through.
    pub orders: &'static [Order],
    /// Shortest dwell of the plan, s.
    pub shortest: f64,
    /// Total time of the plan, s; with [`StopRule::Accuracy`] the accuracy rules instead.
    pub plan_seconds: f64,
}

/// What a session gathers: first the Allan variance, then dwells, in the same room.
#[allow(clippy::large_enum_variant, reason = "without an allocator both live in this one place")]
#[derive(Clone, Debug)]
pub(super) enum Store {
    Survey(Allan),
    Dwells(Vec<Dwell, CAPACITY>),
}

impl Store {
    pub(super) fn dwells(&self) -> &[Dwell] {
        match self {
            Self::Survey(_) => &[],
            Self::Dwells(dwells) => dwells,
        }
    }

    /// Adds a dwell; whether there was room.
    pub(super) fn push(&mut self, dwell: Dwell) -> bool {
        match self {
            Self::Survey(_) => false,
            Self::Dwells(dwells) => dwells.push(dwell).is_ok(),
        }
    }

    pub(super) fn pop(&mut self) {
        if let Self::Dwells(dwells) = self {
            dwells.pop();
        }
    }

    /// Begins a survey. Not inlined, nor is the next: what is new passes over the stack.
    #[inline(never)]
    pub(super) fn begin_survey(&mut self) {
        *self = Self::Survey(Allan::new());
    }

    /// Ends the survey.
    #[inline(never)]
    fn begin_dwells(&mut self) {
        *self = Self::Dwells(Vec::new());
    }

    /// What the survey shows of the noise of a gyro that is sampled every `seconds`.
    #[inline(never)]
    fn fit(&self, seconds: f64) -> Option<Result<NoiseFit, FitError>> {
        match self {
            Self::Survey(allan) => Some(NoiseFit::of(allan, seconds)),
            Self::Dwells(_) => None,
        }
    }

    /// Adds a sample to a survey, begun anew where it is the first; how many it has.
    fn survey(&mut self, rate: AngularRate, is_first: bool) -> u32 {
        if is_first {
            self.begin_survey();
        }
        let Self::Survey(allan) = self else { return u32::MAX };
        allan.push(rate);
        allan.samples()
    }
}

impl Session {
    /// Takes a sample of the survey; a stage that moves begins it anew.
    pub(super) fn survey(&mut self, sample: &Sample) -> Command {
        let is_first = self.average.as_ref().is_none_or(|average| average.count() <= 1);
        if self.store.survey(sample.rate, is_first) < self.pace.survey {
            return Command::Wait;
        }
        match self.learn(sample.time) {
            Ok(command) => command,
            Err(reason) => self.conclude(Some(reason)),
        }
    }

    /// Ends the survey: noise, plan, and off to its first position.
    #[inline(never)]
    fn learn(&mut self, now: Instant) -> Result<Command, Refusal> {
        if self.has_missed_samples() {
            self.store.begin_survey();
            return Ok(Command::Wait);
        }
        let fit = self.store.fit(self.procedure.sample_seconds);
        let Some(fit) = fit else { return Ok(Command::Wait) };
        let found = fit.map_err(Refusal::NoiseUnknown)?;
        self.setting.noise = known(&found, &self.setting.noise);
        self.setting.white_known = true;
        self.surveyed = Some(found);
        // The time allowed counts from here.
        self.begun = Some(now);
        self.plan()?;
        self.store.begin_dwells();
        Ok(self.send(now))
    }

    /// Takes the standstill of the survey, and tells whether samples were missing in it.
    #[inline(never)]
    fn has_missed_samples(&mut self) -> bool {
        let seconds = self.procedure.sample_seconds;
        let dwell = self.average.as_ref().and_then(|all| all.finish(&self.coefficients, seconds));
        self.average = None;
        dwell.is_some_and(|dwell| dwell.fault == Some(SampleFault::Missing))
    }

    /// Plans for the noise that is now known.
    #[inline(never)]
    fn plan(&mut self) -> Result<(), Refusal> {
        let Some(survey) = self.procedure.survey else { return Ok(()) };
        let conditions = Conditions {
            noise: self.setting.noise,
            rotation: survey.rotation,
            shortest: survey.shortest,
            fewest: FEWEST,
            orders: survey.orders,
        };
        let rate = self.setting.latitude.horizontal_rate();
        let (plan, allowed) = match self.procedure.stop {
            StopRule::Accuracy { seconds } => {
                let wanted = RESERVE * self.setting.required_sigma * rate;
                (for_sigma(&conditions, wanted, seconds), seconds)
            }
            _ => (for_time(&conditions, survey.plan_seconds), survey.plan_seconds),
        };
        let plan = plan.map_err(|error| self.unplanned(error, allowed))?;
        self.procedure.schedule = Schedule::Planned(plan);
        designed(&self.procedure)
            .map(|(coefficients, target)| {
                self.coefficients = coefficients;
                self.target = target;
            })
            .map_err(|_: ProcedureError| Refusal::NoSchedule { seconds: allowed })
    }

    /// Why there is no plan, in degrees.
    fn unplanned(&self, error: PlanError, seconds: f64) -> Refusal {
        let degrees = |angle: f64| angle * DEGREES_PER_RADIAN;
        match error {
            PlanError::OutOfReach(rate) => Refusal::OutOfReach {
                sigma: degrees(rate / self.setting.latitude.horizontal_rate()),
                required: degrees(self.setting.required_sigma),
                seconds,
            },
            PlanError::TooShort | PlanError::NoNoise => Refusal::NoSchedule { seconds },
        }
    }

    /// What the survey found of the gyro's noise, where there was one.
    #[must_use]
    pub fn surveyed(&self) -> Option<&NoiseFit> {
        self.surveyed.as_ref()
    }

    /// Whether there is to be a survey that has not been made.
    pub(super) fn must_survey(&self) -> bool {
        self.procedure.survey.is_some() && self.surveyed.is_none()
    }
}

/// The noise to go by: what was found, and of what was not observable what was stated, as far as the
/// survey bears it out.
fn known(found: &NoiseFit, stated: &GyroNoise) -> GyroNoise {
    let of = |estimate: Estimate, stated: f64| match estimate {
        Estimate::Found { value, .. } => value,
        Estimate::NotObservable { at_most } => stated.min(at_most),
    };
    GyroNoise {
        quantisation: of(found.quantisation, stated.quantisation),
        angle_random_walk: of(found.angle_random_walk, stated.angle_random_walk),
        bias_instability: of(found.bias_instability, stated.bias_instability),
        rate_random_walk: of(found.rate_random_walk, stated.rate_random_walk),
        rate_ramp: of(found.rate_ramp, stated.rate_ramp),
    }
}

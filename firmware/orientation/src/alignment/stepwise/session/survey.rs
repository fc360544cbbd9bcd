//! Survey of the gyro before the alignment: the stage stands still while the Allan variance is
//! measured, the noise model is fitted to it, and the planner makes the schedule.

use heapless::Vec;

use super::schedule::{Schedule, StopRule};
use super::timing::designed;
use super::{Phase, Session, Task};
use crate::alignment::progress::Progress::Stepwise;
use crate::alignment::stepwise::{CAPACITY, Progress, Refusal};
use crate::alignment::{Listener, Request, SetupError};
use crate::noise::allan::Allan;
use crate::noise::fit::{Estimate, FitError, NoiseFit};
use crate::noise::{GyroNoise, StatedNoise};
use crate::planner::{Conditions, FEWEST, PlanError, for_sigma, for_time};
use crate::signal::{Dwell, Sample, SampleFault};
use crate::units::{AngularRate, Instant, Radians, RadiansPerSecond, Seconds};

/// Part of the required accuracy that a plan uses for noise; the rest is left to other errors.
const RESERVE: f64 = 0.95;

/// Data of a session: first the Allan variance, then dwells, in the same memory.
#[allow(clippy::large_enum_variant, reason = "without an allocator both live in this one place")]
#[derive(Clone, Debug)]
pub(super) enum Store {
    /// Allan variance of the survey in progress.
    Survey(Allan),
    /// Dwells of the alignment.
    Dwells(Vec<Dwell, CAPACITY>),
}

impl Store {
    /// Dwells so far; none during a survey.
    pub(super) fn dwells(&self) -> &[Dwell] {
        match self {
            Self::Survey(_) => &[],
            Self::Dwells(dwells) => dwells,
        }
    }

    /// Adds a dwell; returns whether there was room.
    pub(super) fn push(&mut self, dwell: Dwell) -> bool {
        match self {
            Self::Survey(_) => false,
            Self::Dwells(dwells) => dwells.push(dwell).is_ok(),
        }
    }

    /// Removes the last dwell.
    pub(super) fn pop(&mut self) {
        if let Self::Dwells(dwells) = self {
            dwells.pop();
        }
    }

    /// Begins a survey. This function and the next are not inlined, because the new value passes
    /// over the stack.
    #[inline(never)]
    pub(super) fn begin_survey(&mut self) {
        *self = Self::Survey(Allan::new());
    }

    /// Ends the survey and makes room for dwells.
    #[inline(never)]
    pub(super) fn begin_dwells(&mut self) {
        *self = Self::Dwells(Vec::new());
    }

    /// Noise of a gyro that was sampled every `seconds`, as the survey shows it; `None` without a
    /// survey.
    #[inline(never)]
    fn fit(&self, seconds: Seconds) -> Option<Result<NoiseFit, FitError>> {
        match self {
            Self::Survey(allan) => Some(NoiseFit::of(allan, seconds)),
            Self::Dwells(_) => None,
        }
    }

    /// Adds a sample to a survey, which begins anew with the first one; returns the number of
    /// samples.
    fn survey(&mut self, rate: AngularRate, is_first: bool) -> u32 {
        if is_first {
            self.begin_survey();
        }
        let Self::Survey(allan) = self else { return u32::MAX };
        allan.push(rate);
        allan.samples
    }
}

impl Session {
    /// Takes a sample of the survey, which begins anew when the stage moves.
    pub(super) fn survey(&mut self, sample: &Sample) -> Request {
        let is_first = self.average.as_ref().is_none_or(|average| average.count() <= 1);
        if self.store.survey(sample.rate, is_first) < self.timing.survey {
            return Request::Continue;
        }
        self.compute_later(Task::Learn(sample.time))
    }

    /// Ends the survey: fits the noise, makes the plan, and goes to its first position, or
    /// concludes with the reason for which there is none.
    pub(super) fn learn(&mut self, now: Instant, listener: Listener) -> Request {
        match self.try_to_learn(now, listener) {
            Ok(request) => request,
            Err(reason) => {
                self.draw(Some(reason.into()));
                self.finish(listener)
            }
        }
    }

    /// Fits the noise and makes the plan; a survey with missing samples begins anew.
    #[inline(never)]
    fn try_to_learn(&mut self, now: Instant, listener: Listener) -> Result<Request, Refusal> {
        self.phase = Phase::Survey;
        if self.has_missed_samples() {
            self.store.begin_survey();
            return Ok(Request::Continue);
        }
        let fit = self.store.fit(self.procedure.sample_seconds);
        let Some(fit) = fit else { return Ok(Request::Continue) };
        let found = fit.map_err(Refusal::NoiseUnknown)?;
        let noise = known(&found, self.setting.site.noise.model());
        self.setting.site.noise = StatedNoise::Whole(noise);
        self.surveyed = Some(found);
        for (coefficient, estimate) in found.in_field_units() {
            listener(Stepwise(Progress::Noise(coefficient, estimate)));
        }
        // The time allowed counts from the end of the survey.
        self.begun = Some(now);
        self.plan()?;
        self.report_plan(listener);
        self.store.begin_dwells();
        Ok(self.send(now))
    }

    /// Takes the standstill of the survey; returns whether samples were missing in it.
    #[inline(never)]
    fn has_missed_samples(&mut self) -> bool {
        let seconds = self.procedure.sample_seconds;
        let dwell = self.average.as_ref().and_then(|all| all.finish(&self.coefficients, seconds));
        self.average = None;
        dwell.is_some_and(|dwell| dwell.fault == Some(SampleFault::Missing))
    }

    /// Makes the plan for the noise that was found.
    #[inline(never)]
    fn plan(&mut self) -> Result<(), Refusal> {
        let Some(survey) = self.procedure.survey else { return Ok(()) };
        let conditions = Conditions {
            noise: *self.setting.site.noise.model(),
            rotation: survey.rotation,
            shortest: survey.shortest,
            fewest: FEWEST,
            orders: survey.orders,
        };
        let rate = self.setting.site.latitude.horizontal_rate().0;
        let (plan, allowed) = match self.procedure.stop {
            StopRule::Accuracy { seconds } => {
                let required = self.setting.site.required_sigma.0 * rate;
                let within = |sigma| for_sigma(&conditions, RadiansPerSecond(sigma), seconds);
                // What only just can be reached has no reserve.
                (within(RESERVE * required).or_else(|_| within(required)), seconds)
            }
            _ => (for_time(&conditions, survey.plan_seconds), survey.plan_seconds),
        };
        let plan = plan.map_err(|error| self.unplanned(error, allowed))?;
        self.procedure.schedule = Schedule::Planned(plan);
        (self.coefficients, self.target) = designed(&self.procedure)
            .map_err(|_: SetupError| Refusal::NoSchedule { seconds: allowed })?;
        Ok(())
    }

    /// Reports the plan.
    fn report_plan(&self, listener: Listener) {
        if let Schedule::Planned(plan) = &self.procedure.schedule {
            let sigma = plan.sigma(self.setting.site.latitude);
            let (positions, dwell, seconds) = (plan.positions(), plan.dwell, plan.seconds);
            listener(Stepwise(Progress::Planned { positions, dwell, seconds, sigma }));
        }
    }

    /// Refusal for a planning error in the time allowed.
    fn unplanned(&self, error: PlanError, seconds: Seconds) -> Refusal {
        match error {
            PlanError::OutOfReach(rate) => {
                let sigma = Radians(rate.0 / self.setting.site.latitude.horizontal_rate().0);
                self.out_of_reach(sigma, seconds)
            }
            PlanError::TooShort | PlanError::NoNoise => Refusal::NoSchedule { seconds },
        }
    }
}

/// Noise model for the alignment: coefficients that were found, and for those not observable the
/// configured ones, limited to the survey's upper limits.
fn known(found: &NoiseFit, stated: &GyroNoise) -> GyroNoise {
    let stated = stated.coefficients();
    GyroNoise::of(core::array::from_fn(|index| match found.estimates[index] {
        Estimate::Found { value, .. } => value,
        Estimate::NotObservable { at_most } => stated[index].min(at_most),
    }))
}

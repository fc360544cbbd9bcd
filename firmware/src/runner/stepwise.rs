//! Runs a session of multi-position alignment.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::session::schedule::Schedule;
use orientation::alignment::stepwise::session::{Command, Event as SessionEvent, Phase, Session};
use orientation::earth::Latitude;
use orientation::noise::fit::NoiseFit;
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES, Instant};

use super::{AlignmentSession, Step, report_level};
use crate::event::Event;
use crate::link::Status;
use crate::shared::Shared;

/// Fraction of the planned dwell above which a dwell counts as complete.
const WHOLE: f64 = 0.99;

/// A session of multi-position alignment with the state of its reports.
pub struct Stepwise<'a> {
    /// The session.
    session: &'a mut Session,
    /// The state of its reports.
    reported: Reported,
}

/// The part of the session's progress that has been reported.
#[derive(Clone, Copy, Debug, Default)]
struct Reported {
    /// Number of dwells that were reported.
    dwells: usize,
    /// Number of repeated dwells that were reported.
    repetitions: usize,
    /// Whether the end of the levelling was reported.
    is_level: bool,
    /// Whether the plan was reported.
    is_planned: bool,
}

impl<'a> Stepwise<'a> {
    /// Takes a session without any reported progress.
    pub fn new(session: &'a mut Session) -> Self {
        Self { session, reported: Reported::default() }
    }
}

impl AlignmentSession<Sample> for Stepwise<'_> {
    fn latitude(&self) -> Latitude {
        self.session.setting().site.latitude
    }

    fn outset(&self) -> Event {
        let dwell = self.session.procedure().schedule.shortest();
        let latitude = self.session.setting().site.latitude.rad() * DEGREES;
        Event::Begun { positions: self.session.planned(), dwell, latitude }
    }

    fn allow_for(&mut self, sway: SwayNoise) {
        self.session.allow_for(sway);
    }

    fn take(&mut self, sample: &Sample) -> Step {
        match self.session.handle(SessionEvent::Sample(sample)) {
            Command::Wait => Step::Wait,
            Command::Rotate(angle) => Step::Move(angle),
            Command::Finished => Step::Finish,
        }
    }

    fn fail(&mut self, reason: Refusal) {
        self.session.handle(SessionEvent::Failed(reason));
    }

    fn time(&self, sample: &Sample) -> Option<Instant> {
        Some(sample.time)
    }

    // Not inlined, so that the temporary copies on the stack are gone when the session runs.
    #[inline(never)]
    fn renew(&mut self) {
        self.reported = Reported::default();
        let mut procedure = self.session.procedure().clone();
        // The result of the survey is in the setting and the schedule already.
        procedure.survey = None;
        // A procedure that was valid is valid again.
        if let Ok(session) = Session::new(*self.session.setting(), procedure) {
            *self.session = session;
        }
    }

    fn follow(&mut self, shared: &Shared<'_>) {
        let (session, reported) = (&*self.session, &mut self.reported);
        if !reported.is_level && session.phase() != Phase::Level {
            reported.is_level = true;
            report_begun(session, shared);
            report_status(session, shared);
        }
        if !reported.is_planned && session.surveyed().is_some() {
            reported.is_planned = true;
            report_plan(session, shared);
        }
        if session.repetitions().len() > reported.repetitions {
            reported.repetitions = session.repetitions().len();
            report_repetition(session, shared);
        }
        if session.dwells().len() > reported.dwells {
            reported.dwells = session.dwells().len();
            report_dwell(session, shared);
            report_status(session, shared);
        }
    }

    fn conclude(&self, shared: &Shared<'_>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.session.conclusion()?;
        for (number, why) in (1..).zip(&conclusion.disturbances) {
            if let Some(why) = why {
                shared.report(Event::LeftOut(number, *why));
            }
        }
        let limit = conclusion.fit.as_ref().map_or(0.0, |fit| fit.limit);
        Some(conclusion.verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

/// Reports the inclination of the platform and the begin of a survey.
fn report_begun(session: &Session, shared: &Shared<'_>) {
    if let Some(force) = session.force() {
        report_level(force, shared);
    }
    if let Some(survey) = &session.procedure().survey {
        shared.report(Event::Surveying(survey.seconds));
    }
}

/// Reports the noise coefficients of the survey and the plan that follows from them.
fn report_plan(session: &Session, shared: &Shared<'_>) {
    let found = session.surveyed().map(NoiseFit::in_field_units);
    for (coefficient, estimate) in found.into_iter().flatten() {
        shared.report(Event::Noise(coefficient, estimate));
    }
    // If the survey ended with a refusal, the schedule is still the original one.
    if session.phase() == Phase::Done {
        return;
    }
    if let Schedule::Planned(plan) = &session.procedure().schedule {
        shared.report(Event::Planned {
            positions: plan.positions(),
            dwell: plan.dwell,
            seconds: plan.seconds,
            sigma: plan.sigma(session.setting().site.latitude) * DEGREES,
        });
    }
}

/// Reports a dwell that is measured again, with the disturbance.
fn report_repetition(session: &Session, shared: &Shared<'_>) {
    if let Some(repetition) = session.repetitions().last() {
        shared.report(Event::Repeated(repetition.position + 1, repetition.why));
    }
}

/// Reports a completed dwell, and whether it was shorter than planned.
fn report_dwell(session: &Session, shared: &Shared<'_>) {
    if let Some(dwell) = session.dwells().last() {
        let rate = dwell.rate / DEGREE_PER_HOUR;
        shared.report(Event::Dwelled(session.dwells().len(), session.planned(), rate));
        if dwell.seconds < WHOLE * session.procedure().schedule.shortest() {
            shared.report(Event::CutShort(dwell.seconds));
        }
    }
    shared.observer.progress(session);
}

/// Updates the status line with completed and planned dwells.
fn report_status(session: &Session, shared: &Shared<'_>) {
    if session.phase() == Phase::Survey {
        shared.status.set(Status::Surveying);
        return;
    }
    let (done, of) = (session.dwells().len() as u16, session.planned() as u16);
    shared.status.set(Status::Measuring { done, of });
}

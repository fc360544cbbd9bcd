//! The session in positions, as it is conducted.

use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::noise::fit::NoiseFit;
use orientation::session::schedule::Schedule;
use orientation::session::{Command, Event as SessionEvent, Phase, Session};
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES, Instant};

use super::{AlignmentSession, Step, tell_level};
use crate::event::Event;
use crate::link::Status;
use crate::ports::Observer;
use crate::shared::Shared;

/// Part of a dwell's time that is as good as all of it.
const WHOLE: f64 = 0.99;

/// A session in positions.
pub struct Stepwise<'a> {
    session: &'a mut Session,
    told: Told,
}

/// What has been told of it.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    dwells: usize,
    repetitions: usize,
    is_level: bool,
    is_planned: bool,
}

impl<'a> Stepwise<'a> {
    /// A session of which nothing was told.
    pub fn new(session: &'a mut Session) -> Self {
        Self { session, told: Told::default() }
    }
}

impl<O: Observer> AlignmentSession<O, Sample> for Stepwise<'_> {
    fn latitude(&self) -> Latitude {
        self.session.setting().latitude
    }

    fn outset(&self) -> Event {
        let dwell = self.session.procedure().schedule.shortest();
        let latitude = self.session.setting().latitude.rad() * DEGREES;
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

    // Not inlined: what it is made of on the stack is not to stay there.
    #[inline(never)]
    fn renew(&mut self) {
        self.told = Told::default();
        let mut procedure = self.session.procedure().clone();
        // What a survey found is in the setting and the schedule.
        procedure.survey = None;
        // A procedure that was possible is possible again.
        if let Ok(session) = Session::new(*self.session.setting(), procedure) {
            *self.session = session;
        }
    }

    fn follow(&mut self, shared: &Shared<'_, O>) {
        let (session, told) = (&*self.session, &mut self.told);
        if !told.is_level && session.phase() != Phase::Level {
            told.is_level = true;
            tell_begun(session, shared);
            tell_status(session, shared);
        }
        if !told.is_planned && session.surveyed().is_some() {
            told.is_planned = true;
            tell_plan(session, shared);
        }
        if session.repetitions().len() > told.repetitions {
            told.repetitions = session.repetitions().len();
            tell_repetition(session, shared);
        }
        if session.dwells().len() > told.dwells {
            told.dwells = session.dwells().len();
            tell_dwell(session, shared);
            tell_status(session, shared);
        }
    }

    fn conclude(&self, shared: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.session.conclusion()?;
        for (number, why) in (1..).zip(&conclusion.disturbances) {
            if let Some(why) = why {
                shared.tell(Event::LeftOut(number, *why));
            }
        }
        let limit = conclusion.fit.as_ref().map_or(0.0, |fit| fit.limit);
        Some(conclusion.verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

fn tell_begun<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    if let Some(force) = session.force() {
        tell_level(force, shared);
    }
    if let Some(survey) = &session.procedure().survey {
        shared.tell(Event::Surveying(survey.seconds));
    }
}

/// What the survey found and what follows from it.
fn tell_plan<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    let found = session.surveyed().map(NoiseFit::in_field_units);
    for (coefficient, estimate) in found.into_iter().flatten() {
        shared.tell(Event::Noise(coefficient, estimate));
    }
    // Where the survey ended in a refusal, the schedule is still the one before it.
    if session.phase() == Phase::Done {
        return;
    }
    if let Schedule::Planned(plan) = &session.procedure().schedule {
        shared.tell(Event::Planned {
            positions: plan.positions(),
            dwell: plan.dwell,
            seconds: plan.seconds,
            sigma: plan.sigma(session.setting().latitude) * DEGREES,
        });
    }
}

fn tell_repetition<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    if let Some(repetition) = session.repetitions().last() {
        shared.tell(Event::Repeated(repetition.position + 1, repetition.why));
    }
}

fn tell_dwell<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    if let Some(dwell) = session.dwells().last() {
        let rate = dwell.rate / DEGREE_PER_HOUR;
        shared.tell(Event::Dwelled(session.dwells().len(), session.planned(), rate));
        if dwell.seconds < WHOLE * session.procedure().schedule.shortest() {
            shared.tell(Event::CutShort(dwell.seconds));
        }
    }
    shared.observer().progress(session);
}

fn tell_status<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    if session.phase() == Phase::Survey {
        shared.status.set(Status::Surveying);
        return;
    }
    let (done, of) = (session.dwells().len() as u16, session.planned() as u16);
    shared.status.set(Status::Measuring { done, of });
}

//! The session in positions, as it is conducted.

use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::noise::fit::NoiseFit;
use orientation::session::schedule::Schedule;
use orientation::session::{Command, Event as SessionEvent, Phase, Session};
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES};

use super::{Conducted, Step, tell_level};
use crate::event::Event;
use crate::link::Status;
use crate::ports::Observer;
use crate::shared::Shared;

/// Part of a dwell's time that is as good as all of it.
const WHOLE: f64 = 0.99;

/// What has been told of the session.
#[derive(Clone, Copy, Debug, Default)]
pub struct Told {
    dwells: usize,
    repetitions: usize,
    is_level: bool,
    is_planned: bool,
}

impl Conducted for Session {
    type Told = Told;

    fn latitude(&self) -> Latitude {
        self.setting().latitude
    }

    fn outset(&self) -> Event {
        let dwell = self.procedure().schedule.shortest();
        let latitude = self.setting().latitude.rad() * DEGREES;
        Event::Begun { positions: self.planned(), dwell, latitude }
    }

    fn allow_for(&mut self, sway: SwayNoise) {
        self.allow_for(sway);
    }

    fn take(&mut self, sample: &Sample) -> Step {
        match self.handle(SessionEvent::Sample(sample)) {
            Command::Wait => Step::Wait,
            Command::Rotate(angle) => Step::Move(angle),
            Command::Finished => Step::Finish,
        }
    }

    fn fail(&mut self, reason: Refusal) {
        self.handle(SessionEvent::Failed(reason));
    }

    fn follow<O: Observer>(&self, told: &mut Told, shared: &Shared<'_, O>) {
        if !told.is_level && self.phase() != Phase::Level {
            told.is_level = true;
            tell_begun(self, shared);
            tell_status(self, shared);
        }
        if !told.is_planned && self.surveyed().is_some() {
            told.is_planned = true;
            tell_plan(self, shared);
        }
        if self.repetitions().len() > told.repetitions {
            told.repetitions = self.repetitions().len();
            tell_repetition(self, shared);
        }
        if self.dwells().len() > told.dwells {
            told.dwells = self.dwells().len();
            tell_dwell(self, shared);
            tell_status(self, shared);
        }
    }

    fn conclude<O: Observer>(&self, shared: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.conclusion()?;
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

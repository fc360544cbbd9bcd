//! The session on a platform that turns all the time, as it is conducted.

use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::session::rotating::{Command, Event as SessionEvent, Phase, RotatingSession};
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::units::DEGREES_PER_RADIAN as DEGREES;

use super::{Conducted, Step, tell_level};
use crate::event::Event;
use crate::link::Status;
use crate::ports::Observer;
use crate::shared::Shared;

/// What has been told of the session.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    phase: Phase,
    turns: usize,
}

impl Default for Told {
    fn default() -> Self {
        Self { phase: Phase::Level, turns: 0 }
    }
}

impl Conducted for RotatingSession {
    type Told = Told;

    fn latitude(&self) -> Latitude {
        self.setting().latitude
    }

    fn outset(&self) -> Event {
        let (_, turns) = self.turns();
        let latitude = self.setting().latitude.rad() * DEGREES;
        Event::BegunTurning { turns, latitude }
    }

    /// Sway is not subtracted on a platform that turns.
    fn allow_for(&mut self, _: SwayNoise) {}

    fn take(&mut self, sample: &Sample) -> Step {
        match self.handle(SessionEvent::Sample(sample)) {
            Command::Wait => Step::Wait,
            Command::Turn(rate) => Step::Move(rate),
            Command::Finished => Step::Finish,
        }
    }

    fn fail(&mut self, reason: Refusal) {
        self.handle(SessionEvent::Failed(reason));
    }

    fn follow<O: Observer>(&self, told: &mut Told, shared: &Shared<'_, O>) {
        if self.phase() != told.phase {
            tell_phase(self, told.phase, shared);
            told.phase = self.phase();
        }
        let (done, of) = self.turns();
        if done > told.turns {
            told.turns = done;
            shared.tell(Event::Turned(done, of));
            tell_status(self, shared);
            shared.observer().turned(self);
        }
    }

    fn conclude<O: Observer>(&self, _: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.conclusion()?;
        Some(conclusion.verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, conclusion.limit]))
    }
}

/// What the phase that is over has found, and what the next one does.
fn tell_phase<O: Observer>(session: &RotatingSession, before: Phase, shared: &Shared<'_, O>) {
    match (before, session.coupling(), session.force()) {
        (Phase::Level, _, Some(force)) => tell_level(force, shared),
        (Phase::Uneven { .. }, Some(coupling), _) => {
            shared.tell(Event::Coupled(coupling.sine * DEGREES, coupling.sine_sigma * DEGREES));
        }
        _ => {}
    }
    match session.phase() {
        Phase::Uneven { speed } => shared.tell(Event::Uneven(speed * DEGREES)),
        Phase::Turning { speed, .. } => shared.tell(Event::Stretch(speed * DEGREES)),
        Phase::Level | Phase::Settle | Phase::Done => {}
    }
    tell_status(session, shared);
}

fn tell_status<O: Observer>(session: &RotatingSession, shared: &Shared<'_, O>) {
    let (done, of) = session.turns();
    shared.status.set(Status::Measuring { done: done as u16, of: of as u16 });
}

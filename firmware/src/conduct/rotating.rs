//! The session on a platform that turns all the time, as it is conducted.

use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::session::rotating::{Command, Event as SessionEvent, Phase, Session};
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
    turns: u32,
}

impl Default for Told {
    fn default() -> Self {
        Self { phase: Phase::Level, turns: 0 }
    }
}

impl Conducted for Session {
    type Told = Told;

    fn latitude(&self) -> Latitude {
        self.setting().common.latitude
    }

    fn outset(&self) -> Event {
        let (_, turns) = self.turns();
        Event::BegunTurning { turns, latitude: self.latitude().rad() * DEGREES }
    }

    /// A platform that turns has no sensors on its base.
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
            tell_found(self, told.phase, shared);
            tell_phase(self, shared);
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

    fn conclude<O: Observer>(&self, shared: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.conclusion()?;
        for average in conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter]) {
            if average.left_out > 0 {
                shared.tell(Event::TurnsLeftOut(average.left_out, average.sense));
            }
        }
        let limit = conclusion.fit.as_ref().map_or(0.0, |fit| fit.limit);
        Some(conclusion.verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

/// What the phase that is over has found.
fn tell_found<O: Observer>(session: &Session, phase: Phase, shared: &Shared<'_, O>) {
    match phase {
        Phase::Level => {
            if let Some(force) = session.force() {
                tell_level(force, shared);
            }
        }
        Phase::Uneven(index) => {
            if let Some(coupling) = session.couplings().nth(index) {
                let [angle, sigma] = [coupling.angle(), coupling.sine_sigma];
                shared.tell(Event::Coupled(angle * DEGREES, sigma * DEGREES));
            }
        }
        _ => {}
    }
}

/// What the phase that begins does.
fn tell_phase<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    let speed = |index: usize| session.procedure().speeds.get(index).map_or(0.0, |w| w * DEGREES);
    match session.phase() {
        Phase::Uneven(index) => shared.tell(Event::Uneven(speed(index))),
        Phase::Even(index, sense) => shared.tell(Event::Stretch(sense, speed(index))),
        _ => {}
    }
    tell_status(session, shared);
}

fn tell_status<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    let (done, of) = session.turns();
    shared.status.set(Status::Measuring { done: done as u16, of: of as u16 });
}

//! Runs a session of continuous rotation (carouselling).

use orientation::align::rotating::turn::Stretch;
use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::session::rotating::{Command, Event as SessionEvent, Phase, Session};
use orientation::signal::Sample;
use orientation::units::DEGREES_PER_RADIAN as DEGREES;

use super::{AlignmentSession, Step, tell_level};
use crate::event::Event;
use crate::link::Status;
use crate::ports::Observer;
use crate::shared::Shared;

/// A session of continuous rotation with the state of its reports.
pub struct Rotating<'a> {
    /// The session.
    session: &'a mut Session,
    /// The state of its reports.
    told: Told,
}

/// The part of the session's progress that has been reported.
#[derive(Clone, Copy, Debug)]
struct Told {
    /// Phase that was reported last.
    phase: Phase,
    /// Number of turns that were reported.
    turns: u32,
}

impl<'a> Rotating<'a> {
    /// Takes a session without any reported progress.
    pub fn new(session: &'a mut Session) -> Self {
        let told = Told { phase: session.phase(), turns: 0 };
        Self { session, told }
    }
}

impl<O: Observer> AlignmentSession<O, Sample> for Rotating<'_> {
    fn latitude(&self) -> Latitude {
        self.session.setting().common.latitude
    }

    fn outset(&self) -> Event {
        let (_, turns) = self.session.turns();
        Event::BegunTurning {
            turns,
            latitude: self.session.setting().common.latitude.rad() * DEGREES,
        }
    }

    fn take(&mut self, sample: &Sample) -> Step {
        match self.session.handle(SessionEvent::Sample(sample)) {
            Command::Wait => Step::Wait,
            Command::Turn(rate) => Step::Move(rate),
            Command::Finished => Step::Finish,
        }
    }

    fn fail(&mut self, reason: Refusal) {
        self.session.handle(SessionEvent::Failed(reason));
    }

    fn follow(&mut self, shared: &Shared<'_, O>) {
        let (session, told) = (&*self.session, &mut self.told);
        if session.phase() != told.phase {
            tell_found(session, told.phase, shared);
            tell_phase(session, shared);
            told.phase = session.phase();
        }
        // The number of planned turns is not computed here, as this runs with every sample.
        let done = session.turn_accumulator().stretches().iter().map(Stretch::count).sum();
        if done > told.turns {
            told.turns = done;
            let (_, of) = session.turns();
            shared.tell(Event::Turned(done, of));
            tell_status(session, shared);
            shared.observer().turned(session);
        }
    }

    fn conclude(&self, shared: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.session.conclusion()?;
        for average in conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter]) {
            if average.left_out > 0 {
                shared.tell(Event::TurnsLeftOut(average.left_out, average.sense));
            }
        }
        let limit = conclusion.fit.as_ref().map_or(0.0, |fit| fit.limit);
        Some(conclusion.verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

/// Reports the result of the phase that has ended: inclination of the platform, or axis
/// misalignment.
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

/// Reports the begin of a phase: rate-modulated turns, or turns that are evaluated.
fn tell_phase<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    let speed = |index: usize| session.procedure().speeds.get(index).map_or(0.0, |w| w * DEGREES);
    match session.phase() {
        Phase::Uneven(index) => shared.tell(Event::Uneven(speed(index))),
        Phase::Even(index, sense) => shared.tell(Event::Stretch(sense, speed(index))),
        _ => {}
    }
    tell_status(session, shared);
}

/// Updates the status line with completed and planned turns.
fn tell_status<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    let (done, of) = session.turns();
    shared.status.set(Status::Measuring { done: done as u16, of: of as u16 });
}

//! Runs a session of continuous rotation (carouselling).

use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::session::{Command, Event as SessionEvent, Phase, Session};
use orientation::alignment::rotating::turn::Stretch;
use orientation::earth::Latitude;
use orientation::signal::Sample;
use orientation::units::DEGREES_PER_RADIAN as DEGREES;

use super::{AlignmentSession, Step, report_level};
use crate::event::Event;
use crate::link::Status;
use crate::shared::Shared;

/// A session of continuous rotation with the state of its reports.
pub struct Rotating<'a> {
    /// The session.
    session: &'a mut Session,
    /// Phase that was reported last.
    reported_phase: Phase,
    /// Number of turns that were reported.
    reported_turns: u32,
}

impl<'a> Rotating<'a> {
    /// Takes a session without any reported progress. One whose sensor has an axis misalignment that
    /// matters but is unknown is refused with [`Refusal::MisalignmentUnknown`].
    pub fn new(session: &'a mut Session) -> Self {
        if !is_misalignment_settled(session) {
            session.handle(SessionEvent::Failed(Refusal::MisalignmentUnknown));
        }
        let reported_phase = session.phase();
        Self { session, reported_phase, reported_turns: 0 }
    }
}

/// Whether the session knows the axis misalignment, or needs none: it is negligible by the sensor's
/// statement, will be estimated by rate-modulated turns, or is known from a calibration.
fn is_misalignment_settled(session: &Session) -> bool {
    let setting = session.setting();
    let is_known = setting.misalignments.iter().any(Option::is_some);
    setting.sensor.is_flat || session.procedure().modulated_turns > 0 || is_known
}

impl AlignmentSession<Sample> for Rotating<'_> {
    fn latitude(&self) -> Latitude {
        self.session.setting().site.latitude
    }

    fn outset(&self) -> Event {
        let (_, turns) = self.session.turns();
        let latitude = self.session.setting().site.latitude.rad() * DEGREES;
        Event::BegunTurning { turns, latitude }
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

    fn follow(&mut self, shared: &Shared<'_>) {
        let session = &*self.session;
        if session.phase() != self.reported_phase {
            report_found(session, self.reported_phase, shared);
            report_phase(session, shared);
            self.reported_phase = session.phase();
        }
        // The number of planned turns is not computed here, as this runs with every sample.
        let done = session.turn_accumulator().stretches().iter().map(Stretch::count).sum();
        if done > self.reported_turns {
            self.reported_turns = done;
            let (_, of) = session.turns();
            shared.report(Event::Turned(done, of));
            report_status(session, shared);
            shared.observer.turned(session);
        }
    }

    fn conclude(&self, shared: &Shared<'_>) -> Option<Result<[f64; 3], Refusal>> {
        let conclusion = self.session.conclusion()?;
        for average in conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter]) {
            if average.left_out > 0 {
                shared.report(Event::TurnsLeftOut(average.left_out, average.sense));
            }
        }
        let limit = conclusion.fit.as_ref().map_or(0.0, |fit| fit.limit);
        Some(conclusion.verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

/// Reports the result of the phase that has ended: inclination of the platform, or axis
/// misalignment.
fn report_found(session: &Session, phase: Phase, shared: &Shared<'_>) {
    match phase {
        Phase::Level => {
            if let Some(force) = session.force() {
                report_level(force, shared);
            }
        }
        Phase::Modulated(index) => {
            if let Some(misalignment) = session.misalignments().nth(index) {
                let [angle, sigma] = [misalignment.angle(), misalignment.sine_sigma];
                shared.report(Event::Misalignment(angle * DEGREES, sigma * DEGREES));
            }
        }
        _ => {}
    }
}

/// Reports the begin of a phase: rate-modulated turns, or turns that are evaluated.
fn report_phase(session: &Session, shared: &Shared<'_>) {
    let speed = |index: usize| session.procedure().speeds.get(index).map_or(0.0, |w| w * DEGREES);
    match session.phase() {
        Phase::Modulated(index) => shared.report(Event::Modulated(speed(index))),
        Phase::Even(index, sense) => shared.report(Event::Stretch(sense, speed(index))),
        _ => {}
    }
    report_status(session, shared);
}

/// Updates the status line with completed and planned turns.
fn report_status(session: &Session, shared: &Shared<'_>) {
    let (done, of) = session.turns();
    shared.status.set(Status::Measuring { done: done as u16, of: of as u16 });
}

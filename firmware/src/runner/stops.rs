//! Runs a session of inertial-frame alignment in a vehicle that is driven from stop to stop.
//!
//! The session's commands are for the driver. If position aiding is available, the session gets the
//! displacement of every stop from the first one.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops::conclusion::Conclusion;
use orientation::alignment::stops::inclination::pitch_and_roll;
use orientation::alignment::stops::session::{Command, Event as SessionEvent, Phase, Session};
use orientation::earth::Latitude;
use orientation::signal::InertialSample;
use orientation::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES, Instant};

use super::{AlignmentSession, Step};
use crate::acquire::TRIAD;
use crate::event::Event;
use crate::link::Status;
use crate::ports::PositionAiding;
use crate::shared::Shared;

/// A session in a vehicle with the state of its reports.
pub struct Stops<'a, W> {
    /// The session.
    session: &'a mut Session,
    /// Source of the vehicle's displacement.
    position_aiding: &'a mut W,
    /// Displacement of the session's first stop, m north and east; [`None`] while a later session
    /// does not know it.
    origin: Option<[f64; 2]>,
    /// The state of its reports.
    reported: Reported,
}

/// The part of the session's progress that has been reported, and news to be reported.
#[derive(Clone, Copy, Debug)]
struct Reported {
    /// Phase that was reported last.
    phase: Phase,
    /// Time at which that phase began.
    since: Instant,
    /// Time of the latest sample.
    now: Instant,
    /// Index of the latest stop whose displacement the session knows; the first stop, 0, is the
    /// origin.
    placed: usize,
    /// The displacement of the present stop, m north and east, until it is reported.
    place: Option<[f64; 2]>,
    /// Whether the permission to drive on is to be reported.
    may_drive: bool,
}

impl Reported {
    /// The state of a session that has not begun.
    fn of(session: &Session) -> Self {
        Self {
            phase: session.phase(),
            since: Instant::default(),
            now: Instant::default(),
            placed: 0,
            place: None,
            may_drive: false,
        }
    }
}

impl<'a, W: PositionAiding> Stops<'a, W> {
    /// Takes a session without any reported progress. The first stop of the first session is the
    /// origin of displacements.
    pub fn new(session: &'a mut Session, position_aiding: &'a mut W) -> Self {
        let reported = Reported::of(session);
        Self { session, position_aiding, origin: Some([0.0; 2]), reported }
    }

    /// Informs the session of the displacement of the present stop as soon as it is known.
    fn place(&mut self) {
        let Phase::Standing(index) = self.session.phase() else { return };
        if index == 0 && self.origin.is_none() {
            self.origin = self.position_aiding.displacement();
        }
        if index <= self.reported.placed {
            return;
        }
        let here = self.position_aiding.displacement();
        self.reported.place =
            here.zip(self.origin).map(|(here, origin)| [here[0] - origin[0], here[1] - origin[1]]);
        if let Some(place) = self.reported.place {
            self.reported.placed = index;
            self.session.handle(SessionEvent::Displaced(place));
        }
    }
}

impl<W: PositionAiding> AlignmentSession<InertialSample> for Stops<'_, W> {
    fn latitude(&self) -> Latitude {
        self.session.setting().site.latitude
    }

    fn outset(&self) -> Event {
        Event::BegunStops { latitude: self.session.setting().site.latitude.rad() * DEGREES }
    }

    fn take(&mut self, sample: &InertialSample) -> Step {
        self.reported.now = sample.time;
        let command = self.session.handle(SessionEvent::Sample(sample));
        self.place();
        match command {
            Command::Wait => Step::Wait,
            Command::Drive => {
                self.reported.may_drive = true;
                Step::Wait
            }
            Command::Finished => Step::Finish,
        }
    }

    fn fail(&mut self, reason: Refusal) {
        self.session.handle(SessionEvent::Failed(reason));
    }

    fn time(&self, sample: &InertialSample) -> Option<Instant> {
        Some(sample.time)
    }

    // Not inlined, so that the temporary copies on the stack are gone when the session runs.
    #[inline(never)]
    fn renew(&mut self) {
        let (setting, procedure) = (*self.session.setting(), self.session.procedure().clone());
        *self.session = Session::of(setting, procedure);
        self.reported = Reported::of(self.session);
        self.origin = None;
    }

    fn follow(&mut self, shared: &Shared<'_>) {
        let (session, reported) = (&*self.session, &mut self.reported);
        if session.phase() != reported.phase {
            report_phase(session.phase(), reported, shared);
            reported.phase = session.phase();
            reported.since = reported.now;
            shared.observer.stopped(session);
        }
        if let Some(place) = reported.place.take() {
            shared.report(Event::Displaced(reported.placed + 1, place));
        }
        if core::mem::take(&mut reported.may_drive) {
            report_levelled(session, shared);
            shared.observer.stopped(session);
        }
    }

    fn conclude(&self, shared: &Shared<'_>) -> Option<Result<[f64; 3], Refusal>> {
        let Conclusion { verdict, found } = self.session.conclusion()?;
        if let Some(found) = found.as_ref().filter(|found| found.are_biases_observed) {
            for ((gyro, bias), sigma) in TRIAD.into_iter().zip(found.biases).zip(found.bias_sigmas)
            {
                let [bias, sigma] = [bias, sigma].map(|rate| rate / DEGREE_PER_HOUR);
                shared.report(Event::Bias(gyro, bias, sigma));
            }
        }
        let limit = found.as_ref().map_or(0.0, |found| found.limit);
        Some(verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

/// Reports the begin of a stop, with the duration of the drive before it, or of a drive.
fn report_phase(phase: Phase, reported: &Reported, shared: &Shared<'_>) {
    match phase {
        Phase::Standing(index) => {
            if let Phase::Driving(_) = reported.phase {
                let seconds = reported.now.seconds() - reported.since.seconds();
                shared.report(Event::Stopped(index + 1, seconds));
            }
            shared.status.set(Status::Levelling(index as u16 + 1));
        }
        Phase::Driving(_) => {
            shared.report(Event::Driving);
            shared.status.set(Status::Driving);
        }
        Phase::Waiting | Phase::Done => {}
    }
}

/// Reports that the stop was long enough, with the inclination of the vehicle.
fn report_levelled(session: &Session, shared: &Shared<'_>) {
    let Some(stop) = session.stops().last() else { return };
    let number = session.stops().len();
    let level = pitch_and_roll(&stop.force.mean()).map(|angle| angle * DEGREES);
    shared.report(Event::MayDrive(number, stop.seconds(), level));
    shared.status.set(Status::MayDrive(number as u16));
}

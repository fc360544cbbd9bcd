//! The session in a vehicle that goes from stop to stop, as it is conducted.
//!
//! Its commands are for who drives. Where somebody knows how far the vehicle has come, the session is told
//! at every stop.

use orientation::align::stops::conclusion::Conclusion;
use orientation::align::stops::inclination::pitch_and_roll;
use orientation::device::Device;
use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::session::stops::{Command, Event as SessionEvent, Phase, Session};
use orientation::signal::InertialSample;
use orientation::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES, Instant};

use super::{AlignmentSession, Step};
use crate::event::Event;
use crate::link::Status;
use crate::ports::{Observer, PositionAiding};
use crate::shared::Shared;

/// The gyros, forward, right, down.
const GYROS: [Device; 3] = [Device::ForwardGyro, Device::RightGyro, Device::DownGyro];

/// A session in a vehicle.
pub struct Stops<'a, W> {
    session: &'a mut Session,
    position_aiding: &'a mut W,
    /// Where the first stop is; none where a later session does not know it yet.
    origin: Option<[f64; 2]>,
    told: Told,
}

/// What has been told of it, and what is to be.
#[derive(Clone, Copy, Debug)]
struct Told {
    phase: Phase,
    /// When that phase began, and the latest sample.
    since: Instant,
    now: Instant,
    /// Stops whose place the session knows; it takes the first one for the origin.
    placed: usize,
    /// Where the vehicle stands, if that is news.
    place: Option<[f64; 2]>,
    /// Whether it may drive, if that is news.
    may_drive: bool,
}

impl Told {
    /// Nothing yet of a session that has not begun.
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
    /// A session of which nothing was told.
    pub fn new(session: &'a mut Session, position_aiding: &'a mut W) -> Self {
        let told = Told::of(session);
        Self { session, position_aiding, origin: Some([0.0; 2]), told }
    }

    /// Tells the session where it stands, as soon as that is known.
    fn place(&mut self) {
        let Phase::Standing(index) = self.session.phase() else { return };
        if index == 0 && self.origin.is_none() {
            self.origin = self.position_aiding.displacement();
        }
        if index <= self.told.placed {
            return;
        }
        let here = self.position_aiding.displacement();
        self.told.place =
            here.zip(self.origin).map(|(here, origin)| [here[0] - origin[0], here[1] - origin[1]]);
        if let Some(place) = self.told.place {
            self.told.placed = index;
            self.session.handle(SessionEvent::Displaced(place));
        }
    }
}

impl<W: PositionAiding, O: Observer> AlignmentSession<O, InertialSample> for Stops<'_, W> {
    fn latitude(&self) -> Latitude {
        self.session.setting().common.latitude
    }

    fn outset(&self) -> Event {
        Event::BegunStops { latitude: self.session.setting().common.latitude.rad() * DEGREES }
    }

    fn take(&mut self, sample: &InertialSample) -> Step {
        self.told.now = sample.time;
        let command = self.session.handle(SessionEvent::Sample(sample));
        self.place();
        match command {
            Command::Wait => Step::Wait,
            Command::Drive => {
                self.told.may_drive = true;
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

    // Not inlined: what it is made of on the stack is not to stay there.
    #[inline(never)]
    fn renew(&mut self) {
        let (setting, procedure) = (*self.session.setting(), self.session.procedure().clone());
        *self.session = Session::of(setting, procedure);
        self.told = Told::of(self.session);
        self.origin = None;
    }

    fn follow(&mut self, shared: &Shared<'_, O>) {
        let (session, told) = (&*self.session, &mut self.told);
        if session.phase() != told.phase {
            tell_phase(session.phase(), told, shared);
            told.phase = session.phase();
            told.since = told.now;
            shared.observer().stopped(session);
        }
        if let Some(place) = told.place.take() {
            shared.tell(Event::Displaced(told.placed + 1, place));
        }
        if core::mem::take(&mut told.may_drive) {
            tell_levelled(session, shared);
            shared.observer().stopped(session);
        }
    }

    fn conclude(&self, shared: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>> {
        let Conclusion { verdict, found } = self.session.conclusion()?;
        if let Some(found) = found.as_ref().filter(|found| found.are_biases_observed) {
            for ((gyro, bias), sigma) in GYROS.into_iter().zip(found.biases).zip(found.bias_sigmas)
            {
                let [bias, sigma] = [bias, sigma].map(|rate| rate / DEGREE_PER_HOUR);
                shared.tell(Event::Bias(gyro, bias, sigma));
            }
        }
        let limit = found.as_ref().map_or(0.0, |found| found.limit);
        Some(verdict.map(|azimuth| [azimuth.angle, azimuth.sigma, limit]))
    }
}

/// What the phase that begins does.
fn tell_phase<O: Observer>(phase: Phase, told: &Told, shared: &Shared<'_, O>) {
    match phase {
        Phase::Standing(index) => {
            if let Phase::Driving(_) = told.phase {
                let seconds = told.now.seconds() - told.since.seconds();
                shared.tell(Event::Stopped(index + 1, seconds));
            }
            shared.status.set(Status::Levelling { stop: index as u16 + 1 });
        }
        Phase::Driving(_) => {
            shared.tell(Event::Driving);
            shared.status.set(Status::Driving);
        }
        Phase::Waiting | Phase::Done => {}
    }
}

/// That the stop was long enough.
fn tell_levelled<O: Observer>(session: &Session, shared: &Shared<'_, O>) {
    let Some(stop) = session.stops().last() else { return };
    let number = session.stops().len();
    let level = pitch_and_roll(&stop.force.mean()).map(|angle| angle * DEGREES);
    shared.tell(Event::MayDrive(number, stop.seconds(), level));
    shared.status.set(Status::MayDrive { stop: number as u16 });
}

//! Conducts a session: samples in, commands to what turns the gyro or to who drives, and what comes of it
//! told.

mod rotating;
mod stepwise;
mod stops;

pub use rotating::Rotating;
pub use stepwise::Stepwise;
pub use stops::Stops;

use core::convert::Infallible;
use core::future::pending;

use embassy_futures::select::{Either, Either3, select, select3};
use embassy_time::{Duration, Instant, Timer};
use orientation::earth::Latitude;
use orientation::error::Refusal;
use orientation::keep::Handover;
use orientation::signal::sway::SwayNoise;
use orientation::units::{self, DEGREES_PER_RADIAN as DEGREES};

use crate::event::Event;
use crate::link::Status;
use crate::ports::{Observer, Recorder};
use crate::shared::{Channels, Queue, Shared};

/// Longest time until the stage is homed: six searches over the whole travel, with their rests.
const HOMING: Duration = Duration::from_secs(900);

/// Rest once all samples are taken: those of a quick gyro are then taken some at a time, because waking for
/// each costs more than the sample. A quarter of what the queue holds at 2 kHz.
const REST: Duration = Duration::from_millis(2);

/// What a session wants done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// To go on sampling.
    Wait,
    /// That the stage stands at this angle, rad, or that the platform turns at this rate, rad/s.
    Move(f64),
    /// Nothing more.
    Finish,
}

/// A session of samples `S`, with what was told of it. The conductor knows no more of its kind, so that an
/// image with two kinds of the same samples has one conductor.
pub trait AlignmentSession<O, S> {
    /// Where it is to find north.
    fn latitude(&self) -> Latitude;

    /// What there is to tell before it begins.
    fn outset(&self) -> Event;

    /// Says what a sway that is subtracted leaves in the samples; nothing is where nothing turns the gyro.
    fn allow_for(&mut self, _sway: SwayNoise) {}

    /// Takes a sample.
    fn take(&mut self, sample: &S) -> Step;

    /// Ends it with a reason.
    fn fail(&mut self, reason: Refusal);

    /// When a sample was taken; none where nobody can keep what is found.
    fn time(&self, _sample: &S) -> Option<units::Instant> {
        None
    }

    /// Begins anew, in the same memory.
    fn renew(&mut self) {}

    /// Tells what the last sample changed.
    fn follow(&mut self, shared: &Shared<'_, O>);

    /// Tells what was left out, and gives the azimuth, its σ and its limit, rad, or the reason why there
    /// is none; [`None`] before the end.
    fn conclude(&self, shared: &Shared<'_, O>) -> Option<Result<[f64; 3], Refusal>>;
}

/// The session at work.
pub struct SessionRunner<'a, R, O, S> {
    session: &'a mut dyn AlignmentSession<O, S>,
    recorder: &'a mut R,
    samples: &'a Queue<S>,
    shared: &'a Shared<'a, O>,
    /// When the latest sample was taken that the session has.
    taken: Option<units::Instant>,
}

/// Why a session comes to no conclusion of its own.
enum Break {
    /// It cannot go on.
    Refused(Refusal),
    /// Nobody needs it: the azimuth is known.
    Spared,
}

impl From<Refusal> for Break {
    fn from(reason: Refusal) -> Self {
        Self::Refused(reason)
    }
}

impl<'a, R: Recorder<S>, O: Observer, S> SessionRunner<'a, R, O, S> {
    /// Takes a session that has not begun.
    pub fn new(
        session: &'a mut dyn AlignmentSession<O, S>,
        recorder: &'a mut R,
        channels: &'a Channels<'a, O, S>,
    ) -> Self {
        Self {
            session,
            recorder,
            samples: &channels.samples,
            shared: &channels.shared,
            taken: None,
        }
    }

    /// Conducts the session to its conclusion, and others when the keeper wants them.
    pub async fn run(&mut self) -> Infallible {
        if !self.shared.homed.signaled() {
            self.shared.status.set(Status::Homing);
        }
        loop {
            self.shared.tell(self.session.outset());
            match self.runner().await {
                Ok(()) | Err(Break::Spared) => {}
                Err(Break::Refused(reason)) => self.session.fail(reason),
            }
            self.conclude();
            self.shared.concluded.signal(());
            self.wait_for_another().await;
            self.session.renew();
        }
    }

    /// Lets samples go by until the keeper wants another session. Where nobody keeps, the link ends the
    /// run once it has told the last status.
    async fn wait_for_another(&mut self) {
        let keep = &self.shared.keep;
        if !keep.is_wanted.get() {
            pending::<()>().await;
        }
        keep.is_idle.set(true);
        keep.is_kept.set(true);
        if self.samples.is_empty() {
            keep.catch_up();
        }
        while let Either::Second(_) = select(keep.again.wait(), self.samples.receive()).await {
            if self.samples.is_empty() {
                keep.catch_up();
                Timer::after(REST).await;
            }
        }
        keep.is_idle.set(false);
        // What went wrong before is over, or comes again.
        self.shared.failure.reset();
        keep.spare.reset();
    }

    async fn runner(&mut self) -> Result<(), Break> {
        self.check_place()?;
        self.wait_for_home().await?;
        self.session.allow_for(self.shared.sway.get());
        loop {
            let sample = self.sample().await?;
            self.recorder.record(&sample).await;
            self.taken = self.session.time(&sample);
            let step = self.session.take(&sample);
            self.session.follow(self.shared);
            match step {
                Step::Wait => {}
                Step::Move(to) => self.shared.wanted.signal(to),
                Step::Finish => return Ok(()),
            }
            if self.samples.is_empty() {
                self.shared.keep.catch_up();
                Timer::after(REST).await;
            }
        }
    }

    /// Refuses a place where nothing could be found, before anything turns.
    fn check_place(&self) -> Result<(), Refusal> {
        let latitude = self.session.latitude();
        if latitude.has_north() {
            return Ok(());
        }
        Err(Refusal::LatitudeTooHigh { latitude: latitude.rad() * DEGREES })
    }

    /// Lets samples go by until angles mean something.
    async fn wait_for_home(&self) -> Result<(), Break> {
        let deadline = Instant::now() + HOMING;
        while !self.shared.homed.signaled() {
            self.sample().await?;
            if self.samples.is_empty() {
                self.shared.keep.catch_up();
            }
            if Instant::now() > deadline {
                return Err(Refusal::TimeExhausted.into());
            }
        }
        Ok(())
    }

    /// The next sample, or why there will be none.
    async fn sample(&self) -> Result<S, Break> {
        let Shared { failure, keep, .. } = self.shared;
        match select3(failure.wait(), self.samples.receive(), keep.spare.wait()).await {
            Either3::First(reason) => Err(reason.into()),
            Either3::Second(sample) => Ok(sample),
            Either3::Third(()) => Err(Break::Spared),
        }
    }

    fn conclude(&self) {
        match self.session.conclude(self.shared) {
            None => {}
            Some(Ok(found)) => {
                let [angle, sigma, limit] = found.map(|angle| angle * DEGREES);
                self.shared.tell(Event::Concluded(angle, sigma, limit));
                self.shared.status.set(Status::concluded(angle, sigma));
                let [azimuth, sigma, _] = found;
                if let Some(taken) = self.taken {
                    self.shared.keep.found.signal((taken, Handover { azimuth, sigma }));
                }
            }
            Some(Err(reason)) => {
                self.shared.tell(Event::Refused(reason));
                self.shared.status.set(Status::Refused);
            }
        }
    }
}

/// Tells the tilt of a platform at rest from the force that it feels there.
fn tell_level<O: Observer>([along, across, down]: [f64; 3], shared: &Shared<'_, O>) {
    let [along, across] = [along, across].map(|f| libm::atan2(f, -down) * DEGREES);
    shared.tell(Event::Levelled(along, across));
}

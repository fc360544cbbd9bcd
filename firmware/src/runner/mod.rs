//! Runs a session: passes samples to it, executes its commands, which move the gyro or go to the
//! driver, and reports its progress and result.

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
use orientation::alignment::refusal::Refusal;
use orientation::attitude::Handover;
use orientation::earth::Latitude;
use orientation::signal::sway::SwayNoise;
use orientation::units::{self, DEGREES_PER_RADIAN as DEGREES};

use crate::event::Event;
use crate::link::Status;
use crate::ports::Recorder;
use crate::shared::{Channels, Shared};

/// Longest time until the stage is homed, s: six searches over the whole travel with the rests
/// between them.
const HOMING: Duration = Duration::from_secs(900);

/// Rest once the queue is empty. Samples of a fast gyro are then taken several at a time, because
/// waking for each would cost more than processing it. A quarter of the queue's capacity at 2 kHz.
const REST: Duration = Duration::from_millis(2);

/// The request of a session after a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Continue sampling.
    Wait,
    /// Move the stage to this angle, rad, or turn the platform at this rate, rad/s.
    Move(f64),
    /// End: the session has concluded.
    Finish,
}

/// A session that consumes samples of the type `S`, with the state of its reports. The runner is
/// not generic over the kind of session, so an image with two kinds of session for the same samples
/// contains one runner.
pub trait AlignmentSession<S> {
    /// The latitude of the site.
    fn latitude(&self) -> Latitude;

    /// The event that reports the begin of the session.
    fn outset(&self) -> Event;

    /// Informs the session of the noise that the compensated sway leaves in the samples. No effect
    /// where no stage turns the gyro.
    fn allow_for(&mut self, _sway: SwayNoise) {}

    /// Processes a sample.
    fn take(&mut self, sample: &S) -> Step;

    /// Ends the session with a reason.
    fn fail(&mut self, reason: Refusal);

    /// The time of a sample; [`None`] for a session whose azimuth cannot be kept.
    fn time(&self, _sample: &S) -> Option<units::Instant> {
        None
    }

    /// Begins the session anew in the same memory.
    fn renew(&mut self) {}

    /// Reports the changes of the last sample.
    fn follow(&mut self, shared: &Shared<'_>);

    /// Reports what was excluded from the fit, and returns azimuth, its 1σ and the Cramér–Rao bound
    /// of the σ, rad, or the reason of a refusal; [`None`] before the session has concluded.
    fn conclude(&self, shared: &Shared<'_>) -> Option<Result<[f64; 3], Refusal>>;
}

/// The runner of a session.
pub struct SessionRunner<'a, R, S> {
    /// The session.
    session: &'a mut dyn AlignmentSession<S>,
    /// Recorder of raw samples.
    recorder: &'a mut R,
    /// The queue of samples, and the signals and counters that all parts share.
    channels: &'a Channels<'a, S>,
    /// Time of the latest sample that the session has taken.
    taken: Option<units::Instant>,
}

/// The cause that ends a session before its own conclusion: a refusal, or [`None`] if the azimuth is
/// known already, so that the session is skipped.
type Break = Option<Refusal>;

impl<'a, R: Recorder<S>, S> SessionRunner<'a, R, S> {
    /// Takes a session that has not begun.
    pub fn new(
        session: &'a mut dyn AlignmentSession<S>,
        recorder: &'a mut R,
        channels: &'a Channels<'a, S>,
    ) -> Self {
        Self { session, recorder, channels, taken: None }
    }

    /// Runs the session to its conclusion, and further sessions as the keeper requests them.
    pub async fn run(&mut self) -> Infallible {
        if !self.channels.shared.homed.signaled() {
            self.channels.shared.status.set(Status::Homing);
        }
        loop {
            self.channels.shared.report(self.session.outset());
            if let Err(Some(reason)) = self.runner().await {
                self.session.fail(reason);
            }
            self.conclude();
            self.channels.shared.concluded.signal(());
            self.wait_for_another().await;
            self.session.renew();
        }
    }

    /// Discards samples until the keeper requests another session. Without a keeper it waits for
    /// ever, and the link ends the run once it has sent the last status.
    async fn wait_for_another(&mut self) {
        let keep = &self.channels.shared.keep;
        if !keep.is_wanted.get() {
            pending::<()>().await;
        }
        keep.is_idle.set(true);
        keep.is_kept.set(true);
        if self.channels.samples.is_empty() {
            keep.catch_up();
        }
        while let Either::Second(_) =
            select(keep.again.wait(), self.channels.samples.receive()).await
        {
            if self.channels.samples.is_empty() {
                keep.catch_up();
                Timer::after(REST).await;
            }
        }
        keep.is_idle.set(false);
        // A failure of the session before is over, or will be reported again.
        self.channels.shared.failure.reset();
        keep.spare.reset();
    }

    /// Runs one session: checks the site, waits for homing, then processes samples until the
    /// session has concluded.
    ///
    /// # Errors
    /// A refusal, or the request of the keeper to skip the session.
    async fn runner(&mut self) -> Result<(), Break> {
        self.check_place()?;
        self.wait_for_home().await?;
        self.session.allow_for(self.channels.shared.sway.get());
        loop {
            let sample = self.sample().await?;
            self.recorder.record(&sample).await;
            self.taken = self.session.time(&sample);
            let step = self.session.take(&sample);
            self.session.follow(&self.channels.shared);
            match step {
                Step::Wait => {}
                Step::Move(to) => self.channels.shared.wanted.signal(to),
                Step::Finish => return Ok(()),
            }
            if self.channels.samples.is_empty() {
                self.channels.shared.keep.catch_up();
                Timer::after(REST).await;
            }
        }
    }

    /// Refuses a latitude at which north cannot be found, before anything moves.
    fn check_place(&self) -> Result<(), Refusal> {
        let latitude = self.session.latitude();
        if latitude.has_north() {
            return Ok(());
        }
        Err(Refusal::LatitudeTooHigh { latitude: latitude.rad() * DEGREES })
    }

    /// Discards samples until the stage is homed and its angles are valid.
    ///
    /// # Errors
    /// [`Refusal::TimeExhausted`] after 15 minutes.
    async fn wait_for_home(&self) -> Result<(), Break> {
        let deadline = Instant::now() + HOMING;
        while !self.channels.shared.homed.signaled() {
            self.sample().await?;
            if self.channels.samples.is_empty() {
                self.channels.shared.keep.catch_up();
            }
            if Instant::now() > deadline {
                return Err(Refusal::TimeExhausted.into());
            }
        }
        Ok(())
    }

    /// The next sample.
    ///
    /// # Errors
    /// The failure of another part, or the request to skip the session.
    async fn sample(&self) -> Result<S, Break> {
        let Shared { failure, keep, .. } = &self.channels.shared;
        match select3(failure.wait(), self.channels.samples.receive(), keep.spare.wait()).await {
            Either3::First(reason) => Err(reason.into()),
            Either3::Second(sample) => Ok(sample),
            Either3::Third(()) => Err(None),
        }
    }

    /// Reports the result, and hands an azimuth to the keeper with the time of the session's last
    /// sample.
    fn conclude(&self) {
        match self.session.conclude(&self.channels.shared) {
            None => {}
            Some(Ok(found)) => {
                let [angle, sigma, limit] = found.map(|angle| angle * DEGREES);
                self.channels.shared.report(Event::Concluded(angle, sigma, limit));
                self.channels.shared.status.set(Status::concluded(angle, sigma));
                let [azimuth, sigma, _] = found;
                if let Some(taken) = self.taken {
                    self.channels.shared.keep.found.signal((taken, Handover { azimuth, sigma }));
                }
            }
            Some(Err(reason)) => {
                self.channels.shared.report(Event::Refused(reason));
                self.channels.shared.status.set(Status::Refused);
            }
        }
    }
}

/// Reports the inclination of a platform at rest along and across the sensitive axis, °, from its
/// mean specific force.
fn report_level([along, across, down]: [f64; 3], shared: &Shared<'_>) {
    let [along, across] = [along, across].map(|f| libm::atan2(f, -down) * DEGREES);
    shared.report(Event::Levelled(along, across));
}

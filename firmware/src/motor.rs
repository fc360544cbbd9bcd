//! The motor of an axis and its encoder, as used by stage and turntable. A request is repeated
//! while only the bus fails; a movement that is broken off reports its cause.

use embassy_time::{Duration, Instant, Timer};
use orientation::alignment::refusal::Refusal;
use orientation::device::{Device, Trouble};
use orientation::units::{Angle, DEGREES_PER_RADIAN as DEGREES, Degrees};

use crate::event::Event;
use crate::guarded::Guarded;
use crate::ports::{Actuator, Command, Motion};
use crate::shared::{LatestAngle, Shared};

/// Period at which the motor's status is read.
pub(crate) const POLL: Duration = Duration::from_millis(20);
/// Rest after the first stall, so that an obstacle can be removed; it doubles with every further
/// stall.
pub(crate) const STALL_REST: Duration = Duration::from_millis(500);
/// Time limit for coming to rest: from 90°/s at the motor driver's deceleration of 33°/s² it takes three seconds.
pub(crate) const LONGEST_STOP: Duration = Duration::from_secs(10);
/// Number of looks in a row without an answer after which a motor is brought to rest without its driver.
const UNANSWERED: u8 = 5;
/// Age beyond which the encoder's latest angle is not used.
const STALE: Duration = Duration::from_millis(100);
/// Longest wait for a recent angle: sensors that are being started again give none.
const LONGEST_WAIT: Duration = Duration::from_secs(5);

/// Names of an axis' devices in the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// Motor with its driver.
    pub drive: Device,
    /// Encoder of the axis.
    pub encoder: Device,
}

impl Axis {
    /// The axis of an instrument with a single one.
    pub const ONLY: Self = Self { drive: Device::Stage, encoder: Device::Encoder };
}

/// The cause that breaks off a movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Break {
    /// The motor has stalled.
    Stalled,
    /// The motor driver was started again, so its step count is lost.
    Lost,
    /// The device is given up, and the session ends with this reason.
    Refused(Refusal),
}

impl From<Refusal> for Break {
    fn from(reason: Refusal) -> Self {
        Self::Refused(reason)
    }
}

/// The motor of an axis with its retry budget, and the latest angle of its encoder.
pub(crate) struct Motor<'a, M> {
    /// Names in the log.
    axis: Axis,
    /// The motor's driver with its retry budget.
    pub(crate) actuator: Guarded<'a, M>,
    /// The motor's status at the latest reading.
    pub(crate) motion: Motion,
    /// The encoder's latest angle and the time of its reading.
    latest: &'a LatestAngle,
    pub(crate) shared: &'a Shared<'a>,
}

impl<'a, M: Actuator> Motor<'a, M> {
    /// Takes the motor of an axis whose encoder writes its angle to `latest`; nothing moves yet.
    pub(crate) fn new(
        axis: Axis,
        actuator: &'a mut M,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a>,
    ) -> Self {
        let actuator = Guarded::new(actuator, axis.drive);
        Self { axis, actuator, motion: Motion::default(), latest, shared }
    }

    /// Executes a request, and repeats it while only the bus fails.
    ///
    /// # Errors
    /// [`Break::Lost`] if the driver had to be started again, [`Break::Refused`] if it is given up.
    pub(crate) async fn ask(&mut self, request: Command) -> Result<(), Break> {
        loop {
            let outcome = self.actuator.device.execute(request).await;
            match self.actuator.checked(outcome) {
                Ok(motion) => {
                    self.motion = motion.unwrap_or(self.motion);
                    return Ok(());
                }
                Err(symptom) if self.actuator.mend(symptom, self.shared).await? => {
                    return Err(Break::Lost);
                }
                Err(_) => {}
            }
        }
    }

    /// Reads the motor's status.
    ///
    /// # Errors
    /// [`Break::Stalled`] if the motor has stalled, and the errors of [`Self::ask`].
    pub(crate) async fn look(&mut self) -> Result<(), Break> {
        self.ask(Command::Look).await?;
        if self.motion.is_stalled { Err(Break::Stalled) } else { Ok(()) }
    }

    /// Reads the motor's status every 20 ms until the condition holds.
    ///
    /// # Errors
    /// `trouble` if the condition does not hold within `longest`, and the errors of [`Self::look`].
    pub(crate) async fn follow(
        &mut self,
        trouble: Trouble,
        longest: Duration,
        is_done: fn(&Motion) -> bool,
    ) -> Result<(), Break> {
        let deadline = Instant::now() + longest;
        while Instant::now() < deadline {
            Timer::after(POLL).await;
            self.look().await?;
            if is_done(&self.motion) {
                return Ok(());
            }
        }
        Err(self.fail(trouble).into())
    }

    /// Has the motor of the only axis rest, gives it its current, and starts its driver.
    ///
    /// # Errors
    /// The driver is given up.
    pub(crate) async fn start(&mut self) -> Result<(), Refusal> {
        self.shared.current.signal(self.rest().await);
        self.actuator.start(self.shared).await
    }

    /// Brings a motor to rest of which nothing is known, before it has its current; whether it rests.
    pub(crate) async fn rest(&mut self) -> bool {
        let deadline = Instant::now() + LONGEST_STOP;
        while self.actuator.device.execute(Command::Rest).await.is_err() {
            if Instant::now() > deadline {
                self.report(Event::CurrentOff);
                return false;
            }
            Timer::after(POLL).await;
        }
        true
    }

    /// Brings the motor to rest by its ramp, and has it stay there, whatever has become of its encoder, after any
    /// alarm; where it does not come to rest or does not answer, asks for its current to be taken away.
    pub(crate) async fn halt(&mut self) {
        let deadline = Instant::now() + LONGEST_STOP;
        let mut unanswered = 0;
        while Instant::now() < deadline && unanswered < UNANSWERED {
            let device = &mut *self.actuator.device;
            // A motor that stands may have been told to go on, as one that a switch stops.
            let released = device.execute(Command::Release).await;
            match (released, device.execute(Command::Look).await) {
                (Ok(_), Ok(Some(motion))) if motion.is_standing => return,
                (Ok(_), Ok(_)) => unanswered = 0,
                _ => unanswered += 1,
            }
            Timer::after(POLL).await;
        }
        self.report(Event::CurrentOff);
        self.shared.current.signal(false);
    }

    /// The encoder's latest angle and the time of its reading; [`None`] if it is older than 100 ms.
    pub(crate) fn fresh(&self) -> Option<(Angle, Instant)> {
        Some(self.latest.get()).filter(|(_, read)| Instant::now() - *read <= STALE)
    }

    /// The encoder's latest angle, regardless of its age.
    pub(crate) fn shown(&self) -> Angle {
        self.latest.get().0
    }

    /// The encoder's latest angle, rad, on the turn nearest to `near`, regardless of its age.
    fn nearest_shown(&self, near: f64) -> f64 {
        near + (self.shown() - Angle::from_rad(near)).signed_rad()
    }

    /// A recent angle of the encoder, rad, on the turn nearest to `near`; waits up to 5 s for it, and as long as
    /// sensors that were given up rest.
    ///
    /// # Errors
    /// The encoder is given up as silent.
    pub(crate) async fn shown_near(&self, near: f64) -> Result<f64, Refusal> {
        let mut deadline = Instant::now() + LONGEST_WAIT;
        while self.fresh().is_none() {
            if self.shared.without_sensors.get().is_some() {
                deadline = Instant::now() + LONGEST_WAIT;
            }
            if Instant::now() > deadline {
                return Err(self.shared.give_up(self.axis.encoder, Trouble::Silent));
            }
            Timer::after(POLL).await;
        }
        Ok(self.nearest_shown(near))
    }

    /// The trouble of a stalled axis, with the angle at which it stands, °.
    pub(crate) fn blocked(&self) -> Trouble {
        Trouble::Stalled(Degrees(self.nearest_shown(self.motion.angle) * DEGREES))
    }

    /// Gives the motor up if two angles that should be equal differ by more than `most`, rad. Not
    /// inlined, so that flash holds it once.
    #[inline(never)]
    pub(crate) fn check(&self, apart: f64, most: f64) -> Result<(), Break> {
        if apart.abs() > most {
            return Err(self.fail(Trouble::Disagrees(Degrees(apart * DEGREES))).into());
        }
        Ok(())
    }

    /// Reports an event of this axis under the name of its drive.
    pub(crate) fn report(&self, event: impl FnOnce(Device) -> Event) {
        self.shared.report(event(self.axis.drive));
    }

    /// Reports that the motor is given up, and returns the reason for the session's end.
    pub(crate) fn fail(&self, trouble: Trouble) -> Refusal {
        self.shared.give_up(self.axis.drive, trouble)
    }
}

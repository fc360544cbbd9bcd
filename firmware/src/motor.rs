//! The motor of an axis beside its encoder, as stage and turntable drive them: what is asked is
//! repeated while only the bus fails, and what breaks a movement off has a name.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, Timer};
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::units::{Angle, DEGREES_PER_RADIAN as DEGREES};

use crate::event::Event;
use crate::guarded::Guarded;
use crate::ports::{Actuator, Motion, Observer};
use crate::shared::{LatestAngle, Shared};

/// How often the motor is asked what it does.
pub(crate) const POLL: Duration = Duration::from_millis(20);
/// Rest after the first stall, so that what blocks the axis can go away; it doubles with each.
pub(crate) const STALL_REST: Duration = Duration::from_millis(500);
/// Age beyond which the encoder's angle is none.
const STALE: Duration = Duration::from_millis(100);
/// How long a fresh angle is waited for: sensors that are started again give none meanwhile.
const PATIENCE: Duration = Duration::from_secs(5);

/// An axis' devices, as the log names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// Motor and its driver.
    pub drive: Device,
    /// Encoder.
    pub encoder: Device,
}

impl Axis {
    /// Of an instrument that has one.
    pub const ONLY: Self = Self { drive: Device::Stage, encoder: Device::Encoder };
}

/// What breaks a movement off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Break {
    /// The motor is blocked.
    Stalled,
    /// The motor driver was started again: its count is lost.
    Lost,
    /// Nothing helps.
    Refused(Refusal),
}

impl From<Refusal> for Break {
    fn from(reason: Refusal) -> Self {
        Self::Refused(reason)
    }
}

/// What the motor driver is asked.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Request {
    /// To go to an angle, rad.
    GoTo(f64),
    /// To turn at a rate, rad/s.
    Seek(f64),
    /// To take this for the angle at which the motor stands, rad.
    SetAngle(f64),
    /// To stop, and to let a motor that stalled turn again.
    Release,
    /// What the motor does.
    Look,
}

/// The motor of an axis under control.
pub(crate) struct Motor<'a, M, O> {
    axis: Axis,
    actuator: Guarded<'a, M>,
    /// What it did when it was last looked at.
    pub(crate) motion: Motion,
    latest: &'a LatestAngle,
    pub(crate) shared: &'a Shared<'a, O>,
}

impl<'a, M: Actuator, O: Observer> Motor<'a, M, O> {
    /// Takes the motor of an axis whose encoder shows the `latest` angle; nothing moves yet.
    pub(crate) fn new(
        axis: Axis,
        actuator: &'a mut M,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let actuator = Guarded::new(actuator, axis.drive);
        Self { axis, actuator, motion: Motion::default(), latest, shared }
    }

    /// Starts its driver.
    pub(crate) fn start(&mut self) -> impl Future<Output = Result<(), Refusal>> {
        self.actuator.start(self.shared)
    }

    /// An exchange with its driver, repeated while only the bus fails.
    pub(crate) async fn ask(&mut self, request: Request) -> Result<(), Break> {
        let restarts = self.actuator.restarts();
        loop {
            let begun = Instant::now();
            let outcome = self.exchange(request).await;
            let Err(symptom) = self.actuator.checked(begun, outcome) else { return Ok(()) };
            self.actuator.mend(symptom, self.shared).await?;
            if self.actuator.restarts() != restarts {
                return Err(Break::Lost);
            }
        }
    }

    async fn exchange(&mut self, request: Request) -> Result<(), Fault> {
        let motor = &mut *self.actuator.device;
        match request {
            Request::GoTo(angle) => motor.go_to(angle).await,
            Request::Seek(rate) => motor.seek(rate).await,
            Request::SetAngle(angle) => motor.set_angle(angle).await,
            Request::Release => motor.release().await,
            Request::Look => motor.motion().await.map(|motion| self.motion = motion),
        }
    }

    /// Looks at the motor, which must not have stalled.
    pub(crate) async fn look(&mut self) -> Result<(), Break> {
        self.ask(Request::Look).await?;
        if self.motion.is_stalled { Err(Break::Stalled) } else { Ok(()) }
    }

    /// Watches the motor until it does what is waited for; `trouble` where it takes too long.
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

    /// The latest encoder angle and when it was read, unless that is long ago.
    pub(crate) fn fresh(&self) -> Option<(Angle, Instant)> {
        Some(self.latest.get()).filter(|(_, read)| Instant::now() - *read <= STALE)
    }

    /// The latest encoder angle, rad, in the turn around `near`, however old.
    fn nearest_shown(&self, near: f64) -> f64 {
        let (shown, _) = self.latest.get();
        near + (shown - Angle::from_rad(near)).signed_rad()
    }

    /// A fresh encoder angle, rad, in the turn around `near`.
    pub(crate) async fn shown_near(&self, near: f64) -> Result<f64, Refusal> {
        let deadline = Instant::now() + PATIENCE;
        while self.fresh().is_none() {
            if Instant::now() > deadline {
                return Err(self.shared.give_up(self.axis.encoder, Trouble::Silent));
            }
            Timer::after(POLL).await;
        }
        Ok(self.nearest_shown(near))
    }

    /// The trouble of an axis that stands where it stands.
    pub(crate) fn blocked(&self) -> Trouble {
        Trouble::Stalled(self.nearest_shown(self.motion.angle) * DEGREES)
    }

    /// Tells something of the motor, and with it its name.
    pub(crate) fn tell(&self, event: impl FnOnce(Device) -> Event) {
        self.shared.tell(event(self.axis.drive));
    }

    /// Tells that the motor is given up, and why.
    pub(crate) fn fail(&self, trouble: Trouble) -> Refusal {
        self.shared.give_up(self.axis.drive, trouble)
    }
}

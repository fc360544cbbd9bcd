//! The stage: finds its index, goes where it is sent within its travel, and compares motor and
//! encoder after every movement.
//!
//! The encoder knows the angle but not the turn, the motor's count knows the turn but not the angle:
//! at the index, a switch at the lower end of the travel, each learns from the other. From then on
//! they must agree; where they do not, one of them is wrong and no azimuth may come of it.

use core::convert::Infallible;

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, Timer};
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::units::{Angle, DEGREES_PER_RADIAN as DEGREES};

use crate::configuration::StageConfiguration;
use crate::event::Event;
use crate::guarded::Guarded;
use crate::ports::{Actuator, Motion, Observer};
use crate::shared::{LatestAngle, Shared};

/// How often the motor is asked what it does.
const POLL: Duration = Duration::from_millis(20);
/// How often the search for the index is tried again while something blocks it.
const RETRIES: u32 = 5;
/// How often a movement is tried again: what blocks it twice after the stage has homed blocks it for
/// good.
const MOVES: u32 = 2;
/// Rest after the first stall, so that what blocks the stage can go away; it doubles with each.
const STALL_REST: Duration = Duration::from_millis(500);
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

/// What breaks a movement off.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Break {
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
enum Request {
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

/// The stage under control, or one frame of a mount with two.
pub struct Stage<'a, M, O> {
    axis: Axis,
    actuator: Guarded<'a, M>,
    /// What the motor did when it was last looked at.
    motion: Motion,
    configuration: StageConfiguration,
    latest: &'a LatestAngle,
    shared: &'a Shared<'a, O>,
}

impl<'a, M: Actuator, O: Observer> Stage<'a, M, O> {
    /// Takes the motor of a single-axis stage; nothing moves yet.
    pub fn new(
        actuator: &'a mut M,
        configuration: &StageConfiguration,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let axis = Axis { drive: Device::Stage, encoder: Device::Encoder };
        Self::of(axis, actuator, configuration, &shared.angle, shared)
    }

    /// Takes the motor of an axis whose encoder shows the `latest` angle; nothing moves yet.
    pub fn of(
        axis: Axis,
        actuator: &'a mut M,
        configuration: &StageConfiguration,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let actuator = Guarded::new(actuator, axis.drive);
        let (motion, configuration) = (Motion::default(), *configuration);
        Self { axis, actuator, motion, configuration, latest, shared }
    }

    /// Homes, then goes where it is sent until it must be given up; gives the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.serve().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        self.start().await?;
        self.shared.sensing.wait().await;
        self.home().await?;
        self.turn_to(self.configuration.home).await?;
        self.shared.homed.signal(());
        loop {
            let target = self.shared.target.wait().await;
            self.turn_to(target).await?;
        }
    }

    /// Starts the motor's driver.
    pub(crate) fn start(&mut self) -> impl Future<Output = Result<(), Refusal>> {
        self.actuator.start(self.shared)
    }

    /// Finds the index and sets the motor's count by the encoder there.
    pub(crate) async fn home(&mut self) -> Result<(), Refusal> {
        self.shared.tell(Event::Homing(self.axis.drive));
        for attempt in 0..=RETRIES {
            match self.find_index().await {
                Ok(()) => return Ok(()),
                Err(Break::Refused(reason)) => return Err(reason),
                Err(Break::Stalled) => {
                    self.shared.tell(Event::Blocked(self.axis.drive));
                    Timer::after(STALL_REST * (1 << attempt)).await;
                }
                Err(Break::Lost) => {}
            }
        }
        Err(self.fail(self.blocked()))
    }

    /// Goes down to the index, always from above, and believes the encoder's angle there.
    async fn find_index(&mut self) -> Result<(), Break> {
        self.ask(Request::Release).await?;
        self.ask(Request::Look).await?;
        if self.motion.at_index {
            self.seek(1.0, |motion| !motion.at_index).await?;
            self.ask(Request::Release).await?;
        }
        self.seek(-1.0, |motion| motion.is_standing).await?;
        if !self.motion.at_index {
            return Err(self.fail(Trouble::NoIndex).into());
        }
        self.adopt_index().await
    }

    /// Turns up or down until the motor does what is waited for.
    async fn seek(&mut self, way: f64, is_done: fn(&Motion) -> bool) -> Result<(), Break> {
        self.ask(Request::Seek(way * self.configuration.seek_rate)).await?;
        self.follow(Trouble::NoIndex, is_done).await
    }

    async fn adopt_index(&mut self) -> Result<(), Break> {
        Timer::after(self.configuration.settle).await;
        let index = self.configuration.index;
        let shown = self.shown_near(index).await?;
        if (shown - index).abs() > self.configuration.index_tolerance {
            return Err(self.fail(Trouble::Disagrees((shown - index) * DEGREES)).into());
        }
        self.ask(Request::SetAngle(shown)).await?;
        self.shared.tell(Event::Homed(self.axis.drive, shown * DEGREES));
        Ok(())
    }

    /// Goes to an angle, rad, and does not rest until the encoder shows it.
    pub(crate) async fn turn_to(&mut self, target: f64) -> Result<(), Refusal> {
        let [low, high] = self.configuration.travel;
        if !(low..=high).contains(&target) {
            return Err(self.fail(Trouble::BeyondTravel(target * DEGREES)));
        }
        let begun = Instant::now();
        self.shared.tell(Event::Turning(self.axis.drive, target * DEGREES));
        let mut aim = target;
        let mut trouble = None;
        for attempt in 0..=MOVES {
            match self.approach(aim, target).await {
                Ok(off) if off.abs() <= self.configuration.tolerance => {
                    let took = (Instant::now() - begun).as_micros() as f64 * 1e-6;
                    self.shared.tell(Event::Arrived(
                        self.axis.drive,
                        (target + off) * DEGREES,
                        took,
                    ));
                    return Ok(());
                }
                Ok(off) => {
                    self.shared.tell(Event::Corrected(self.axis.drive, off * DEGREES));
                    trouble = Some(Trouble::NotThere(off * DEGREES));
                    aim -= off;
                }
                Err(Break::Stalled) if attempt == MOVES => trouble = None,
                Err(Break::Lost) if attempt == MOVES => trouble = Some(Trouble::Resets),
                Err(broken) => self.recover(broken, STALL_REST * (1 << attempt)).await?,
            }
        }
        Err(self.fail(trouble.unwrap_or_else(|| self.blocked())))
    }

    /// The trouble of a stage that stands where it stands.
    fn blocked(&self) -> Trouble {
        Trouble::Stalled(self.nearest_shown(self.motion.angle) * DEGREES)
    }

    /// One movement; how far the encoder then stands from the target, rad. Motor and encoder must
    /// agree.
    async fn approach(&mut self, aim: f64, target: f64) -> Result<f64, Break> {
        self.ask(Request::GoTo(aim)).await?;
        self.follow(Trouble::Restless, |motion| motion.has_reached && motion.is_standing).await?;
        Timer::after(self.configuration.settle).await;
        let shown = self.shown_near(self.motion.angle).await?;
        let apart = shown - self.motion.angle;
        if apart.abs() > self.configuration.agreement {
            return Err(self.fail(Trouble::Disagrees(apart * DEGREES)).into());
        }
        Ok(shown - target)
    }

    /// Makes the stage ready for another attempt. What the motor counts after a stall or a restart is
    /// worth nothing, and the encoder alone proves nothing: both must meet at the index again.
    async fn recover(&mut self, broken: Break, rest: Duration) -> Result<(), Refusal> {
        match broken {
            Break::Refused(reason) => Err(reason),
            Break::Lost => self.home().await,
            Break::Stalled => {
                self.shared.tell(Event::Blocked(self.axis.drive));
                Timer::after(rest).await;
                self.home().await
            }
        }
    }

    /// Watches the motor until it does what is waited for; `trouble` where it takes too long.
    async fn follow(
        &mut self,
        trouble: Trouble,
        is_done: fn(&Motion) -> bool,
    ) -> Result<(), Break> {
        let deadline = Instant::now() + self.configuration.longest;
        while Instant::now() < deadline {
            Timer::after(POLL).await;
            self.ask(Request::Look).await?;
            if self.motion.is_stalled {
                return Err(Break::Stalled);
            }
            if is_done(&self.motion) {
                return Ok(());
            }
        }
        Err(self.fail(trouble).into())
    }

    /// An exchange with the motor driver, repeated while only the bus fails.
    async fn ask(&mut self, request: Request) -> Result<(), Break> {
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

    /// The latest encoder angle, rad, in the turn around `near`, however old.
    fn nearest_shown(&self, near: f64) -> f64 {
        let (shown, _) = self.latest.get();
        near + (shown - Angle::from_rad(near)).signed_rad()
    }

    /// A fresh encoder angle, rad, in the turn around `near`.
    async fn shown_near(&self, near: f64) -> Result<f64, Refusal> {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let (_, read) = self.latest.get();
            if Instant::now() - read <= STALE {
                return Ok(self.nearest_shown(near));
            }
            if Instant::now() > deadline {
                return Err(self.shared.give_up(self.axis.encoder, Trouble::Silent));
            }
            Timer::after(POLL).await;
        }
    }

    fn fail(&self, trouble: Trouble) -> Refusal {
        self.shared.give_up(self.axis.drive, trouble)
    }
}

//! The stage: finds its index, goes where it is sent within its travel, and compares motor and
//! encoder after every movement.
//!
//! The encoder knows the angle but not the turn, the motor's count knows the turn but not the angle:
//! at the index, a switch at the lower end of the travel, each learns from the other. From then on
//! they must agree; where they do not, one of them is wrong and no azimuth may come of it.

use core::convert::Infallible;

use embassy_time::{Duration, Instant, Timer};
use orientation::device::Trouble;
use orientation::error::Refusal;
use orientation::units::DEGREES_PER_RADIAN as DEGREES;

use crate::configuration::StageConfiguration;
use crate::event::Event;
use crate::motor::{Axis, Break, Motor, Request, STALL_REST};
use crate::ports::{Actuator, Motion, Observer};
use crate::shared::{LatestAngle, Shared};

/// How often the search for the index is tried again while something blocks it.
const RETRIES: u32 = 5;
/// How often a movement is tried again: what blocks it twice after the stage has homed blocks it for
/// good.
const MOVES: u32 = 2;

/// The stage under control, or one frame of a mount with two.
pub struct Stage<'a, M, O> {
    motor: Motor<'a, M, O>,
    configuration: StageConfiguration,
}

impl<'a, M: Actuator, O: Observer> Stage<'a, M, O> {
    /// Takes the motor of a single-axis stage; nothing moves yet.
    pub fn new(
        actuator: &'a mut M,
        configuration: &StageConfiguration,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        Self::of(Axis::ONLY, actuator, configuration, &shared.angle, shared)
    }

    /// Takes the motor of an axis whose encoder shows the `latest` angle; nothing moves yet.
    pub fn of(
        axis: Axis,
        actuator: &'a mut M,
        configuration: &StageConfiguration,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let motor = Motor::new(axis, actuator, latest, shared);
        Self { motor, configuration: *configuration }
    }

    /// Homes, then goes where it is sent until it must be given up; gives the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.serve().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        let shared = self.motor.shared;
        self.start().await?;
        shared.sensing.wait().await;
        self.home().await?;
        self.turn_to(self.configuration.home).await?;
        shared.homed.signal(());
        loop {
            let target = shared.wanted.wait().await;
            self.turn_to(target).await?;
        }
    }

    /// Starts the motor's driver.
    pub(crate) fn start(&mut self) -> impl Future<Output = Result<(), Refusal>> {
        self.motor.start()
    }

    /// Finds the index and sets the motor's count by the encoder there.
    pub(crate) async fn home(&mut self) -> Result<(), Refusal> {
        self.motor.tell(Event::Homing);
        for attempt in 0..=RETRIES {
            match self.find_index().await {
                Ok(()) => return Ok(()),
                Err(Break::Refused(reason)) => return Err(reason),
                Err(Break::Stalled) => {
                    self.motor.tell(Event::Blocked);
                    Timer::after(STALL_REST * (1 << attempt)).await;
                }
                Err(Break::Lost) => {}
            }
        }
        Err(self.motor.fail(self.motor.blocked()))
    }

    /// Goes down to the index, always from above, and believes the encoder's angle there.
    async fn find_index(&mut self) -> Result<(), Break> {
        self.motor.ask(Request::Release).await?;
        self.motor.ask(Request::Look).await?;
        if self.motor.motion.at_index {
            self.seek(1.0, |motion| !motion.at_index).await?;
            self.motor.ask(Request::Release).await?;
        }
        self.seek(-1.0, |motion| motion.is_standing).await?;
        if !self.motor.motion.at_index {
            return Err(self.motor.fail(Trouble::NoIndex).into());
        }
        self.adopt_index().await
    }

    /// Turns up or down until the motor does what is waited for.
    async fn seek(&mut self, way: f64, is_done: fn(&Motion) -> bool) -> Result<(), Break> {
        self.motor.ask(Request::Seek(way * self.configuration.seek_rate)).await?;
        self.motor.follow(Trouble::NoIndex, self.configuration.longest, is_done).await
    }

    async fn adopt_index(&mut self) -> Result<(), Break> {
        Timer::after(self.configuration.settle).await;
        let index = self.configuration.index;
        let shown = self.motor.shown_near(index).await?;
        if (shown - index).abs() > self.configuration.index_tolerance {
            return Err(self.motor.fail(Trouble::Disagrees((shown - index) * DEGREES)).into());
        }
        self.motor.ask(Request::SetAngle(shown)).await?;
        self.motor.tell(|axis| Event::Homed(axis, shown * DEGREES));
        Ok(())
    }

    /// Goes to an angle, rad, and does not rest until the encoder shows it.
    pub(crate) async fn turn_to(&mut self, target: f64) -> Result<(), Refusal> {
        let [low, high] = self.configuration.travel;
        if !(low..=high).contains(&target) {
            return Err(self.motor.fail(Trouble::BeyondTravel(target * DEGREES)));
        }
        let begun = Instant::now();
        self.motor.tell(|axis| Event::Turning(axis, target * DEGREES));
        let mut aim = target;
        let mut trouble = None;
        for attempt in 0..=MOVES {
            match self.approach(aim, target).await {
                Ok(off) if off.abs() <= self.configuration.tolerance => {
                    let took = begun.elapsed().as_micros() as f64 * 1e-6;
                    let angle = (target + off) * DEGREES;
                    self.motor.tell(|axis| Event::Arrived(axis, angle, took));
                    return Ok(());
                }
                Ok(off) => {
                    self.motor.tell(|axis| Event::Corrected(axis, off * DEGREES));
                    trouble = Some(Trouble::NotThere(off * DEGREES));
                    aim -= off;
                }
                Err(Break::Stalled) if attempt == MOVES => trouble = None,
                Err(Break::Lost) if attempt == MOVES => trouble = Some(Trouble::Resets),
                Err(broken) => self.recover(broken, STALL_REST * (1 << attempt)).await?,
            }
        }
        Err(self.motor.fail(trouble.unwrap_or_else(|| self.motor.blocked())))
    }

    /// One movement; how far the encoder then stands from the target, rad. Motor and encoder must
    /// agree.
    async fn approach(&mut self, aim: f64, target: f64) -> Result<f64, Break> {
        let has_arrived = |motion: &Motion| motion.has_reached && motion.is_standing;
        self.motor.ask(Request::GoTo(aim)).await?;
        self.motor.follow(Trouble::Restless, self.configuration.longest, has_arrived).await?;
        Timer::after(self.configuration.settle).await;
        let shown = self.motor.shown_near(self.motor.motion.angle).await?;
        let apart = shown - self.motor.motion.angle;
        if apart.abs() > self.configuration.agreement {
            return Err(self.motor.fail(Trouble::Disagrees(apart * DEGREES)).into());
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
                self.motor.tell(Event::Blocked);
                Timer::after(rest).await;
                self.home().await
            }
        }
    }
}

//! Control of the stage: homes at the index switch, moves to requested angles within the travel,
//! and compares motor and encoder after every movement.
//!
//! The encoder knows the angle but not the number of turns; the motor's step count knows the turns
//! but not the angle. At the index, a switch at the lower end of the travel, each gets its missing
//! part from the other. From then on the two must agree. If they do not, one of them is wrong, and
//! no azimuth may be computed from either.

use core::convert::Infallible;

use embassy_time::{Instant, Timer};
use orientation::alignment::Request;
use orientation::alignment::refusal::Refusal;
use orientation::device::Trouble;
use orientation::units::{DEGREES_PER_RADIAN as DEGREES, Degrees};

use crate::configuration::StageConfiguration;
use crate::event::Event;
use crate::mechanism::Mechanism;
use crate::motor::{Axis, Break, Motor, STALL_REST};
use crate::ports::{Actuator, Command, Motion};
use crate::shared::{LatestAngle, Shared};

/// Number of repetitions of the search for the index after a stall.
const RETRIES: u32 = 5;
/// Number of repetitions of a movement: an obstacle that is still there after the third attempt is
/// taken as permanent.
const MOVES: u32 = 2;
/// Largest change of the encoder of an axis that has not moved, in steps of an angle: 0.015°, half of
/// the distance from a target that is not corrected.
const STOOD: u32 = u32::MAX / 24_000;

/// The control of a stage, or of one frame of a two-frame mount.
pub struct Stage<'a, M> {
    /// The motor and its encoder.
    pub(crate) motor: Motor<'a, M>,
    /// Travel, tolerances and time limits.
    configuration: StageConfiguration,
}

impl<'a, M: Actuator> Stage<'a, M> {
    /// Takes the motor of a single-axis stage; nothing moves yet.
    pub fn new(
        actuator: &'a mut M,
        configuration: &StageConfiguration,
        shared: &'a Shared<'a>,
    ) -> Self {
        Self::of(Axis::ONLY, actuator, configuration, &shared.angles.outer, shared)
    }

    /// Takes the motor of an axis whose encoder writes its angle to `latest`; nothing moves yet.
    pub fn of(
        axis: Axis,
        actuator: &'a mut M,
        configuration: &StageConfiguration,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a>,
    ) -> Self {
        let motor = Motor::new(axis, actuator, latest, shared);
        Self { motor, configuration: *configuration }
    }

    /// Finds the index and sets the motor's step count by the encoder there.
    ///
    /// # Errors
    /// The index was not found, or motor or encoder is given up.
    pub(crate) async fn home(&mut self) -> Result<(), Refusal> {
        self.motor.report(Event::Homing);
        for attempt in 0..=RETRIES {
            let Err(broken) = self.find_index().await else { return Ok(()) };
            self.rest(broken, attempt).await?;
        }
        Err(self.motor.fail(self.motor.blocked()))
    }

    /// Approaches the index from above, so that backlash always has the same sign, and takes over
    /// the encoder's angle there.
    async fn find_index(&mut self) -> Result<(), Break> {
        self.motor.ask(Command::Release).await?;
        self.motor.ask(Command::Look).await?;
        if self.motor.motion.at_index {
            self.seek(1.0, |motion| !motion.at_index).await?;
            self.motor.ask(Command::Release).await?;
        }
        self.seek(-1.0, |motion| motion.is_standing).await?;
        if !self.motor.motion.at_index {
            return Err(self.motor.fail(Trouble::NoIndex).into());
        }
        self.adopt_index().await
    }

    /// Turns up (`way` = 1) or down (−1) at the search rate until the condition holds.
    async fn seek(&mut self, way: f64, is_done: fn(&Motion) -> bool) -> Result<(), Break> {
        self.motor.ask(Command::Seek(way * self.configuration.seek_rate)).await?;
        self.motor.follow(Trouble::NoIndex, self.configuration.longest, is_done).await
    }

    /// Compares the encoder at rest with the angle of the index, and sets the motor's step count to
    /// it.
    async fn adopt_index(&mut self) -> Result<(), Break> {
        Timer::after(self.configuration.settle).await;
        let index = self.configuration.index;
        let shown = self.motor.shown_near(index).await?;
        self.motor.check(shown - index, self.configuration.index_tolerance)?;
        self.motor.ask(Command::SetAngle(shown)).await?;
        self.motor.report(|axis| Event::Homed(axis, shown * DEGREES));
        Ok(())
    }

    /// Moves to an angle, rad, and corrects until the encoder shows it within the tolerance.
    ///
    /// # Errors
    /// The angle is beyond the travel, the stage does not arrive after three attempts, or motor and
    /// encoder disagree.
    pub(crate) async fn turn_to(&mut self, target: f64) -> Result<(), Refusal> {
        let [low, high] = self.configuration.travel;
        if !(low..=high).contains(&target) {
            return Err(self.motor.fail(Trouble::BeyondTravel(Degrees(target * DEGREES))));
        }
        let begun = Instant::now();
        self.motor.report(|axis| Event::Turning(axis, target * DEGREES));
        let mut aim = target;
        let mut trouble = None;
        for attempt in 0..=MOVES {
            match self.approach(aim, target).await {
                Ok(off) if off.abs() <= self.configuration.tolerance => {
                    let took = begun.elapsed().as_micros() as f64 * 1e-6;
                    let angle = (target + off) * DEGREES;
                    self.motor.report(|axis| Event::Arrived(axis, angle, took));
                    return Ok(());
                }
                Ok(off) => {
                    self.motor.report(|axis| Event::Corrected(axis, off * DEGREES));
                    trouble = Some(Trouble::NotThere(Degrees(off * DEGREES)));
                    aim -= off;
                }
                Err(Break::Stalled) if attempt == MOVES => trouble = None,
                Err(Break::Lost) if attempt == MOVES => trouble = Some(Trouble::Resets),
                Err(broken) => {
                    self.rest(broken, attempt).await?;
                    // The motor's step count is invalid after a stall or a restart, and the encoder
                    // has then nothing to agree with: both are referenced at the index again.
                    self.home().await?;
                    // A correction belongs to the step count before.
                    aim = target;
                }
            }
        }
        Err(self.motor.fail(trouble.unwrap_or_else(|| self.motor.blocked())))
    }

    /// Makes one movement to `aim` and returns the distance of the encoder's angle from `target`,
    /// rad. Motor and encoder must agree. An encoder that stands where it was, away from the target,
    /// shows a stall: in a short movement the motor is too slow for the driver's own detection.
    async fn approach(&mut self, aim: f64, target: f64) -> Result<f64, Break> {
        let has_arrived = |motion: &Motion| motion.has_reached && motion.is_standing;
        let before = self.motor.shown();
        self.motor.ask(Command::GoTo(aim)).await?;
        self.motor.follow(Trouble::Restless, self.configuration.longest, has_arrived).await?;
        Timer::after(self.configuration.settle).await;
        let shown = self.motor.shown_near(self.motor.motion.angle).await?;
        let (apart, off) = (shown - self.motor.motion.angle, shown - target);
        let moved = (self.motor.shown() - before).0.cast_signed().unsigned_abs();
        if moved <= STOOD && off.abs() > self.configuration.tolerance {
            return Err(Break::Stalled);
        }
        self.motor.check(apart, self.configuration.agreement)?;
        Ok(off)
    }

    /// Rests before another attempt, after a stall for 0.5 s, doubled with each attempt.
    async fn rest(&mut self, broken: Break, attempt: u32) -> Result<(), Refusal> {
        match broken {
            Break::Refused(reason) => return Err(reason),
            Break::Lost => {}
            Break::Stalled => {
                self.motor.report(Event::Blocked);
                Timer::after(STALL_REST * (1 << attempt)).await;
            }
        }
        Ok(())
    }
}

impl<M: Actuator> Mechanism for Stage<'_, M> {
    /// Starts the motor, waits for the sensors, homes, and then follows requests for ever.
    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        self.motor.start().await?;
        self.motor.shared.sensing.wait().await;
        self.home().await?;
        self.turn_to(self.configuration.home).await?;
        self.motor.shared.homed.signal(());
        loop {
            if let Request::Point(target) = self.motor.shared.wanted.wait().await {
                self.turn_to(target.0).await?;
            }
        }
    }

    async fn halt(&mut self) {
        self.motor.halt().await;
    }
}

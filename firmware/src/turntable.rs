//! The turntable: a platform on a slip ring, which turns at the rate that it is told, either way and
//! for as long as it is told.
//!
//! There is no index: the absolute encoder's zero is the reference, and the motor's count is set by it
//! where the platform stands. From then on the two are compared at every look. A gear is uneven and its
//! platform runs ahead of the motor and behind it, but by the same in the same place of every turn; what
//! differs from one turn to the next is an encoder that slips, a motor that loses steps, or either
//! standing while the other turns.

use core::convert::Infallible;

use embassy_futures::select::{Either, select};
use embassy_time::{Duration, Instant, Timer};
use orientation::device::Trouble;
use orientation::error::Refusal;
use orientation::units::{Angle, DEGREES_PER_RADIAN as DEGREES, TURN};

use crate::configuration::TurntableConfiguration;
use crate::event::Event;
use crate::motor::{Axis, Break, Motor, POLL, Request, STALL_REST};
use crate::ports::{Actuator, Observer};
use crate::shared::Shared;

/// How often in a session the platform may be blocked and turn on.
const BLOCKS: u32 = 1;
/// Longest time to come to rest: 90°/s at the motor driver's 33°/s² is over in three seconds.
const LONGEST_STOP: Duration = Duration::from_secs(10);

/// Parts of a turn in which motor and encoder are compared: within one, a gear of 0.5 % turns by
/// 0.06° more or less than its motor.
const SECTORS: usize = 32;
/// Bits of an [`Angle`] below its sector.
const SECTOR_BITS: u32 = u32::BITS - SECTORS.ilog2();

/// The turntable under control.
pub struct Turntable<'a, M, O> {
    motor: Motor<'a, M, O>,
    configuration: TurntableConfiguration,
    comparison: Comparison,
    /// When the motor was last looked at.
    looked: Instant,
    /// The rate that it was told last, rad/s.
    rate: f64,
    blocks: u32,
}

impl<'a, M: Actuator, O: Observer> Turntable<'a, M, O> {
    /// Takes the motor; nothing moves yet.
    pub fn new(
        actuator: &'a mut M,
        configuration: &TurntableConfiguration,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        Self {
            motor: Motor::new(Axis::ONLY, actuator, &shared.angle, shared),
            configuration: *configuration,
            comparison: Comparison::default(),
            looked: Instant::MIN,
            rate: 0.0,
            blocks: 0,
        }
    }

    /// Turns as it is told until it must be given up; gives the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.serve().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    /// Has the platform come to rest.
    ///
    /// # Errors
    /// A motor that had to be given up meanwhile, which is told.
    pub async fn rest(&mut self) -> Result<(), Refusal> {
        for _ in 0..=BLOCKS {
            match self.stop().await {
                Err(Break::Refused(reason)) => return Err(reason),
                // A driver that was started again has stopped its motor; a stall has, too.
                Ok(()) | Err(Break::Lost | Break::Stalled) => {}
            }
        }
        Ok(())
    }

    async fn stop(&mut self) -> Result<(), Break> {
        self.motor.look().await?;
        if self.motor.motion.is_standing {
            return Ok(());
        }
        self.motor.tell(|axis| Event::Revolving(axis, 0.0));
        self.motor.ask(Request::Seek(0.0)).await?;
        self.motor.follow(Trouble::Restless, LONGEST_STOP, |motion| motion.is_standing).await
    }

    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        self.motor.start().await?;
        self.motor.shared.sensing.wait().await;
        loop {
            let Err(broken) = self.turn().await;
            self.forgive(broken)?;
        }
    }

    /// Whether the platform may be turned on after this: where only the driver was started again, which
    /// has its own limit, and where it was blocked for the first time.
    fn forgive(&mut self, broken: Break) -> Result<(), Refusal> {
        match broken {
            Break::Refused(reason) => return Err(reason),
            Break::Stalled if self.blocks == BLOCKS => {
                return Err(self.motor.fail(self.motor.blocked()));
            }
            Break::Stalled => {
                self.blocks += 1;
                self.motor.tell(Event::Blocked);
            }
            Break::Lost => {}
        }
        Ok(())
    }

    /// Turns from rest, as it is told meanwhile, until something breaks it off.
    async fn turn(&mut self) -> Result<Infallible, Break> {
        self.align().await?;
        let shared = self.motor.shared;
        shared.homed.signal(());
        self.motor.ask(Request::Seek(self.rate)).await?;
        loop {
            match select(shared.wanted.wait(), Timer::at(self.looked + POLL)).await {
                Either::First(rate) => self.turn_at(rate).await?,
                Either::Second(()) => self.watch().await?,
            }
        }
    }

    /// Sets the motor's count by the encoder where the platform stands. What was blocked gets its time
    /// to come free; an encoder that moves meanwhile slips.
    async fn align(&mut self) -> Result<(), Break> {
        self.motor.ask(Request::Release).await?;
        self.motor.follow(Trouble::Restless, LONGEST_STOP, |motion| motion.is_standing).await?;
        Timer::after(self.configuration.settle).await;
        let before = self.motor.shown_near(0.0).await?;
        Timer::after(STALL_REST).await;
        let shown = self.motor.shown_near(before).await?;
        self.check(shown - before)?;
        self.motor.ask(Request::SetAngle(shown)).await?;
        self.motor.look().await?;
        self.looked = Instant::now();
        self.comparison = Comparison::at(Angle::from_rad(shown));
        Ok(())
    }

    /// Turns at another rate from now on; zero has the platform come to rest.
    async fn turn_at(&mut self, rate: f64) -> Result<(), Break> {
        // A stall is to be found here, where it has its name: the driver refuses to turn on after it.
        self.watch().await?;
        if rate == 0.0 || rate * self.rate <= 0.0 {
            self.motor.tell(|axis| Event::Revolving(axis, rate * DEGREES));
        }
        self.rate = rate;
        self.motor.ask(Request::Seek(rate)).await
    }

    /// Looks at the motor and compares it with the encoder. A platform that has not left where it was
    /// aligned is blocked: its motor is too slow yet to know that it stalls.
    async fn watch(&mut self) -> Result<(), Break> {
        let before = (self.looked, self.motor.motion.angle);
        self.motor.look().await?;
        self.looked = Instant::now();
        // Where there is no angle, acquisition knows why.
        let Some((shown, read)) = self.motor.fresh() else { return Ok(()) };
        let counted = at(read, before, (self.looked, self.motor.motion.angle));
        let apart = self.comparison.judge(shown, Angle::from_rad(counted));
        if self.is_far(apart) && !self.is_far(self.comparison.way(shown)) {
            return Err(Break::Stalled);
        }
        self.check(apart)
    }

    /// Whether angles that should be one are not, rad.
    fn is_far(&self, apart: f64) -> bool {
        apart.abs() > self.configuration.agreement
    }

    /// Refuses to go on where motor and encoder differ by too much, rad.
    fn check(&self, apart: f64) -> Result<(), Break> {
        if self.is_far(apart) {
            return Err(self.motor.fail(Trouble::Disagrees(apart * DEGREES)).into());
        }
        Ok(())
    }
}

/// An angle at a time, from two looks at it of different times; also beyond them.
fn at(time: Instant, before: (Instant, f64), after: (Instant, f64)) -> f64 {
    let micros = |time: Instant| time.as_micros() as f64;
    let part = (micros(after.0) - micros(time)) / (micros(after.0) - micros(before.0)).max(1.0);
    after.1 - (after.1 - before.1) * part
}

/// By what encoder and motor differ in each sector of a turn.
#[derive(Clone, Copy, Debug, Default)]
struct Comparison {
    /// Where both were one.
    aligned: Angle,
    /// As the sector was first entered.
    known: [Angle; SECTORS],
    /// A bit for every sector that was.
    entered: u32,
    latest: Angle,
}

impl Comparison {
    /// Of a motor whose count was set there.
    fn at(aligned: Angle) -> Self {
        Self { aligned, ..Self::default() }
    }

    /// How far the encoder has moved from there, rad: half a turn once it has moved by a sector.
    fn way(&self, shown: Angle) -> f64 {
        let has_moved = self.entered.count_ones() > 1;
        if has_moved { TURN / 2.0 } else { (shown - self.aligned).signed_rad() }
    }

    /// How much more they differ than when the platform first came by here, rad: where it has not been
    /// before, than a look before.
    fn judge(&mut self, shown: Angle, counted: Angle) -> f64 {
        let sector = shown.0 >> SECTOR_BITS;
        let known = &mut self.known[sector as usize % SECTORS];
        if self.entered & (1 << sector) == 0 {
            self.entered |= 1 << sector;
            *known = self.latest;
        }
        self.latest = shown - counted;
        (self.latest - *known).signed_rad()
    }
}

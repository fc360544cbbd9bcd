//! Control of the turntable: a platform on a slip ring, which turns at the requested rate in either
//! sense without limit.
//!
//! The motor's step count is set by the absolute encoder while the platform stands, so the encoder's
//! zero enters the azimuth in full, and the motor cannot contradict it. An index mark on the platform
//! can: it passes a switch once per turn, the motor driver latches its step count there, and the
//! encoder must show the angle at which the mark was found when the zero was set. An encoder that has
//! slipped while the board was off shows at the first pass.
//!
//! Motor and encoder are also compared at every reading of the motor's status. A gear is not uniform, so the
//! platform runs ahead of the motor and behind it, but by the same amount at the same place of every turn. A
//! change from one turn to the next means that the encoder slips, that the motor loses steps, or that one of
//! them stands while the other turns.

use core::convert::Infallible;

use embassy_futures::select::{Either, select};
use embassy_time::{Instant, Timer};
use orientation::alignment::Request;
use orientation::alignment::refusal::Refusal;
use orientation::device::Trouble;
use orientation::units::{Angle, DEGREES_PER_RADIAN as DEGREES, TURN};

use crate::configuration::TurntableConfiguration;
use crate::event::Event;
use crate::mechanism::Mechanism;
use crate::motor::{Axis, Break, LONGEST_STOP, Motor, POLL, STALL_REST};
use crate::ports::{Actuator, Command, Motion};
use crate::shared::Shared;

/// Number of stalls in a session after which the platform may turn on.
const BLOCKS: u32 = 1;

/// Sectors of a turn in which motor and encoder are compared. Within one sector, a gear with an
/// error of 0.5 % turns by 0.06° more or less than its motor.
const SECTORS: usize = 32;
/// Number of bits of an [`Angle`] below its sector.
const SECTOR_BITS: u32 = u32::BITS - SECTORS.ilog2();

/// Way of the platform within which the index mark must pass once, rad: two turns and what the start
/// and a reversal take.
const LONGEST_UNMARKED: f64 = 2.5 * TURN;
/// Way between two readings, rad, below which the platform may have reversed between them: half a
/// period of readings at the motor driver's deceleration of 33°/s² takes 0.002°.
const REVERSING: f64 = 0.01 / DEGREES;

/// The control of a turntable.
pub struct Turntable<'a, M> {
    /// The motor and its encoder.
    motor: Motor<'a, M>,
    /// Tolerance and settling time.
    configuration: TurntableConfiguration,
    /// Differences of encoder and motor around a turn.
    comparison: Comparison,
    /// Angle by the motor's step count at which the mark passed last, or at which the count was set,
    /// rad.
    passed: f64,
    /// Time of the latest reading of the motor's status.
    looked: Instant,
    /// The rate requested last, rad/s, clockwise positive.
    rate: f64,
    /// Number of stalls so far.
    blocks: u32,
}

impl<'a, M: Actuator> Turntable<'a, M> {
    /// Takes the motor; nothing moves yet.
    pub fn new(
        actuator: &'a mut M,
        configuration: &TurntableConfiguration,
        shared: &'a Shared<'a>,
    ) -> Self {
        Self {
            motor: Motor::new(Axis::ONLY, actuator, &shared.angles.outer, shared),
            configuration: *configuration,
            comparison: Comparison::default(),
            passed: 0.0,
            looked: Instant::MIN,
            rate: 0.0,
            blocks: 0,
        }
    }

    /// Decides whether the platform may turn on after a break: after a restart of the driver, whose
    /// number its own budget limits, and after the first stall.
    fn forgive(&mut self, broken: Break) -> Result<(), Refusal> {
        match broken {
            Break::Refused(reason) => return Err(reason),
            Break::Stalled if self.blocks == BLOCKS => {
                return Err(self.motor.fail(self.motor.blocked()));
            }
            Break::Stalled => {
                self.blocks += 1;
                self.motor.report(Event::Blocked);
            }
            Break::Lost => {}
        }
        Ok(())
    }

    /// Turns from rest at the requested rates until a failure breaks it off.
    async fn turn(&mut self) -> Result<Infallible, Break> {
        self.align().await?;
        let shared = self.motor.shared;
        shared.homed.signal(());
        self.motor.ask(Command::Seek(self.rate)).await?;
        loop {
            match select(shared.wanted.wait(), Timer::at(self.looked + POLL)).await {
                Either::First(Request::Turn(rate)) => self.turn_at(rate.0).await?,
                Either::First(Request::Vertical) => self.turn_at(0.0).await?,
                Either::First(_) => {}
                Either::Second(()) => self.watch().await?,
            }
        }
    }

    /// Sets the motor's step count by the encoder while the platform stands. Waits between two
    /// readings, so that an obstacle can come free; an encoder that changes meanwhile slips.
    async fn align(&mut self) -> Result<(), Break> {
        self.motor.ask(Command::Release).await?;
        self.motor.follow(Trouble::Restless, LONGEST_STOP, |motion| motion.is_standing).await?;
        Timer::after(self.configuration.settle).await;
        let before = self.motor.shown_near(0.0).await?;
        Timer::after(STALL_REST).await;
        let shown = self.motor.shown_near(before).await?;
        self.motor.check(shown - before, self.configuration.agreement)?;
        self.motor.ask(Command::SetAngle(shown)).await?;
        self.motor.look().await?;
        self.looked = Instant::now();
        self.comparison = Comparison::at(Angle::from_rad(shown));
        self.passed = shown;
        Ok(())
    }

    /// Changes the rate, rad/s; zero brings the platform to rest. Reports only begins, ends and
    /// reversals of the rotation.
    async fn turn_at(&mut self, rate: f64) -> Result<(), Break> {
        // A stall must be detected here, where it can be named: the driver refuses to turn after
        // it. What breaks it off goes on at the new rate.
        let before = core::mem::replace(&mut self.rate, rate);
        self.watch().await?;
        if rate == 0.0 || rate * before <= 0.0 {
            self.motor.report(|axis| Event::Revolving(axis, rate * DEGREES));
        }
        self.motor.ask(Command::Seek(rate)).await
    }

    /// Reads the motor's status and compares the motor with the encoder. A platform that has not
    /// left the place where it was aligned counts as blocked: its motor is still too slow for the
    /// driver's own detection of stalls.
    async fn watch(&mut self) -> Result<(), Break> {
        let before = (self.looked, self.motor.motion.angle);
        self.motor.look().await?;
        self.looked = Instant::now();
        // If there is no recent angle, acquisition handles the failure of the encoder.
        let Some((shown, read)) = self.motor.fresh() else { return Ok(()) };
        let counted = at(read, before, (self.looked, self.motor.motion.angle));
        let apart = self.comparison.judge(shown, Angle::from_rad(counted));
        if self.is_far(apart) && !self.is_far(self.comparison.way(shown)) {
            return Err(Break::Stalled);
        }
        self.motor.check(apart, self.configuration.agreement)?;
        self.compare_index(self.motor.motion.angle - before.1)
    }

    /// Compares the encoder with the index where the mark has passed while the motor has turned by
    /// `turned` since the reading before, rad. A platform that reverses meanwhile may have met either
    /// end of the mark; it meets it again.
    fn compare_index(&mut self, turned: f64) -> Result<(), Break> {
        let Motion { angle, mark, .. } = self.motor.motion;
        let Some(mark) = mark else {
            let is_missing = (angle - self.passed).abs() > LONGEST_UNMARKED;
            return if is_missing { Err(self.motor.fail(Trouble::NoIndex).into()) } else { Ok(()) };
        };
        if turned.abs() < REVERSING || turned * self.rate < 0.0 {
            return Ok(());
        }
        self.passed = mark;
        let [clockwise, counter] = self.configuration.index;
        let index = if turned > 0.0 { clockwise } else { counter };
        let apart = self.comparison.latest - Angle::from_rad(index - mark);
        self.motor.check(apart.signed_rad(), self.configuration.agreement)
    }

    /// Whether two angles that should be equal differ by more than the tolerance, rad.
    fn is_far(&self, apart: f64) -> bool {
        apart.abs() > self.configuration.agreement
    }
}

impl<M: Actuator> Mechanism for Turntable<'_, M> {
    /// Starts the motor, waits for the sensors, and turns until the session has to end.
    async fn serve(&mut self) -> Result<Infallible, Refusal> {
        self.motor.start().await?;
        self.motor.shared.sensing.wait().await;
        loop {
            let Err(broken) = self.turn().await;
            self.forgive(broken)?;
        }
    }

    async fn halt(&mut self) {
        if core::mem::take(&mut self.rate) != 0.0 {
            self.motor.report(|axis| Event::Revolving(axis, 0.0));
        }
        self.motor.halt().await;
    }
}

/// An angle at a time by linear interpolation, or extrapolation, of two readings at different
/// times.
fn at(time: Instant, before: (Instant, f64), after: (Instant, f64)) -> f64 {
    let micros = |time: Instant| time.as_micros() as f64;
    let part = (micros(after.0) - micros(time)) / (micros(after.0) - micros(before.0)).max(1.0);
    after.1 - (after.1 - before.1) * part
}

/// The difference of encoder and motor in each sector of a turn.
#[derive(Clone, Copy, Debug, Default)]
struct Comparison {
    /// The angle at which encoder and motor were set equal.
    aligned: Angle,
    /// Difference of encoder and motor when the sector was first entered.
    known: [Angle; SECTORS],
    /// One bit for each sector that has been entered.
    entered: u32,
    /// Difference of encoder and motor at the latest reading.
    latest: Angle,
}

impl Comparison {
    /// The comparison of a motor whose count was set at this angle.
    fn at(aligned: Angle) -> Self {
        Self { aligned, ..Self::default() }
    }

    /// Distance of the encoder from the angle of alignment, rad; reported as half a turn once a
    /// second sector has been entered.
    fn way(&self, shown: Angle) -> f64 {
        let has_moved = self.entered.count_ones() > 1;
        if has_moved { TURN / 2.0 } else { (shown - self.aligned).signed_rad() }
    }

    /// Change of the difference since the platform first entered this sector, rad; in a new sector,
    /// change since the reading before.
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

//! TMC5160: stepper driver with ramp generator of the stage (Trinamic data sheet, rev. 1.14).
//!
//! SPI mode 3, datagrams of 40 bits, at most 4 MHz with the internal oscillator (4.3). A read takes two
//! datagrams, because a reply carries what the datagram before it asked for.
//!
//! The chip has no checksum. Other checks take its place:
//! - after every write the chip sends back the data it received (4.1.1), and all of it is compared:
//!   a bit that flips in the data is noticed, on the way in or out;
//! - registers that can be read are read back: [`start`](Tmc5160::start) does so for `GCONF`, `CHOPCONF`,
//!   `SW_MODE`, `RAMPMODE` and `XTARGET`, a motion for its target before the motor leaves rest, so a write
//!   to a wrong address is noticed there. All other registers are write-only: a write-only register
//!   that a flipped *address* bit has missed, or hit, stays unnoticed until the next start;
//! - a [`Status`] ends with the version and a second look at the position, which must be the
//!   same where the motor stands, and near where it moves: dead lines and a flipped bit of a position
//!   are noticed, of a moving one if it counts for more than 0.3° of the stage. So is one that is
//!   reserved as zero: when every reply has a wrong bit, one status in fifty passes at most.
//!
//! Each status byte is evaluated: a chip that has been reset is reported as [`Fault::Reset`] by
//! every function except `start`, and one that has shut its bridges down refuses motions with
//! [`Fault::Alarm`].
//!
//! | budget at [`BUS_HERTZ`] | datagrams | bytes | time |
//! |---|--:|--:|--:|
//! | a status | 8 | 40 | 160 µs |
//! | a motion from rest | 13 | 65 | 260 µs |
//!
//! With the default ramp 15° take 1.20 s and 360° take 18.41 s, ± 4 % for the internal oscillator.

pub mod codec;
pub mod configuration;
mod link;
pub mod registers;
pub mod units;

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::SpiDevice;

use self::codec::{DATAGRAM, Guard, Status};
use self::configuration::Configuration;
use self::link::{Link, Pass};
use self::registers::{Address, drv_status, gstat, ioin, ramp_mode, ramp_stat, spi_status};
use self::units::Velocity;
use crate::fault::Fault;
use crate::pause::pause;

/// Fastest bus clock with the internal oscillator, Hz (4.3).
pub const GREATEST_BUS_HERTZ: u32 = 4_000_000;

/// Bus clock that the budget is made for, Hz.
pub const BUS_HERTZ: u32 = 2_000_000;

/// Bytes of a status: seven registers and one datagram to fetch the last.
pub const STATUS_BYTES: usize = 8 * DATAGRAM;

/// Bytes of the longest motion command.
pub const MOTION_BYTES: usize = 13 * DATAGRAM;

/// Time of so many bytes at [`BUS_HERTZ`].
#[must_use]
pub const fn bus_time(bytes: usize) -> Duration {
    Duration::from_nanos(bytes as u64 * 8 * 1_000_000_000 / BUS_HERTZ as u64)
}

/// The reset ends 10 µs after the supply is there (28.2, typical only): a hundred times that.
const POWER_UP: Duration = Duration::from_millis(1);

/// Time between two readings of the state of a motor that is being stopped.
const STOPPING: Duration = Duration::from_millis(20);

/// Farthest that a moving motor gets between the two looks at its position in a status, microsteps: at
/// 90°/s of the stage it takes 3.5 ms, five times what a bus that other chips share may take.
const MOST_PASSED: u32 = 4096;

/// Number of readings until the motor must stand: 2 s, three times the slowest default ramp.
const STOPPING_LOOKS: usize = 100;

/// Between switching the bridges on and asking for shorts: some 50 chopper periods, in which the chip
/// has tried three times (11.2).
const BRIDGE_TEST: Duration = Duration::from_millis(2);

/// Slows down to rest.
const STOP: [(Address, u32); 2] = [(registers::VMAX, 0), (registers::RAMPMODE, ramp_mode::FORWARD)];

/// Holds the motor at rest, whatever target and velocity are set.
const HOLD: [(Address, u32); 1] = [(registers::RAMPMODE, ramp_mode::HOLD)];

/// Clears a stall, so that the motor may move again, without starting it.
const CLEAR_STALL: [(Address, u32); 3] = [
    (registers::VMAX, 0),
    (registers::RAMPMODE, ramp_mode::HOLD),
    (registers::RAMP_STAT, ramp_stat::STALLED),
];

/// Clears the event of a latched position.
const CLEAR_LATCH: [(Address, u32); 1] = [(registers::RAMP_STAT, ramp_stat::LATCHED_LEFT)];

/// Clears the global flags with the bridges off.
const CLEAR_ERRORS: [(Address, u32); 2] =
    [(registers::CHOPCONF, codec::CHOPPER_OFF), (registers::GSTAT, gstat::ALL)];

/// Registers of a status; version and position are read a second time to verify the rest.
const LOOKED_AT: [Address; 7] = [
    registers::RAMP_STAT,
    registers::XACTUAL,
    registers::VACTUAL,
    registers::DRV_STATUS,
    registers::GSTAT,
    registers::IOIN,
    registers::XACTUAL,
];

/// The driver of a TMC5160 on its bus.
#[derive(Debug)]
pub struct Tmc5160<S, D> {
    link: Link<S>,
    delay: D,
    configuration: Configuration,
    /// The position, microsteps, counted on where the chip's 32 bits overflow.
    counted: i64,
}

impl<S: SpiDevice, D: DelayNs> Tmc5160<S, D> {
    /// Creates the driver of a chip that has not been started.
    #[must_use]
    pub const fn new(spi: S, delay: D, configuration: Configuration) -> Self {
        Self { link: Link(spi), delay, configuration, counted: 0 }
    }

    /// Stops the motor, checks and configures the chip, tests the bridges, and leaves it standing in
    /// position mode. After a loss of supply the position is zero wherever the stage stands, and the
    /// chip cannot detect afterwards: home after every start.
    ///
    /// # Errors
    /// [`Fault::Identity`] for another chip or one strapped to external steps, [`Fault::NotReady`] where
    /// the enable pin keeps the bridges off or the motor does not stop, [`Fault::Alarm`] with GSTAT where
    /// an error cannot be cleared, [`Fault::SelfTest`] for shorts and heat, [`Fault::NotAsWritten`].
    pub async fn start(&mut self) -> Result<(), Fault> {
        let inputs = self.come_to_rest().await?;
        if inputs & ioin::DISABLED != 0 {
            return Err(Fault::NotReady);
        }
        self.clear_errors().await?;
        let mut position = [0];
        let look = Pass::Read(&[registers::XACTUAL], &mut position);
        self.link.pass(&mut [Pass::Configure(&self.configuration), look], false).await?;
        self.stand_ready(position).await?;
        self.counted = 0;
        self.test_bridges().await
    }

    /// Brings the ramp to rest of a chip of which nothing is known, as after a reset of the controller: it
    /// may go on although the enable pin keeps the bridges off, and would drive the motor once it does not.
    ///
    /// # Errors
    /// [`Fault::Identity`] as of [`Self::start`], and [`Fault::NotReady`] where the ramp does not stop
    /// within two seconds.
    pub async fn rest(&mut self) -> Result<(), Fault> {
        self.come_to_rest().await.map(|_| ())
    }

    /// Moves to a position, microsteps, by the ramp; permitted during a motion. From rest the
    /// target is read back before the motor leaves.
    ///
    /// # Errors
    /// [`Fault::Alarm`] if a stall waits for [`Self::clear_stall`] or the bridges are shut down.
    pub async fn go_to(&mut self, microsteps: i32) -> Result<(), Fault> {
        let Configuration { clock, ramp, .. } = self.configuration;
        let target = (registers::XTARGET, microsteps.cast_unsigned());
        let first = [self.guard(ramp.peak), target];
        let peak = clock.velocity_units(ramp.peak);
        let last = [(registers::RAMPMODE, ramp_mode::POSITION), (registers::VMAX, peak)];
        self.depart(&first, &first, &last).await
    }

    /// Turns at a velocity in either direction until it is stopped: by switches along the ramp
    /// where the velocity is too low to detect stalls, otherwise by stalls and switches at once.
    ///
    /// # Errors
    /// The errors of [`Self::go_to`].
    pub async fn run(&mut self, velocity: Velocity) -> Result<(), Fault> {
        let is_forward = velocity.0 >= 0;
        let mode = if is_forward { ramp_mode::FORWARD } else { ramp_mode::BACKWARD };
        let units = self.configuration.clock.velocity_units(velocity);
        let guard = self.guard(velocity);
        // A mark that has just passed is still to be taken.
        let cleared = if self.configuration.switches.do_stop { ramp_stat::LATCHED_LEFT } else { 0 };
        let first = [guard, (registers::RAMP_STAT, cleared)];
        let last = [(registers::VMAX, units), (registers::RAMPMODE, mode)];
        self.depart(&first, &[guard], &last).await
    }

    /// Slows down to rest with AMAX (12.2.4 a); a stall stays to be acknowledged.
    pub async fn stop(&mut self) -> Result<(), Fault> {
        self.pass(&mut [Pass::Write(&STOP)]).await.map(|_| ())
    }

    /// Sets the position of the standing motor, microsteps.
    ///
    /// # Errors
    /// [`Fault::NotReady`] while it moves.
    pub async fn set_position(&mut self, microsteps: i32) -> Result<(), Fault> {
        let position = microsteps.cast_unsigned();
        let [state, ..] = self.read(&[registers::RAMP_STAT], false).await?;
        if !is_set(state, ramp_stat::STANDING) {
            return Err(Fault::NotReady);
        }
        let both = [(registers::XACTUAL, position), (registers::XTARGET, position)];
        let follow = [(registers::RAMPMODE, ramp_mode::POSITION)];
        let mut passes =
            [Pass::Write(&HOLD), Pass::Write(&both), Pass::Verify(&both), Pass::Write(&follow)];
        self.pass(&mut passes).await?;
        self.counted = microsteps.into();
        Ok(())
    }

    /// A position, microsteps, counted on beyond the 32 bits of the chip, which the stage passes
    /// every 466 turns. It must be asked for more often than that: the position next to the one
    /// before is meant.
    pub fn counted(&mut self, position: i32) -> i64 {
        self.counted = self.beside(position);
        self.counted
    }

    /// A position, microsteps, on the same count, next to the latest one; for an edge that was
    /// passed.
    #[must_use]
    pub fn beside(&self, position: i32) -> i64 {
        self.counted + i64::from(position.wrapping_sub(self.counted as i32))
    }

    /// Takes the position, microsteps, of a mark that has passed, so that the next one can be
    /// latched; `status` is the latest. [`None`] where switches stop the motor, or no mark has
    /// passed.
    ///
    /// # Errors
    /// The bus fails.
    pub async fn take_mark(&mut self, status: &Status) -> Result<Option<i32>, Fault> {
        if self.configuration.switches.do_stop || !status.latched_left {
            return Ok(None);
        }
        let edge = self.left_edge().await?;
        self.pass(&mut [Pass::Write(&CLEAR_LATCH)]).await?;
        Ok(edge)
    }

    /// The position, microsteps, at which the left switch became active since the last
    /// [`Self::run`], or the last mark that was taken; a soft stop ends beyond it.
    pub async fn left_edge(&mut self) -> Result<Option<i32>, Fault> {
        let [state, edge, ..] =
            self.read(&[registers::RAMP_STAT, registers::XLATCH], false).await?;
        Ok((state & ramp_stat::LATCHED_LEFT != 0).then(|| edge.cast_signed()))
    }

    /// Acknowledges a stall, by which the motor stands; it stays where it is. One that moves would go on at its
    /// velocity. The position is lost, so the axis must be homed again.
    pub async fn clear_stall(&mut self) -> Result<(), Fault> {
        let mut state = [0];
        let look = Pass::Read(&[registers::RAMP_STAT], &mut state);
        self.pass(&mut [Pass::Write(&CLEAR_STALL), look]).await?;
        if is_set(state[0], ramp_stat::STALLED) {
            return Err(Fault::NotAsWritten { register: registers::RAMP_STAT.0 });
        }
        Ok(())
    }

    /// Reads the state of the motor.
    ///
    /// # Errors
    /// [`Fault::Checksum`] if the two readings of the position contradict each other, or if a bit is
    /// set that is reserved as zero; [`Fault::Identity`] if the version does not come back.
    pub async fn status(&mut self) -> Result<Status, Fault> {
        let [ramp, position, velocity, driver, global, inputs, again] =
            self.read(&LOOKED_AT, false).await?;
        check_version(inputs)?;
        let clock = self.configuration.clock;
        let status = Status::new(clock, [ramp, position, velocity, driver, global]);
        let passed = again.wrapping_sub(position).cast_signed().unsigned_abs();
        let is_at_rest = passed == 0 && status.velocity == Velocity(0);
        let reserved =
            ramp & ramp_stat::RESERVED | global & gstat::RESERVED | inputs & ioin::RESERVED;
        if reserved != 0 || passed > MOST_PASSED || status.standing && !is_at_rest {
            return Err(Fault::Checksum);
        }
        Ok(status)
    }

    /// Reads as many registers as a status has at most, of a chip that may have been reset or not.
    async fn read(
        &mut self,
        addresses: &[Address],
        may_be_reset: bool,
    ) -> Result<[u32; LOOKED_AT.len()], Fault> {
        let mut values = [0; LOOKED_AT.len()];
        self.link.pass(&mut [Pass::Read(addresses, &mut values)], may_be_reset).await?;
        Ok(values)
    }

    /// Makes passes through a chip that must not have been reset.
    fn pass(&mut self, passes: &mut [Pass<'_>]) -> impl Future<Output = Result<u8, Fault>> {
        self.link.pass(passes, false)
    }

    /// Makes passes through a chip that may have been reset.
    fn pass_anyhow(&mut self, passes: &mut [Pass<'_>]) -> impl Future<Output = Result<u8, Fault>> {
        self.link.pass(passes, true)
    }

    /// The stop conditions for a velocity.
    fn guard(&self, velocity: Velocity) -> (Address, u32) {
        let guard = Guard::at(self.configuration.stall, velocity);
        (registers::SW_MODE, codec::switch_mode(&self.configuration, guard))
    }

    /// Begins a motion: writes the preparation, reads back those registers that must be correct,
    /// and writes the command. Refuses to move if the chip cannot, and holds a standing motor until
    /// everything has been written.
    async fn depart(
        &mut self,
        first: &[(Address, u32)],
        verified: &[(Address, u32)],
        last: &[(Address, u32)],
    ) -> Result<(), Fault> {
        let mut state = [0];
        let look = Pass::Read(&[registers::RAMP_STAT], &mut state);
        let seen = self.pass(&mut [look]).await?;
        if is_set(state[0], ramp_stat::STALLED) || seen & spi_status::DRIVER_ERROR != 0 {
            return Err(Fault::Alarm { status: seen });
        }
        let mut passes =
            [Pass::Write(&HOLD), Pass::Write(first), Pass::Verify(verified), Pass::Write(last)];
        let moving = usize::from(!is_set(state[0], ramp_stat::STANDING));
        self.pass(passes.get_mut(moving..).unwrap_or_default()).await.map(|_| ())
    }

    /// Verifies that the chip is a TMC5160 in the mode with its internal ramp generator, and returns its
    /// inputs. It may have been reset.
    async fn identify(&mut self) -> Result<u32, Fault> {
        let [inputs, ..] = self.read(&[registers::IOIN], true).await?;
        check_version(inputs)?;
        if inputs & ioin::STEP_MODE != 0 {
            return Err(Fault::Identity { found: inputs });
        }
        Ok(inputs)
    }

    /// Checks the chip, stops the motor, whatever it did before, and holds it; returns the chip's inputs.
    async fn come_to_rest(&mut self) -> Result<u32, Fault> {
        pause(&mut self.delay, POWER_UP).await;
        let inputs = self.identify().await?;
        self.pass_anyhow(&mut [Pass::Write(&STOP)]).await?;
        for _ in 0..STOPPING_LOOKS {
            let [state, ..] = self.read(&[registers::RAMP_STAT], true).await?;
            if is_set(state, ramp_stat::STANDING) {
                return self.pass_anyhow(&mut [Pass::Write(&HOLD)]).await.map(|_| inputs);
            }
            pause(&mut self.delay, STOPPING).await;
        }
        Err(Fault::NotReady)
    }

    /// Clears the global flags with the bridges off, and reads them back.
    ///
    /// # Errors
    /// [`Fault::Alarm`] with flags that cannot be cleared.
    async fn clear_errors(&mut self) -> Result<(), Fault> {
        let mut errors = [0];
        let look = Pass::Read(&[registers::GSTAT], &mut errors);
        self.pass_anyhow(&mut [Pass::Write(&CLEAR_ERRORS), look]).await?;
        let [errors] = errors;
        if errors & gstat::ALL != 0 {
            return Err(Fault::Alarm { status: errors as u8 });
        }
        Ok(())
    }

    /// Sets the target to the present position in position mode, switches the bridges on, and reads
    /// back every readable register.
    async fn stand_ready(&mut self, [position]: [u32; 1]) -> Result<(), Fault> {
        let configuration = &self.configuration;
        let written = [
            (registers::GCONF, codec::global_configuration(configuration)),
            (registers::SW_MODE, codec::switch_mode(configuration, Guard::Soft)),
            (registers::XTARGET, position),
            (registers::RAMPMODE, ramp_mode::POSITION),
            (registers::CHOPCONF, codec::CHOPPER),
        ];
        let [.., target, mode, chopper] = written;
        let last = [target, mode, chopper];
        self.pass(&mut [Pass::Write(&last), Pass::Verify(&written)]).await.map(|_| ())
    }

    /// Lets the bridges work and reads whether they have detected a short.
    async fn test_bridges(&mut self) -> Result<(), Fault> {
        pause(&mut self.delay, BRIDGE_TEST).await;
        let [driver, global, ..] =
            self.read(&[registers::DRV_STATUS, registers::GSTAT], false).await?;
        if driver & drv_status::SHUT_DOWN != 0 || global & gstat::ALL != 0 {
            return Err(Fault::SelfTest);
        }
        Ok(())
    }
}

/// Whether a bit of a register is set.
const fn is_set(register: u32, bit: u32) -> bool {
    register & bit != 0
}

/// Whether IOIN is that of a TMC5160.
const fn check_version(inputs: u32) -> Result<(), Fault> {
    if inputs >> ioin::VERSION_SHIFT == ioin::VERSION {
        Ok(())
    } else {
        Err(Fault::Identity { found: inputs })
    }
}

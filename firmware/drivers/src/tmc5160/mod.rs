//! TMC5160: stepper driver with ramp generator of the stage (Trinamic data sheet, rev. 1.14).
//!
//! SPI mode 3, datagrams of 40 bits, at most 4 MHz with the internal oscillator (4.3). A read takes two
//! datagrams, because a reply carries what the datagram before it asked for.
//!
//! There is no checksum. What stands in for one:
//! - after every write the chip sends back the data it received (4.1.1), and all of it is compared:
//!   a bit that flips in the data is noticed, on the way in or out;
//! - registers that can be read are read back: [`start`](Tmc5160::start) does so for `GCONF`, `CHOPCONF`,
//!   `SW_MODE`, `RAMPMODE` and `XTARGET`, a motion for its target before the motor leaves rest, so a write
//!   to a wrong address is noticed there. All other registers are write-only: a write-only register
//!   that a flipped *address* bit has missed, or hit, stays unnoticed until the next start;
//! - a [`Status`] ends with the version and a second look at the position, which must be the
//!   same where the motor stands: dead lines and a flipped bit of a standing position are noticed. A
//!   flipped bit of a moving position is not: the stage's encoder is the judge of that.
//!
//! Each status byte is looked at: a chip that has been reset is [`Fault::Reset`] in every function
//! but `start`, and one that has shut its bridges down refuses motions with [`Fault::Alarm`].
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
use self::link::Link;
use self::registers::{Address, drv_status, gstat, ioin, ramp_mode, ramp_stat, spi_status};
use self::units::Velocity;
use crate::fault::Fault;
use crate::pause::pause;

/// The bus clock that the budget is made for, Hz; the limit is 4 MHz (4.3).
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

/// Between two looks at a motor that is being stopped.
const STOPPING: Duration = Duration::from_millis(20);

/// Looks until a motor must stand: 2 s, three times the slowest default ramp.
const STOPPING_LOOKS: usize = 100;

/// Between switching the bridges on and asking for shorts: some 50 chopper periods, in which the chip
/// has tried three times (11.2).
const BRIDGE_TEST: Duration = Duration::from_millis(2);

/// The driver.
#[derive(Debug)]
pub struct Tmc5160<S, D> {
    link: Link<S>,
    delay: D,
    configuration: Configuration,
}

impl<S: SpiDevice, D: DelayNs> Tmc5160<S, D> {
    /// A chip that is not yet started.
    #[must_use]
    pub const fn new(spi: S, delay: D, configuration: Configuration) -> Self {
        Self { link: Link(spi), delay, configuration }
    }

    /// Stops the motor, checks and configures the chip, tests the bridges, and leaves it standing in
    /// position mode. After a loss of supply the position is zero wherever the stage stands, and the
    /// chip cannot tell afterwards: home after every start.
    ///
    /// # Errors
    /// [`Fault::Identity`] for another chip or one strapped to external steps, [`Fault::NotReady`] where
    /// the enable pin keeps the bridges off or the motor does not stop, [`Fault::Alarm`] with GSTAT where
    /// an error cannot be cleared, [`Fault::SelfTest`] for shorts and heat, [`Fault::NotAsWritten`].
    pub async fn start(&mut self) -> Result<(), Fault> {
        pause(&mut self.delay, POWER_UP).await;
        self.identify().await?;
        self.come_to_rest().await?;
        self.clear_errors().await?;
        self.write(&codec::settings(&self.configuration)).await?;
        let [position] = self.read([registers::XACTUAL]).await?;
        self.write(&[
            (registers::XTARGET, position),
            (registers::RAMPMODE, ramp_mode::POSITION),
            (registers::CHOPCONF, codec::CHOPPER),
        ])
        .await?;
        self.verify_settings(position).await?;
        self.test_bridges().await
    }

    /// Moves to a position, microsteps, by the ramp; also on the fly. From rest the target is read back
    /// before the motor leaves.
    ///
    /// # Errors
    /// [`Fault::Alarm`] where a stall waits for [`Self::clear_stall`] or the bridges are shut down.
    pub async fn go_to(&mut self, microsteps: i32) -> Result<(), Fault> {
        let Configuration { clock, ramp, .. } = self.configuration;
        let guard = self.prepare(ramp.peak).await?;
        let target = (registers::XTARGET, microsteps.cast_unsigned());
        self.write(&[guard, target]).await?;
        self.verify([guard, target]).await?;
        let peak = clock.velocity_units(ramp.peak);
        self.write(&[(registers::RAMPMODE, ramp_mode::POSITION), (registers::VMAX, peak)]).await
    }

    /// Moves on with a velocity, either way, until it is stopped: softly by switches where it is too
    /// slow for stalls to be told, at once by stalls and switches where it is not.
    ///
    /// # Errors
    /// As [`Self::go_to`].
    pub async fn run(&mut self, velocity: Velocity) -> Result<(), Fault> {
        let guard = self.prepare(velocity).await?;
        let is_forward = velocity.0 >= 0;
        let mode = if is_forward { ramp_mode::FORWARD } else { ramp_mode::BACKWARD };
        let units = self.configuration.clock.velocity_units(velocity);
        self.write(&[guard, (registers::RAMP_STAT, ramp_stat::LATCHED_LEFT)]).await?;
        self.verify([guard]).await?;
        self.write(&[(registers::VMAX, units), (registers::RAMPMODE, mode)]).await
    }

    /// Slows down to rest with AMAX (12.2.4 a); a stall stays to be acknowledged.
    pub async fn stop(&mut self) -> Result<(), Fault> {
        self.write(&[(registers::VMAX, 0), (registers::RAMPMODE, ramp_mode::FORWARD)]).await
    }

    /// Says where the standing motor is, microsteps.
    ///
    /// # Errors
    /// [`Fault::NotReady`] while it moves.
    pub async fn set_position(&mut self, microsteps: i32) -> Result<(), Fault> {
        let position = microsteps.cast_unsigned();
        let [state] = self.read([registers::RAMP_STAT]).await?;
        if state & ramp_stat::STANDING == 0 {
            return Err(Fault::NotReady);
        }
        let both = [(registers::XACTUAL, position), (registers::XTARGET, position)];
        self.write(&[(registers::RAMPMODE, ramp_mode::HOLD)]).await?;
        self.write(&both).await?;
        self.verify(both).await?;
        self.write(&[(registers::RAMPMODE, ramp_mode::POSITION)]).await
    }

    /// Where the left switch was met since the last [`Self::run`], microsteps; a soft stop leads
    /// beyond it.
    pub async fn left_edge(&mut self) -> Result<Option<i32>, Fault> {
        let [state, edge] = self.read([registers::RAMP_STAT, registers::XLATCH]).await?;
        Ok((state & ramp_stat::LATCHED_LEFT != 0).then(|| edge.cast_signed()))
    }

    /// Acknowledges a stall; the motor stays where it is. It has lost its position: home again.
    pub async fn clear_stall(&mut self) -> Result<(), Fault> {
        self.write(&[
            (registers::VMAX, 0),
            (registers::RAMPMODE, ramp_mode::HOLD),
            (registers::RAMP_STAT, ramp_stat::STALLED),
        ])
        .await?;
        let [state] = self.read([registers::RAMP_STAT]).await?;
        if state & ramp_stat::STALLED != 0 {
            return Err(Fault::NotAsWritten { register: registers::RAMP_STAT.0 });
        }
        Ok(())
    }

    /// What the motor does.
    ///
    /// # Errors
    /// [`Fault::Checksum`] where two looks at a standing motor differ, [`Fault::Identity`] where the
    /// version does not come back.
    pub async fn status(&mut self) -> Result<Status, Fault> {
        let [ramp, position, velocity, driver, global, inputs, again] = self
            .read([
                registers::RAMP_STAT,
                registers::XACTUAL,
                registers::VACTUAL,
                registers::DRV_STATUS,
                registers::GSTAT,
                registers::IOIN,
                registers::XACTUAL,
            ])
            .await?;
        check_version(inputs)?;
        let clock = self.configuration.clock;
        let status = Status::new(clock, [ramp, position, velocity, driver, global]);
        if status.standing && (again != position || status.velocity != Velocity(0)) {
            return Err(Fault::Checksum);
        }
        Ok(status)
    }

    /// Reads from a chip that must not have been reset.
    async fn read<const N: usize>(&mut self, addresses: [Address; N]) -> Result<[u32; N], Fault> {
        let (values, seen) = self.link.read(addresses).await?;
        check_reset(seen)?;
        Ok(values)
    }

    /// Writes to a chip that must not have been reset.
    async fn write(&mut self, values: &[(Address, u32)]) -> Result<(), Fault> {
        let ((), seen) = self.link.write(values).await?;
        check_reset(seen)
    }

    /// Compares registers with what was written to them.
    async fn verify<const N: usize>(&mut self, written: [(Address, u32); N]) -> Result<(), Fault> {
        let found = self.read(written.map(|(address, _)| address)).await?;
        for ((Address(register), value), found) in written.into_iter().zip(found) {
            if found != value {
                return Err(Fault::NotAsWritten { register });
            }
        }
        Ok(())
    }

    /// Refuses to move where the chip cannot, and has a standing motor stand until all is said. The
    /// stops that suit a velocity, to be written next.
    async fn prepare(&mut self, velocity: Velocity) -> Result<(Address, u32), Fault> {
        let ([state], seen) = self.link.read([registers::RAMP_STAT]).await?;
        check_reset(seen)?;
        if state & ramp_stat::STALLED != 0 || seen & spi_status::DRIVER_ERROR != 0 {
            return Err(Fault::Alarm { status: seen });
        }
        if state & ramp_stat::STANDING != 0 {
            self.write(&[(registers::RAMPMODE, ramp_mode::HOLD)]).await?;
        }
        let guard = Guard::at(self.configuration.stall, velocity);
        Ok((registers::SW_MODE, codec::switch_mode(&self.configuration, guard)))
    }

    /// Whether the right chip is there, ready to move by itself. It may have been reset.
    async fn identify(&mut self) -> Result<(), Fault> {
        let ([inputs], _) = self.link.read([registers::IOIN]).await?;
        check_version(inputs)?;
        if inputs & ioin::STEP_MODE != 0 {
            return Err(Fault::Identity { found: inputs });
        }
        if inputs & ioin::DISABLED != 0 {
            return Err(Fault::NotReady);
        }
        Ok(())
    }

    /// Stops whatever the motor did before, and holds it.
    async fn come_to_rest(&mut self) -> Result<(), Fault> {
        let stop = [(registers::VMAX, 0), (registers::RAMPMODE, ramp_mode::FORWARD)];
        self.link.write(&stop).await?;
        for _ in 0..STOPPING_LOOKS {
            let ([state], _) = self.link.read([registers::RAMP_STAT]).await?;
            if state & ramp_stat::STANDING != 0 {
                self.link.write(&[(registers::RAMPMODE, ramp_mode::HOLD)]).await?;
                return Ok(());
            }
            pause(&mut self.delay, STOPPING).await;
        }
        Err(Fault::NotReady)
    }

    /// Clears the global flags with the bridges off; what comes back is true.
    async fn clear_errors(&mut self) -> Result<(), Fault> {
        let clear = [(registers::CHOPCONF, codec::CHOPPER_OFF), (registers::GSTAT, gstat::ALL)];
        self.link.write(&clear).await?;
        let ([errors], _) = self.link.read([registers::GSTAT]).await?;
        if errors & gstat::ALL != 0 {
            return Err(Fault::Alarm { status: errors as u8 });
        }
        Ok(())
    }

    /// Reads back every register that can be.
    async fn verify_settings(&mut self, position: u32) -> Result<(), Fault> {
        let configuration = &self.configuration;
        let written = [
            (registers::GCONF, codec::global_configuration(configuration)),
            (registers::SW_MODE, codec::switch_mode(configuration, Guard::Soft)),
            (registers::XTARGET, position),
            (registers::RAMPMODE, ramp_mode::POSITION),
            (registers::CHOPCONF, codec::CHOPPER),
        ];
        self.verify(written).await
    }

    /// Lets the bridges work and asks whether they have found a short.
    async fn test_bridges(&mut self) -> Result<(), Fault> {
        pause(&mut self.delay, BRIDGE_TEST).await;
        let [driver, global] = self.read([registers::DRV_STATUS, registers::GSTAT]).await?;
        if driver & drv_status::SHUT_DOWN != 0 || global & gstat::ALL != 0 {
            return Err(Fault::SelfTest);
        }
        Ok(())
    }
}

/// Whether no datagram told of a reset.
const fn check_reset(seen: u8) -> Result<(), Fault> {
    if seen & spi_status::RESET == 0 { Ok(()) } else { Err(Fault::Reset) }
}

/// Whether IOIN is this chip's.
const fn check_version(inputs: u32) -> Result<(), Fault> {
    if inputs >> ioin::VERSION_SHIFT == ioin::VERSION {
        Ok(())
    } else {
        Err(Fault::Identity { found: inputs })
    }
}

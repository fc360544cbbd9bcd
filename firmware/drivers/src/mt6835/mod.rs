//! MT6835: 21-bit angle encoder of the stage (`MagnTek` data sheet, rev. 1.3). SPI mode 3.
//!
//! **Identity.** The chip has no fixed identification. `start` therefore writes three patterns to
//! the byte that is free for the user and reads them back through the chip's 12-bit addresses;
//! together with the checksum of a burst this is as near to an identification as the chip permits.
//! The last pattern stays.
//!
//! **A chip that has reset itself** has loaded its registers from the EEPROM again and has lost the
//! pattern. There is no status bit for it, so every reading also reads one register: the pattern at
//! every other reading, between them the registers that the angle depends on, in turn. A reset is
//! reported by the second reading after it at the latest, another changed register within ten. A
//! burst of zeros passes its checksum, so it is accepted only after the pattern has been read.
//!
//! **RAM only.** The EEPROM lasts for some thousand programmings and a wrong one stays; this driver
//! has no way to send the commands for programming or for setting the zero.
//!
//! **No reset.** The chip has no reset command; it restarts by its supply alone. `start` writes
//! every register that the driver uses and keeps the manufacturer's bits in them.
//!
//! A reading costs [`BYTES_PER_READING`] bytes on the bus, [`TIME_PER_READING`] at [`BUS_HERTZ`].

pub mod codec;
pub mod registers;

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::{Operation, SpiDevice};
use orientation::units::Angle;

use crate::fault::{Fault, compare};
use crate::pause::pause;
use registers::{
    BANDWIDTH, BURST, Bandwidth, CALIBRATION, CORRECTION, DIRECTION, Hysteresis, USER_ID,
    ZERO_HIGH, ZERO_LOW,
};

/// Fastest bus clock, Hz (SPI Timing).
pub const GREATEST_BUS_HERTZ: u32 = 16_000_000;

/// Bus clock that the budget is made for, Hz.
pub const BUS_HERTZ: u32 = 5_000_000;

/// Bytes of a reading: a burst and one register.
pub const BYTES_PER_READING: usize = 6 + 3;

/// Bus time of a reading.
pub const TIME_PER_READING: Duration =
    Duration::from_nanos(BYTES_PER_READING as u64 * 8 * 1_000_000_000 / BUS_HERTZ as u64);

/// Time from power-up to valid angles. 64 ms by the data sheet (Electrical Characteristics,
/// Power-up Time), as a public evaluation of the chip quotes it, and a margin of a tenth.
const POWER_UP: Duration = Duration::from_millis(70);

/// Content of the user byte of a started chip; an empty EEPROM and a dead line give other values.
const PATTERN: u8 = 0x4D;

/// Patterns that are written and read back in turn to identify the chip: each bit in both states,
/// then the pattern that stays.
const PATTERNS: [u8; 3] = [0xA5, 0x5A, PATTERN];

/// Addresses of the registers that the angle depends on.
const WATCHED: [u16; 5] = [DIRECTION, BANDWIDTH, ZERO_HIGH, ZERO_LOW, CORRECTION];

/// The selectable configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configuration {
    /// Whether the angle is to be reversed against the chip's own direction, which depends on the
    /// side on which the chip is mounted.
    pub is_reversed: bool,
    /// Hysteresis of the angle.
    pub hysteresis: Hysteresis,
    /// Bandwidth of the angle filter.
    pub bandwidth: Bandwidth,
}

/// The driver of an encoder on its bus.
#[derive(Debug)]
pub struct Mt6835<S, D> {
    spi: S,
    delay: D,
    configuration: Configuration,
    /// Contents of the watched registers at the start; empty until a start has succeeded.
    expected: Option<[u8; WATCHED.len()]>,
    /// Number of readings, modulo twice the number of watched registers.
    turn: usize,
}

impl<S: SpiDevice, D: DelayNs> Mt6835<S, D> {
    /// Creates the driver of a chip on `spi` (mode 3, at most 16 MHz); nothing is sent yet.
    pub const fn new(spi: S, delay: D, configuration: Configuration) -> Self {
        Self { spi, delay, configuration, expected: None, turn: 0 }
    }

    /// Brings the chip from any state to readiness: identity, state of its calibration,
    /// configuration, read-back, one good angle. Takes about 70 ms.
    ///
    /// # Errors
    /// [`Fault::Bus`]; [`Fault::Identity`] with the byte that came instead of the pattern;
    /// [`Fault::NotReady`] while a self-calibration runs, [`Fault::SelfTest`] where it has failed;
    /// [`Fault::NotAsWritten`]; [`Fault::Checksum`] where two reads of one register differ, or of the
    /// burst; [`Fault::Alarm`] with the chip's warnings.
    pub async fn start(&mut self) -> Result<(), Fault> {
        self.expected = None;
        pause(&mut self.delay, POWER_UP).await;
        self.identify().await?;
        codec::calibration(self.agreed(CALIBRATION).await?)?;
        self.configure().await?;
        let mut held = [0; WATCHED.len()];
        for (held, register) in held.iter_mut().zip(WATCHED) {
            *held = self.agreed(register).await?;
        }
        self.expected = Some(held);
        self.turn = 0;
        self.read().await.map(|_| ())
    }

    /// Reads the angle of this moment.
    ///
    /// # Errors
    /// [`Fault::Bus`]; [`Fault::Checksum`]; [`Fault::Reset`], also before a start has come to its
    /// end; [`Fault::NotAsWritten`] for a register that has changed; [`Fault::Alarm`] with the
    /// warnings of [`registers`]: at overspeed the angle lags without bound, with a weak magnet or
    /// supply it is noise, so none of them is an angle.
    pub async fn read(&mut self) -> Result<Angle, Fault> {
        let bytes = self.burst().await?;
        let frame = codec::frame(bytes)?;
        self.watch(bytes == [0; 4]).await?;
        match frame.status {
            0 => Ok(frame.angle),
            status => Err(Fault::Alarm { status }),
        }
    }

    /// Reads the register whose turn it is. A suspicious burst, one of zeros, passes its checksum, so
    /// the pattern is read as well.
    ///
    /// # Errors
    /// [`Fault::Reset`] if the pattern is lost or no start has succeeded, [`Fault::NotAsWritten`]
    /// if a register has changed.
    async fn watch(&mut self, is_suspicious: bool) -> Result<(), Fault> {
        let expected = self.expected.ok_or(Fault::Reset)?;
        let (index, is_pattern) = (self.turn / 2, self.turn.is_multiple_of(2));
        self.turn = (self.turn + 1) % (2 * WATCHED.len());
        if is_pattern || is_suspicious {
            self.see_pattern().await?;
        }
        if is_pattern {
            return Ok(());
        }
        let found = self.register(WATCHED[index]).await?;
        compare(WATCHED[index] as u8, &[found], &[expected[index]])
    }

    async fn see_pattern(&mut self) -> Result<(), Fault> {
        if self.register(USER_ID).await? == PATTERN { Ok(()) } else { Err(Fault::Reset) }
    }

    async fn identify(&mut self) -> Result<(), Fault> {
        for pattern in PATTERNS {
            self.write(USER_ID, pattern).await?;
            let found = self.register(USER_ID).await?;
            if found != pattern {
                return Err(Fault::Identity { found: found.into() });
            }
        }
        Ok(())
    }

    async fn configure(&mut self) -> Result<(), Fault> {
        let Configuration { is_reversed, hysteresis, bandwidth } = self.configuration;
        let kept = self.agreed(DIRECTION).await?;
        self.set(DIRECTION, codec::direction(kept, is_reversed, hysteresis)).await?;
        let kept = self.agreed(BANDWIDTH).await?;
        self.set(BANDWIDTH, codec::bandwidth(kept, bandwidth)).await
    }

    /// Writes a register and reads it back.
    async fn set(&mut self, register: u16, value: u8) -> Result<(), Fault> {
        self.write(register, value).await?;
        compare(register as u8, &[self.agreed(register).await?], &[value])
    }

    /// Reads a register twice: single registers have no checksum, and the value is written back.
    ///
    /// # Errors
    /// [`Fault::Checksum`] if the two readings differ.
    async fn agreed(&mut self, register: u16) -> Result<u8, Fault> {
        let value = self.register(register).await?;
        if self.register(register).await? == value { Ok(value) } else { Err(Fault::Checksum) }
    }

    async fn burst(&mut self) -> Result<[u8; 4], Fault> {
        let [high, low] = BURST;
        let mut bytes = [high, low, 0, 0, 0, 0];
        let mut operations = [Operation::TransferInPlace(&mut bytes)];
        self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)?;
        let [_, _, frame @ ..] = bytes;
        Ok(frame)
    }

    async fn register(&mut self, register: u16) -> Result<u8, Fault> {
        let mut bytes = codec::read(register);
        let mut operations = [Operation::TransferInPlace(&mut bytes)];
        self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)?;
        let [.., value] = bytes;
        Ok(value)
    }

    async fn write(&mut self, register: u16, value: u8) -> Result<(), Fault> {
        let bytes = codec::write(register, value);
        let mut operations = [Operation::Write(&bytes)];
        self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)
    }
}

//! ADXL355: three-axis accelerometer on the platform (Analog Devices data sheet, rev. C). SPI mode 0.
//!
//! **One sample.** The data sheet ("Reading Acceleration or Temperature Data from the Interface")
//! does not promise that the data registers of one burst belong to one sample: a sample that
//! completes between two bytes tears the reading, even within an axis. A burst from status to z is
//! therefore followed by a second reading of the status. If a new sample came meanwhile, the burst
//! is repeated, right after that sample, when the next one is far away; at most [`ATTEMPTS`] times.
//!
//! **What protects a reading.** The chip has no checksum. A burst has 19 bits that are always zero,
//! which finds dead and slipped lines ([`Fault::Checksum`]); all writable registers are read back
//! after `start`, then whenever a reading is not new, and at the latest after [`READS_UNCHECKED`]
//! new ones; where a start has failed no reading passes. A single flipped data bit is not found: the
//! instrument must judge plausibility.
//!
//! **A chip that has reset itself** is in standby and never has new data, so the first reading
//! after the reset is not new; the registers are then read, and [`Fault::Reset`] is reported.
//!
//! **Not protected.** The temperature is not double-buffered and is refreshed at a rate that the data
//! sheet does not give: rarely it may be off by 256 LSB = 28 °C, near 35.3 °C. Smooth it.
//!
//! Values are given on the chip's own axes; their direction on the platform is assigned by the
//! instrument. A burst costs [`BYTES_PER_SAMPLE`] bytes on the bus, [`TIME_PER_SAMPLE`] at
//! [`BUS_HERTZ`].

pub mod codec;
pub mod registers;

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::{Operation, SpiDevice};
use orientation::units::{SpecificForce, Temperature};

use crate::fault::Fault;
use crate::pause::pause;
use codec::{BURST, Frame, SETTINGS};
use registers::{
    DEVID_AD, FILTER, IDENTITY, MEASURING, OFFSET_X_H, OutputRate, POWER_CTL, RANGE, RANGE_2_G,
    RANGE_8_G, RESET, RESET_CODE, SELF_TEST, SELF_TEST_FORCE, SELF_TEST_MODE, SELF_TEST_OFF,
    SHADOW, STANDBY, STATUS, Status,
};

/// Fastest bus clock, Hz (SPI Characteristics).
pub const GREATEST_BUS_HERTZ: u32 = 10_000_000;

/// Bus clock that the budget is made for, Hz.
pub const BUS_HERTZ: u32 = 5_000_000;

/// Bytes of one sample: command and burst, then command and status.
pub const BYTES_PER_SAMPLE: usize = (1 + BURST) + (1 + 1);

/// Bytes of a reading of the writable registers, which a burst without a new sample adds.
pub const BYTES_PER_CHECK: usize = 1 + SETTINGS;

/// Bus time of one sample.
pub const TIME_PER_SAMPLE: Duration =
    Duration::from_nanos(BYTES_PER_SAMPLE as u64 * 8 * 1_000_000_000 / BUS_HERTZ as u64);

/// Number of bursts before a reading is given up; each failure needs a new sample to complete
/// within the burst.
pub const ATTEMPTS: usize = 3;

/// Number of new samples after which the registers are read back in any case.
pub const READS_UNCHECKED: u8 = 255;

/// Time from power-up to standby (Specifications, Turn-On Time: below 10 ms).
const POWER_UP: Duration = Duration::from_millis(10);

/// Time from reset until the factory settings are loaded. The data sheet gives none; Linux waits 5
/// ms, and the busy bit decides.
const RESET_TIME: Duration = Duration::from_millis(5);

/// Number of readings of the busy bit after a reset; the first one after loading still finds it
/// set.
const RESET_LOOKS: usize = 4;

/// Number of resets before it is given up that the factory settings load correctly (Linux: 4).
const RESETS: usize = 4;

/// Settling from standby, or after a change of the self-test force, to 1 mg (Specifications,
/// Turn-On Time: below 10 ms).
const SETTLING: Duration = Duration::from_millis(10);

/// Number of samples of one half of the self-test: at 80 µg/√Hz or less their noise is far below
/// its limits.
const SELF_TEST_SAMPLES: i32 = 16;

/// Time between two samples of the self-test: four periods at 4 kHz.
const SELF_TEST_INTERVAL: Duration = Duration::from_millis(1);

/// Output periods until the filter has settled after a change (Table "Digital Filter Group Delay
/// and Profile": at most 2.52 periods of delay, twice that to the end of a step).
const FILTER_PERIODS: u32 = 5;

/// Register contents of the two halves of the self-test, without and with the force.
const HALVES: &[&[(u8, u8)]] = &[
    &[(RANGE, RANGE_8_G), (SELF_TEST, SELF_TEST_MODE), (POWER_CTL, MEASURING)],
    &[(SELF_TEST, SELF_TEST_FORCE)],
];

/// Register content that ends the self-test.
const AFTER_TEST: &[(u8, u8)] = &[(SELF_TEST, SELF_TEST_OFF), (POWER_CTL, STANDBY)];

/// Copies of the factory settings.
type Shadow = [u8; 5];

/// One sample on the chip's own axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Specific force on x, y, z, ±2.048 g.
    pub force: [SpecificForce; 3],
    /// Temperature of the chip, uncalibrated.
    pub temperature: Temperature,
    /// Whether the sample is new since the reading before.
    pub is_fresh: bool,
    /// Whether an axis is at the limit of its range, ±2.048 g.
    pub is_clipped: bool,
}

impl Reading {
    fn new(frame: &Frame, is_fresh: bool) -> Self {
        Self {
            force: frame.counts.map(codec::force),
            temperature: codec::temperature(frame.temperature),
            is_fresh,
            is_clipped: frame.counts.into_iter().any(codec::is_clipped),
        }
    }
}

/// The driver of an accelerometer on its bus.
#[derive(Debug)]
pub struct Adxl355<S, D> {
    spi: S,
    delay: D,
    rate: OutputRate,
    /// The factory settings as the chip loaded them before the first software reset.
    shadow: Option<Shadow>,
    /// Number of new samples since all registers were found correct; at its limit until they are.
    reads_unchecked: u8,
}

impl<S: SpiDevice, D: DelayNs> Adxl355<S, D> {
    /// Creates the driver of a chip on `spi` (mode 0, at most 10 MHz) with an output data rate; nothing
    /// is sent yet.
    pub const fn new(spi: S, delay: D, rate: OutputRate) -> Self {
        Self { spi, delay, rate, shadow: None, reads_unchecked: READS_UNCHECKED }
    }

    /// Brings the chip from any state to measuring: identity, reset, self-test, configuration,
    /// read-back. Takes about 75 ms and five output periods; the first reading is a settled one.
    ///
    /// The first call in the life of this value ought to follow the chip's power-up, or a use of the
    /// chip by this driver: it keeps the factory settings that later resets are held to. A chip
    /// exchanged under power therefore fails with [`Fault::NotReady`].
    ///
    /// # Errors
    /// [`Fault::Bus`]; [`Fault::Identity`] with the four identity bytes; [`Fault::NotReady`] where
    /// the factory settings do not load or no samples come; [`Fault::SelfTest`];
    /// [`Fault::NotAsWritten`]; [`Fault::Checksum`].
    pub async fn start(&mut self) -> Result<(), Fault> {
        self.reads_unchecked = READS_UNCHECKED;
        pause(&mut self.delay, POWER_UP).await;
        self.identify().await?;
        self.keep_shadow().await?;
        self.reset().await?;
        self.test().await?;
        self.configure().await?;
        let settling = SETTLING + self.rate.period() * FILTER_PERIODS;
        pause(&mut self.delay, settling).await;
        self.check().await
    }

    /// Reads the newest sample.
    ///
    /// # Errors
    /// [`Fault::Bus`]; [`Fault::Checksum`] for an answer that the chip cannot give;
    /// [`Fault::Reset`]; [`Fault::NotAsWritten`] for a register that has changed;
    /// [`Fault::NotReady`] where the chip is busy or new samples tore every attempt.
    pub async fn read(&mut self) -> Result<Reading, Fault> {
        let (frame, is_fresh) = self.sample().await?;
        let is_due = self.reads_unchecked == READS_UNCHECKED;
        if is_due || !is_fresh || frame.status.is_busy() {
            self.reads_unchecked = READS_UNCHECKED;
            self.check().await?;
        } else {
            self.reads_unchecked += 1;
        }
        if frame.status.is_busy() {
            return Err(Fault::NotReady);
        }
        Ok(Reading::new(&frame, is_fresh))
    }

    /// Reads a burst during which no new sample completed, and whether it is new.
    async fn sample(&mut self) -> Result<(Frame, bool), Fault> {
        let mut is_fresh = false;
        for _ in 0..ATTEMPTS {
            let [_, burst @ ..] = self.read_from::<{ 1 + BURST }>(STATUS).await?;
            let frame = codec::frame(&burst)?;
            is_fresh |= frame.status.is_ready();
            if !self.status().await?.is_ready() {
                return Ok((frame, is_fresh));
            }
            is_fresh = true;
        }
        Err(Fault::NotReady)
    }

    async fn identify(&mut self) -> Result<(), Fault> {
        let [_, found @ ..] = self.read_from::<5>(DEVID_AD).await?;
        let [identity @ .., _revision] = found;
        let fault = Fault::Identity { found: u32::from_be_bytes(found) };
        if identity == IDENTITY { Ok(()) } else { Err(fault) }
    }

    /// Keeps the factory settings as they are before the first software reset; two reads must agree.
    async fn keep_shadow(&mut self) -> Result<(), Fault> {
        if self.shadow.is_none() {
            let shadow = self.read_shadow().await?;
            if shadow != self.read_shadow().await? {
                return Err(Fault::Checksum);
            }
            self.shadow = Some(shadow);
        }
        Ok(())
    }

    async fn read_shadow(&mut self) -> Result<Shadow, Fault> {
        let [_, shadow @ ..] = self.read_from::<6>(SHADOW).await?;
        Ok(shadow)
    }

    /// Resets until the factory settings have loaded as after power-up: a race in the silicon up to
    /// revision 1 may spoil them (Reset Register, note on software resets).
    async fn reset(&mut self) -> Result<(), Fault> {
        for _ in 0..RESETS {
            self.write(&[(RESET, RESET_CODE)]).await?;
            self.wait_loaded().await?;
            let shadow = self.read_shadow().await?;
            if self.shadow == Some(shadow) {
                return Ok(());
            }
        }
        Err(Fault::NotReady)
    }

    async fn wait_loaded(&mut self) -> Result<(), Fault> {
        for _ in 0..RESET_LOOKS {
            pause(&mut self.delay, RESET_TIME).await;
            if !self.status().await?.is_busy() {
                return Ok(());
            }
        }
        Err(Fault::NotReady)
    }

    /// Self-test at ±8 g, where gravity and the force together cannot clip, and at 4 kHz, the rate
    /// after reset: the difference that the force makes (Self Test).
    async fn test(&mut self) -> Result<(), Fault> {
        let mut sums = [[0; 3]; 2];
        for (sum, contents) in sums.iter_mut().zip(HALVES) {
            self.write(contents).await?;
            self.sum(sum).await?;
        }
        self.write(AFTER_TEST).await?;
        let [without, with] = sums;
        let passes = codec::self_test_passes(without, with, SELF_TEST_SAMPLES);
        if passes { Ok(()) } else { Err(Fault::SelfTest) }
    }

    /// Adds some samples after settling.
    async fn sum(&mut self, sum: &mut [i32; 3]) -> Result<(), Fault> {
        pause(&mut self.delay, SETTLING).await;
        for _ in 0..SELF_TEST_SAMPLES {
            pause(&mut self.delay, SELF_TEST_INTERVAL).await;
            let (frame, is_fresh) = self.sample().await?;
            if !is_fresh {
                return Err(Fault::NotReady);
            }
            for (sum, count) in sum.iter_mut().zip(frame.counts) {
                *sum += count;
            }
        }
        Ok(())
    }

    /// Sets what differs from the reset values; allowed in standby only (Register Map, note).
    async fn configure(&mut self) -> Result<(), Fault> {
        let rate = (FILTER, self.rate as u8);
        self.write(&[rate, (RANGE, RANGE_2_G), (POWER_CTL, MEASURING)]).await
    }

    /// Compares all writable registers with what they ought to hold.
    async fn check(&mut self) -> Result<(), Fault> {
        let [_, found @ ..] = self.read_from::<{ 1 + SETTINGS }>(OFFSET_X_H).await?;
        codec::compare(&found, &codec::settings(self.rate))?;
        self.reads_unchecked = 0;
        Ok(())
    }

    async fn status(&mut self) -> Result<Status, Fault> {
        let [_, status] = self.read_from(STATUS).await?;
        Ok(Status(status))
    }

    /// Reads registers in a row, from `first` on, behind a byte that means nothing: one transfer, which is what it
    /// comes to on the bus.
    async fn read_from<const N: usize>(&mut self, first: u8) -> Result<[u8; N], Fault> {
        let mut bytes = [0; N];
        if let [command, ..] = &mut bytes[..] {
            *command = first << 1 | 1;
        }
        let mut operations = [Operation::TransferInPlace(&mut bytes)];
        self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)?;
        Ok(bytes)
    }

    /// Writes registers, one after another.
    async fn write(&mut self, contents: &[(u8, u8)]) -> Result<(), Fault> {
        for (register, value) in contents {
            let bytes = [register << 1, *value];
            let mut operations = [Operation::Write(&bytes)];
            self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)?;
        }
        Ok(())
    }
}

//! LSM6DSL: three coarse gyros and accelerometers on the base (ST data sheet `DocID028475`). I²C.
//!
//! **One sample.** Gyro and accelerometer run at one rate and sample together. The chip holds the
//! two bytes of an axis together (block data update), but if a sample completes within a burst,
//! some axes are older than others by one period. An integration of the rates must count this
//! as an uncertainty of time.
//!
//! **What protects a reading.** I²C has an acknowledge for every byte that is sent and nothing for
//! those that are read; the chip has no checksum. The control registers are read back after `start`,
//! whenever two readings in a row are not new, and at the latest after [`READS_UNCHECKED`] new ones;
//! where a start has failed no reading passes. A single flipped data bit is not found: the instrument
//! must judge plausibility.
//!
//! **A chip that has reset itself** has both sensors off and never has new data, so at the second
//! reading after the reset the registers are read, and [`Fault::Reset`] is reported.
//!
//! **Sources differ** on the duration of a reset: the data sheet gives 50 µs, ST's example polls
//! the bit, Linux waits 50 ms for the reset and again for the boot. This driver polls the bits,
//! within limits.
//!
//! Values are given on the chip's own axes; their direction on the base is assigned by the
//! instrument. A reading costs [`BITS_PER_SAMPLE`] bit times on the bus, [`TIME_PER_SAMPLE`] at
//! [`BUS_HERTZ`].

pub mod codec;
pub mod registers;

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;
use orientation::units::{AngularRate, SpecificForce, Temperature};

use crate::fault::Fault;
use crate::pause::pause;
use codec::{BURST, Frame, SETTINGS, Sums};
use registers::{
    BLOCK_DATA_UPDATE, BOOT, CTRL1_XL, CTRL2_G, CTRL3_C, CTRL5_C, ForceRange, IDENTITY, INCREMENT,
    OUT_TEMP_L, OutputRate, RateRange, SOFTWARE_RESET, STATUS, Status, TEST_CTRL1_XL, TEST_CTRL2_G,
    TEST_FORCES, WHO_AM_I,
};

/// Bus clock, Hz: the chip's fastest (I²C slave timing values, fast mode).
pub const BUS_HERTZ: u32 = 400_000;

/// Bit times of a read of `bytes` bytes: nine for each byte, those of address, register and
/// repeated address included, and start, repeated start and stop.
const fn bits(bytes: usize) -> usize {
    9 * (3 + bytes) + 3
}

/// Bit times of one sample: status and burst.
pub const BITS_PER_SAMPLE: usize = bits(1) + bits(BURST);

/// Bit times of a reading of the control registers.
pub const BITS_PER_CHECK: usize = bits(SETTINGS);

/// Bus time of one sample.
pub const TIME_PER_SAMPLE: Duration =
    Duration::from_nanos(BITS_PER_SAMPLE as u64 * 1_000_000_000 / BUS_HERTZ as u64);

/// Number of new samples after which the registers are read back in any case.
pub const READS_UNCHECKED: u8 = 255;

/// Time from power-up to an answer (ST's example: boot time 15 ms), and from setting the boot bit
/// to its end.
const BOOT_TIME: Duration = Duration::from_millis(15);

/// Time between two readings of a bit that clears itself.
const LOOK: Duration = Duration::from_millis(5);
/// Number of readings of that bit before it is given up: 50 ms in total, as in Linux.
const LOOKS: usize = 10;

/// Settling from power-off, or after a change of the self-test force, to valid data (ST's example:
/// 150 ms for the gyro, the longest).
const SETTLING: Duration = Duration::from_millis(150);

/// Number of samples of one half of the self-test, as in ST's example.
const SELF_TEST_SAMPLES: i32 = 5;

/// Time between two samples of the self-test: a period at 52 Hz and its tolerance.
const SELF_TEST_INTERVAL: Duration = Duration::from_millis(22);

/// The selectable configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configuration {
    /// Output data rate of both sensors.
    pub output: OutputRate,
    /// Range of the gyro.
    pub rate: RateRange,
    /// Range of the accelerometer.
    pub force: ForceRange,
}

/// One sample on the chip's own axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Rates about x, y, z.
    pub rate: [AngularRate; 3],
    /// Specific force on x, y, z.
    pub force: [SpecificForce; 3],
    /// Temperature of the chip, uncalibrated.
    pub temperature: Temperature,
    /// Whether a rate is beyond its nominal range, or beyond the range of its type.
    pub is_rate_clipped: bool,
    /// Whether a specific force is at the limit of its range.
    pub is_force_clipped: bool,
}

impl Reading {
    fn new(frame: &Frame, configuration: Configuration) -> Self {
        let rate = frame.rate.map(|count| codec::rate(count, configuration.rate));
        Self {
            rate,
            force: frame.force.map(|count| codec::force(count, configuration.force)),
            temperature: codec::temperature(frame.temperature),
            is_rate_clipped: frame.rate.into_iter().any(codec::is_rate_clipped)
                || rate.into_iter().any(AngularRate::is_saturated),
            is_force_clipped: frame.force.into_iter().any(codec::is_force_clipped),
        }
    }
}

/// The driver of coarse gyros and accelerometers on their bus.
#[derive(Debug)]
pub struct Lsm6dsl<I, D> {
    bus: I,
    delay: D,
    address: u8,
    configuration: Configuration,
    /// Number of new samples since the registers were found correct; at its limit until they are.
    reads_unchecked: u8,
    /// Whether the latest reading was not new.
    was_stale: bool,
}

impl<I: I2c, D: DelayNs> Lsm6dsl<I, D> {
    /// Creates the driver of a chip at a 7-bit address on `bus` (at most 400 kHz); nothing is sent
    /// yet.
    pub const fn new(bus: I, delay: D, address: u8, configuration: Configuration) -> Self {
        let reads_unchecked = READS_UNCHECKED;
        Self { bus, delay, address, configuration, reads_unchecked, was_stale: false }
    }

    /// Nominal time between two outputs.
    pub const fn output_period(&self) -> Duration {
        self.configuration.output.period()
    }

    /// Brings the chip from any state to measuring: identity, reset, boot, self-test,
    /// configuration, read-back. Takes about 0.75 s, most of it the self-test; the base may sway
    /// meanwhile.
    ///
    /// # Errors
    /// [`Fault::Bus`], also if no chip acknowledges; [`Fault::Identity`]; [`Fault::NotReady`] if a
    /// reset does not end or no samples come; [`Fault::SelfTest`]; [`Fault::NotAsWritten`].
    pub async fn start(&mut self) -> Result<(), Fault> {
        self.reads_unchecked = READS_UNCHECKED;
        pause(&mut self.delay, BOOT_TIME).await;
        self.identify().await?;
        self.restart(SOFTWARE_RESET).await?;
        self.restart(BOOT).await?;
        self.test().await?;
        let [force, rate, ..] = codec::settings(&self.configuration);
        self.write(&[(CTRL1_XL, force), (CTRL2_G, rate)]).await?;
        pause(&mut self.delay, SETTLING).await;
        self.check().await
    }

    /// Reads the newest sample; `None` if it has been read before.
    ///
    /// # Errors
    /// [`Fault::Bus`]; [`Fault::Reset`]; [`Fault::NotAsWritten`] for a register that has changed.
    pub async fn read(&mut self) -> Result<Option<Reading>, Fault> {
        let is_fresh = self.status().await?.is_fresh();
        let was_stale = core::mem::replace(&mut self.was_stale, !is_fresh);
        if self.reads_unchecked == READS_UNCHECKED || (!is_fresh && was_stale) {
            self.reads_unchecked = READS_UNCHECKED;
            self.check().await?;
        }
        if !is_fresh {
            return Ok(None);
        }
        self.reads_unchecked += 1;
        let frame = self.sample().await?;
        Ok(Some(Reading::new(&frame, self.configuration)))
    }

    async fn identify(&mut self) -> Result<(), Fault> {
        let mut found = [0];
        self.read_from(WHO_AM_I, &mut found).await?;
        let [found] = found;
        if found == IDENTITY { Ok(()) } else { Err(Fault::Identity { found: u32::from(found) }) }
    }

    /// Sets a bit that clears itself once the chip is ready.
    async fn restart(&mut self, bit: u8) -> Result<(), Fault> {
        self.write(&[(CTRL3_C, bit | INCREMENT)]).await?;
        pause(&mut self.delay, BOOT_TIME).await;
        for _ in 0..LOOKS {
            let mut control = [0];
            self.read_from(CTRL3_C, &mut control).await?;
            if control[0] & bit == 0 {
                return Ok(());
            }
            pause(&mut self.delay, LOOK).await;
        }
        Err(Fault::NotReady)
    }

    /// Runs the self-test of both sensors together: measures the difference that the self-test
    /// forces make.
    async fn test(&mut self) -> Result<(), Fault> {
        let begin = [
            (CTRL3_C, BLOCK_DATA_UPDATE | INCREMENT),
            (CTRL1_XL, TEST_CTRL1_XL),
            (CTRL2_G, TEST_CTRL2_G),
        ];
        self.write(&begin).await?;
        let without = self.sums().await?;
        self.write(&[(CTRL5_C, TEST_FORCES)]).await?;
        let with = self.sums().await?;
        self.write(&[(CTRL5_C, 0)]).await?;
        let passes = codec::self_test_passes(&without, &with, SELF_TEST_SAMPLES);
        if passes { Ok(()) } else { Err(Fault::SelfTest) }
    }

    /// Sums samples after settling; the sample before is read and discarded.
    async fn sums(&mut self) -> Result<Sums, Fault> {
        pause(&mut self.delay, SETTLING).await;
        self.sample().await?;
        let mut sums = Sums::default();
        for _ in 0..SELF_TEST_SAMPLES {
            pause(&mut self.delay, SELF_TEST_INTERVAL).await;
            if !self.status().await?.is_fresh() {
                return Err(Fault::NotReady);
            }
            let Frame { rate, force, .. } = self.sample().await?;
            for (sum, counts) in sums.iter_mut().zip([rate, force]) {
                for (sum, count) in sum.iter_mut().zip(counts) {
                    *sum += i32::from(count);
                }
            }
        }
        Ok(sums)
    }

    /// Compares the control registers with their required contents.
    async fn check(&mut self) -> Result<(), Fault> {
        let mut found = [0; SETTINGS];
        self.read_from(CTRL1_XL, &mut found).await?;
        codec::compare(&found, &codec::settings(&self.configuration))?;
        self.reads_unchecked = 0;
        Ok(())
    }

    async fn status(&mut self) -> Result<Status, Fault> {
        let mut status = [0];
        self.read_from(STATUS, &mut status).await?;
        Ok(Status(status[0]))
    }

    async fn sample(&mut self) -> Result<Frame, Fault> {
        let mut burst = [0; BURST];
        self.read_from(OUT_TEMP_L, &mut burst).await?;
        Ok(codec::frame(&burst))
    }

    /// Reads registers in a row, from `first` on.
    async fn read_from(&mut self, first: u8, bytes: &mut [u8]) -> Result<(), Fault> {
        self.bus.write_read(self.address, &[first], bytes).await.map_err(|_| Fault::Bus)
    }

    /// Writes registers, one after another.
    async fn write(&mut self, contents: &[(u8, u8)]) -> Result<(), Fault> {
        for (register, value) in contents {
            self.bus.write(self.address, &[*register, *value]).await.map_err(|_| Fault::Bus)?;
        }
        Ok(())
    }
}

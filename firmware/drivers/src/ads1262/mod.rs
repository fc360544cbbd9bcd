//! ADS1262: 32-bit converter of the analogue fibre-optic gyro (Texas Instruments SBAS661C).
//!
//! ```text
//!  gyro ─▶ AIN0/AIN1 ─▶ gain ─▶ modulator 921.6 kHz ─▶ sinc⁵ ─▶ mean ─▶ code ─▶ Scale ─▶ rate
//!  test voltage ─▶┘                                             data-ready ─▶ ready()
//! ```
//!
//! Bus: SPI mode 1, at most 8 MHz. One sample is a command and a frame,
//! [`BYTES_PER_SAMPLE`] = 7 bytes: 7 µs at 8 MHz, 11.2 µs at 5 MHz ([`bus_time`]); at 400 SPS
//! that is 0.3 % and 0.5 % of the bus.
//!
//! The newest conversion is read by command, not straight from the shift register: the direct way
//! saves one byte, but allows no other clocking since data-ready and must end 2.2 µs before the next
//! conversion (figure 9-43), which a late task cannot promise. By command data are valid at any
//! time, and the status byte shows whether they are new.
//!
//! Time: at 400 SPS the first conversion comes 2.855 ms after the start, the others every 2.5 ms, and
//! each shows the input as it was 1.4 ms before, in the mean ([`Configuration::latency`]).
//!
//! A data-ready line that stays silent may mean that the chip has restarted, since a reset stops
//! conversions. If a wait for [`Ads1262::ready`] is given up, [`Ads1262::read`] reports the reason
//! ([`Fault::Reset`]), and [`Ads1262::start`] restores the operation. After a wrong checksum the
//! conversion is lost, because a second reading of it is not marked as new: wait for the next one.

pub mod codec;
pub mod configuration;
pub mod registers;
pub mod scale;

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::{MODE_1, Mode, Operation, SpiDevice};

use crate::data_ready::{DataReady, Edge};
use crate::fault::Fault;
use crate::pause::pause;
use codec::{Conversion, FRAME, Status};
use configuration::{Configuration, Sign};
use registers::Image;

/// Clock polarity and phase (section 7.6: data change on rising and are taken on falling edges).
pub const SPI_MODE: Mode = MODE_1;

/// Fastest bus clock, Hz: 125 ns a bit (section 7.6).
pub const GREATEST_BUS_HERTZ: u32 = 8_000_000;

/// Bytes on the bus for one sample: the command and the frame.
pub const BYTES_PER_SAMPLE: usize = 1 + FRAME;

/// From the last supply threshold to the first communication: 65 536 clocks, 8.9 ms, and the
/// oscillator's tolerance (figure 9-52).
const POWER_UP: Duration = Duration::from_millis(10);

/// From the reset command to the next one: 8 clocks, at the slowest clock of 1 MHz (table 9-32).
const RESET: Duration = Duration::from_micros(8);

/// Settling of the internal reference with 1 µF to within 10⁻⁵ (figure 7-33; TI's example code
/// waits as long). Counted from the reset, because the time since the supply came up is unknown.
const REFERENCE_SETTLING: Duration = Duration::from_millis(50);

/// A test conversion is given its latency and a fraction of 1/20 of it, 5 %: the oscillator may be
/// slow by 2 % (section 7.5).
const OSCILLATOR_MARGIN: u32 = 20;

/// Nominal code of the test voltage: 1 V of 2.5 V.
const TEST_CODE: i32 = 858_993_459;

/// Tolerance of the test voltage, 10 %: it scales with the analogue supply (± 5 %, section 7.3),
/// and its divider and the reference add little. The tolerance is narrow enough to find a dead or
/// stuck modulator, a wrong gain, polarity, multiplexer or reference.
const TEST_TOLERANCE: u32 = 85_899_346;

/// Time on the bus for one sample at a clock of `hertz` (> 0).
#[must_use]
pub const fn bus_time(hertz: u32) -> Duration {
    Duration::from_nanos(BYTES_PER_SAMPLE as u64 * 8_000_000_000 / hertz as u64)
}

/// An ADS1262 on a bus, with its data-ready line (falling: a conversion is ready).
#[derive(Debug)]
pub struct Ads1262<S, R, D> {
    spi: S,
    ready: R,
    delay: D,
    configuration: Configuration,
    /// Whether the chip's clock is external.
    is_clocked: bool,
}

impl<S, R, D> Ads1262<S, R, D> {
    /// Creates the driver of a chip that has not been started, on its internal oscillator. The
    /// START pin must be held low and the clock input grounded.
    pub const fn new(spi: S, ready: R, delay: D, configuration: Configuration) -> Self {
        Self { spi, ready, delay, configuration, is_clocked: false }
    }

    /// Creates the driver of a chip with 7.3728 MHz at its clock input: several chips on one clock
    /// convert synchronously.
    #[must_use]
    pub fn clocked(self) -> Self {
        Self { is_clocked: true, ..self }
    }
}

impl<S: SpiDevice, R: DataReady, D: DelayNs> Ads1262<S, R, D> {
    /// Resets, identifies, tests and configures the chip and begins conversions: from any state,
    /// in 60 ms and two conversions. The gyro is not measured before the test voltage was, in both
    /// directions, through the configured filter and gain.
    ///
    /// # Errors
    /// [`Fault::Bus`]; [`Fault::Identity`] with ID, POWER and INTERFACE where another chip, none, or
    /// one that did not obey the reset answers; [`Fault::NotAsWritten`]; [`Fault::NotReady`] where it
    /// does not convert, [`Fault::SelfTest`] where it converts wrongly, [`Fault::Alarm`] where its
    /// reference is low or its clock another than stated.
    pub async fn start(&mut self) -> Result<(), Fault> {
        pause(&mut self.delay, POWER_UP).await;
        self.reset().await?;
        self.identify().await?;
        pause(&mut self.delay, REFERENCE_SETTLING).await;
        for sign in [Sign::Plus, Sign::Minus] {
            self.test(sign).await?;
        }
        self.run(&self.configuration.image()).await
    }

    /// Waits until a conversion is ready that has not been read, and returns its end. The future may be dropped at
    /// any time without loss. It has no time limit of its own, so the caller sets one.
    ///
    /// # Errors
    /// [`Fault::Bus`] if the line cannot be observed.
    pub fn ready(&mut self) -> impl Future<Output = Result<Edge, Fault>> {
        self.ready.edge()
    }

    /// Reads the newest conversion, at any time.
    ///
    /// # Errors
    /// [`Fault::Bus`], and as [`codec::decode`].
    pub async fn read(&mut self) -> Result<Conversion, Fault> {
        let mut bytes = [0; BYTES_PER_SAMPLE];
        bytes[0] = registers::RDATA1;
        self.transfer(&mut bytes).await?;
        let [_, frame @ ..] = bytes;
        codec::decode(frame)
    }

    /// Stops the conversions of a started chip and prepares new ones: those of several chips on one
    /// clock are then begun synchronously.
    ///
    /// # Errors
    /// [`Fault::Bus`] and [`Fault::NotAsWritten`].
    pub async fn arm(&mut self) -> Result<(), Fault> {
        self.configure(&self.configuration.image()).await
    }

    /// Begins conversions.
    ///
    /// # Errors
    /// [`Fault::Bus`].
    pub fn begin(&mut self) -> impl Future<Output = Result<(), Fault>> {
        self.write(&[registers::START1])
    }

    async fn reset(&mut self) -> Result<(), Fault> {
        self.write(&[registers::RESET]).await?;
        pause(&mut self.delay, RESET).await;
        Ok(())
    }

    /// An ADS1262 has the device number zero, which a dead line also gives; only together with the
    /// reset values of the two following registers does it identify the chip.
    async fn identify(&mut self) -> Result<(), Fault> {
        let mut bytes = [registers::RREG | registers::ID, 2, 0, 0, 0];
        self.transfer(&mut bytes).await?;
        let [_, _, id, power, interface] = bytes;
        let is_right = id >> registers::DEVICE_SHIFT == 0
            && power == registers::POWER_RESET_VALUE
            && interface == registers::INTERFACE_STATUS_AND_SUM;
        let found = u32::from_be_bytes([0, id, power, interface]);
        if is_right { Ok(()) } else { Err(Fault::Identity { found }) }
    }

    /// Converts the test voltage once.
    async fn test(&mut self, sign: Sign) -> Result<(), Fault> {
        self.run(&self.configuration.test_image(sign)).await?;
        let latency = self.configuration.latency();
        pause(&mut self.delay, latency + latency / OSCILLATOR_MARGIN).await;
        let conversion = self.read().await?;
        if !conversion.is_new {
            return Err(Fault::NotReady);
        }
        if conversion.status.has(Status::EXTERNAL_CLOCK) != self.is_clocked {
            return Err(Fault::Alarm { status: conversion.status.0 });
        }
        let expected = if sign == Sign::Plus { TEST_CODE } else { -TEST_CODE };
        let is_near = conversion.code.abs_diff(expected) <= TEST_TOLERANCE;
        if is_near && !conversion.is_clipped { Ok(()) } else { Err(Fault::SelfTest) }
    }

    /// Begins conversions with these register contents.
    async fn run(&mut self, image: &Image) -> Result<(), Fault> {
        self.configure(image).await?;
        self.begin().await
    }

    /// Writes these register contents after a reset, which stops whatever ran before.
    async fn configure(&mut self, image: &Image) -> Result<(), Fault> {
        self.reset().await?;
        self.write(&image.written()).await?;
        let mut bytes = registers::READ_BACK;
        self.transfer(&mut bytes).await?;
        image.verify(&bytes)
    }

    async fn transfer(&mut self, bytes: &mut [u8]) -> Result<(), Fault> {
        let mut operations = [Operation::TransferInPlace(bytes)];
        self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)
    }

    async fn write(&mut self, bytes: &[u8]) -> Result<(), Fault> {
        let mut operations = [Operation::Write(bytes)];
        self.spi.transaction(&mut operations).await.map_err(Fault::of_transfer)
    }
}

//! Buses, chip selects and lines of a board, as each carrier uses them.
//!
//! **One clock polarity on each bus.** On the sensors' bus embassy switches the SPI off between two
//! transfers, and a pull resistor alone holds the clock at its idle level (RM0351, SPI, clock phase and
//! polarity). A device of the other polarity would see an additional edge while selected. So the
//! ADS1262 and the ADXL355, which idle low, share one bus, the MT6835 and the TMC5160, which idle high,
//! the other; the phases may differ.

use drivers::{ads1262, adxl355};
use embassy_embedded_hal::adapter::BlockingAsync;
use embassy_embedded_hal::shared_bus::asynch::spi::{SpiDevice, SpiDeviceWithConfig};
use embassy_stm32::Peri;
use embassy_stm32::exti::ExtiInput;
use embassy_stm32::gpio::{Level, Output, Pin, Pull, Speed};
use embassy_stm32::i2c::{self, I2c};
use embassy_stm32::mode::{Async, Blocking};
use embassy_stm32::peripherals::FLASH;
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{self, MODE_0, MODE_1, MODE_3, Mode, Spi};
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::UartTx;
use embassy_sync::mutex::Mutex;
use firmware::crossing::Lock;
use firmware::ports::Frames;

/// Greatest bus clock of the TMC5160 with its own oscillator, Hz (data sheet rev. 1.14, 4.3); the
/// MT6835 allows more.
const TMC5160_HERTZ: u32 = 4_000_000;

/// The bus of the sensors. All its devices belong to one executor; the lock lets them be handed to it.
pub type Bus = Mutex<Lock, Spi<'static, Async, Master>>;
/// A sensor on its bus, with its own mode and clock.
pub type Device = SpiDeviceWithConfig<'static, Lock, Spi<'static, Async, Master>, Output<'static>>;
/// The SPI of the stage without DMA: the few bytes of a transfer take 20 µs, hardly more than to set
/// up two DMA channels, which the IMU on the base has.
type StageSpi = BlockingAsync<Spi<'static, Blocking, Master>>;
/// The bus of encoders and motor drivers.
pub type StageBus = Mutex<Lock, StageSpi>;
/// An encoder or a motor driver on its bus; all have one mode and one clock.
pub type StageDevice = SpiDevice<'static, Lock, StageSpi, Output<'static>>;
/// The bus of the IMU on the base.
pub type BaseBus = I2c<'static, Async, i2c::Master>;
/// A data-ready line.
pub type Ready = ExtiInput<'static, Async>;
/// The serial port for status lines.
pub type Link = UartTx<'static, Async>;

/// Connections of a platform that turns the gyro, with the axes `A`.
pub struct PlatformWires<A> {
    /// Converter ADS1262 of the gyro.
    pub converter: ConverterWires,
    /// Accelerometer ADXL355.
    pub accelerometer: Device,
    /// Encoders and motor drivers.
    pub axes: A,
    /// IMU LSM6DSL of the board itself, on the base.
    pub base: BaseBus,
    /// Enable pin of the motor drivers, active low: without it, or during a reset, the motors have no
    /// current.
    pub motor_enable: Output<'static>,
    /// Link and flash.
    pub outlets: Outlets,
}

/// Connections of a stage or a turntable.
pub type AxisPlatformWires = PlatformWires<AxisWires>;
/// Connections of two frames.
pub type FramesWires = PlatformWires<Frames<AxisWires>>;

/// Connections in a vehicle.
pub struct VehicleWires {
    /// Converters of the gyros forward, right and down.
    pub converters: [ConverterWires; 3],
    /// Accelerometer ADXL355.
    pub accelerometer: Device,
    /// Link and flash.
    pub outlets: Outlets,
}

/// Connections on a spinning body.
pub struct SpinWires {
    /// Converters of the gyros forward, up and right, and of the accelerometers up and right.
    pub converters: [ConverterWires; 5],
    /// Link and flash.
    pub outlets: Outlets,
}

/// Where results go.
pub struct Outlets {
    /// Link for status lines.
    pub link: Link,
    /// Flash of the controller, for what must outlast a loss of supply.
    pub flash: Peri<'static, FLASH>,
}

/// Connections of an axis.
pub struct AxisWires {
    /// Encoder MT6835.
    pub encoder: StageDevice,
    /// Motor driver TMC5160.
    pub motor: StageDevice,
}

/// Connections of an ADS1262.
pub struct ConverterWires {
    /// The chip on its bus.
    pub bus: Device,
    /// Data-ready line of the chip, low when a conversion is ready.
    pub ready: Ready,
}

/// The buses of a board at their final place in memory.
#[derive(Clone, Copy)]
pub struct Buses {
    /// The bus of the sensors.
    pub sensors: &'static Bus,
    /// The bus of encoders and motor drivers.
    pub stage: &'static StageBus,
    /// Clock that the buses divide, Hz.
    pub clock: u32,
}

impl Buses {
    /// Connects an ADS1262 by its select pin and its data-ready line.
    pub fn converter(self, select: Peri<'static, impl Pin>, ready: Ready) -> ConverterWires {
        let bus =
            SpiDeviceWithConfig::new(self.sensors, unselected(select), sensor_settings(self.clock));
        ConverterWires { bus, ready }
    }

    /// Connects the ADXL355 by its select pin.
    pub fn accelerometer(self, select: Peri<'static, impl Pin>) -> Device {
        let settings = settings(MODE_0, adxl355::BUS_HERTZ, self.clock);
        SpiDeviceWithConfig::new(self.sensors, unselected(select), settings)
    }

    /// Connects the encoder and the motor driver of an axis by their select pins.
    pub fn axis(
        self,
        encoder: Peri<'static, impl Pin>,
        motor: Peri<'static, impl Pin>,
    ) -> AxisWires {
        AxisWires {
            encoder: SpiDevice::new(self.stage, unselected(encoder)),
            motor: SpiDevice::new(self.stage, unselected(motor)),
        }
    }
}

/// A select line at rest.
fn unselected(select: Peri<'static, impl Pin>) -> Output<'static> {
    Output::new(select, Level::High, Speed::Medium)
}

/// Settings of the sensors' bus as its converters use it, by the clock that it divides, Hz.
#[must_use]
pub fn sensor_settings(clock: u32) -> spi::Config {
    settings(MODE_1, ads1262::GREATEST_BUS_HERTZ, clock)
}

/// Settings of the bus of encoders and motor drivers, by the clock that it divides, Hz.
#[must_use]
pub fn stage_settings(clock: u32) -> spi::Config {
    settings(MODE_3, TMC5160_HERTZ, clock)
}

/// Mode of a device, and the fastest division of a clock, Hz, not above its limit, Hz. A pull-up makes
/// a broken line read as ones, which, unlike zeros, fail every checksum.
fn settings(mode: Mode, limit: u32, clock: u32) -> spi::Config {
    let mut settings = spi::Config::default();
    settings.mode = mode;
    settings.frequency = within(limit, clock);
    settings.miso_pull = Pull::Up;
    settings.gpio_speed = Speed::Medium;
    settings
}

/// Fastest clock of a divider that is not above the limit, Hz. embassy itself takes the nearest
/// divider, which may be faster than requested.
const fn within(limit: u32, clock: u32) -> Hertz {
    let mut divided = clock / 2;
    while divided > limit {
        divided /= 2;
    }
    Hertz(divided)
}

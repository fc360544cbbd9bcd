//! Pins, buses and DMA channels: from the controller's peripherals to the instrument's ports.
//!
//! **One clock polarity on each bus.** On the sensors' bus embassy switches the SPI off between two
//! transfers, and a
//! pull resistor alone holds the clock at its idle level (RM0351, SPI, clock phase and polarity). A
//! device of the other polarity would see an additional edge while selected. So the ADS1262 and the
//! ADXL355, which idle low, share one bus, the MT6835 and the TMC5160, which idle high, the other;
//! the phases may differ.

use drivers::{ads1262, adxl355, lsm6dsl};
use embassy_embedded_hal::adapter::BlockingAsync;
use embassy_embedded_hal::shared_bus::asynch::spi::{SpiDevice, SpiDeviceWithConfig};
use embassy_stm32::exti::{self, ExtiInput};
use embassy_stm32::gpio::{Level, Output, Pin, Pull, Speed};
use embassy_stm32::i2c::{self, I2c};
use embassy_stm32::interrupt::typelevel;
use embassy_stm32::mode::{Async, Blocking};
use embassy_stm32::peripherals::{
    DMA1_CH2, DMA1_CH3, DMA1_CH4, DMA1_CH5, DMA2_CH6, EXTI0, EXTI1, EXTI3, EXTI4, FLASH, I2C2, PA3,
    PA4, PB0, PB1, PB2, PB4, PB10, PB11, PC3, PC4,
};
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{self, MODE_0, MODE_1, MODE_3, Mode, Spi};
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::{self, ConfigError, UartTx};
use embassy_stm32::{Peri, Peripherals, bind_interrupts, dma};
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::mutex::Mutex;
use embassy_time::Duration;
use static_cell::StaticCell;

use crate::clock;

bind_interrupts!(struct Interrupts {
    EXTI0 => exti::InterruptHandler<typelevel::EXTI0>;
    EXTI1 => exti::InterruptHandler<typelevel::EXTI1>;
    EXTI3 => exti::InterruptHandler<typelevel::EXTI3>;
    EXTI4 => exti::InterruptHandler<typelevel::EXTI4>;
    EXTI15_10 => exti::InterruptHandler<typelevel::EXTI15_10>;
    I2C2_EV => i2c::EventInterruptHandler<I2C2>;
    I2C2_ER => i2c::ErrorInterruptHandler<I2C2>;
    DMA1_CHANNEL2 => dma::InterruptHandler<DMA1_CH2>;
    DMA1_CHANNEL3 => dma::InterruptHandler<DMA1_CH3>;
    DMA1_CHANNEL4 => dma::InterruptHandler<DMA1_CH4>;
    DMA1_CHANNEL5 => dma::InterruptHandler<DMA1_CH5>;
    DMA2_CHANNEL6 => dma::InterruptHandler<DMA2_CH6>;
});

/// Greatest bus clock of the TMC5160 with its own oscillator, Hz (data sheet rev. 1.14, 4.3); the
/// MT6835 allows more.
const TMC5160_HERTZ: u32 = 4_000_000;

/// Longest transfer of the IMU on the base before the bus counts as broken; the usual ones take 0.4 ms.
const BASE_TIMEOUT: Duration = Duration::from_millis(5);

/// The bus of the sensors. All devices of a bus belong to one executor, so it needs no lock.
type Bus = Mutex<NoopRawMutex, Spi<'static, Async, Master>>;
/// A sensor on its bus, with its own mode and clock.
pub type Device =
    SpiDeviceWithConfig<'static, NoopRawMutex, Spi<'static, Async, Master>, Output<'static>>;
/// SPI2 without DMA: the few bytes of a transfer take 20 µs, hardly more than to set up two DMA
/// channels, which the IMU on the base has.
type StageSpi = BlockingAsync<Spi<'static, Blocking, Master>>;
/// The bus of encoders and motor drivers.
type StageBus = Mutex<NoopRawMutex, StageSpi>;
/// An encoder or a motor driver on its bus; all have one mode and one clock.
pub type StageDevice = SpiDevice<'static, NoopRawMutex, StageSpi, Output<'static>>;
/// The bus of the IMU on the base.
pub type BaseBus = I2c<'static, Async, i2c::Master>;
/// A data-ready line.
pub type Ready = ExtiInput<'static, Async>;
/// The virtual COM port.
pub type Link = UartTx<'static, Async>;

/// All connections of the board.
pub struct Wiring {
    /// All sensors but those of the axis.
    pub sensors: SensorWires,
    /// The axis of a stage or a turntable, or the outer frame.
    pub axis: AxisWires,
    /// Enable pin of the motor driver, active low: without it, or during a reset, the motor has no
    /// current.
    pub motor_enable: Output<'static>,
    /// Link for status lines.
    pub link: Link,
    /// Flash of the controller: a rotating platform stores its axis misalignment there, a carrier that
    /// keeps its attitude the heading.
    pub flash: Peri<'static, FLASH>,
}

/// Connections of the sensors.
pub struct SensorWires {
    /// Converter ADS1262; in a vehicle that of the forward gyro.
    pub converter: ConverterWires,
    /// Two further devices in a vehicle, on a spinning body or on two frames.
    pub others: OtherWires,
    /// Two further converters on a spinning body.
    pub more: MoreWires,
    /// Accelerometer ADXL355.
    pub accelerometer: Device,
    /// IMU LSM6DSL of the board itself.
    pub base: BaseWires,
}

/// Connections of an axis.
pub struct AxisWires {
    /// Encoder MT6835.
    pub encoder: StageDevice,
    /// Motor driver TMC5160.
    pub motor: StageDevice,
}

/// Pins of the IMU on the base, unconnected until it is needed.
pub struct BaseWires {
    bus: Peri<'static, I2C2>,
    pins: (Peri<'static, PB10>, Peri<'static, PB11>),
    channels: (Peri<'static, DMA1_CH4>, Peri<'static, DMA1_CH5>),
}

impl BaseWires {
    /// Connects the IMU.
    pub fn connect(self) -> BaseBus {
        let Self { bus, pins: (clock, data), channels: (sending, receiving) } = self;
        let mut settings = i2c::Config::default();
        settings.frequency = Hertz(lsm6dsl::BUS_HERTZ);
        settings.timeout = BASE_TIMEOUT;
        I2c::new(bus, clock, data, sending, receiving, Interrupts, settings)
    }
}

/// Connections of an ADS1262.
pub struct ConverterWires {
    /// The chip on its bus.
    pub bus: Device,
    /// Data-ready line of the chip, low when a conversion is ready.
    pub ready: Ready,
}

/// Pins of two further devices, unconnected until they are needed: a pin takes no memory.
pub struct OtherWires {
    sensors: &'static Bus,
    stage: &'static StageBus,
    selects: (Peri<'static, PB2>, Peri<'static, PA4>),
    ready: (Peri<'static, PB0>, Peri<'static, PB1>),
    lines: (Peri<'static, EXTI0>, Peri<'static, EXTI1>),
}

impl OtherWires {
    /// Connects the converters in a vehicle of the right and the down gyro; on a spinning body of the
    /// right and the up gyro.
    pub fn converters(self) -> [ConverterWires; 2] {
        let Self { sensors, selects, ready, lines, .. } = self;
        [
            converter(sensors, selects.0, ExtiInput::new(ready.0, lines.0, Pull::Up, Interrupts)),
            converter(sensors, selects.1, ExtiInput::new(ready.1, lines.1, Pull::Up, Interrupts)),
        ]
    }

    /// Connects the inner of two frames.
    pub fn inner_frame(self) -> AxisWires {
        let (encoder, motor) = self.selects;
        axis(self.stage, encoder, motor)
    }
}

/// Pins of two further converters, unconnected until they are needed.
pub struct MoreWires {
    bus: &'static Bus,
    selects: (Peri<'static, PA3>, Peri<'static, PB4>),
    ready: (Peri<'static, PC4>, Peri<'static, PC3>),
    lines: (Peri<'static, EXTI4>, Peri<'static, EXTI3>),
}

impl MoreWires {
    /// Connects the converters of the accelerometers up and to the right.
    pub fn connect(self) -> [ConverterWires; 2] {
        let Self { bus, selects, ready, lines } = self;
        [
            converter(bus, selects.0, ExtiInput::new(ready.0, lines.0, Pull::Up, Interrupts)),
            converter(bus, selects.1, ExtiInput::new(ready.1, lines.1, Pull::Up, Interrupts)),
        ]
    }
}

/// Connects all peripherals.
///
/// # Errors
/// An invalid configuration of the serial port.
pub fn connect(p: Peripherals) -> Result<Wiring, ConfigError> {
    static SENSORS: StaticCell<Bus> = StaticCell::new();
    static STAGE: StaticCell<StageBus> = StaticCell::new();
    let low = settings(MODE_1, ads1262::GREATEST_BUS_HERTZ);
    let high = settings(MODE_3, TMC5160_HERTZ);
    let sensors = Spi::new(p.SPI1, p.PA5, p.PA7, p.PA6, p.DMA1_CH3, p.DMA1_CH2, Interrupts, low);
    let stage = Spi::new_blocking(p.SPI2, p.PD1, p.PD4, p.PD3, high);
    let sensors = SENSORS.init(Mutex::new(sensors));
    let stage = STAGE.init(Mutex::new(BlockingAsync::new(stage)));
    Ok(Wiring {
        sensors: SensorWires {
            converter: converter(
                sensors,
                p.PA2,
                ExtiInput::new(p.PD14, p.EXTI14, Pull::Up, Interrupts),
            ),
            others: OtherWires {
                sensors,
                stage,
                selects: (p.PB2, p.PA4),
                ready: (p.PB0, p.PB1),
                lines: (p.EXTI0, p.EXTI1),
            },
            more: MoreWires {
                bus: sensors,
                selects: (p.PA3, p.PB4),
                ready: (p.PC4, p.PC3),
                lines: (p.EXTI4, p.EXTI3),
            },
            accelerometer: device(sensors, p.PA15, settings(MODE_0, adxl355::BUS_HERTZ)),
            base: BaseWires {
                bus: p.I2C2,
                pins: (p.PB10, p.PB11),
                channels: (p.DMA1_CH4, p.DMA1_CH5),
            },
        },
        axis: axis(stage, p.PD0, p.PD5),
        motor_enable: Output::new(p.PD2, Level::Low, Speed::Low),
        link: UartTx::new(p.USART1, p.PB6, p.DMA2_CH6, Interrupts, usart::Config::default())?,
        flash: p.FLASH,
    })
}

/// Connects an ADS1262 to its bus and its data-ready line.
fn converter(bus: &'static Bus, select: Peri<'static, impl Pin>, ready: Ready) -> ConverterWires {
    let settings = settings(MODE_1, ads1262::GREATEST_BUS_HERTZ);
    ConverterWires { bus: device(bus, select, settings), ready }
}

/// Connects the encoder and the motor driver of an axis.
fn axis(
    bus: &'static StageBus,
    encoder: Peri<'static, impl Pin>,
    motor: Peri<'static, impl Pin>,
) -> AxisWires {
    AxisWires {
        encoder: SpiDevice::new(bus, unselected(encoder)),
        motor: SpiDevice::new(bus, unselected(motor)),
    }
}

/// Creates a device on a bus, not selected.
fn device(bus: &'static Bus, select: Peri<'static, impl Pin>, settings: spi::Config) -> Device {
    SpiDeviceWithConfig::new(bus, unselected(select), settings)
}

/// A select line at rest.
fn unselected(select: Peri<'static, impl Pin>) -> Output<'static> {
    Output::new(select, Level::High, Speed::Medium)
}

/// Mode of a device, and the fastest clock not above its limit, Hz. A pull-up makes a broken line
/// read as ones, which, unlike zeros, fail every checksum.
fn settings(mode: Mode, limit: u32) -> spi::Config {
    let mut settings = spi::Config::default();
    settings.mode = mode;
    settings.frequency = within(limit);
    settings.miso_pull = Pull::Up;
    settings.gpio_speed = Speed::Medium;
    settings
}

/// Fastest clock of a divider that is not above the limit, Hz. embassy itself takes the nearest
/// divider, which may be faster than requested.
const fn within(limit: u32) -> Hertz {
    let mut clock = clock::SYSTEM / 2;
    while clock > limit {
        clock /= 2;
    }
    Hertz(clock)
}

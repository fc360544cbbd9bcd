//! Buses, chip selects and lines of a board, as each carrier uses them.
//!
//! **One clock polarity on each bus.** While the interface is switched off to change mode or clock, a pull resistor
//! alone holds the clock at its idle level (RM0351, SPI, clock phase and polarity). A device of the other polarity would
//! see an additional edge. So the ADS1262 and the ADXL355, which idle low, share one bus, the MT6835 and the TMC5160,
//! which idle high, the other; the phases may differ.

use drivers::{ads1262, adxl355, mt6835, tmc5160};
use embassy_stm32::Peri;
use embassy_stm32::gpio::{AnyPin, Level, Output, Pin, Pull, Speed};
use embassy_stm32::spi::{self, MODE_0, MODE_1, MODE_3, Mode};
use firmware::ports::Frames;

use crate::chain;
use crate::edges::Line;
use crate::i2c::BaseBus;
use crate::spi::{Bus, Device};
use crate::{BoardLog, UpperBank};

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
    /// Flash, log and clock.
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
    /// Flash, log and clock.
    pub outlets: Outlets,
}

/// Connections on a spinning body.
pub struct SpinWires {
    /// Converters of the gyros forward, up and right, and of the accelerometers up and right.
    pub converters: [ConverterWires; 5],
    /// Flash, log and clock.
    pub outlets: Outlets,
}

/// Where results go, beside the link.
#[derive(Clone, Copy)]
pub struct Outlets {
    /// Flash of the controller, for what must outlast a loss of supply.
    pub flash: UpperBank,
    /// The log, and where the parts check in.
    pub log: &'static BoardLog,
    /// The clock by which everything is timed.
    pub clock: Clock,
}

/// The clock of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// Whether it follows a crystal; without one it is accurate to about 1 %.
    pub has_crystal: bool,
}

/// Connections of an axis.
pub struct AxisWires {
    /// Encoder MT6835.
    pub encoder: Device,
    /// Motor driver TMC5160.
    pub motor: Device,
}

/// Connections of an ADS1262.
pub struct ConverterWires {
    /// The chip on its bus.
    pub bus: Device,
    /// Data-ready line of the chip, low when a conversion is ready.
    pub ready: Line,
}

/// The serial buses of a board.
#[derive(Clone, Copy)]
pub struct Buses {
    /// The bus of the sensors.
    pub sensors: Bus,
    /// The bus of encoders and motor drivers.
    pub stage: Bus,
    /// Clock that the buses divide, Hz.
    pub clock: u32,
}

impl Buses {
    /// Connects an ADS1262 by its select pin and its data-ready line.
    pub fn converter(self, select: Peri<'static, impl Pin>, ready: Line) -> ConverterWires {
        let bus = self.sensor(select, MODE_1, ads1262::GREATEST_BUS_HERTZ);
        ConverterWires { bus, ready }
    }

    /// Connects the converters of a spinning body, which are read in a chain, by select pins and data-ready lines.
    #[must_use]
    pub fn chained(self, wires: [(Peri<'static, AnyPin>, Line); 5]) -> [ConverterWires; 5] {
        chain::connect(&wires);
        wires.map(|(select, ready)| self.converter(select, ready))
    }

    /// Connects the ADXL355 by its select pin.
    pub fn accelerometer(self, select: Peri<'static, impl Pin>) -> Device {
        self.sensor(select, MODE_0, adxl355::GREATEST_BUS_HERTZ)
    }

    /// Connects the encoder and the motor driver of an axis by their select pins.
    pub fn axis(
        self,
        encoder: Peri<'static, impl Pin>,
        motor: Peri<'static, impl Pin>,
    ) -> AxisWires {
        let device = |select, limit| Device::new(self.stage, select, MODE_3, limit, self.clock);
        AxisWires {
            encoder: device(unselected(encoder), mt6835::GREATEST_BUS_HERTZ),
            // The encoder belongs to acquisition, which interrupts the task of the motor.
            motor: device(unselected(motor), tmc5160::GREATEST_BUS_HERTZ).uninterrupted(),
        }
    }

    /// Connects a sensor with a mode and a greatest clock, Hz.
    fn sensor(self, select: Peri<'static, impl Pin>, mode: Mode, limit: u32) -> Device {
        Device::new(self.sensors, unselected(select), mode, limit, self.clock)
    }
}

/// A select line at rest.
fn unselected(select: Peri<'static, impl Pin>) -> Output<'static> {
    Output::new(select, Level::High, Speed::Medium)
}

/// How embassy sets up the pins of the sensors' bus.
#[must_use]
pub fn sensor_settings() -> spi::Config {
    settings(MODE_1)
}

/// How embassy sets up the pins of the bus of encoders and motor drivers.
#[must_use]
pub fn stage_settings() -> spi::Config {
    settings(MODE_3)
}

/// Pins for devices of this mode. A pull-up makes a broken line read as ones, which, unlike zeros, fail every
/// checksum.
fn settings(mode: Mode) -> spi::Config {
    let mut settings = spi::Config::default();
    settings.mode = mode;
    settings.miso_pull = Pull::Up;
    settings.gpio_speed = Speed::Medium;
    settings
}

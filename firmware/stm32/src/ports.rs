//! The chips on their wires, as the instrument's ports.

use drivers::ads1262::Ads1262;
use drivers::ads1262::configuration::Configuration as Conversion;
use drivers::adxl355::Adxl355;
use drivers::adxl355::registers::OutputRate;
use drivers::lsm6dsl::registers::ADDRESS_LOW;
use drivers::lsm6dsl::{self, Lsm6dsl};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::Tmc5160;
use drivers::tmc5160::configuration::{Configuration as Motor, Switches};
use embassy_time::Delay;
use firmware::chips::{AnalogueGyro, BaseImu};
use firmware::platform::Platform;
use firmware::ports::{Frames, Sensors, SpinSensors, VehicleSensors};
use firmware::settings;
use firmware::sway::SwayCompensation;
use orientation::alignment::setup::SetupError;

use crate::chain::ChainReader;
use crate::configuration;
use crate::configuration::PLATFORM;
use crate::edges::Line;
use crate::i2c::BaseBus;
use crate::spi::Device;
use crate::wiring::ConverterWires;

/// Converter with its data-ready line.
type Converter = Ads1262<Device, Line, Delay>;
/// Gyro behind its converter.
type Gyro = AnalogueGyro<Device, Line, Delay>;
/// Accelerometer on the platform, or in the vehicle.
type Accelerometer = Adxl355<Device, Delay>;
/// Encoder of an axis.
type AxisEncoder = Mt6835<Device, Delay>;
/// Motor of an axis.
pub type AxisMotor = Tmc5160<Device, Delay>;
/// IMU of the board on the base.
pub type Base = BaseImu<BaseBus, Delay>;
/// The IMU on the base, which measures its motion.
pub type OnBase = SwayCompensation<'static, Base>;
/// Sensors of a stage or a turntable, and of their base.
pub type Inputs<B> = Sensors<Gyro, Accelerometer, AxisEncoder, B>;
/// Sensors of a two-frame mount and of its base.
pub type MountInputs<B> = Sensors<Gyro, Accelerometer, Frames<AxisEncoder>, B>;
/// Sensors of a vehicle.
pub type Triad = VehicleSensors<Gyro, Accelerometer>;
/// Sensors of a spinning body.
pub type Spinning = SpinSensors<Converter, ChainReader>;

/// Connects the sensors on a stage, a turntable or two frames to their wires.
///
/// # Errors
/// A scale factor of the gyro that does not allow it.
pub fn inputs<E, B>(
    (wires, settings): (ConverterWires, &settings::Gyro),
    force: Device,
    encoder: E,
    base: B,
) -> Result<Sensors<Gyro, Accelerometer, E, B>, SetupError> {
    let gyro = gyro(converter(wires, configuration::CONVERTER), settings)?;
    Ok(Sensors { gyro, accelerometer: accelerometer(force), encoder, base })
}

/// Encoder of an axis.
#[must_use]
pub fn encoder(wires: Device) -> AxisEncoder {
    Mt6835::new(wires, Delay, mt6835::Configuration::default())
}

/// Connects the IMU of the board.
#[must_use]
pub fn base(bus: BaseBus) -> Base {
    let configuration = lsm6dsl::Configuration {
        output: configuration::BASE_OUTPUT,
        ..lsm6dsl::Configuration::default()
    };
    BaseImu {
        chip: Lsm6dsl::new(bus, Delay, ADDRESS_LOW, configuration),
        sensors: configuration::base_sensors(),
        divider: configuration::BASE_DIVIDER,
    }
}

/// Connects the sensors of a vehicle to their wires.
///
/// # Errors
/// A scale factor of the gyros that does not allow it.
pub fn triad(
    (converters, settings): ([ConverterWires; 3], &settings::Gyro),
    accelerometer: Device,
) -> Result<Triad, SetupError> {
    let gyro = |wires| gyro(converter(wires, configuration::CONVERTER).clocked(), settings);
    let [forward, right, down] = converters.map(gyro);
    let gyros = [forward?, right?, down?];
    Ok(VehicleSensors { gyros, accelerometer: self::accelerometer(accelerometer) })
}

/// Connects the sensors of a spinning body to their wires: gyros about x, y and z, accelerometers
/// along y and z.
#[must_use]
pub fn spinning(converters: [ConverterWires; 5]) -> Spinning {
    let reader = ChainReader::new(converters[0].bus.control());
    let converter = |wires| converter(wires, configuration::SPIN_CONVERTER).clocked();
    SpinSensors { converters: converters.map(converter), reader }
}

/// Converter with its data-ready line.
fn converter(wires: ConverterWires, configuration: Conversion) -> Converter {
    Ads1262::new(wires.bus, wires.ready, Delay, configuration)
}

/// Gyro with its scale and saturation limit.
fn gyro(converter: Converter, settings: &settings::Gyro) -> Result<Gyro, SetupError> {
    let scale = settings.scale(configuration::CONVERTER.gain)?;
    Ok(AnalogueGyro { converter, scale, limit: settings.limit() })
}

/// Accelerometer with the output rate of this carrier.
fn accelerometer(bus: Device) -> Accelerometer {
    Adxl355::new(bus, Delay, force())
}

/// Connects the motor to its wires.
#[must_use]
pub fn motor(wires: Device) -> AxisMotor {
    Tmc5160::new(wires, Delay, drive())
}

/// Output rate of the accelerometer. Its filter delays a force by two and a half outputs, during
/// which a platform must not turn far, nor a vehicle sway; a vehicle's is read 400 times a second.
fn force() -> OutputRate {
    match PLATFORM {
        Platform::Stage | Platform::TwoFrame | Platform::Spin => OutputRate::default(),
        Platform::Turntable => OutputRate::Hz1000,
        Platform::Vehicle => OutputRate::Hz500,
    }
}

/// Configuration of the motor driver. On a platform that rotates without limit the index mark passes
/// the switch, and does not stop it.
fn drive() -> Motor {
    let usual = Motor::default();
    let do_stop = PLATFORM != Platform::Turntable;
    Motor { switches: Switches { do_stop, ..usual.switches }, ..usual }
}

//! The chips on their wires, as the instrument's ports.

use drivers::ads1262::Ads1262;
use drivers::adxl355::registers::OutputRate;
use drivers::adxl355::{self, Adxl355};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::Tmc5160;
use drivers::tmc5160::configuration::{Configuration as Motor, Switches};
use embassy_time::Delay;
use firmware::chips::{
    AnalogueGyro, AnalogueSensor, PlatformAccelerometer, StageEncoder, StageMotor,
};
use firmware::ports::{NoBase, Sensors, SpinSensors, VehicleSensors};

use crate::configuration;
use crate::configuration::{CARRIER, Carrier};
use crate::wiring::{ConverterWires, Device, Ready, SensorWires};

/// Gyro behind its converter.
type Gyro = AnalogueGyro<Device, Ready, Delay>;
/// Accelerometer on the platform, or in the vehicle.
type Accelerometer = PlatformAccelerometer<Device, Delay>;
/// Sensors of a stage or a rotating platform.
pub type Inputs = Sensors<Gyro, Accelerometer, StageEncoder<Device, Delay>>;
/// Sensors of a vehicle.
pub type Triad = VehicleSensors<Gyro, Accelerometer>;
/// Sensors of a spinning body.
pub type Spinning = SpinSensors<AnalogueSensor<Device, Ready, Delay>>;

/// Connects the sensors of a stage to their wires.
pub fn inputs(wires: SensorWires) -> Inputs {
    let SensorWires { converter, others: _, more: _, accelerometer, encoder } = wires;
    Sensors {
        gyro: gyro(self::converter(converter)),
        accelerometer: self::accelerometer(accelerometer),
        encoder: StageEncoder(Mt6835::new(encoder, Delay, mt6835::Configuration::default())),
        base: NoBase,
    }
}

/// Connects the sensors of a vehicle to their wires.
pub fn triad(wires: SensorWires) -> Triad {
    let SensorWires { converter, others: [right, down], more: _, accelerometer, encoder: _ } =
        wires;
    VehicleSensors {
        gyros: [converter, right, down].map(|wires| gyro(self::converter(wires).clocked())),
        accelerometer: self::accelerometer(accelerometer),
    }
}

/// Connects the sensors of a spinning body to their wires: gyros about x, y and z, accelerometers
/// along y and z.
pub fn spinning(wires: SensorWires) -> Spinning {
    let SensorWires { converter, others: [right, up], more, accelerometer: _, encoder: _ } = wires;
    let [force_up, force_right] = more.connect();
    SpinSensors([converter, up, right, force_up, force_right].map(|wires| {
        let rate = configuration::SPIN_CONVERTER;
        AnalogueSensor(Ads1262::new(wires.bus, wires.ready, Delay, rate).clocked())
    }))
}

/// Converter with its data-ready line.
fn converter(wires: ConverterWires) -> Ads1262<Device, Ready, Delay> {
    Ads1262::new(wires.bus, wires.ready, Delay, configuration::CONVERTER)
}

/// Gyro with its scale and saturation limit.
fn gyro(converter: Ads1262<Device, Ready, Delay>) -> Gyro {
    AnalogueGyro { converter, scale: configuration::SCALE, limit: configuration::LIMIT }
}

/// Accelerometer with the output rate of this carrier.
fn accelerometer(bus: Device) -> Accelerometer {
    PlatformAccelerometer(Adxl355::new(bus, Delay, force()))
}

/// Connects the motor to its wires.
pub fn motor(wires: Device) -> StageMotor<Device, Delay> {
    StageMotor(Tmc5160::new(wires, Delay, drive()))
}

/// Configuration of the accelerometer. Its filter delays a force by two and a half outputs, during
/// which a platform must not turn far, nor a vehicle sway; a vehicle's is read 400 times a second.
fn force() -> adxl355::Configuration {
    let rate = match CARRIER {
        Carrier::Stage | Carrier::SpinningBody => adxl355::Configuration::default().rate,
        Carrier::Turntable => OutputRate::Hz1000,
        Carrier::Vehicle => OutputRate::Hz500,
    };
    adxl355::Configuration { rate }
}

/// Configuration of the motor driver. A platform that rotates without limit has no switches.
fn drive() -> Motor {
    let usual = Motor::default();
    let none = Switches { left: None, right: None };
    Motor { switches: if CARRIER == Carrier::Turntable { none } else { usual.switches }, ..usual }
}

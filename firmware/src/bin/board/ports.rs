//! The chips on their wires, as the instrument's ports.

use drivers::ads1262::Ads1262;
use drivers::adxl355::registers::OutputRate;
use drivers::adxl355::{self, Adxl355};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::Tmc5160;
use drivers::tmc5160::configuration::{Configuration as Motor, Switches};
use embassy_time::Delay;
use firmware::chips::{AnalogueGyro, PlatformAccelerometer, StageEncoder, StageMotor};
use firmware::ports::{NoBase, NoRecorder, Ports, Sensors};

use crate::configuration;
use crate::wiring::{Device, Link, Ready, SensorWires};

/// The sensors.
pub type Inputs = Sensors<
    AnalogueGyro<Device, Ready, Delay>,
    PlatformAccelerometer<Device, Delay>,
    StageEncoder<Device, Delay>,
>;
/// The other ports.
pub type Outputs = Ports<StageMotor<Device, Delay>, Link, NoRecorder>;

/// The sensors on their wires.
pub fn inputs(wires: SensorWires) -> Inputs {
    let SensorWires { converter, ready, accelerometer, encoder } = wires;
    let accelerometer = Adxl355::new(accelerometer, Delay, force());
    Sensors {
        gyro: AnalogueGyro {
            converter: Ads1262::new(converter, ready, Delay, configuration::CONVERTER),
            scale: configuration::SCALE,
            limit: configuration::LIMIT,
        },
        accelerometer: PlatformAccelerometer(accelerometer),
        encoder: StageEncoder(Mt6835::new(encoder, Delay, mt6835::Configuration::default())),
        base: NoBase,
    }
}

/// The other ports on their wires.
pub fn outputs(motor: Device, link: Link) -> Outputs {
    let motor = Tmc5160::new(motor, Delay, drive());
    Ports { actuator: StageMotor(motor), link, recorder: NoRecorder }
}

/// The accelerometer. Its filter delays a force by two and a half outputs, in which a platform that turns
/// is not to turn far.
fn force() -> adxl355::Configuration {
    let usual = adxl355::Configuration::default();
    let rate = if configuration::TURNS { OutputRate::Hz1000 } else { usual.rate };
    adxl355::Configuration { rate }
}

/// The motor driver. A platform that turns without end has no switches.
fn drive() -> Motor {
    let usual = Motor::default();
    let none = Switches { left: None, right: None };
    Motor { switches: if configuration::TURNS { none } else { usual.switches }, ..usual }
}

//! The chips on their wires, as the instrument's ports.

use drivers::ads1262::Ads1262;
use drivers::adxl355::{self, Adxl355};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::{Tmc5160, configuration::Configuration as Motor};
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
    let accelerometer = Adxl355::new(accelerometer, Delay, adxl355::Configuration::default());
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
    let motor = Tmc5160::new(motor, Delay, Motor::default());
    Ports { actuator: StageMotor(motor), link, recorder: NoRecorder }
}

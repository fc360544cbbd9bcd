//! The board of a two-frame mount: six chips on one bus around one gimbal.
//!
//! The outer frame has the select lines of a stage's encoder and actuator, the inner frame lines of its
//! own. A motor driver that loses its supply stops its own frame alone.

use embassy_time::Instant;

use super::Gimbal;
use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::assembly::{Board, Chips, Task};
use crate::chip::Select;
use crate::mt6835::Mt6835;
use crate::tmc5160::{Oscillator, Tmc5160};

/// The chips of a two-frame mount; the outer frame has the encoder and the actuator of a stage.
#[derive(Clone, Debug)]
pub struct GimbalChips {
    /// The converter of the gyro in the inner frame.
    pub gyro: Ads1262,
    /// The accelerometer on the base.
    accelerometer: Adxl355,
    /// The encoders of the outer and the inner frame.
    encoders: [Mt6835; 2],
    /// The motor drivers of the outer and the inner frame.
    pub actuators: [Tmc5160; 2],
}

/// The gimbal with its chips.
pub type GimbalBoard<'a> = Board<'a, Gimbal<'a>, GimbalChips>;

impl<'a> GimbalBoard<'a> {
    /// A board that gets its supply at the start of the clock and does not lose it; both motor drivers run
    /// from an oscillator of this kind.
    pub fn new(gimbal: Gimbal<'a>, oscillator: Oscillator) -> Self {
        let chips = GimbalChips {
            gyro: Ads1262::default(),
            accelerometer: Adxl355::new(Instant::MIN),
            encoders: [(); 2].map(|()| Mt6835::new(Instant::MIN)),
            actuators: [(); 2].map(|()| Tmc5160::new(oscillator, Instant::MIN)),
        };
        Self { plant: gimbal, chips, blackouts: &[] }
    }
}

impl<'a> Chips<Gimbal<'a>> for GimbalChips {
    // The frames move before they are measured.
    const SELECTS: &'static [Select] = &[
        Select::Actuator,
        Select::InnerActuator,
        Select::Gyro,
        Select::Accelerometer,
        Select::Encoder,
        Select::InnerEncoder,
    ];

    fn with(&mut self, plant: &mut Gimbal<'a>, select: Select, task: Task) {
        match select {
            Select::Gyro => task.perform(&mut self.gyro, plant),
            Select::Accelerometer => task.perform(&mut self.accelerometer, plant),
            Select::Encoder => task.perform(&mut self.encoders[0], &mut plant.outer),
            Select::InnerEncoder => task.perform(&mut self.encoders[1], &mut plant.inner),
            Select::Actuator => task.perform(&mut self.actuators[0], &mut plant.outer.drive),
            Select::InnerActuator => task.perform(&mut self.actuators[1], &mut plant.inner.drive),
            _ => {}
        }
    }

    fn move_on(plant: &mut Gimbal<'a>, now: Instant) {
        plant.advance(now);
    }

    fn lose(plant: &mut Gimbal<'a>, select: Select, now: Instant) {
        match select {
            Select::Actuator => plant.outer.drive.stop(now),
            Select::InnerActuator => plant.inner.drive.stop(now),
            _ => {}
        }
    }
}

//! The board of a two-frame mount: six chips on one bus around one gimbal.
//!
//! At equal times the actuators act first.

use embassy_time::Instant;

use super::Gimbal;
use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::assembly::{Assembly, Task};
use crate::chip::{Select, SpiChip};
use crate::fault::Blackout;
use crate::mt6835::Mt6835;
use crate::tmc5160::{Oscillator, Tmc5160};
use crate::violation::Violations;

/// The chips of the board, in the order in which they act at equal times: the frames move before they
/// are measured.
pub const CHIPS: [Select; 6] = [
    Select::Actuator,
    Select::InnerActuator,
    Select::Gyro,
    Select::Accelerometer,
    Select::Encoder,
    Select::InnerEncoder,
];

/// The gimbal with its chips; the outer frame has the encoder and the actuator of a stage.
#[derive(Clone, Debug)]
pub struct GimbalBoard<'a> {
    /// What the chips measure and move.
    pub gimbal: Gimbal<'a>,
    gyro: Ads1262,
    accelerometer: Adxl355,
    encoders: [Mt6835; 2],
    actuators: [Tmc5160; 2],
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<'a> GimbalBoard<'a> {
    /// A board that gets its supply at the start of the clock.
    #[must_use]
    pub fn new(gimbal: Gimbal<'a>, oscillator: Oscillator) -> Self {
        Self {
            gimbal,
            gyro: Ads1262::new(),
            accelerometer: Adxl355::new(Instant::MIN),
            encoders: [(); 2].map(|()| Mt6835::new(Instant::MIN)),
            actuators: [(); 2].map(|()| Tmc5160::new(oscillator, Instant::MIN)),
            blackouts: &[],
        }
    }

    /// What was done to a chip that its data sheet forbids.
    #[must_use]
    pub fn violations(&self, select: Select) -> &Violations {
        match select {
            Select::Accelerometer => SpiChip::<Gimbal>::violations(&self.accelerometer),
            Select::Encoder => SpiChip::<super::Side>::violations(&self.encoders[0]),
            Select::InnerEncoder => SpiChip::<super::Side>::violations(&self.encoders[1]),
            Select::Actuator => SpiChip::<super::Side>::violations(&self.actuators[0]),
            Select::InnerActuator => SpiChip::<super::Side>::violations(&self.actuators[1]),
            _ => SpiChip::<Gimbal>::violations(&self.gyro),
        }
    }

    /// Lets everything happen that is due until `now`, that moment included.
    pub fn advance(&mut self, now: Instant) {
        Assembly::advance(self, now);
    }
}

impl Assembly for GimbalBoard<'_> {
    const CHIPS: &'static [Select] = &CHIPS;

    fn with(&mut self, select: Select, task: &mut impl Task) {
        let Self { gimbal, gyro, accelerometer, encoders, actuators, .. } = self;
        let ([outer_encoder, inner_encoder], [outer_actuator, inner_actuator]) =
            (encoders, actuators);
        match select {
            Select::Gyro => task.perform(gyro, gimbal),
            Select::Accelerometer => task.perform(accelerometer, gimbal),
            Select::Encoder => task.perform(outer_encoder, &mut gimbal.outer()),
            Select::InnerEncoder => task.perform(inner_encoder, &mut gimbal.inner()),
            Select::Actuator => task.perform(outer_actuator, &mut gimbal.outer()),
            Select::InnerActuator => task.perform(inner_actuator, &mut gimbal.inner()),
            _ => {}
        }
    }

    fn move_on(&mut self, now: Instant) {
        self.gimbal.advance(now);
    }

    fn blackouts(&self) -> &[Blackout] {
        self.blackouts
    }

    fn drop_blackout(&mut self) {
        self.blackouts = self.blackouts.get(1..).unwrap_or_default();
    }

    fn lose(&mut self, select: Select, now: Instant) {
        match select {
            Select::Actuator => self.gimbal.outer().stop_motor(now),
            Select::InnerActuator => self.gimbal.inner().stop_motor(now),
            _ => {}
        }
    }
}

//! The board of a two-frame mount: six chips on one bus around one gimbal.
//!
//! The outer frame has the select lines of a stage's encoder and actuator, the inner frame lines of its
//! own. A motor driver that loses its supply stops its own frame alone.

use embassy_time::Instant;

use super::{Gimbal, Side};
use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::assembly::{Assembly, Task};
use crate::chip::{Select, SpiChip};
use crate::fault::Blackout;
use crate::mt6835::Mt6835;
use crate::tmc5160::{Oscillator, Tmc5160};
use crate::violation::Violations;

/// The gimbal with its chips; the outer frame has the encoder and the actuator of a stage.
#[derive(Clone, Debug)]
pub struct GimbalBoard<'a> {
    /// What the chips measure and move.
    pub gimbal: Gimbal<'a>,
    /// The converter of the gyro in the inner frame.
    gyro: Ads1262,
    /// The accelerometer on the base.
    accelerometer: Adxl355,
    /// The encoders of the outer and the inner frame.
    encoders: [Mt6835; 2],
    /// The motor drivers of the outer and the inner frame.
    actuators: [Tmc5160; 2],
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<'a> GimbalBoard<'a> {
    /// A board that gets its supply at the start of the clock and does not lose it; both motor drivers run
    /// from an oscillator of this kind.
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
}

impl Assembly for GimbalBoard<'_> {
    // The frames move before they are measured.
    const CHIPS: &'static [Select] = &[
        Select::Actuator,
        Select::InnerActuator,
        Select::Gyro,
        Select::Accelerometer,
        Select::Encoder,
        Select::InnerEncoder,
    ];

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

    fn violations(&self, select: Select) -> Option<&Violations> {
        Some(match select {
            Select::Gyro => SpiChip::<Gimbal>::violations(&self.gyro),
            Select::Accelerometer => SpiChip::<Gimbal>::violations(&self.accelerometer),
            Select::Encoder => SpiChip::<Side>::violations(&self.encoders[0]),
            Select::InnerEncoder => SpiChip::<Side>::violations(&self.encoders[1]),
            Select::Actuator => SpiChip::<Side>::violations(&self.actuators[0]),
            Select::InnerActuator => SpiChip::<Side>::violations(&self.actuators[1]),
            _ => return None,
        })
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

//! The board of a single-axis stage: four chips on one bus around one plant.
//!
//! The chips are of any type, so that a test can put its own in their place. At equal times the actuator
//! acts first: the stage moves before it is measured, and a conversion sees it where it was when the
//! conversion ended.

use embassy_time::Instant;

use crate::assembly::{Assembly, Task};
use crate::chip::{Select, SpiChip};
use crate::fault::Blackout;
use crate::plant::Plant;
use crate::violation::Violations;

/// The plant of a single-axis stage with the converter `G` of the gyro, the accelerometer `A`, the encoder
/// `E` and the motor driver `M`. Its one frame answers on the select lines of an inner frame too.
#[derive(Clone, Debug)]
pub struct Board<'a, G, A, E, M> {
    /// What the chips measure and move.
    pub plant: Plant<'a>,
    /// The converter of the precise gyro.
    pub gyro: G,
    /// The accelerometer on the platform.
    pub accelerometer: A,
    /// The encoder of the stage.
    pub encoder: E,
    /// The motor driver of the stage.
    pub actuator: M,
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<'a, G, A, E, M> Assembly for Board<'a, G, A, E, M>
where
    G: SpiChip<Plant<'a>>,
    A: SpiChip<Plant<'a>>,
    E: SpiChip<Plant<'a>>,
    M: SpiChip<Plant<'a>>,
{
    // The stage moves before it is measured.
    const CHIPS: &'static [Select] =
        &[Select::Actuator, Select::Gyro, Select::Accelerometer, Select::Encoder];

    fn with(&mut self, select: Select, task: &mut impl Task) {
        let Self { plant, gyro, accelerometer, encoder, actuator, .. } = self;
        match select {
            Select::Accelerometer => task.perform(accelerometer, plant),
            Select::Encoder | Select::InnerEncoder => task.perform(encoder, plant),
            Select::Actuator | Select::InnerActuator => task.perform(actuator, plant),
            _ => task.perform(gyro, plant),
        }
    }

    fn violations(&self, select: Select) -> Option<&Violations> {
        Some(match select {
            Select::Accelerometer => self.accelerometer.violations(),
            Select::Encoder | Select::InnerEncoder => self.encoder.violations(),
            Select::Actuator | Select::InnerActuator => self.actuator.violations(),
            _ => self.gyro.violations(),
        })
    }

    fn move_on(&mut self, now: Instant) {
        self.plant.advance(now);
    }

    fn lose(&mut self, select: Select, now: Instant) {
        if select == Select::Actuator {
            self.plant.stop_motor(now);
        }
    }

    fn blackouts(&self) -> &[Blackout] {
        self.blackouts
    }

    fn drop_blackout(&mut self) {
        self.blackouts = self.blackouts.get(1..).unwrap_or_default();
    }
}

//! The board of a single-axis stage: four chips on one bus around one plant.
//!
//! The chips are of any type, so that a test can put its own in their place. At equal times the actuator
//! acts first: the stage moves before it is measured, and a conversion sees it where it was when the
//! conversion ended.

use embassy_time::Instant;

use crate::assembly::{Board, Chips, Task};
use crate::chip::{Select, SpiChip};
use crate::plant::Plant;

/// The converter `G` of the gyro, the accelerometer `A`, the encoder `E` and the motor driver `M` of a
/// single-axis stage.
#[derive(Clone, Debug)]
pub struct StageChips<G, A, E, M> {
    /// The converter of the precise gyro.
    pub gyro: G,
    /// The accelerometer on the platform.
    pub accelerometer: A,
    /// The encoder of the stage.
    pub encoder: E,
    /// The motor driver of the stage.
    pub actuator: M,
}

/// The plant of a single-axis stage with its chips.
pub type StageBoard<'a, G, A, E, M> = Board<'a, Plant<'a>, StageChips<G, A, E, M>>;

impl<'a, G, A, E, M> Chips<Plant<'a>> for StageChips<G, A, E, M>
where
    G: SpiChip<Plant<'a>>,
    A: SpiChip<Plant<'a>>,
    E: SpiChip<Plant<'a>>,
    M: SpiChip<Plant<'a>>,
{
    // The stage moves before it is measured.
    const SELECTS: &'static [Select] =
        &[Select::Actuator, Select::Gyro, Select::Accelerometer, Select::Encoder];

    fn with(&mut self, plant: &mut Plant<'a>, select: Select, task: Task) {
        match select {
            Select::Gyro => task.perform(&mut self.gyro, plant),
            Select::Accelerometer => task.perform(&mut self.accelerometer, plant),
            Select::Encoder => task.perform(&mut self.encoder, plant),
            Select::Actuator => task.perform(&mut self.actuator, plant),
            _ => {}
        }
    }

    fn move_on(plant: &mut Plant<'a>, now: Instant) {
        plant.advance(now);
    }

    fn lose(plant: &mut Plant<'a>, select: Select, now: Instant) {
        if select == Select::Actuator {
            plant.drive.stop(now);
        }
    }
}

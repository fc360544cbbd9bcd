//! The board: four chips on one bus around one plant.
//!
//! Before anybody touches a chip, every chip does what is due until that moment, in order of time, so
//! that a conversion sees the stage where it was when the conversion ended. At equal times the
//! actuator comes first.

use embassy_time::Instant;

use crate::chip::{ReadyLine, Rig, Select, SpiChip, Transaction};
use crate::fault::Blackout;
use crate::plant::Plant;
use crate::violation::Violations;

/// Order in which chips act at equal times: the stage moves before it is measured.
const ORDER: [Select; 4] = [Select::Actuator, Select::Gyro, Select::Accelerometer, Select::Encoder];

/// The plant of a single-axis stage, whose one frame answers for an inner one too, with the converter `G` of the gyro, the accelerometer `A`, the encoder `E` and the motor
/// driver `M`.
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

impl<'a, G, A, E, M> Board<'a, G, A, E, M>
where
    G: SpiChip<Plant<'a>>,
    A: SpiChip<Plant<'a>>,
    E: SpiChip<Plant<'a>>,
    M: SpiChip<Plant<'a>>,
{
    /// What was done to a chip that its data sheet forbids.
    #[must_use]
    pub fn violations(&self, select: Select) -> &Violations {
        self.chip(select).violations()
    }

    /// How many forbidden accesses there were to all chips.
    #[must_use]
    pub fn violation_count(&self) -> usize {
        ORDER.iter().map(|select| self.violations(*select).count()).sum()
    }

    /// Lets everything happen that is due until `now`, that moment included. A supply that is lost at
    /// the moment of a chip's event is lost before it.
    pub fn advance(&mut self, now: Instant) {
        loop {
            let event = self.next_event().filter(|(at, _)| *at <= now);
            let blackout = self.blackouts.first().filter(|blackout| blackout.at <= now).copied();
            match (event, blackout) {
                (Some((at, select)), blackout) if blackout.is_none_or(|b| at < b.at) => {
                    self.plant.advance(at);
                    let (chip, plant) = self.chip_and_plant(select);
                    chip.event(plant);
                }
                (_, Some(Blackout { select, at })) => {
                    self.blackouts = self.blackouts.get(1..).unwrap_or_default();
                    self.restart(select, at);
                }
                _ => break,
            }
        }
        self.plant.advance(now);
    }

    /// The chip that acts next, and when; the first of [`ORDER`] among equals.
    fn next_event(&self) -> Option<(Instant, Select)> {
        let events =
            ORDER.iter().filter_map(|select| Some((self.chip(*select).next_event()?, *select)));
        events.min_by_key(|(at, _)| *at)
    }

    /// Takes a chip's supply away and gives it back; a motor stops with its driver.
    fn restart(&mut self, select: Select, now: Instant) {
        if select == Select::Actuator {
            self.plant.stop_motor(now);
        }
        self.chip_and_plant(select).0.power_cycle(now);
    }

    fn chip(&self, select: Select) -> &dyn SpiChip<Plant<'a>> {
        match select {
            Select::Accelerometer => &self.accelerometer,
            Select::Encoder | Select::InnerEncoder => &self.encoder,
            Select::Actuator | Select::InnerActuator => &self.actuator,
            _ => &self.gyro,
        }
    }

    fn chip_and_plant(&mut self, select: Select) -> (&mut dyn SpiChip<Plant<'a>>, &mut Plant<'a>) {
        let chip: &mut dyn SpiChip<Plant<'a>> = match select {
            Select::Accelerometer => &mut self.accelerometer,
            Select::Encoder | Select::InnerEncoder => &mut self.encoder,
            Select::Actuator | Select::InnerActuator => &mut self.actuator,
            _ => &mut self.gyro,
        };
        (chip, &mut self.plant)
    }
}

impl<'a, G, A, E, M> Rig for Board<'a, G, A, E, M>
where
    G: SpiChip<Plant<'a>>,
    A: SpiChip<Plant<'a>>,
    E: SpiChip<Plant<'a>>,
    M: SpiChip<Plant<'a>>,
{
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]) {
        self.advance(transaction.now);
        let (chip, plant) = self.chip_and_plant(select);
        chip.transact(plant, transaction, reply);
    }

    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine {
        self.advance(now);
        self.chip(select).ready_line()
    }

    fn power_cycle(&mut self, select: Select, now: Instant) {
        self.advance(now);
        self.restart(select, now);
    }
}

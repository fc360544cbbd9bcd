//! The board of a two-frame mount: six chips on one bus around one gimbal.
//!
//! Chips act as on [`crate::board::Board`]: before anybody touches one, all do what is due until that
//! moment, in order of time, the actuators first.

use embassy_time::Instant;

use super::Gimbal;
use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::chip::{ReadyLine, Rig, Select, SpiChip, Transaction};
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
        }
    }

    /// What was done to a chip that its data sheet forbids.
    #[must_use]
    pub fn violations(&self, select: Select) -> &Violations {
        match select {
            Select::Gyro => SpiChip::<Gimbal>::violations(&self.gyro),
            Select::Accelerometer => SpiChip::<Gimbal>::violations(&self.accelerometer),
            Select::Encoder => SpiChip::<super::Side>::violations(&self.encoders[0]),
            Select::InnerEncoder => SpiChip::<super::Side>::violations(&self.encoders[1]),
            Select::Actuator => SpiChip::<super::Side>::violations(&self.actuators[0]),
            Select::InnerActuator => SpiChip::<super::Side>::violations(&self.actuators[1]),
        }
    }

    /// Lets everything happen that is due until `now`, that moment included.
    pub fn advance(&mut self, now: Instant) {
        while let Some((at, select)) = self.next_event().filter(|(at, _)| *at <= now) {
            self.gimbal.advance(at);
            self.with(select, Event);
        }
        self.gimbal.advance(now);
    }

    /// The chip that acts next, and when; the first of [`CHIPS`] among equals.
    fn next_event(&self) -> Option<(Instant, Select)> {
        let event = |select| match select {
            Select::Gyro => SpiChip::<Gimbal>::next_event(&self.gyro),
            Select::Accelerometer => SpiChip::<Gimbal>::next_event(&self.accelerometer),
            Select::Encoder | Select::InnerEncoder => None,
            Select::Actuator => SpiChip::<super::Side>::next_event(&self.actuators[0]),
            Select::InnerActuator => SpiChip::<super::Side>::next_event(&self.actuators[1]),
        };
        CHIPS.iter().filter_map(|select| Some((event(*select)?, *select))).min_by_key(|(at, _)| *at)
    }

    /// Does something with a chip in its environment.
    fn with(&mut self, select: Select, mut task: impl Task) {
        let Self { gimbal, gyro, accelerometer, encoders, actuators } = self;
        let ([outer_encoder, inner_encoder], [outer_actuator, inner_actuator]) =
            (encoders, actuators);
        match select {
            Select::Gyro => task.perform(gyro, gimbal),
            Select::Accelerometer => task.perform(accelerometer, gimbal),
            Select::Encoder => task.perform(outer_encoder, &mut gimbal.outer()),
            Select::InnerEncoder => task.perform(inner_encoder, &mut gimbal.inner()),
            Select::Actuator => task.perform(outer_actuator, &mut gimbal.outer()),
            Select::InnerActuator => task.perform(inner_actuator, &mut gimbal.inner()),
        }
    }
}

/// Something that is done with any chip.
trait Task {
    /// Does it.
    fn perform<E, C: SpiChip<E>>(&mut self, chip: &mut C, environment: &mut E);
}

/// Has a chip do what is due.
struct Event;

impl Task for Event {
    fn perform<E, C: SpiChip<E>>(&mut self, chip: &mut C, environment: &mut E) {
        chip.event(environment);
    }
}

/// Has a chip answer.
struct Answer<'t, 'b>(&'t Transaction<'b>, &'t mut [u8]);

impl Task for Answer<'_, '_> {
    fn perform<E, C: SpiChip<E>>(&mut self, chip: &mut C, environment: &mut E) {
        chip.transact(environment, self.0, self.1);
    }
}

/// Takes a chip's supply away for a moment.
struct Restart(Instant);

impl Task for Restart {
    fn perform<E, C: SpiChip<E>>(&mut self, chip: &mut C, _: &mut E) {
        chip.power_cycle(self.0);
    }
}

impl Rig for GimbalBoard<'_> {
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]) {
        self.advance(transaction.now);
        self.with(select, Answer(transaction, reply));
    }

    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine {
        self.advance(now);
        match select {
            Select::Gyro => SpiChip::<Gimbal>::ready_line(&self.gyro),
            _ => ReadyLine::default(),
        }
    }

    fn power_cycle(&mut self, select: Select, now: Instant) {
        self.advance(now);
        match select {
            Select::Actuator => self.gimbal.outer().stop_motor(now),
            Select::InnerActuator => self.gimbal.inner().stop_motor(now),
            _ => {}
        }
        self.with(select, Restart(now));
    }
}

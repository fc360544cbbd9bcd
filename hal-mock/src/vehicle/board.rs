//! The board of a vehicle: the converters of three gyros and an accelerometer on one bus.
//!
//! Chips have their own select and data-ready lines. The converters may share a START line
//! ([`StartPin`]): its rise begins their conversions in one moment. Without it each begins with its own
//! START command at the end of that command's byte. All run from clocks of the same frequency, so that
//! what began together stays together, and what began apart stays as far apart.

use core::cell::RefCell;
use core::convert::Infallible;

use embassy_time::Instant;
use embedded_hal::digital::{ErrorType, OutputPin};

use super::plant::{GyroOutput, VehiclePlant};
use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::assembly::{Assembly, Task};
use crate::chip::{Select, SpiChip};
use crate::fault::Blackout;
use crate::violation::Violations;

/// The gyros' converters, forward, right, down.
pub const GYROS: [Select; 3] = [Select::Gyro, Select::GyroRight, Select::GyroDown];

/// The chips of the board, in the order in which they act at equal times.
pub const CHIPS: [Select; 4] =
    [Select::Gyro, Select::GyroRight, Select::GyroDown, Select::Accelerometer];

/// The vehicle with its chips.
#[derive(Clone, Debug)]
pub struct VehicleBoard<'a> {
    /// What the chips measure.
    pub plant: VehiclePlant<'a>,
    /// The converters of the gyros forward, right, down.
    pub gyros: [Ads1262; 3],
    /// The accelerometer, its axes forward, right, down.
    pub accelerometer: Adxl355,
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<'a> VehicleBoard<'a> {
    /// A board that gets its supply at the start of the clock.
    #[must_use]
    pub fn new(plant: VehiclePlant<'a>) -> Self {
        Self {
            plant,
            gyros: [(); 3].map(|()| Ads1262::new()),
            accelerometer: Adxl355::new(Instant::MIN),
            blackouts: &[],
        }
    }

    /// What was done to a chip that its data sheet forbids; none of a chip that is not on this board.
    #[must_use]
    pub fn violations(&self, select: Select) -> Option<&Violations> {
        if select == Select::Accelerometer {
            return Some(SpiChip::<VehiclePlant>::violations(&self.accelerometer));
        }
        let gyro = self.gyros.get(place(select)?)?;
        Some(SpiChip::<GyroOutput>::violations(gyro))
    }

    /// Lets everything happen that is due until `now`, that moment included.
    pub fn advance(&mut self, now: Instant) {
        Assembly::advance(self, now);
    }

    /// The level of the converters' START line changes at `now`.
    pub fn set_start(&mut self, is_high: bool, now: Instant) {
        self.advance(now);
        self.gyros.iter_mut().for_each(|gyro| gyro.set_start(is_high, now));
    }
}

/// Which gyro a converter belongs to.
fn place(select: Select) -> Option<usize> {
    GYROS.iter().position(|gyro| *gyro == select)
}

impl Assembly for VehicleBoard<'_> {
    const CHIPS: &'static [Select] = &CHIPS;

    fn with(&mut self, select: Select, task: &mut impl Task) {
        let Self { plant, gyros, accelerometer, .. } = self;
        match place(select) {
            Some(axis) => task.perform(&mut gyros[axis], &mut plant.gyro(axis)),
            None if select == Select::Accelerometer => task.perform(accelerometer, plant),
            None => {}
        }
    }

    // Readings move the vehicle on.
    fn move_on(&mut self, _: Instant) {}

    fn blackouts(&self) -> &[Blackout] {
        self.blackouts
    }

    fn drop_blackout(&mut self) {
        self.blackouts = self.blackouts.get(1..).unwrap_or_default();
    }
}

/// The line that starts all three converters.
#[derive(Debug)]
pub struct StartPin<'r, 'a> {
    board: &'r RefCell<VehicleBoard<'a>>,
}

impl<'r, 'a> StartPin<'r, 'a> {
    /// The line of a board; it is low at first.
    #[must_use]
    pub const fn new(board: &'r RefCell<VehicleBoard<'a>>) -> Self {
        Self { board }
    }
}

impl ErrorType for StartPin<'_, '_> {
    type Error = Infallible;
}

impl OutputPin for StartPin<'_, '_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.board.borrow_mut().set_start(false, Instant::now());
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.board.borrow_mut().set_start(true, Instant::now());
        Ok(())
    }
}

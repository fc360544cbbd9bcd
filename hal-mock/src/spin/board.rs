//! The board of a spinning body: the converters of three gyros and two accelerometers on one bus.
//!
//! Chips have their own select and data-ready lines and share a START line ([`StartPin`]): its rise begins
//! their conversions in one moment. All run from clocks of the same frequency, so that what began together
//! stays together.

use core::cell::RefCell;
use core::convert::Infallible;

use embassy_time::Instant;
use embedded_hal::digital::{ErrorType, OutputPin};

use super::plant::{CHANNELS, SensorOutput, SpinPlant};
use crate::ads1262::Ads1262;
use crate::assembly::{Assembly, Task};
use crate::chip::{Select, SpiChip};
use crate::fault::Blackout;
use crate::violation::Violations;

/// The converters, in the order in which they act at equal times: of the gyros about x, y (up at roll
/// zero) and z (right there), of the accelerometers along y and z.
pub const CHIPS: [Select; CHANNELS] =
    [Select::Gyro, Select::GyroUp, Select::GyroRight, Select::ForceUp, Select::ForceRight];

/// The body with its chips.
#[derive(Clone, Debug)]
pub struct SpinBoard<'a> {
    /// What the chips measure.
    pub plant: SpinPlant<'a>,
    /// The converters, in the order of [`CHIPS`].
    pub converters: [Ads1262; CHANNELS],
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<'a> SpinBoard<'a> {
    /// A board that gets its supply at the start of the clock.
    #[must_use]
    pub fn new(plant: SpinPlant<'a>) -> Self {
        Self { plant, converters: [(); CHANNELS].map(|()| Ads1262::new()), blackouts: &[] }
    }

    /// What was done to a chip that its data sheet forbids; none of a chip that is not on this board.
    #[must_use]
    pub fn violations(&self, select: Select) -> Option<&Violations> {
        Some(SpiChip::<SensorOutput>::violations(&self.converters[place(select)?]))
    }

    /// Lets everything happen that is due until `now`, that moment included.
    pub fn advance(&mut self, now: Instant) {
        Assembly::advance(self, now);
    }

    /// The level of the converters' START line changes at `now`.
    pub fn set_start(&mut self, is_high: bool, now: Instant) {
        self.advance(now);
        self.converters.iter_mut().for_each(|converter| converter.set_start(is_high, now));
    }
}

/// Which sensor a converter belongs to.
fn place(select: Select) -> Option<usize> {
    CHIPS.iter().position(|chip| *chip == select)
}

impl Assembly for SpinBoard<'_> {
    const CHIPS: &'static [Select] = &CHIPS;

    fn with(&mut self, select: Select, task: &mut impl Task) {
        let Self { plant, converters, .. } = self;
        if let Some(channel) = place(select) {
            task.perform(&mut converters[channel], &mut plant.channel(channel));
        }
    }

    // Readings move the body on.
    fn move_on(&mut self, _: Instant) {}

    fn blackouts(&self) -> &[Blackout] {
        self.blackouts
    }

    fn drop_blackout(&mut self) {
        self.blackouts = self.blackouts.get(1..).unwrap_or_default();
    }
}

/// The line that starts all five converters.
#[derive(Debug)]
pub struct StartPin<'r, 'a> {
    board: &'r RefCell<SpinBoard<'a>>,
}

impl<'r, 'a> StartPin<'r, 'a> {
    /// The line of a board; it is low at first.
    #[must_use]
    pub const fn new(board: &'r RefCell<SpinBoard<'a>>) -> Self {
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

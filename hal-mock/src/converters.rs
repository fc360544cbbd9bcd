//! A board of converters: `N` of them, and where the plant gives forces an accelerometer beside them, on
//! one bus.
//!
//! Chips have their own select and data-ready lines. The converters share a START line ([`StartPin`]):
//! its rise begins their conversions in one moment. Where it stays low each begins with its own START
//! command at the end of that command's byte. All run from clocks of the same frequency, so that what
//! began together stays together, and what began apart stays as far apart.

use core::cell::RefCell;
use core::convert::Infallible;

use embassy_time::Instant;
use embedded_hal::digital::{ErrorType, OutputPin};

use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::assembly::{Assembly, Task};
use crate::chip::{Select, SpiChip};
use crate::environment::{AnalogueInput, ForceInput};
use crate::fault::Blackout;
use crate::violation::Violations;

/// What `N` converters measure.
pub trait Channels<const N: usize> {
    /// The select lines of the converters in the order of their channels, then that of the accelerometer
    /// where the plant gives forces.
    const CHIPS: &'static [Select];

    /// The mean voltage of a channel, 0 to `N` − 1, over the conversion that ends at `now`, V. Converters
    /// ask in rising order of time.
    fn volts(&mut self, channel: usize, now: Instant) -> f64;

    /// What the accelerometer feels, on a board that has one.
    fn force(&mut self) -> Option<&mut dyn ForceInput> {
        None
    }
}

/// One channel of a plant: what its converter sees.
#[derive(Debug)]
pub struct Channel<'p, P, const N: usize> {
    /// What all channels belong to.
    plant: &'p mut P,
    /// Number of the channel, 0 to `N` − 1.
    channel: usize,
}

impl<P: Channels<N>, const N: usize> AnalogueInput for Channel<'_, P, N> {
    fn volts(&mut self, now: Instant) -> f64 {
        self.plant.volts(self.channel, now)
    }
}

/// A plant `P` with its `N` converters, and with an accelerometer where it gives forces.
#[derive(Clone, Debug)]
pub struct ConverterBoard<'a, P, const N: usize> {
    /// What the chips measure.
    pub plant: P,
    /// The converters, in the order of [`Channels::CHIPS`].
    pub converters: [Ads1262; N],
    /// The accelerometer beside them.
    pub accelerometer: Option<Adxl355>,
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<P: Channels<N>, const N: usize> ConverterBoard<'_, P, N> {
    /// A board that gets its supply at the start of the clock and never loses it.
    #[must_use]
    pub fn new(mut plant: P) -> Self {
        let accelerometer = plant.force().map(|_| Adxl355::new(Instant::MIN));
        let converters = [(); N].map(|()| Ads1262::new());
        Self { plant, converters, accelerometer, blackouts: &[] }
    }

    /// The level of the converters' START line changes at `now`: all of them begin to convert with its
    /// rise and end with its fall. Everything that is due until then happens first.
    pub fn set_start(&mut self, is_high: bool, now: Instant) {
        self.advance(now);
        self.converters.iter_mut().for_each(|converter| converter.set_start(is_high, now));
    }

    /// The channel of a converter.
    fn channel(select: Select) -> Option<usize> {
        P::CHIPS.iter().take(N).position(|chip| *chip == select)
    }
}

impl<P: Channels<N>, const N: usize> Assembly for ConverterBoard<'_, P, N> {
    const CHIPS: &'static [Select] = P::CHIPS;

    fn with(&mut self, select: Select, task: &mut impl Task) {
        let Self { plant, converters, accelerometer, .. } = self;
        if let Some(channel) = Self::channel(select) {
            task.perform(&mut converters[channel], &mut Channel { plant, channel });
        } else if let (Select::Accelerometer, Some(chip), Some(force)) =
            (select, accelerometer, plant.force())
        {
            task.perform(chip, force);
        }
    }

    fn violations(&self, select: Select) -> Option<&Violations> {
        if select == Select::Accelerometer {
            return self.accelerometer.as_ref().map(SpiChip::<dyn ForceInput>::violations);
        }
        let converter = &self.converters[Self::channel(select)?];
        Some(SpiChip::<Channel<P, N>>::violations(converter))
    }

    // Readings move the plant on.
    fn move_on(&mut self, _: Instant) {}

    fn blackouts(&self) -> &[Blackout] {
        self.blackouts
    }

    fn drop_blackout(&mut self) {
        self.blackouts = self.blackouts.get(1..).unwrap_or_default();
    }
}

/// The line that starts all converters of a board.
#[derive(Debug)]
pub struct StartPin<'r, B> {
    /// The board whose converters it starts.
    board: &'r RefCell<B>,
}

impl<'r, B> StartPin<'r, B> {
    /// The START line of a board; it is low at first.
    #[must_use]
    pub const fn new(board: &'r RefCell<B>) -> Self {
        Self { board }
    }
}

impl<B> ErrorType for StartPin<'_, B> {
    type Error = Infallible;
}

impl<P: Channels<N>, const N: usize> OutputPin for StartPin<'_, ConverterBoard<'_, P, N>> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.board.borrow_mut().set_start(false, Instant::now());
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.board.borrow_mut().set_start(true, Instant::now());
        Ok(())
    }
}

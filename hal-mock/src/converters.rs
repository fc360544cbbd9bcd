//! A board of converters: `N` of them, and where the plant gives forces an accelerometer beside them, on
//! one bus.
//!
//! Chips have their own select and data-ready lines. The converters share a START line ([`ConverterBoard::set_start`]):
//! its rise begins their conversions in one moment. Where it stays low each begins with its own START
//! command at the end of that command's byte. All run from clocks of the same frequency, so that what
//! began together stays together, and what began apart stays as far apart.

use embassy_time::Instant;

use crate::ads1262::Ads1262;
use crate::adxl355::Adxl355;
use crate::assembly::{Board, Chips, Task};
use crate::chip::Select;
use crate::environment::{AnalogueInput, ForceInput};

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

/// `N` converters, and an accelerometer where the plant gives forces.
#[derive(Clone, Debug)]
pub struct Converters<const N: usize> {
    /// The converters, in the order of [`Channels::CHIPS`].
    pub converters: [Ads1262; N],
    /// The accelerometer beside them.
    pub accelerometer: Option<Adxl355>,
}

/// A plant `P` with its `N` converters, and with an accelerometer where it gives forces.
pub type ConverterBoard<'a, P, const N: usize> = Board<'a, P, Converters<N>>;

impl<P: Channels<N>, const N: usize> ConverterBoard<'_, P, N> {
    /// A board that gets its supply at the start of the clock and never loses it.
    pub fn new(mut plant: P) -> Self {
        let accelerometer = plant.force().map(|_| Adxl355::new(Instant::MIN));
        let converters = [(); N].map(|()| Ads1262::default());
        Self { plant, chips: Converters { converters, accelerometer }, blackouts: &[] }
    }

    /// The level of the converters' START line, low at first, changes at `now`: all of them begin to convert
    /// with its rise and end with its fall. Everything that is due until then happens first.
    pub fn set_start(&mut self, is_high: bool, now: Instant) {
        self.advance(now);
        self.chips.converters.iter_mut().for_each(|converter| converter.set_start(is_high, now));
    }
}

impl<P: Channels<N>, const N: usize> Chips<P> for Converters<N> {
    const SELECTS: &'static [Select] = P::CHIPS;

    fn with(&mut self, plant: &mut P, select: Select, task: Task) {
        let chips = P::CHIPS.iter().zip(&mut self.converters).enumerate();
        if let Some((channel, (_, chip))) = chips.into_iter().find(|(_, (at, _))| **at == select) {
            task.perform(chip, &mut Channel { plant, channel });
        } else if let (Select::Accelerometer, Some(chip), Some(force)) =
            (select, &mut self.accelerometer, plant.force())
        {
            task.perform(chip, force);
        }
    }
}

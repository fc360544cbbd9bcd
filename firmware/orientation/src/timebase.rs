//! The two clocks of an instrument: that by which its converters sample, and that of the controller, by
//! which it stamps samples.
//!
//! A rate times a time is an angle, so that a clock that is wrong makes all angles wrong by the same
//! ratio, as a gyro's scale factor does. Angles therefore integrate over the better of the two clocks,
//! and its tolerance belongs into the scale factor's σ. A rate alone, such as the Earth's at a dwell, and
//! an angle that an encoder shows depend on no clock.
//!
//! The Earth turns on between two samples, so that their times must be true, too, or its rate is subtracted
//! in part, as if the gyros had a bias: a stamp is corrected where a sample is made of it, and nothing but
//! samples has the corrected time. A controller without a crystal shows times that nothing corrects; a per
//! cent of the Earth's rate is small beside the bias of a gyro that was switched on.

use crate::units::Instant;

/// Source of a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// A crystal, or an oscillator with one.
    Crystal,
    /// The oscillator in an ADS1262, where nothing feeds its CLKIN.
    Converter,
    /// The oscillator MSI of a controller whose crystal does not hold it.
    Controller,
}

/// Square root of three: a tolerance over it is the standard deviation of equally likely errors.
const UNIFORM: f64 = 1.732_050_807_568_877_2;
/// Greatest relative difference of two crystals, of which each may also be a slightly wrong one.
const OF_CRYSTALS: f64 = 0.002;
/// Bits behind the point of [`Timebase::excess`].
const FRACTION: u32 = 32;
/// Nanoseconds of a microsecond.
const NANOSECONDS: u64 = 1000;

impl Clock {
    /// Greatest relative error: 100 ppm of a crystal at any temperature, 2 % of the ADS1262's oscillator
    /// (data sheet SBAS661C, §7.5, internal oscillator accuracy), 1 % of the MSI about room temperature
    /// (STM32L475 data sheet DS10969, MSI oscillator characteristics).
    #[must_use]
    pub const fn tolerance(self) -> f64 {
        match self {
            Self::Crystal => 1e-4,
            Self::Converter => 0.02,
            Self::Controller => 0.01,
        }
    }
}

/// The clocks of an instrument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timebase {
    /// Clock of the converters.
    pub converter: Clock,
    /// Clock of the controller.
    pub controller: Clock,
    /// Excess of the true time over the controller's, as a fraction of 2³².
    excess: u32,
}

impl Timebase {
    /// Clocks of which the controller's has this frequency where it should have the nominal one, which
    /// is not less, Hz.
    #[must_use]
    pub const fn new(converter: Clock, controller: Clock, [actual, nominal]: [u64; 2]) -> Self {
        let excess = (((nominal - actual) << FRACTION) / actual) as u32;
        Self { converter, controller, excess }
    }

    /// Clocks of which each shows its nominal frequency.
    #[must_use]
    pub const fn nominal(converter: Clock, controller: Clock) -> Self {
        Self { converter, controller, excess: 0 }
    }

    /// True time of a moment that the controller's clock shows, rounded down to a microsecond.
    #[inline]
    pub const fn instant(&self, shown: Instant) -> Instant {
        let excess = self.excess as u64;
        let (upper, lower) = (shown.0 >> FRACTION, shown.0 as u32 as u64);
        Instant(shown.0 + upper * excess + ((lower * excess) >> FRACTION))
    }

    /// Whether angles integrate over the periods of the converters, by their number, rather than over the
    /// time between two stamps: where a crystal feeds the converters, or none the controller, whose
    /// oscillator drifts with temperature by more than a converter's.
    #[must_use]
    pub fn counts_periods(&self) -> bool {
        self.converter == Clock::Crystal || self.controller != Clock::Crystal
    }

    /// Time over which a rate integrates to an angle, ns: so many periods of the converters, ns, between
    /// stamps that are this far apart in true time, µs.
    #[inline]
    #[must_use]
    pub fn integrated(&self, periods: u32, period: u32, elapsed: u32) -> u64 {
        if self.counts_periods() {
            u64::from(periods) * u64::from(period)
        } else {
            u64::from(elapsed) * NANOSECONDS
        }
    }

    /// Standard deviation of integrated angles by their clock, 1σ, relative.
    #[must_use]
    pub fn scale_sigma(&self) -> f64 {
        let clock = if self.counts_periods() { self.converter } else { self.controller };
        clock.tolerance() / UNIFORM
    }

    /// Standard deviation of a scale factor, 1σ, relative, with that of the clock.
    #[must_use]
    pub fn with_scale(&self, scale_sigma: f64) -> f64 {
        libm::hypot(scale_sigma, self.scale_sigma())
    }

    /// Greatest relative difference of the period that the stamps show from the nominal one: what two
    /// crystals may not differ by, or else what the data sheets allow both.
    #[must_use]
    pub fn period_tolerance(&self) -> f64 {
        if (self.converter, self.controller) == (Clock::Crystal, Clock::Crystal) {
            OF_CRYSTALS
        } else {
            self.converter.tolerance() + self.controller.tolerance()
        }
    }
}

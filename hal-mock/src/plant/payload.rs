//! What a stage or a two-frame mount carries, and how the base under it moves.

use embassy_time::Instant;

use super::journey::Journey;
use super::sway::SwayConfiguration;
use super::{PlantConfiguration, STANDARD_GRAVITY_M_S2, seconds};
use crate::disturbance::{self, Disturbance, Effect};
use crate::earth::InertialInput;
use crate::instruments::Instruments;
use crate::noise::{White, source};

/// The instruments with the gyro's output stage, the base's own motion, and the disturbances.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Payload<'a> {
    /// Gyro, accelerometer and thermometer.
    pub(crate) instruments: Instruments,
    /// Sway of the base, if it sways.
    pub(crate) sway: Option<SwayConfiguration>,
    /// Where the base goes, if it leaves.
    journey: Option<Journey<'a>>,
    /// Time between two readings of the gyro's converter and of the accelerometer, s.
    periods_s: [f64; 2],
    /// White noise of the converter, V.
    converter: White,
    /// Scale factor of the gyro, V per rad/s.
    volts_per_rad_s: f64,
    /// Rate at which the gyro's output clips, rad/s.
    full_scale_rad_s: f64,
    /// Bumps, nudges and overloads.
    disturbances: &'a [Disturbance],
}

impl<'a> Payload<'a> {
    /// A payload at the start of the clock; the seed fixes everything random in it.
    pub(crate) fn new(configuration: &PlantConfiguration<'a>, seed: u64) -> Self {
        let PlantConfiguration { instruments, accelerometer_hz, .. } = *configuration;
        Self {
            instruments: Instruments::with_accelerometer_at(&instruments, accelerometer_hz, seed),
            sway: Some(configuration.sway).filter(SwayConfiguration::is_active),
            journey: configuration.journey.map(|journey| Journey::new(&journey, &instruments)),
            periods_s: [1.0 / instruments.rate_hz, 1.0 / accelerometer_hz],
            converter: White::new(configuration.converter_noise_v, seed, source::CONVERTER),
            volts_per_rad_s: configuration.gyro_volts_per_rad_s,
            full_scale_rad_s: configuration.gyro_full_scale_rad_s,
            disturbances: configuration.disturbances,
        }
    }

    /// What a base that goes somewhere feels over the reading of the gyro's converter, 0, or of the
    /// accelerometer, 1, that ends `now`; none of a base that stays.
    #[inline]
    pub(crate) fn ridden(&mut self, chip: usize, now: Instant) -> Option<InertialInput> {
        let period_s = self.periods_s[chip];
        self.journey.as_mut().and_then(|way| way.felt(chip, seconds(now), period_s))
    }

    /// What the disturbances add at `now`.
    #[inline]
    pub(crate) fn effect(&self, now: Instant) -> Effect {
        if self.disturbances.is_empty() {
            return Effect::default();
        }
        disturbance::total(self.disturbances, seconds(now))
    }

    /// The gyro's output, V, of what the instruments feel.
    #[inline]
    pub(crate) fn volts(&mut self, now: Instant) -> f64 {
        let effect = self.effect(now);
        let limit = self.full_scale_rad_s;
        let rate_rad_s = self.instruments.rate(seconds(now), &effect).max(-limit).min(limit);
        rate_rad_s * self.volts_per_rad_s + self.converter.sample()
    }

    /// The accelerometer's output, g, of what the instruments feel with this effect added.
    #[inline]
    pub(crate) fn force_g(&mut self, effect: &Effect) -> [f64; 3] {
        self.instruments.force(effect).map(|force| force / STANDARD_GRAVITY_M_S2)
    }
}

//! The spinning body as the chips of its board see it, in virtual time.
//!
//! ```text
//!  flight ─mean ω─▶ gyro ─volts─▶ its converter, three of them
//!         ─mean f─▶ accelerometer ─volts─▶ its converter, two of them
//! ```
//!
//! A sigma-delta converter averages: every reading is the mean since the reading before it by the same
//! chip, or over one period where that is long ago. Converters that run in step see the same stretches of
//! time: what they show belongs to the middle of a stretch, half a period before it ends. Time counts from
//! the start of the clock and must not fall.

use embassy_time::Instant;

use super::body::{Body, Felt};
use super::sensors::Sensors;
use super::{SpinConfiguration, SpinTruth};
use crate::accelerometer::AccelerometerConfiguration;
use crate::chip::Select;
use crate::converters::{Channels, ConverterBoard};
use crate::noise::{White, source};
use crate::plant::seconds;
use crate::strapdown::gyro_seeds;

/// How many converters there are: of the gyros about x, y and z, of the accelerometers along y and z.
pub const CHANNELS: usize = 5;
/// How many of them belong to gyros.
const GYROS: usize = 3;
/// The converters, in the order in which they act at equal times: of the gyros about x, y (up at roll
/// zero) and z (right there), of the accelerometers along y and z.
pub const CHIPS: [Select; CHANNELS] =
    [Select::Gyro, Select::GyroUp, Select::GyroRight, Select::ForceUp, Select::ForceRight];
/// Periods after which a reading no longer reaches back to the one before it.
const LONG_AGO: f64 = 1.5;

/// A spinning body with its analogue electronics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinPlantConfiguration<'a> {
    /// The body; `rate_hz` is the conversion rate of the converters (default 14 400 Hz: the next that an
    /// ADS1262 has above the paper's 10 kHz). Sensors clip before the converter; gaps are those of the bus
    /// and not looked at.
    pub body: SpinConfiguration<'a>,
    /// Scale factors of the gyros about x, y and z, V per rad/s (default 2 V at 700 rad/s, and at 20 rad/s
    /// across).
    pub gyro_volts_per_rad_s: [f64; 3],
    /// Scale factor of the accelerometers, V per m/s² (default 2 V at 10 km/s²).
    pub volts_per_m_s2: f64,
    /// White noise of each converter, V RMS per conversion.
    pub converter_noise_v: f64,
}

impl Default for SpinPlantConfiguration<'_> {
    /// Perfect sensors on the paper's body.
    fn default() -> Self {
        Self {
            body: SpinConfiguration {
                rate_hz: 14_400.0,
                gyro_full_scale_rad_s: [700.0, 20.0, 20.0],
                accelerometer: AccelerometerConfiguration {
                    full_scale_m_s2: Some(10_000.0),
                    ..AccelerometerConfiguration::default()
                },
                ..SpinConfiguration::default()
            },
            gyro_volts_per_rad_s: [2.0 / 700.0, 0.1, 0.1],
            volts_per_m_s2: 2e-4,
            converter_noise_v: 0.0,
        }
    }
}

/// The plant at work.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinPlant<'a> {
    /// The body in flight.
    body: Body<'a>,
    /// What is fixed to it.
    sensors: Sensors<'a>,
    /// White noise of each converter, V.
    converters: [White; CHANNELS],
    /// Scale factors of the gyros about x, y and z, V per rad/s.
    gyro_volts_per_rad_s: [f64; 3],
    /// Scale factor of the accelerometers, V per m/s².
    volts_per_m_s2: f64,
    /// Period of a conversion, s.
    period_s: f64,
    /// When each converter read last, s.
    marks_s: [f64; CHANNELS],
    /// The latest stretch of time and what was felt over it: converters in step share it.
    latest: ([f64; 2], Felt),
    /// What the accelerometer along z shows of the stretch in which that along y was read, m/s².
    force_z: Option<(f64, f64)>,
}

/// The body with its chips: the converters of three gyros and two accelerometers on one bus.
pub type SpinBoard<'a> = ConverterBoard<'a, SpinPlant<'a>, CHANNELS>;

impl<'a> SpinPlant<'a> {
    /// A plant at the start of the clock; the seed fixes everything random in it.
    #[must_use]
    #[inline(never)]
    pub fn new(configuration: &SpinPlantConfiguration<'a>, seed: u64) -> Self {
        let c = configuration;
        let [x, y, z] = gyro_seeds(seed, source::SPIN_GYROS);
        // Each converter a stream of its own, off those of the gyros.
        let converter = |own| White::new(c.converter_noise_v, own, source::CONVERTER);
        Self {
            body: Body::new(&c.body),
            sensors: Sensors::new(&c.body, seed),
            converters: [x, y, z, !x, !y].map(converter),
            gyro_volts_per_rad_s: c.gyro_volts_per_rad_s,
            volts_per_m_s2: c.volts_per_m_s2,
            period_s: 1.0 / c.body.rate_hz,
            marks_s: [0.0; CHANNELS],
            latest: Default::default(),
            force_z: None,
        }
    }

    /// The truth at a moment, which is not before the latest reading's half period.
    pub fn truth_at(&self, now: Instant) -> SpinTruth {
        let time_s = seconds(now);
        let mut body = self.body.clone();
        body.advance(time_s);
        SpinTruth::of(&body, &self.sensors, time_s)
    }

    /// Means over the sample of a converter that ends at a time in s.
    fn felt(&mut self, channel: usize, time_s: f64) -> Felt {
        let mark_s = self.marks_s[channel];
        let is_new = time_s - mark_s > LONG_AGO * self.period_s;
        let from_s = if is_new { time_s - self.period_s } else { mark_s };
        self.marks_s[channel] = time_s;
        if self.latest.0 != [from_s, time_s] {
            self.body.advance(time_s);
            self.latest = ([from_s, time_s], self.body.means(from_s, time_s));
        }
        self.latest.1
    }

    /// What a sensor shows of its latest stretch, V.
    fn shown(&mut self, channel: usize, time_s: f64) -> f64 {
        let felt = self.felt(channel, time_s);
        if let Some(volts_per_rad_s) = self.gyro_volts_per_rad_s.get(channel) {
            return volts_per_rad_s * self.sensors.rate(channel, time_s, felt.rate_rad_s[channel]);
        }
        self.volts_per_m_s2 * self.force(channel - GYROS, time_s, felt.force_m_s2)
    }

    /// What an accelerometer shows, m/s². Both draw together: the one along z is kept for its converter.
    fn force(&mut self, axis: usize, time_s: f64, force_m_s2: [f64; 2]) -> f64 {
        if axis == 1
            && let Some((_, force)) = self.force_z.take().filter(|(at_s, _)| *at_s == time_s)
        {
            return force;
        }
        let shown = self.sensors.force(time_s, force_m_s2);
        self.force_z = (axis == 0).then_some((time_s, shown[1]));
        shown[axis]
    }
}

/// Channels 0 to 2 are the gyros about x, y and z, 3 and 4 the accelerometers along y and z.
impl Channels<CHANNELS> for SpinPlant<'_> {
    const CHIPS: &'static [Select] = &CHIPS;

    fn volts(&mut self, channel: usize, now: Instant) -> f64 {
        self.shown(channel, seconds(now)) + self.converters[channel].sample()
    }
}

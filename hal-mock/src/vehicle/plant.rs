//! The vehicle as the chips of its board see it, in virtual time.
//!
//! ```text
//!  motion ─∫ω─▶ gyro ─volts─▶ its converter, three of them      ∫f ─force─▶ accelerometer
//! ```
//!
//! Every reading is a mean (module `averaged`): chips that run in step see the same stretches of time,
//! others each its own. Time counts from the start of the
//! clock and must not fall.

use embassy_time::Instant;

use super::averaged::Averaged;
use super::sensors::Sensors;
use super::{VehicleConfiguration, VehicleTruth};
use crate::chip::Select;
use crate::converters::{Channels, ConverterBoard};
use crate::earth::InertialInput;
use crate::environment::ForceInput;
use crate::noise::{White, source};
use crate::plant::{DEGREE_PER_SECOND, STANDARD_GRAVITY_M_S2, seconds};
use crate::strapdown::gyro_seeds;
use crate::temperature::Thermometer;

/// The select lines of the gyros' converters: forward, right, down.
pub const GYROS: [Select; 3] = [Select::Gyro, Select::GyroRight, Select::GyroDown];

/// The chips of the board, in the order in which they act at equal times: the converters of [`GYROS`],
/// then the accelerometer, its axes forward, right, down.
pub const CHIPS: [Select; 4] = [GYROS[0], GYROS[1], GYROS[2], Select::Accelerometer];

/// Whose reading of the accelerometer is marked, behind the three gyros.
const ACCELEROMETER: usize = 3;

/// A vehicle with the analogue electronics of its gyros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehiclePlantConfiguration<'a> {
    /// The vehicle; `rate_hz` is the conversion rate of the converters. The gyros' full scale (default
    /// 40 °/s: ±2 V) clips before the converter; gaps are those of the bus and not looked at.
    pub vehicle: VehicleConfiguration<'a>,
    /// Output rate of the accelerometer, Hz, > 0 (default 125).
    pub accelerometer_hz: f64,
    /// Scale factor of the gyros, V per rad/s (default 50 mV per °/s).
    pub gyro_volts_per_rad_s: f64,
    /// White noise of each converter, V RMS per conversion.
    pub converter_noise_v: f64,
}

impl Default for VehiclePlantConfiguration<'_> {
    /// Perfect sensors in a vehicle that has nowhere to go.
    fn default() -> Self {
        Self {
            vehicle: VehicleConfiguration {
                gyro_full_scale_rad_s: 40.0 * DEGREE_PER_SECOND,
                ..VehicleConfiguration::default()
            },
            accelerometer_hz: 125.0,
            gyro_volts_per_rad_s: 0.05 / DEGREE_PER_SECOND,
            converter_noise_v: 0.0,
        }
    }
}

/// The plant at work.
#[derive(Clone, Debug, PartialEq)]
pub struct VehiclePlant<'a> {
    /// For each gyro's converter and for the accelerometer.
    motion: Averaged<'a, 4>,
    /// What is fixed to the vehicle.
    sensors: Sensors<'a>,
    /// The thermometer of the accelerometer.
    thermometer: Thermometer,
    /// White noise of each converter, V.
    converters: [White; 3],
    /// Scale factor of the gyros, V per rad/s.
    volts_per_rad_s: f64,
    /// Periods of a converter and of the accelerometer, s.
    periods_s: [f64; 2],
}

/// The vehicle with its chips: the converters of three gyros and an accelerometer on one bus.
pub type VehicleBoard<'a> = ConverterBoard<'a, VehiclePlant<'a>, 3>;

impl<'a> VehiclePlant<'a> {
    /// A plant at the start of the clock; the seed fixes everything random in it.
    #[must_use]
    #[inline(never)]
    pub fn new(configuration: &VehiclePlantConfiguration<'a>, seed: u64) -> Self {
        let c = configuration;
        let converter = |own| White::new(c.converter_noise_v, own, source::CONVERTER);
        Self {
            motion: Averaged::new(c.vehicle.motion()),
            sensors: Sensors::new(&c.vehicle, c.accelerometer_hz, seed),
            thermometer: Thermometer::new(&c.vehicle.temperature, seed),
            converters: gyro_seeds(seed, source::VEHICLE_GYROS).map(converter),
            volts_per_rad_s: c.gyro_volts_per_rad_s,
            periods_s: [1.0 / c.vehicle.rate_hz, 1.0 / c.accelerometer_hz],
        }
    }

    /// What the sensors cannot know, as of the latest reading.
    pub fn truth(&self) -> VehicleTruth {
        self.sensors.truth(&self.motion.motion)
    }

    /// The truth at `now`, which is not before the latest reading.
    pub fn truth_at(&self, now: Instant) -> VehicleTruth {
        let mut motion = self.motion.motion.clone();
        motion.advance(seconds(now));
        self.sensors.truth(&motion)
    }

    /// Means over the sample of a chip that ends at a time in s.
    fn felt(&mut self, chip: usize, time_s: f64) -> InertialInput {
        self.motion.felt(chip, time_s, self.periods_s[chip / ACCELEROMETER])
    }
}

/// The accelerometer's axes are those of the vehicle.
impl ForceInput for VehiclePlant<'_> {
    fn force_g(&mut self, now: Instant) -> [f64; 3] {
        let time_s = seconds(now);
        let felt = self.felt(ACCELEROMETER, time_s);
        self.sensors.force(time_s, &felt).map(|force| force / STANDARD_GRAVITY_M_S2)
    }

    fn temperature_c(&mut self, now: Instant) -> f64 {
        self.thermometer.sample(seconds(now))
    }
}

/// Channels 0 to 2 are the gyros forward, right, down.
impl Channels<3> for VehiclePlant<'_> {
    const CHIPS: &'static [Select] = &CHIPS;

    fn volts(&mut self, axis: usize, now: Instant) -> f64 {
        let time_s = seconds(now);
        let felt = self.felt(axis, time_s);
        let rate_rad_s = self.sensors.rate(axis, time_s, &felt);
        rate_rad_s * self.volts_per_rad_s + self.converters[axis].sample()
    }

    fn force(&mut self) -> Option<&mut dyn ForceInput> {
        Some(self)
    }
}

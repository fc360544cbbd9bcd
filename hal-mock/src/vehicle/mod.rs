//! A vehicle that stands and drives on the rotating Earth, with three gyros and three accelerometers
//! fixed to it, axes forward, right, down: sample by sample, as a recording of kind `imu`.
//!
//! A list of legs says when it stands and how it drives; everything changes smoothly. A sample carries
//! integrals over its time, as an integrating strapdown unit gives them: the three angles are true
//! integrals of the body's inertial rate, not a rotation vector, so that coning is left to who uses
//! them. Time counts from the start; the first sample ends one period after it.

pub(crate) mod averaged;
mod event;
mod leg;
pub mod motion;
mod place;
pub mod plant;
mod route;
pub mod scenario;
mod sensors;
mod smooth;

pub use self::event::Event;
pub use self::leg::{Drive, Leg, Stop};
use self::motion::{Integrals, Motion};
pub use self::place::Position;
use self::sensors::Sensors;
use self::smooth::Smooth;
use crate::accelerometer::AccelerometerConfiguration;
use crate::earth::Attitude;
use crate::gyro::GyroConfiguration;
use crate::instruments::BaseMotion;
use crate::plant::sway::SwayConfiguration;
use crate::sensor_fault::SensorFault;
use crate::stage::first_sample;
use crate::temperature::TemperatureConfiguration;

/// A vehicle, its sensors, its day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleConfiguration<'a> {
    /// Geodetic latitude of the start, °, within ±89.
    pub latitude_deg: f64,
    /// True azimuth at the start, °, clockwise from north.
    pub azimuth_deg: f64,
    /// Samples per second, Hz, > 0.
    pub rate_hz: f64,
    /// The gyros forward, right, down; each draws for itself. Elevation and dynamics of a sensor on a
    /// stage are not looked at; the g-sensitivity is that along the axis and along the next one.
    pub gyros: [GyroConfiguration; 3],
    /// Rate at which a gyro clips, rad/s (default never).
    pub gyro_full_scale_rad_s: f64,
    /// The accelerometers.
    pub accelerometer: AccelerometerConfiguration,
    /// From the point about which the body sways to the sensors, m, forward, right, down; above it is
    /// negative.
    pub lever_m: [f64; 3],
    /// The warm-up.
    pub temperature: TemperatureConfiguration,
    /// The stops and drives, in order; the run ends with the last.
    pub legs: &'a [Leg],
    /// What happens to the vehicle, in any order.
    pub events: &'a [Event],
    /// What goes wrong with the sensors, in any order.
    pub faults: &'a [SensorFault],
}

impl Default for VehicleConfiguration<'_> {
    /// Perfect sensors at 100 Hz in a vehicle on the equator that faces north and has nowhere to go.
    fn default() -> Self {
        Self {
            latitude_deg: 0.0,
            azimuth_deg: 0.0,
            rate_hz: 100.0,
            gyros: [GyroConfiguration::default(); 3],
            gyro_full_scale_rad_s: f64::INFINITY,
            accelerometer: AccelerometerConfiguration::default(),
            lever_m: [0.0; 3],
            temperature: TemperatureConfiguration::default(),
            legs: &[],
            events: &[],
            faults: &[],
        }
    }
}

impl<'a> VehicleConfiguration<'a> {
    /// Length of the whole run, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.legs.iter().map(Leg::seconds).sum()
    }

    /// From when until when the vehicle stands, s, stop by stop.
    pub fn stops(&self) -> impl Iterator<Item = [f64; 2]> + 'a {
        let mut end_s = 0.0;
        self.legs.iter().filter_map(move |leg| {
            let from_s = end_s;
            end_s += leg.seconds();
            matches!(leg, Leg::Stop(_)).then_some([from_s, end_s])
        })
    }

    /// The motion of this vehicle, from its start, without sensors.
    pub fn motion(&self) -> Motion<'a> {
        let [latitude_rad, azimuth_rad] =
            [self.latitude_deg, self.azimuth_deg].map(f64::to_radians);
        Motion::new(self.legs, self.events, latitude_rad, azimuth_rad, self.lever_m)
    }
}

/// One sample of a strapdown unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VehicleSample {
    /// Time of its end, s from the start.
    pub time_s: f64,
    /// Integral of each gyro's rate over the sample, rad, about forward, right, down.
    pub turned_rad: [f64; 3],
    /// Mean of each accelerometer over the sample, m/s², along forward, right, down.
    pub force_m_s2: [f64; 3],
    /// Whether a sensor was at its full scale.
    pub is_clipped: bool,
}

/// What the sensors cannot know, at the end of the latest sample; for checking only.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleTruth {
    /// Attitude of the body; the azimuth is not wrapped.
    pub attitude: Attitude,
    /// Latitude, and longitude from the start.
    pub position: Position,
    /// North and east from the start, m.
    pub displacement_m: [f64; 2],
    /// Velocity over the ground, north, east, down, m/s.
    pub velocity_m_s: [f64; 3],
    /// Turn-on biases of the gyros, rad/s.
    pub gyro_bias_rad_s: [f64; 3],
    /// Scale factor errors of the gyros, 1.
    pub gyro_scale_error: [f64; 3],
    /// Biases of the accelerometers, m/s².
    pub accelerometer_bias_m_s2: [f64; 3],
}

/// A vehicle at work: an iterator of samples that ends with the last leg. Sample k ends at k/`rate_hz`, k
/// from 1; samples in a gap are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle<'a> {
    /// Samples per second, Hz.
    rate_hz: f64,
    /// How the vehicle moves.
    motion: Motion<'a>,
    /// What is fixed to it.
    sensors: Sensors<'a>,
    /// Integrals at the end of the latest sample.
    before: Integrals,
    /// Numbers of the samples that are still to come.
    samples: core::ops::RangeInclusive<u64>,
}

impl<'a> Vehicle<'a> {
    /// The vehicle of a configuration; the seed fixes everything random in it.
    #[must_use]
    pub fn new(configuration: &VehicleConfiguration<'a>, seed: u64) -> Self {
        Self {
            rate_hz: configuration.rate_hz,
            motion: configuration.motion(),
            sensors: Sensors::new(configuration, configuration.rate_hz, seed),
            before: Integrals::default(),
            samples: 1..=first_sample(configuration.seconds(), configuration.rate_hz),
        }
    }

    /// The truth behind the latest sample.
    pub fn truth(&self) -> VehicleTruth {
        self.sensors.truth(&self.motion)
    }

    /// The next sample, whether it is missing or not; none after the end.
    fn sample(&mut self) -> Option<VehicleSample> {
        let time_s = self.samples.next()? as f64 / self.rate_hz;
        self.motion.advance(time_s);
        let felt = self.motion.integrals.means(&self.before, 1.0 / self.rate_hz);
        self.before = self.motion.integrals;
        let (shown, is_clipped) = self.sensors.sample(time_s, &felt);
        let turned_rad = shown.rate_rad_s.map(|rate| rate / self.rate_hz);
        Some(VehicleSample { time_s, turned_rad, force_m_s2: shown.force_m_s2, is_clipped })
    }
}

impl Iterator for Vehicle<'_> {
    type Item = VehicleSample;

    /// The next sample that is not missing.
    fn next(&mut self) -> Option<VehicleSample> {
        let faults = self.sensors.strapdown.faults;
        core::iter::from_fn(|| self.sample())
            .find(|sample| !SensorFault::lost(faults, sample.time_s))
    }
}

/// How the vehicle moves at one moment, over the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pose {
    /// Azimuth of the body, rad, clockwise from north.
    azimuth: Smooth,
    /// Pitch of the body, rad, nose up positive.
    pitch: Smooth,
    /// Roll of the body, rad, right side down positive.
    roll: Smooth,
    /// Heading of the road, rad, clockwise from north.
    heading: Smooth,
    /// Speed along the road, m/s.
    speed: Smooth,
    /// Slope of the road, height per way, 1.
    slope: Smooth,
    /// Specific force that shakes the accelerometers forward, right, down, m/s².
    force_m_s2: [f64; 3],
}

impl Pose {
    /// Level and at rest, facing an azimuth in rad.
    fn facing(azimuth_rad: f64) -> Self {
        let azimuth = Smooth { value: azimuth_rad, rate: 0.0 };
        Self { azimuth, heading: azimuth, ..Self::default() }
    }

    /// Turns the body by small azimuth, pitch and roll.
    fn turn(&mut self, [azimuth, pitch, roll]: [Smooth; 3]) {
        self.azimuth = self.azimuth + azimuth;
        self.pitch = self.pitch + pitch;
        self.roll = self.roll + roll;
    }

    /// Turns the body by a sway at a time in s, of which `presence`, 0 to 1, is there.
    fn sway(&mut self, sway: &SwayConfiguration, presence: Smooth, time_s: f64) {
        if !sway.is_active() {
            return;
        }
        let BaseMotion { lean, rates_rad_s } = sway.at(time_s);
        let angles = [lean.azimuth_rad, lean.pitch_rad, lean.roll_rad];
        let axis = |index: usize| Smooth { value: angles[index], rate: rates_rad_s[index] };
        self.turn([0, 1, 2].map(|index| axis(index) * presence));
    }

    /// Attitude of the body.
    fn attitude(&self) -> Attitude {
        Attitude {
            azimuth_rad: self.azimuth.value,
            pitch_rad: self.pitch.value,
            roll_rad: self.roll.value,
        }
    }

    /// Whether the vehicle stands.
    fn stands(&self) -> bool {
        self.speed == Smooth::default()
    }

    /// Velocity, m/s, and its derivative on axes that stay level and northward, m/s²: north, east, down.
    fn way(&self) -> [[f64; 3]; 2] {
        if self.stands() {
            return [[0.0; 3]; 2];
        }
        let (sine, cosine) = libm::sincos(self.heading.value);
        let Smooth { value: speed, rate: along } = self.speed;
        let (across, climb) = (speed * self.heading.rate, self.speed * self.slope);
        let velocity = [speed * cosine, speed * sine, -climb.value];
        let north = along * cosine - across * sine;
        [velocity, [north, along * sine + across * cosine, -climb.rate]]
    }
}

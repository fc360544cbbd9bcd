//! A body that flies and turns fast about its long axis, with three gyros and two accelerometers fixed to
//! it (Nekrasova 2017): sample by sample, as a recording of kind `spin` and more.
//!
//! Axes as in the paper: body x forward, y up and z right at roll zero; the roll γ is right-handed about
//! x. Forward, right and down of this crate are x, z and −y. A sample carries what the sensors show at its
//! moment, not means. Accelerometers at the distances ρ from the axis feel
//!
//! ```text
//!  a_y =  q cos γ + s sin γ − ρ_y ω²
//!  a_z = −q sin γ + s cos γ − ρ_z ω²
//! ```
//!
//! of a lift q and a side force s, with which pitch and course change too ([`trajectory`]). Time counts
//! from the start; the first sample is taken there.

mod body;
pub mod plant;
pub mod profile;
mod sensors;
pub mod trajectory;

use self::body::Body;
use self::profile::Profile;
use self::sensors::Sensors;
use self::trajectory::{Flight, Forces};
use crate::accelerometer::AccelerometerConfiguration;
use crate::gyro::GyroConfiguration;
use crate::plant::STANDARD_GRAVITY_M_S2;
use crate::sensor_fault::SensorFault;
use crate::stage::first_sample;

/// A spinning body, its flight, its sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinConfiguration<'a> {
    /// Samples per second, Hz, > 0.
    pub rate_hz: f64,
    /// Length of the run, s.
    pub seconds: f64,
    /// Speed at the start, m/s, > 0; it must stay above zero.
    pub speed_m_s: f64,
    /// Pitch at the start, °, up positive; it must stay within ±90.
    pub pitch_deg: f64,
    /// Course at the start, °, clockwise from north.
    pub course_deg: f64,
    /// Roll at the start, rad.
    pub roll_rad: f64,
    /// What acts on the body.
    pub forces: Forces<'a>,
    /// Rate of the roll over the time, rad/s.
    pub spin_rad_s: Profile<'a>,
    /// Distances of the accelerometers along y and z from the axis of rotation, m.
    pub radius_m: [f64; 2],
    /// The gyros about x, y and z; each draws for itself. Elevation, g-sensitivity, temperature and the
    /// dynamics of a sensor on a stage are not looked at.
    pub gyros: [GyroConfiguration; 3],
    /// Rates at which the gyros clip, rad/s (default never).
    pub gyro_full_scale_rad_s: [f64; 3],
    /// The accelerometers; of the three, those along y and z.
    pub accelerometer: AccelerometerConfiguration,
    /// What goes wrong with the sensors, in any order; channels 0 to 2 are the gyros about x, y and z, 3
    /// and 4 the accelerometers along y and z.
    pub faults: &'a [SensorFault],
}

impl Default for SpinConfiguration<'_> {
    /// The paper's body with perfect sensors: 100 turns a second, read at 10 kHz for a second, in level
    /// flight northwards at 300 m/s with a lift that holds it up.
    fn default() -> Self {
        Self {
            rate_hz: 10_000.0,
            seconds: 1.0,
            speed_m_s: 300.0,
            pitch_deg: 0.0,
            course_deg: 0.0,
            roll_rad: 0.0,
            forces: Forces {
                gravity_m_s2: STANDARD_GRAVITY_M_S2,
                drag_per_s: 0.0,
                lift_m_s2: Profile(&[(0.0, STANDARD_GRAVITY_M_S2)]),
                side_m_s2: Profile(&[]),
            },
            spin_rad_s: Profile(&[(0.0, 200.0 * core::f64::consts::PI)]),
            radius_m: [0.02, 0.01],
            gyros: [GyroConfiguration::default(); 3],
            gyro_full_scale_rad_s: [f64::INFINITY; 3],
            accelerometer: AccelerometerConfiguration::default(),
            faults: &[],
        }
    }
}

/// What the sensors show at one moment; not a number where one fails so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpinSample {
    /// Moment of the sample, s from the start.
    pub time_s: f64,
    /// Rates about body x, y and z, rad/s.
    pub rate_rad_s: [f64; 3],
    /// Specific force along body y and z, m/s².
    pub force_m_s2: [f64; 2],
}

/// What the sensors cannot know, at one moment; for checking only.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinTruth {
    /// Roll, rad, whole turns counted.
    pub roll_rad: f64,
    /// Rate of the roll, rad/s.
    pub spin_rad_s: f64,
    /// Speed, pitch, course and place.
    pub flight: Flight,
    /// The lift, m/s².
    pub lift_m_s2: f64,
    /// Scale factor errors of the gyros, 1.
    pub gyro_scale_error: [f64; 3],
}

impl SpinTruth {
    /// The truth at a time in s of a body that has flown there.
    fn of(body: &Body, sensors: &Sensors, time_s: f64) -> Self {
        Self {
            roll_rad: body.roll_rad(time_s),
            spin_rad_s: body.spin.value(time_s),
            flight: body.flight,
            lift_m_s2: body.forces.lift_m_s2.value(time_s),
            gyro_scale_error: sensors.0.gyros.each_ref().map(|gyro| gyro.scale_error),
        }
    }
}

/// A spinning body at work: an iterator of samples that ends with the run. Sample k is taken at k/`rate_hz`,
/// k from 0; samples in a gap are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinWorld<'a> {
    /// Samples per second, Hz.
    rate_hz: f64,
    /// The body in flight.
    body: Body<'a>,
    /// What is fixed to it.
    sensors: Sensors<'a>,
    /// Numbers of the samples that are still to come.
    samples: core::ops::Range<u64>,
}

impl<'a> SpinWorld<'a> {
    /// The world of a configuration; the seed fixes everything random in it.
    #[must_use]
    pub fn new(configuration: &SpinConfiguration<'a>, seed: u64) -> Self {
        Self {
            rate_hz: configuration.rate_hz,
            body: Body::new(configuration),
            sensors: Sensors::new(configuration, seed),
            samples: 0..first_sample(configuration.seconds, configuration.rate_hz),
        }
    }

    /// The truth behind the latest sample.
    pub fn truth(&self) -> SpinTruth {
        SpinTruth::of(&self.body, &self.sensors, self.body.time_s)
    }

    /// The next sample, whether it is missing or not; none after the end.
    fn sample(&mut self) -> Option<SpinSample> {
        let time_s = self.samples.next()? as f64 / self.rate_hz;
        self.body.advance(time_s);
        let shown = self.sensors.sample(time_s, &self.body.felt(time_s));
        Some(SpinSample { time_s, rate_rad_s: shown.rate_rad_s, force_m_s2: shown.force_m_s2 })
    }
}

impl Iterator for SpinWorld<'_> {
    type Item = SpinSample;

    /// The next sample that is not missing.
    fn next(&mut self) -> Option<SpinSample> {
        let faults = self.sensors.0.faults;
        core::iter::from_fn(|| self.sample())
            .find(|sample| !SensorFault::lost(faults, sample.time_s))
    }
}

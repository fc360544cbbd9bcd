//! The instruments on the platform, read at any stage state: what `World` reads on its schedule, and
//! what a simulated board reads while its own firmware turns the stage.
//!
//! A schedule reads all of them at once ([`Instruments::sample`]); chips read each at its own rate
//! ([`Instruments::rate`], [`Instruments::force`], [`Instruments::temperature`]). Every source of
//! noise has a stream of its own, so both give the same numbers.

use crate::accelerometer::{Accelerometer, AccelerometerConfiguration};
use crate::disturbance::Effect;
use crate::earth::{Attitude, InertialInput, Site};
use crate::gyro::{Gyro, GyroConfiguration};
use crate::stage::{EncoderConfiguration, StageState};
use crate::temperature::{TemperatureConfiguration, Thermometer};

/// Where the base stands and what is mounted on it.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstrumentsConfiguration {
    /// Geodetic latitude, °, ±90.
    pub latitude_deg: f64,
    /// True azimuth of body x, °, clockwise from north.
    pub azimuth_deg: f64,
    /// True pitch of the base, °.
    pub pitch_deg: f64,
    /// True roll of the base, °.
    pub roll_deg: f64,
    /// Samples per second, Hz, > 0.
    pub rate_hz: f64,
    /// The precise gyro.
    pub gyro: GyroConfiguration,
    /// The accelerometer beside it.
    pub accelerometer: AccelerometerConfiguration,
    /// The stage's encoder.
    pub encoder: EncoderConfiguration,
    /// The warm-up.
    pub temperature: TemperatureConfiguration,
}

impl Default for InstrumentsConfiguration {
    /// Perfect instruments on a level base on the equator, facing north, 100 Hz.
    fn default() -> Self {
        Self {
            latitude_deg: 0.0,
            azimuth_deg: 0.0,
            pitch_deg: 0.0,
            roll_deg: 0.0,
            rate_hz: 100.0,
            gyro: GyroConfiguration::default(),
            accelerometer: AccelerometerConfiguration::default(),
            encoder: EncoderConfiguration::default(),
            temperature: TemperatureConfiguration::default(),
        }
    }
}

impl InstrumentsConfiguration {
    /// These instruments on a base that leans by `tilt_deg` with its axis at stage angle `uphill_deg`
    /// uphill
    /// ([`Attitude::tilted`]), °.
    pub fn leaning(self, tilt_deg: f64, uphill_deg: f64) -> Self {
        let attitude = Attitude::tilted(0.0, tilt_deg.to_radians(), uphill_deg.to_radians());
        let (pitch_deg, roll_deg) =
            (attitude.pitch_rad.to_degrees(), attitude.roll_rad.to_degrees());
        Self { pitch_deg, roll_deg, ..self }
    }

    /// Attitude of the base, rad.
    pub fn attitude(&self) -> Attitude {
        Attitude {
            azimuth_rad: self.azimuth_deg.to_radians(),
            pitch_rad: self.pitch_deg.to_radians(),
            roll_rad: self.roll_deg.to_radians(),
        }
    }
}

/// One reading of all instruments, as a recording of kind `stage` has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time from the first sample, s.
    pub time_s: f64,
    /// What the encoder shows, rad.
    pub stage_rad: f64,
    /// What the gyro shows, rad/s.
    pub rate_rad_s: f64,
    /// What the accelerometer shows, m/s²: x along the sensitive axis, y 90° clockwise, z down.
    pub force_m_s2: [f64; 3],
    /// What the thermometer shows, °C.
    pub temperature_c: f64,
}

/// What the sensors cannot know; for checking only.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Attitude of the base.
    pub attitude: Attitude,
    /// Stage angle and rate at the latest sample.
    pub stage: StageState,
    /// Inertial rate along the sensitive axis at the latest sample, rad/s, without disturbance.
    pub axis_rad_s: f64,
    /// The gyro's turn-on bias, rad/s.
    pub gyro_bias_rad_s: f64,
    /// The gyro's scale factor error, 1.
    pub gyro_scale_error: f64,
    /// The accelerometer's biases, m/s².
    pub accelerometer_bias_m_s2: [f64; 3],
}

/// The instruments at work.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
pub struct Instruments {
    /// Attitude of the base at rest.
    pub(crate) attitude: Attitude,
    /// Latitude and attitude at rest, with gravity and Earth rate.
    pub(crate) site: Site,
    /// Errors of the encoder.
    encoder: EncoderConfiguration,
    /// The precise gyro.
    pub(crate) gyro: Gyro,
    /// The accelerometer beside it.
    accelerometer: Accelerometer,
    /// The thermometer of the accelerometer, with the warm-up.
    thermometer: Thermometer,
    /// What the latest stage state gives.
    pub(crate) pose: Pose,
}

/// How the base moves at one moment: small angles on top of its attitude, and their derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BaseMotion {
    /// Added to the attitude of the base.
    pub lean: Attitude,
    /// Rates of azimuth, pitch and roll, rad/s.
    pub rates_rad_s: [f64; 3],
}

impl BaseMotion {
    /// The attitude of a base that stands at `rest` without this motion.
    pub fn moved(&self, rest: &Attitude) -> Attitude {
        Attitude {
            azimuth_rad: rest.azimuth_rad + self.lean.azimuth_rad,
            pitch_rad: rest.pitch_rad + self.lean.pitch_rad,
            roll_rad: rest.roll_rad + self.lean.roll_rad,
        }
    }

    /// Rate of the base about its own axes forward, right, down, rad/s, at an attitude: kinematics of
    /// the turns azimuth, pitch, roll in this order.
    #[must_use]
    pub fn body_rad_s(&self, attitude: &Attitude) -> [f64; 3] {
        let [azimuth, pitch, roll] = self.rates_rad_s;
        let (sine_pitch, cosine_pitch) = libm::sincos(attitude.pitch_rad);
        let (sine_roll, cosine_roll) = libm::sincos(attitude.roll_rad);
        let level = azimuth * cosine_pitch;
        [
            roll - azimuth * sine_pitch,
            pitch * cosine_roll + level * sine_roll,
            level * cosine_roll - pitch * sine_roll,
        ]
    }
}

/// What one stage state gives without noise, computed once while the stage stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pose {
    /// The stage state that it belongs to.
    stage: StageState,
    /// What the encoder shows there, rad.
    encoder_rad: f64,
    /// What the sensors feel there.
    pub(crate) felt: Felt,
}

/// What the platform's sensors feel, less noise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Felt {
    /// Inertial rate along the gyro's sensitive axis, rad/s.
    pub(crate) axis_rad_s: f64,
    /// What the gyro shows of that, less noise, rad/s.
    pub(crate) steady_rad_s: f64,
    /// Specific force on platform x, y, z, m/s².
    pub(crate) force_m_s2: [f64; 3],
    /// Force on platform x and y in units of local gravity.
    pub(crate) force_g: [f64; 2],
}

impl Instruments {
    /// Instruments with the stage at zero; everything random comes from the seed.
    pub fn new(configuration: &InstrumentsConfiguration, seed: u64) -> Self {
        Self::with_accelerometer_at(configuration, configuration.rate_hz, seed)
    }

    /// Instruments whose accelerometer is read `accelerometer_hz` times a second (> 0), and whose gyro
    /// `rate_hz` times.
    pub fn with_accelerometer_at(
        configuration: &InstrumentsConfiguration,
        accelerometer_hz: f64,
        seed: u64,
    ) -> Self {
        let c = configuration;
        let attitude = c.attitude();
        let mut instruments = Self {
            attitude,
            site: Site::new(c.latitude_deg.to_radians(), &attitude),
            encoder: c.encoder,
            gyro: Gyro::new(&c.gyro, c.rate_hz, seed),
            accelerometer: Accelerometer::new(&c.accelerometer, accelerometer_hz, seed),
            thermometer: Thermometer::new(&c.temperature, seed),
            pose: Pose::default(),
        };
        instruments.pose = instruments.pose_at(StageState::default());
        instruments
    }

    /// Moves the stage; free while it stands.
    #[inline]
    pub fn turn(&mut self, stage: StageState) {
        if stage != self.pose.stage {
            self.pose = self.pose_at(stage);
        }
    }

    /// Moves the stage on a base that moves itself, which costs the whole geometry every time.
    pub fn turn_on(&mut self, stage: StageState, motion: &BaseMotion) {
        self.turn(stage);
        let attitude = motion.moved(&self.attitude);
        let site = self.site.with_attitude(&attitude);
        self.pose.felt = self.felt_at(&site, stage, motion.body_rad_s(&attitude));
    }

    /// Has everything feel what a base on its way feels, in the mean.
    pub fn ride(&mut self, stage: StageState, means: &InertialInput) {
        self.turn(stage);
        let [x, y, z] = about_stage(means.rate_rad_s, stage.angle_rad);
        let force_m_s2 = about_stage(means.force_m_s2, stage.angle_rad);
        self.pose.felt = self.felt_on([x, y, z + stage.rate_rad_s], force_m_s2);
    }

    /// Reads everything once, `time_s` after the first sample. Call `rate_hz` times a second.
    #[inline]
    pub fn sample(&mut self, time_s: f64, effect: &Effect) -> Sample {
        Sample {
            time_s,
            stage_rad: self.pose.encoder_rad,
            rate_rad_s: self.rate(time_s, effect),
            force_m_s2: self.force(effect),
            temperature_c: self.thermometer.sample(time_s),
        }
    }

    /// What the gyro shows next, rad/s, `time_s` after the first sample. Call `rate_hz` times a second.
    #[inline]
    pub fn rate(&mut self, time_s: f64, effect: &Effect) -> f64 {
        let Felt { steady_rad_s, force_g, .. } = self.pose.felt;
        let temperature_c = self.thermometer.temperature.at(time_s);
        let rate_rad_s = steady_rad_s + effect.rate_rad_s;
        self.gyro.sample_under(force_g, rate_rad_s, time_s, temperature_c)
    }

    /// What the accelerometer shows next, m/s², on platform x, y, z. Call at its own rate.
    #[inline]
    pub fn force(&mut self, effect: &Effect) -> [f64; 3] {
        let [x, y, z] = self.pose.felt.force_m_s2;
        let [add_x, add_y, add_z] = effect.force_m_s2;
        self.accelerometer.sample([x + add_x, y + add_y, z + add_z])
    }

    /// What the thermometer shows next, °C, `time_s` after the first sample.
    #[inline]
    pub fn temperature(&mut self, time_s: f64) -> f64 {
        self.thermometer.sample(time_s)
    }

    /// What the encoder shows, rad: it has no noise.
    #[must_use]
    pub fn shown_rad(&self) -> f64 {
        self.pose.encoder_rad
    }

    /// The truth behind the latest sample.
    pub fn truth(&self) -> Truth {
        Truth {
            attitude: self.attitude,
            stage: self.pose.stage,
            axis_rad_s: self.pose.felt.axis_rad_s,
            gyro_bias_rad_s: self.gyro.bias_rad_s,
            gyro_scale_error: self.gyro.scale_error,
            accelerometer_bias_m_s2: self.accelerometer.bias_m_s2,
        }
    }

    /// Everything that does not change while the stage stands on a base at rest.
    fn pose_at(&self, stage: StageState) -> Pose {
        let encoder_rad = self.encoder.read(stage.angle_rad);
        Pose { stage, encoder_rad, felt: self.felt_at(&self.site, stage, [0.0; 3]) }
    }

    /// What is felt on a base that turns at `body_rad_s` about forward, right, down.
    fn felt_at(&self, site: &Site, stage: StageState, body_rad_s: [f64; 3]) -> Felt {
        let InertialInput { rate_rad_s: [x, y, z], force_m_s2 } = site.on_platform(stage.angle_rad);
        let [along, across, down] = about_stage(body_rad_s, stage.angle_rad);
        // The stage turns about platform z, down, clockwise from above.
        self.felt_on([x + along, y + across, z + down + stage.rate_rad_s], force_m_s2)
    }

    /// What is felt of an angular rate, the stage's own included, and a specific force on the platform axes.
    fn felt_on(&self, platform_rad_s: [f64; 3], force_m_s2: [f64; 3]) -> Felt {
        let axis_rad_s = self.gyro.along_axis(platform_rad_s);
        let gravity = self.site.gravity_m_s2;
        let force_g = [force_m_s2[0] / gravity, force_m_s2[1] / gravity];
        let steady_rad_s = self.gyro.steady(axis_rad_s, force_g);
        Felt { axis_rad_s, steady_rad_s, force_m_s2, force_g }
    }
}

/// A vector of the base on the platform axes at a stage angle in rad; zero needs no sines.
fn about_stage([forward, right, down]: [f64; 3], angle_rad: f64) -> [f64; 3] {
    if [forward, right] == [0.0; 2] {
        return [0.0, 0.0, down];
    }
    let (sine, cosine) = libm::sincos(angle_rad);
    [forward * cosine + right * sine, right * cosine - forward * sine, down]
}

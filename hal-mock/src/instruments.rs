//! The instruments on the platform, read at any stage state: what `World` reads on its schedule, and
//! what a simulated board reads while its own firmware turns the stage.

use crate::accelerometer::{Accelerometer, AccelerometerConfiguration};
use crate::disturbance::Effect;
use crate::earth::{Attitude, PlatformInput, Site};
use crate::gyro::{Gyro, GyroConfiguration};
use crate::stage::{EncoderConfiguration, StageState};
use crate::temperature::{TemperatureConfiguration, Thermometer};

/// Where the base stands and what is mounted on it.
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
    /// Attitude of the base, rad.
    #[must_use]
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
#[derive(Clone, Debug, PartialEq)]
pub struct Instruments {
    attitude: Attitude,
    site: Site,
    encoder: EncoderConfiguration,
    temperature: TemperatureConfiguration,
    gyro: Gyro,
    accelerometer: Accelerometer,
    thermometer: Thermometer,
    pose: Pose,
}

/// What one stage state gives without noise, computed once while the stage stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pose {
    stage: StageState,
    encoder_rad: f64,
    axis_rad_s: f64,
    steady_rad_s: f64,
    force_m_s2: [f64; 3],
}

impl Instruments {
    /// Instruments with the stage at zero; everything random comes from the seed.
    #[must_use]
    pub fn new(configuration: &InstrumentsConfiguration, seed: u64) -> Self {
        let c = configuration;
        let attitude = c.attitude();
        let mut instruments = Self {
            attitude,
            site: Site::new(c.latitude_deg.to_radians(), &attitude),
            encoder: c.encoder,
            temperature: c.temperature,
            gyro: Gyro::new(&c.gyro, c.rate_hz, seed),
            accelerometer: Accelerometer::new(&c.accelerometer, c.rate_hz, seed),
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

    /// Reads everything once, `time_s` after the first sample. Call `rate_hz` times a second.
    #[inline]
    pub fn sample(&mut self, time_s: f64, effect: &Effect) -> Sample {
        let temperature_c = self.temperature.at(time_s);
        let pose = &self.pose;
        let [x, y, z] = pose.force_m_s2;
        let [add_x, add_y, add_z] = effect.force_m_s2;
        let rate_rad_s = pose.steady_rad_s + effect.rate_rad_s;
        Sample {
            time_s,
            stage_rad: pose.encoder_rad,
            rate_rad_s: self.gyro.sample(rate_rad_s, time_s, temperature_c),
            force_m_s2: self.accelerometer.sample([x + add_x, y + add_y, z + add_z]),
            temperature_c: self.thermometer.sample(temperature_c),
        }
    }

    /// The truth behind the latest sample.
    #[must_use]
    pub fn truth(&self) -> Truth {
        Truth {
            attitude: self.attitude,
            stage: self.pose.stage,
            axis_rad_s: self.pose.axis_rad_s,
            gyro_bias_rad_s: self.gyro.bias_rad_s(),
            gyro_scale_error: self.gyro.scale_error(),
            accelerometer_bias_m_s2: self.accelerometer.bias_m_s2(),
        }
    }

    /// Everything that does not change while the stage stands.
    fn pose_at(&self, stage: StageState) -> Pose {
        let PlatformInput { rate_rad_s: [x, y, z], force_m_s2 } =
            self.site.on_platform(stage.angle_rad);
        // The stage turns about platform z, down, clockwise from above.
        let axis_rad_s = self.gyro.along_axis([x, y, z + stage.rate_rad_s]);
        let gravity = self.site.gravity_m_s2();
        let force_g = [force_m_s2[0] / gravity, force_m_s2[1] / gravity];
        Pose {
            stage,
            encoder_rad: self.encoder.read(stage.angle_rad),
            axis_rad_s,
            steady_rad_s: self.gyro.steady(axis_rad_s, force_g),
            force_m_s2,
        }
    }
}

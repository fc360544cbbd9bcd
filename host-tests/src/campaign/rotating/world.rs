//! The platform that the campaigns turn: its site, its gear, its sensor, and how long it turns which way.

use std::f64::consts::TAU;

use hal_mock::disturbance::{Disturbance, Effect};
use hal_mock::earth::EARTH_RATE_RAD_S;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::{Instruments, InstrumentsConfiguration};
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::noise::Generator;
use hal_mock::stage::{EncoderConfiguration, Ripple, Unevenness};
use hal_mock::turntable::{EncoderSlip, Segment, TurningSample, Turntable, TurntableConfiguration};

use orientation::alignment::rotating::Session;
use orientation::alignment::{Input, Method, Request};

use super::motor::Motor;
use crate::recording::RotatingRow;
use crate::simulate::stage_path;

/// Latitude, °: that of the laboratory of MET 2018.
pub const LATITUDE_DEG: f64 = 55.75;
/// Sample rate, Hz: the noise of a turn does not depend on it; at fewer the motion between two samples does not follow a line.
pub const RATE_HZ: f64 = 200.0;
/// Non-orthogonality of sensitive axis and platform axis, °.
pub const MISALIGNMENT_DEG: f64 = 0.8;
/// Tilt of the platform, °.
pub const TILT_DEG: f64 = 0.3;
/// Unevenness of the gear once per turn, relative.
pub const UNEVENNESS: f64 = 0.002;
/// Length of the rate-modulated stretch, turns.
const MODULATED_TURNS: f64 = 12.0;
/// Time in which the platform takes on another rate, s.
const RAMP_SECONDS: f64 = 3.0;
/// Depth of the rate modulation, relative, and its frequency in turns.
const MODULATION: (f64, f64) = (0.25, 0.83);
/// Step of the encoder: 21 bit.
const ENCODER_STEP_RAD: f64 = TAU / 2_097_152.0;
/// Where the accelerometer clips, m/s²: ±2.048 g.
const FORCE_FULL_SCALE: f64 = 20.08;
/// The random stream from which worlds are drawn: none of those that their sensors draw from.
const DRAWN: u64 = 1_000;
/// Noise of the accelerometer, m/s²/√Hz: 25 µg/√Hz, an ADXL355's.
const FORCE_NOISE: f64 = 2.5e-4;

/// One run's world.
#[derive(Clone, Debug)]
pub struct World {
    /// Azimuth of body x, °.
    pub azimuth_deg: f64,
    /// Stage angle at which the gear is quickest, °.
    pub quickest_deg: f64,
    /// Stage angle at which the sensitive axis points uphill, °.
    pub uphill_deg: f64,
    /// Non-orthogonality of sensitive axis and platform axis, °.
    pub coupling_deg: f64,
    /// Angle random walk, °/√h.
    pub n_deg_sqrt_h: f64,
    /// Ordinary g-sensitivity `k_s`, `k_o`, °/h/g.
    pub g_sensitivity_deg_h_g: [f64; 2],
    /// What a molecular-electronic sensor has beside it.
    pub molecular: Option<MolecularConfiguration>,
    /// What the platform does in turn.
    pub segments: Vec<Segment>,
    /// What goes wrong with the encoder.
    pub slip: EncoderSlip,
    /// Disturbances of the sensors.
    pub disturbances: Vec<Disturbance>,
}

impl World {
    /// A healthy gyro that turns at these speeds, so many seconds each way at each; azimuth, gear and tilt
    /// are drawn.
    #[must_use]
    pub fn drawn(seed: u64, speeds_hz: &[f64], seconds: f64) -> Self {
        let mut chance = Generator::stream(seed, DRAWN);
        let mut angle = || 360.0 * chance.uniform();
        Self {
            azimuth_deg: angle(),
            quickest_deg: angle(),
            uphill_deg: angle(),
            coupling_deg: MISALIGNMENT_DEG,
            n_deg_sqrt_h: 0.0,
            g_sensitivity_deg_h_g: [0.0; 2],
            molecular: None,
            segments: segments(speeds_hz, seconds),
            slip: EncoderSlip::default(),
            disturbances: Vec::new(),
        }
    }
}

/// A rate-modulated stretch, then as many seconds clockwise and counter-clockwise at each speed in turns a
/// second.
pub(crate) fn segments(speeds_hz: &[f64], seconds: f64) -> Vec<Segment> {
    let Some(first) = speeds_hz.first() else { return Vec::new() };
    let (depth, frequency) = MODULATION;
    let modulated =
        Segment::steady(TAU * first, MODULATED_TURNS / first).modulated(depth, frequency * first);
    let both = |speed: &f64| {
        [TAU * speed, -TAU * speed].map(|rate| Segment::steady(rate, seconds).after(RAMP_SECONDS))
    };
    [modulated].into_iter().chain(speeds_hz.iter().flat_map(both)).collect()
}

/// A molecular-electronic sensor by what it does at a speed.
#[derive(Clone, Copy, Debug)]
pub struct Integrating {
    /// Integrated g-sensitivity times the tilt, over speed and horizontal Earth rate: ρ.
    pub ratio: f64,
    /// Direction of that g-sensitivity from the sensitive axis, clockwise, °.
    pub toward_deg: f64,
    /// By how much it lags, °, in [0, 90).
    pub lag_deg: f64,
    /// The speed, turns a second.
    pub speed_hz: f64,
}

impl Integrating {
    /// The g-sensitivity as it multiplies the tilt's phasor, rad/s² per g.
    #[must_use]
    pub fn force_rad_s2_g(&self) -> [f64; 2] {
        let horizontal = EARTH_RATE_RAD_S * LATITUDE_DEG.to_radians().cos();
        let tilt = TILT_DEG.to_radians().sin();
        let size = self.ratio * TAU * self.speed_hz * horizontal / tilt;
        let (sine, cosine) = self.toward_deg.to_radians().sin_cos();
        [size * cosine, size * sine]
    }

    /// The sensor that does so.
    #[must_use]
    pub fn sensor(&self) -> MolecularConfiguration {
        let lag_s = self.lag_deg.to_radians().tan() / (TAU * self.speed_hz);
        let force_rad_s2_g = self.force_rad_s2_g();
        MolecularConfiguration { force_rad_s2_g, high_pass_hz: 0.0, lag_s }
    }
}

impl World {
    fn instruments(&self) -> InstrumentsConfiguration {
        let mut instruments = InstrumentsConfiguration {
            latitude_deg: LATITUDE_DEG,
            azimuth_deg: self.azimuth_deg,
            rate_hz: RATE_HZ,
            gyro: GyroConfiguration {
                n_deg_sqrt_h: self.n_deg_sqrt_h,
                g_sensitivity_deg_h_g: self.g_sensitivity_deg_h_g,
                axis_elevation_rad: self.coupling_deg.to_radians(),
                molecular: self.molecular,
                ..GyroConfiguration::default()
            },
            encoder: EncoderConfiguration {
                step_rad: ENCODER_STEP_RAD,
                ..EncoderConfiguration::default()
            },
            ..InstrumentsConfiguration::default()
        };
        instruments.accelerometer.noise_m_s2_sqrt_hz = FORCE_NOISE;
        instruments.accelerometer.full_scale_m_s2 = Some(FORCE_FULL_SCALE);
        instruments.leaning(TILT_DEG, self.uphill_deg)
    }

    fn gear(&self) -> Unevenness {
        let first = Ripple { relative: UNEVENNESS, phase_rad: self.quickest_deg.to_radians() };
        Unevenness { first, ..Unevenness::default() }
    }

    /// Runs a session to its end on a platform that obeys it.
    ///
    /// The loop is bounded: a session that does not end within `longest_s` is given the end.
    pub fn obey(&self, session: &mut Session, longest_s: f64, seed: u64) {
        let mut instruments = Instruments::new(&self.instruments(), seed);
        let (mut motor, gear) = (Motor::default(), self.gear());
        for index in 0..(longest_s * RATE_HZ) as u64 {
            let time_s = index as f64 / RATE_HZ;
            instruments.turn(gear.stage(motor.after(1.0 / RATE_HZ)));
            let reading = instruments.sample(time_s, &Effect::default());
            match session.feed(Input::Sample(&stage_path(&reading))) {
                Request::Turn(rate_rad_s) => motor.send(rate_rad_s.0),
                Request::Done => return,
                _ => {}
            }
        }
        session.feed(Input::End);
    }

    /// The platform's samples as rows of a recording of kind `rotating`.
    #[must_use]
    pub fn rows(&self, seed: u64) -> Vec<RotatingRow> {
        let configuration = TurntableConfiguration {
            instruments: self.instruments(),
            unevenness: self.gear(),
            slip: self.slip,
            segments: &self.segments,
            disturbances: &self.disturbances,
            ..TurntableConfiguration::default()
        };
        let row = |(index, sample): (usize, TurningSample)| RotatingRow {
            line: index as u64 + 1,
            time_s: sample.time_s,
            stage_rad: sample.stage_rad,
            stage_rate_rad_s: sample.stage_rate_rad_s,
            rate_rad_s: sample.rate_rad_s,
            force_m_s2: sample.force_m_s2[0],
            across_m_s2: None,
            force_is_new: true,
        };
        Turntable::new(&configuration, seed).enumerate().map(row).collect()
    }
}

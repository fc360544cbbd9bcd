//! The platform that the campaigns turn: its site, its gear, its sensor, and how long it turns which way.

use std::f64::consts::TAU;

use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::stage::{EncoderConfiguration, Ripple, Unevenness};
use hal_mock::turntable::{Segment, Turntable, TurntableConfiguration};

use crate::recording::RotatingRow;

/// Latitude, °: that of papers/004's laboratory.
pub const LATITUDE_DEG: f64 = 55.75;
/// Sample rate, Hz: the noise of a turn does not depend on it.
pub const RATE_HZ: f64 = 50.0;
/// Non-orthogonality of sensitive axis and platform axis, °.
pub const COUPLING_DEG: f64 = 0.8;
/// Tilt of the platform, °.
pub const TILT_DEG: f64 = 0.3;
/// Unevenness of the gear once per turn, relative.
pub const UNEVENNESS: f64 = 0.002;
/// Length of the deliberately uneven stretch, turns.
const UNEVEN_TURNS: f64 = 12.0;
/// Its depth, relative, and its frequency in turns.
const MODULATION: (f64, f64) = (0.25, 0.83);
/// Step of the encoder: 21 bit.
const ENCODER_STEP_RAD: f64 = TAU / 2_097_152.0;
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
    /// Angle random walk, °/√h.
    pub n_deg_sqrt_h: f64,
    /// Ordinary g-sensitivity `k_s`, `k_o`, °/h/g.
    pub g_sensitivity_deg_h_g: [f64; 2],
    /// What a molecular-electronic sensor has beside it.
    pub molecular: Option<MolecularConfiguration>,
    /// What the platform does in turn.
    pub segments: Vec<Segment>,
}

/// An uneven stretch, then as many seconds clockwise and counter-clockwise at each speed in turns a
/// second.
#[must_use]
pub fn segments(speeds_hz: &[f64], seconds: f64) -> Vec<Segment> {
    let Some(first) = speeds_hz.first() else { return Vec::new() };
    let (depth, frequency) = MODULATION;
    let uneven =
        Segment::steady(TAU * first, UNEVEN_TURNS / first).uneven(depth, frequency * first);
    let both = |speed: &f64| [TAU * speed, -TAU * speed].map(|rate| Segment::steady(rate, seconds));
    [uneven].into_iter().chain(speeds_hz.iter().flat_map(both)).collect()
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
                axis_elevation_rad: COUPLING_DEG.to_radians(),
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
        instruments.leaning(TILT_DEG, self.uphill_deg)
    }

    /// The platform's samples as rows of a recording of kind `rotating`.
    #[must_use]
    pub fn rows(&self, seed: u64) -> Vec<RotatingRow> {
        let quickest = Ripple { relative: UNEVENNESS, phase_rad: self.quickest_deg.to_radians() };
        let configuration = TurntableConfiguration {
            instruments: self.instruments(),
            unevenness: Unevenness { first: quickest, ..Unevenness::default() },
            segments: &self.segments,
            ..TurntableConfiguration::default()
        };
        let row = |(index, sample): (usize, hal_mock::turntable::TurningSample)| RotatingRow {
            line: index as u64 + 1,
            time_s: sample.time_s,
            stage_rad: sample.stage_rad,
            stage_rate_rad_s: sample.stage_rate_rad_s,
            rate_rad_s: sample.rate_rad_s,
            force_m_s2: sample.force_m_s2[0],
        };
        Turntable::new(&configuration, seed).enumerate().map(row).collect()
    }
}

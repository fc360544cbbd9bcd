//! A gyro and an accelerometer that a stage or a platform turns: how they are drawn, how their base moves, and
//! what every such rig has in common.

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::earth::Attitude;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::{BaseMotion, InstrumentsConfiguration};
use hal_mock::noise::Generator;
use hal_mock::stage::EncoderConfiguration;

use super::axes::{Axes, UPRIGHT};
use super::class::Subject;
use super::gyro::{Column, Drift, Drifting, GyroFault};
use crate::campaign::chance::Chance;
use crate::output::degrees;
use crate::recording::Header;

/// Step of the encoder: 21 bit.
const ENCODER_STEP_RAD: f64 = TAU / 2_097_152.0;

/// N beside which an accelerometer of 10 to 30 µg/√Hz is built, °/√h: beside a better gyro there is a better one.
const ORDINARY_N: f64 = 5e-3;

/// Quality and place of an instrument.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grade {
    latitude_deg: f64,
    n: f64,
    b: f64,
    r: f64,
    k: f64,
    scale_sigma: f64,
    bias_sigma: f64,
    kappa_sigma: f64,
}

impl Grade {
    /// Draws a grade with an N between two values, °/√h.
    pub(super) fn drawn(chance: &mut Chance, [least_n, greatest_n]: [f64; 2]) -> Self {
        let latitude_deg = chance.between(-65.0, 65.0);
        let n = chance.scaled(least_n, greatest_n);
        let b = chance.one_of(&[0.0, 3.0 * n]);
        let (r, k) = chance.one_of(&[(0.0, 0.0), (0.0, 0.0), (10.0 * n, 0.0), (0.0, n)]);
        let scale_sigma = chance.scaled(1e-4, 2e-3);
        let bias_sigma = chance.scaled(5e-3, 0.1);
        let kappa_sigma = chance.one_of(&[0.0, n]);
        Self { latitude_deg, n, b, r, k, scale_sigma, bias_sigma, kappa_sigma }
    }

    /// Both parts of its g-sensitivity, °/h/g.
    pub(super) fn g_sensitivity(&self, chance: &mut Chance) -> [f64; 2] {
        [0, 1].map(|_| self.kappa_sigma * chance.normal())
    }

    /// An instrument of this grade, of any azimuth and tilt; its sensitive axis lies `elevation_rad` above the base.
    pub(super) fn instruments(
        &self,
        chance: &mut Chance,
        rate_hz: f64,
        g_sensitivity_deg_h_g: [f64; 2],
        elevation_rad: impl FnOnce(&mut Chance) -> f64,
    ) -> InstrumentsConfiguration {
        InstrumentsConfiguration {
            latitude_deg: self.latitude_deg,
            azimuth_deg: chance.between(0.0, 360.0),
            rate_hz,
            gyro: GyroConfiguration {
                n_deg_sqrt_h: self.n,
                b_deg_h: self.b,
                k_deg_h_sqrt_h: self.k,
                r_deg_h2: self.r * chance.normal(),
                bias_sigma_deg_h: 1.0,
                scale_sigma: self.scale_sigma,
                axis_elevation_rad: elevation_rad(chance),
                g_sensitivity_deg_h_g,
                ..GyroConfiguration::default()
            },
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: chance.scaled(1e-4, 3e-4) * (self.n / ORDINARY_N).sqrt(),
                bias_sigma_m_s2: self.bias_sigma,
                ..AccelerometerConfiguration::default()
            },
            encoder: EncoderConfiguration {
                step_rad: ENCODER_STEP_RAD,
                ..EncoderConfiguration::default()
            },
            ..InstrumentsConfiguration::default()
        }
        .leaning(chance.scaled(0.02, 2.0), chance.between(0.0, 360.0))
    }

    /// What is stated about it, all true; of its noise only where that is known.
    pub(super) fn header(&self, rate_hz: f64, knows_noise: bool) -> Header {
        Header {
            latitude_deg: Some(self.latitude_deg),
            rate_hz: Some(rate_hz),
            gyro_n_deg_sqrt_h: knows_noise.then_some(self.n),
            gyro_b_deg_h: Some(self.b),
            gyro_k_deg_h_sqrt_h: Some(self.k),
            gyro_r_deg_h2: Some(self.r),
            gyro_scale_sigma: Some(self.scale_sigma),
            accelerometer_bias_m_s2: Some(self.bias_sigma),
            g_sensitivity_deg_h_g: Some([0.0; 2]),
            g_sensitivity_sigma_deg_h_g: Some(self.kappa_sigma),
            ..Header::default()
        }
    }
}

/// A drawn instrument, and what is wrong with it.
#[derive(Clone, Debug)]
pub(super) struct Unit {
    pub(super) seed: u64,
    pub(super) instruments: InstrumentsConfiguration,
    pub(super) header: Header,
    pub(super) base: BaseChange,
    /// Steps of the encoder against what it measures: from when, s, by how much, rad.
    pub(super) slips: Vec<(f64, f64)>,
    /// Whether the encoder counts the other way.
    pub(super) is_reversed: bool,
    /// Rate that nothing explains.
    pub(super) drift: Vec<Drift>,
    pub(super) gyro: GyroFault,
    /// What the accelerometer's columns show of its axes.
    pub(super) axes: Axes,
}

impl Unit {
    /// A unit with nothing wrong.
    pub(super) fn new(seed: u64, instruments: &InstrumentsConfiguration, header: Header) -> Self {
        Self {
            seed,
            instruments: *instruments,
            header,
            base: BaseChange::default(),
            slips: Vec::new(),
            is_reversed: false,
            drift: Vec::new(),
            gyro: GyroFault::default(),
            axes: UPRIGHT,
        }
    }

    /// Which way the encoder counts.
    pub(super) fn sense(&self) -> f64 {
        if self.is_reversed { -1.0 } else { 1.0 }
    }

    /// What the encoder shows of an angle, rad, at a time, s.
    pub(super) fn shown_rad(&self, angle_rad: f64, time_s: f64) -> f64 {
        self.sense() * (angle_rad + stepped(&self.slips, time_s))
    }
}

/// How a base moves that should stand.
#[derive(Clone, Debug, Default)]
pub(super) struct BaseChange {
    /// Rates of azimuth, pitch and roll, rad/s.
    pub(super) rates_rad_s: [f64; 3],
    /// Turns about the vertical: from when, s, by how much, rad.
    pub(super) turns: Vec<(f64, f64)>,
}

impl BaseChange {
    /// How far the base has come from its attitude.
    pub(super) fn lean(&self, time_s: f64) -> Attitude {
        let [azimuth, pitch, roll] = self.rates_rad_s.map(|rate| rate * time_s);
        let azimuth_rad = azimuth + stepped(&self.turns, time_s);
        Attitude { azimuth_rad, pitch_rad: pitch, roll_rad: roll }
    }

    /// The motion at a time; none of a base that stands.
    pub(super) fn at(&self, time_s: f64) -> Option<BaseMotion> {
        let stands = self.turns.is_empty() && self.rates_rad_s == [0.0; 3];
        (!stands).then(|| BaseMotion { lean: self.lean(time_s), rates_rad_s: self.rates_rad_s })
    }
}

/// The sum of all steps up to a time.
fn stepped(steps: &[(f64, f64)], time_s: f64) -> f64 {
    steps.iter().filter(|(at, _)| *at <= time_s).map(|(_, by)| by).sum()
}

/// What turns an instrument.
pub(super) trait Rig: Subject {
    /// What a mean rate is of.
    const MEAN: &'static str;
    /// When something happens in the middle of a recording.
    const MIDWAY: &'static str;
    /// Samples a second.
    const RATE_HZ: f64;

    /// One that goes all around: on an arc a drift in step with the turn looks like the Earth.
    fn on_circle(seed: u64) -> Self {
        Self::drawn(seed)
    }

    fn unit(&self) -> &Unit;
    fn unit_mut(&mut self) -> &mut Unit;
    /// How long its recording is, s.
    fn seconds(&self) -> f64;
    /// A time at which something may happen, s, with a quarter of the recording on either side at least.
    fn some_time(&self, chance: &mut Chance) -> f64;
    /// 1σ of one mean rate, of a dwell or a turn, from white noise, rad/s.
    fn mean_sigma(&self) -> f64;
    /// The rates that its gyro shows at its usual speed, rad/s.
    fn rates(&self) -> Vec<f64>;

    /// True azimuth at the end, °.
    fn truth_deg(&self) -> f64 {
        let end = self.unit().base.lean(self.seconds());
        self.unit().instruments.azimuth_deg + degrees(end.azimuth_rad)
    }

    /// 1σ of a sample's white noise, rad/s.
    fn sample_sigma(&self) -> f64 {
        self.unit().instruments.gyro.white_sigma_rad_s(Self::RATE_HZ)
    }

    /// Drift of the gyro and its column at work.
    fn at_work(&self) -> (Drifting, Column) {
        let walk = Generator::stream(self.seed(), Self::FAULT + 1);
        let drifting = Drifting::new(Self::RATE_HZ, walk);
        (drifting, Column::new(Self::RATE_HZ, &self.unit().gyro))
    }
}

//! A gyro on a stage that stops: drawn instruments, and what goes wrong with stage, base, gyro and
//! accelerometer.

mod classes;
mod gyro;

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::disturbance::Effect;
use hal_mock::earth::Attitude;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::{BaseMotion, Instruments, InstrumentsConfiguration};
use hal_mock::stage::{EncoderConfiguration, Stage, Stop};
use orientation::align::level;
use orientation::align::regression::{Column as Coefficient, Regression};
use orientation::session::Session;

use super::axes::{Axes, UPRIGHT, shown};
use super::chance::Chance;
use super::{FEW_RESIDUALS, Pair};
use crate::campaign::statistics::Answer;
use crate::output::{azimuth_error, degrees};
use crate::recording::{Body, Header, StageRow};
use crate::replay::{Options, replay};
use gyro::{Column, Drift, Drifting, GyroFault};

pub use classes::CLASSES;

/// The random streams of an instrument and of its fault: none of those that a world draws from.
const DRAWN: u64 = 2_001;
const FAULT: u64 = 2_002;
/// Samples a second: the noise of a dwell does not depend on it.
const RATE_HZ: f64 = 25.0;
/// Step of the encoder: 21 bit.
const ENCODER_STEP_RAD: f64 = TAU / 2_097_152.0;
/// rad/s of one °/h.
const DEGREE_PER_HOUR: f64 = TAU / 360.0 / 3600.0;

/// A drawn instrument, and what is wrong with it.
#[derive(Clone, Debug)]
struct Bench {
    seed: u64,
    instruments: InstrumentsConfiguration,
    stops: Vec<Stop>,
    header: Header,
    has_temperature: bool,
    base: BaseChange,
    /// Steps of the encoder against the stage: from when, s, by how much, rad.
    slips: Vec<(f64, f64)>,
    /// Whether the encoder counts the other way.
    is_reversed: bool,
    /// Rate that nothing explains, rad/s, over the time, s, and the unwrapped stage angle, rad.
    drift: Vec<Drift>,
    gyro: GyroFault,
    /// What the accelerometer's columns show of its axes.
    axes: Axes,
}

/// How a base moves that should stand.
#[derive(Clone, Debug, Default)]
struct BaseChange {
    /// Rates of azimuth, pitch and roll, rad/s.
    rates_rad_s: [f64; 3],
    /// Turns about the vertical: from when, s, by how much, rad.
    turns: Vec<(f64, f64)>,
}

impl Bench {
    /// A healthy instrument at a drawn place; what it is told of itself is true.
    fn drawn(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let latitude_deg = chance.between(-65.0, 65.0);
        let n = chance.scaled(5e-4, 1e-2);
        let b = chance.one_of(&[0.0, 3.0 * n]);
        let (r, k) = chance.one_of(&[(0.0, 0.0), (0.0, 0.0), (10.0 * n, 0.0), (0.0, n)]);
        let scale_sigma = chance.scaled(1e-4, 2e-3);
        let bias_sigma = chance.scaled(5e-3, 0.1);
        let kappa_sigma = chance.one_of(&[0.0, n]);
        let kappa = [0, 1].map(|_| kappa_sigma * chance.normal());
        let instruments = InstrumentsConfiguration {
            latitude_deg,
            azimuth_deg: chance.between(0.0, 360.0),
            rate_hz: RATE_HZ,
            gyro: GyroConfiguration {
                n_deg_sqrt_h: n,
                b_deg_h: b,
                k_deg_h_sqrt_h: k,
                r_deg_h2: r * chance.normal(),
                bias_sigma_deg_h: 1.0,
                scale_sigma,
                g_sensitivity_deg_h_g: kappa,
                ..GyroConfiguration::default()
            },
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: chance.scaled(1e-4, 3e-4),
                bias_sigma_m_s2: bias_sigma,
                ..AccelerometerConfiguration::default()
            },
            encoder: EncoderConfiguration {
                step_rad: ENCODER_STEP_RAD,
                ..EncoderConfiguration::default()
            },
            ..InstrumentsConfiguration::default()
        }
        .leaning(chance.scaled(0.02, 2.0), chance.between(0.0, 360.0));
        let knows_noise = chance.happens(0.7);
        let header = Header {
            latitude_deg: Some(latitude_deg),
            rate_hz: Some(RATE_HZ),
            gyro_n_deg_sqrt_h: knows_noise.then_some(n),
            gyro_b_deg_h: Some(b),
            gyro_k_deg_h_sqrt_h: Some(k),
            gyro_r_deg_h2: Some(r),
            gyro_scale_sigma: Some(scale_sigma),
            accelerometer_bias_m_s2: Some(bias_sigma),
            g_sensitivity_deg_h_g: Some([0.0; 2]),
            g_sensitivity_sigma_deg_h_g: Some(kappa_sigma),
            ..Header::default()
        };
        Self {
            seed,
            instruments,
            stops: stops(&mut chance, 0.9),
            header,
            has_temperature: chance.happens(0.3),
            base: BaseChange::default(),
            slips: Vec::new(),
            is_reversed: false,
            drift: Vec::new(),
            gyro: GyroFault::default(),
            axes: UPRIGHT,
        }
    }

    /// The same on a whole circle: on an arc a drift in step with the turn looks like the Earth.
    fn on_circle(seed: u64) -> Self {
        let stops = stops(&mut Chance::new(seed, FAULT + 3), 1.0);
        Self { stops, ..Self::drawn(seed) }
    }

    fn seconds(&self) -> f64 {
        Stage::new(&self.stops, RATE_HZ).seconds()
    }

    /// When the stage leaves its `index`-th stop, s.
    fn departure(&self, index: usize) -> f64 {
        let through =
            |(k, stop): (usize, &Stop)| stop.dwell_s + if k > 0 { stop.rotation_s } else { 0.0 };
        self.stops.iter().enumerate().take(index + 1).map(through).sum()
    }

    /// A rotation with a quarter of the dwells or more on either side: in fewer, of some headings, neither the
    /// heading before nor that after shows.
    fn some_departure(&self, chance: &mut Chance) -> f64 {
        let dwells = self.stops.len();
        let quarter = dwells.div_ceil(4);
        let (first, last) = (quarter - 1, dwells - 1 - quarter);
        let index = (chance.between(first as f64, last as f64 + 1.0) as usize).min(last);
        self.departure(index) + 0.5 * self.stops[index + 1].rotation_s
    }

    /// The recording.
    fn rows(&self) -> Vec<StageRow> {
        let mut instruments = Instruments::new(&self.instruments, self.seed);
        let mut stage = Stage::new(&self.stops, RATE_HZ);
        let mut drifting = Drifting::new(self.seed);
        let mut column = Column::new(&self.gyro);
        let mut rows = Vec::new();
        while let Some(state) = stage.state(rows.len() as u64) {
            let time_s = rows.len() as f64 / RATE_HZ;
            match self.base.at(time_s) {
                Some(motion) => instruments.turn_on(state, &motion),
                None => instruments.turn(state),
            }
            let rate_rad_s = drifting.rate(&self.drift, time_s, state.angle_rad);
            let sample = instruments.sample(time_s, &Effect { rate_rad_s, ..Effect::default() });
            let slipped: f64 =
                self.slips.iter().filter(|(at, _)| *at <= time_s).map(|(_, by)| by).sum();
            let stage_rad = sample.stage_rad + slipped;
            rows.push(StageRow {
                line: rows.len() as u64 + 1,
                time_s,
                stage_rad: if self.is_reversed { -stage_rad } else { stage_rad },
                rate_rad_s: column.show(sample.rate_rad_s),
                force_m_s2: shown(&self.axes, sample.force_m_s2),
                temperature_c: self.has_temperature.then_some(sample.temperature_c),
            });
        }
        rows
    }

    /// True azimuth at the end, °.
    fn truth_deg(&self) -> f64 {
        let end = self.base.lean(self.seconds());
        self.instruments.azimuth_deg + degrees(end.azimuth_rad)
    }

    fn align(&self) -> (Result<Answer, String>, Option<Session>) {
        let body = Body::Stage(self.rows());
        match replay(&self.header, &body, &Options::default(), |_| ()) {
            Ok(replay) => (answer(&replay.session, self.truth_deg()), Some(replay.session)),
            Err(error) => (Err(error.to_string()), None),
        }
    }

    /// This instrument with a fault and without.
    fn pair(&self, spoil: impl FnOnce(&mut Self, &mut Chance)) -> Pair {
        let (healthy, _) = self.align();
        let mut spoilt = self.clone();
        spoil(&mut spoilt, &mut Chance::new(self.seed, FAULT));
        let (faulty, session) = spoilt.align();
        let unchecked = session.as_ref().and_then(unchecked_deg);
        let unchecked_deg = unchecked.map(|azimuth| azimuth_error(azimuth, spoilt.truth_deg()));
        Pair { healthy, faulty, unchecked_deg, is_few: self.stops.len() < FEW_RESIDUALS + 3 }
    }
}

/// Where the stage goes: a circle, or an arc, and back to the first position.
fn stops(chance: &mut Chance, circles: f64) -> Vec<Stop> {
    let positions = chance.one_of(&[8, 12, 16, 24]);
    let (dwell_s, rotation_s) = (chance.between(5.0, 12.0), chance.between(1.0, 2.5));
    let is_circle = chance.happens(circles);
    let whole = if is_circle { TAU } else { chance.between(0.3, 0.6) * TAU };
    let start = chance.between(0.0, TAU);
    let step = whole / f64::from(positions);
    let mut list: Vec<f64> = (0..positions).map(|k| start + f64::from(k) * step).collect();
    list.push(start);
    list.into_iter().map(|angle| Stop::new(angle, dwell_s).after(rotation_s)).collect()
}

impl BaseChange {
    /// How far the base has come from its attitude.
    fn lean(&self, time_s: f64) -> Attitude {
        let [azimuth, pitch, roll] = self.rates_rad_s.map(|rate| rate * time_s);
        let turned: f64 = self.turns.iter().filter(|(at, _)| *at <= time_s).map(|(_, by)| by).sum();
        Attitude { azimuth_rad: azimuth + turned, pitch_rad: pitch, roll_rad: roll }
    }

    /// The motion at a time; none of a base that stands.
    fn at(&self, time_s: f64) -> Option<BaseMotion> {
        let stands = self.turns.is_empty() && self.rates_rad_s == [0.0; 3];
        (!stands).then(|| BaseMotion { lean: self.lean(time_s), rates_rad_s: self.rates_rad_s })
    }
}

/// The answer of a session against the truth.
fn answer(session: &Session, truth_deg: f64) -> Result<Answer, String> {
    let conclusion = session.conclusion().ok_or("the session did not end")?;
    Answer::of(conclusion, truth_deg).map_err(|refusal| refusal.to_string())
}

/// Azimuth of plain least squares on all dwells, °: nothing is checked, nothing left out.
fn unchecked_deg(session: &Session) -> Option<f64> {
    let setting = session.setting();
    let gravity = setting.latitude.gravity();
    let tilt = level::tilt(session.dwells().iter(), gravity, setting.accelerometer_bias_sigma);
    let mut regression = Regression::<3>::default();
    for dwell in session.dwells() {
        let axis = tilt.sensitive_axis(dwell.stage.rad());
        let left = dwell.rate + setting.latitude.vertical_rate() * axis[2];
        regression.push(&[axis[0], -axis[1], 1.0], left);
    }
    let [north, east, _] = regression.solve(&[Coefficient::Free; 3])?.coefficients;
    Some(degrees(east.atan2(north)))
}

impl Bench {
    /// 1σ of a dwell's mean rate from white noise, rad/s.
    fn dwell_sigma(&self) -> f64 {
        let seconds = self.stops.first().map_or(1.0, |stop| stop.dwell_s);
        self.sample_sigma() / (seconds * RATE_HZ).sqrt()
    }

    /// 1σ of a sample's white noise, rad/s.
    fn sample_sigma(&self) -> f64 {
        self.instruments.gyro.white_sigma_rad_s(RATE_HZ)
    }
}

/// The answer of a drawn instrument without any fault.
pub fn healthy(seed: u64) -> Result<Answer, String> {
    Bench::drawn(seed).align().0
}

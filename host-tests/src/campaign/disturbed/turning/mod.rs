//! A gyro on a platform that turns all the time: drawn instruments, and what goes wrong with platform, base, gyro
//! and accelerometer.

mod classes;
mod gyro;

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::earth::Attitude;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::{BaseMotion, InstrumentsConfiguration};
use hal_mock::stage::{EncoderConfiguration, Ripple, Unevenness};
use hal_mock::turntable::{EncoderSlip, Segment, TurningSample, Turntable, TurntableConfiguration};
use orientation::align::rotating::coupling;
use orientation::align::rotating::level::Lean;
use orientation::align::rotating::solution::Fit;
use orientation::align::rotating::turn::{Stretch, Turn};
use orientation::math::Complex;
use orientation::session::rotating::Session;

use super::Pair;
use super::axes::{Axes, UPRIGHT, shown};
use super::chance::Chance;
use crate::campaign::statistics::Answer;
use crate::output::{azimuth_error, degrees};
use crate::recording::{Body, Header, RotatingRow, Sensor};
use crate::replay::Options;
use crate::rotating::replay;
use gyro::{Column, Drift, Drifting, GyroFault};

pub use classes::CLASSES;

/// The random streams of an instrument and of its fault: none of those that a world draws from.
const DRAWN: u64 = 2_011;
const FAULT: u64 = 2_012;
/// Samples a second: the noise of a turn does not depend on it.
const RATE_HZ: f64 = 50.0;
/// Step of the encoder: 21 bit.
const ENCODER_STEP_RAD: f64 = TAU / 2_097_152.0;
/// rad/s of one °/h.
const DEGREE_PER_HOUR: f64 = TAU / 360.0 / 3600.0;
/// Turns of the uneven stretch, its depth, relative, and its frequency in turns.
const UNEVEN: (f64, f64, f64) = (12.0, 0.25, 0.83);
/// Time in which the platform takes on another rate, s.
const RAMP_SECONDS: f64 = 3.0;

/// A drawn instrument, and what is wrong with it.
#[derive(Clone, Debug)]
struct Bench {
    seed: u64,
    instruments: InstrumentsConfiguration,
    unevenness: Unevenness,
    start_rad: f64,
    /// How long the platform turns unevenly, and then either way, s; how fast, rad/s.
    uneven_s: f64,
    either_s: f64,
    speed: f64,
    header: Header,
    base: BaseChange,
    /// What the encoder shows more: from when, s, by how much, rad.
    slips: Vec<(f64, f64)>,
    /// Whether the encoder counts the other way, and whether the stage's rate is the encoder's own.
    is_reversed: bool,
    rate_is_encoders: bool,
    /// Rate that nothing explains.
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
    /// A turn about the vertical: from when, s, by how much, rad.
    turn: Option<(f64, f64)>,
}

impl Bench {
    /// A healthy instrument at a drawn place; what it is told of itself is true.
    fn drawn(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let latitude_deg = chance.between(-65.0, 65.0);
        let n = chance.scaled(1e-3, 2e-2);
        let b = chance.one_of(&[0.0, 3.0 * n]);
        let (r, k) = chance.one_of(&[(0.0, 0.0), (0.0, 0.0), (10.0 * n, 0.0), (0.0, n)]);
        let scale_sigma = chance.scaled(1e-4, 2e-3);
        let bias_sigma = chance.scaled(5e-3, 0.1);
        let kappa_sigma = chance.one_of(&[0.0, n]);
        let zero_sigma_deg = chance.scaled(0.002, 0.05);
        let kappa = [0, 1].map(|_| kappa_sigma * chance.normal());
        let turn_hz = chance.scaled(0.08, 0.3);
        let ripple = |chance: &mut Chance, low: f64, high: f64| Ripple {
            relative: chance.scaled(low, high),
            phase_rad: chance.between(0.0, TAU),
        };
        let unevenness = Unevenness {
            first: ripple(&mut chance, 1e-4, 3e-3),
            second: ripple(&mut chance, 1e-5, 2e-4),
        };
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
                axis_elevation_rad: (chance.sign() * chance.between(0.2, 1.2)).to_radians(),
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
            sensor: Some(Sensor::Gyro),
            gyro_n_deg_sqrt_h: knows_noise.then_some(n),
            gyro_b_deg_h: Some(b),
            gyro_k_deg_h_sqrt_h: Some(k),
            gyro_r_deg_h2: Some(r),
            gyro_scale_sigma: Some(scale_sigma),
            accelerometer_bias_m_s2: Some(bias_sigma),
            g_sensitivity_deg_h_g: Some([0.0; 2]),
            g_sensitivity_sigma_deg_h_g: Some(kappa_sigma),
            encoder_zero_sigma_deg: Some(zero_sigma_deg),
            ..Header::default()
        };
        Self {
            seed,
            instruments,
            unevenness,
            start_rad: chance.between(0.0, TAU),
            uneven_s: UNEVEN.0 / turn_hz,
            either_s: chance.between(120.0, 240.0),
            speed: TAU * turn_hz,
            header,
            base: BaseChange::default(),
            slips: vec![(0.0, zero_sigma_deg.to_radians() * chance.normal())],
            is_reversed: false,
            rate_is_encoders: chance.happens(0.5),
            drift: Vec::new(),
            gyro: GyroFault::default(),
            axes: UPRIGHT,
        }
    }

    fn segments(&self) -> [Segment; 3] {
        let (_, depth, part) = UNEVEN;
        let uneven = Segment::steady(self.speed, self.uneven_s);
        let even = |rate: f64| Segment::steady(rate, self.either_s).after(RAMP_SECONDS);
        [uneven.uneven(depth, part * self.speed / TAU), even(self.speed), even(-self.speed)]
    }

    fn seconds(&self) -> f64 {
        self.segments().iter().map(|segment| segment.seconds).sum()
    }

    /// A time mid-way in the even turns, s: with a quarter of them on either side at least.
    fn some_time(&self, chance: &mut Chance) -> f64 {
        let even_s = self.seconds() - self.uneven_s;
        self.uneven_s + even_s * chance.between(0.25, 0.75)
    }

    /// The recording.
    fn rows(&self) -> Vec<RotatingRow> {
        let segments = self.segments();
        let configuration = TurntableConfiguration {
            instruments: self.instruments,
            unevenness: self.unevenness,
            start_rad: self.start_rad,
            slip: EncoderSlip::default(),
            segments: &segments,
            ..TurntableConfiguration::default()
        };
        let mut turntable = Turntable::new(&configuration, self.seed);
        let mut drifting = Drifting::new(self.seed);
        let mut column = Column::new(&self.gyro);
        let mut rows: Vec<RotatingRow> = Vec::new();
        let mut befalls =
            |time_s: f64, _: f64| (self.base.at(time_s), drifting.rate(&self.drift, time_s));
        while let Some(sample) = turntable.next_on(&mut befalls) {
            let row = self.row(&sample, rows.last(), &mut column);
            rows.push(row);
        }
        if self.rate_is_encoders { with_own_rate(rows) } else { rows }
    }

    fn row(
        &self,
        sample: &TurningSample,
        last: Option<&RotatingRow>,
        column: &mut Column,
    ) -> RotatingRow {
        let time_s = sample.time_s;
        let slipped: f64 =
            self.slips.iter().filter(|(at, _)| *at <= time_s).map(|(_, by)| by).sum();
        let sense = if self.is_reversed { -1.0 } else { 1.0 };
        let stage_rad = sense * (sample.stage_rad + slipped);
        let [along, across, _] = shown(&self.axes, sample.force_m_s2);
        RotatingRow {
            line: last.map_or(1, |last| last.line + 1),
            time_s,
            stage_rad,
            stage_rate_rad_s: sense * sample.stage_rate_rad_s,
            rate_rad_s: column.show(sample.rate_rad_s),
            force_m_s2: along,
            across_m_s2: Some(across),
        }
    }

    /// True azimuth at the end, °.
    fn truth_deg(&self) -> f64 {
        let end = self.base.lean(self.seconds());
        self.instruments.azimuth_deg + degrees(end.azimuth_rad)
    }

    fn align(&self) -> (Result<Answer, String>, Option<Session>) {
        let body = Body::Rotating(self.rows());
        match replay(&self.header, &body, &Options::default()) {
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
        Pair { healthy, faulty, unchecked_deg, is_few: false }
    }

    /// 1σ of either part of a turn's phasor from white noise, rad/s.
    fn turn_sigma(&self) -> f64 {
        self.sample_sigma() * (2.0 * self.speed / TAU / RATE_HZ).sqrt()
    }

    /// 1σ of a sample's white noise, rad/s.
    fn sample_sigma(&self) -> f64 {
        self.instruments.gyro.white_sigma_rad_s(RATE_HZ)
    }
}

/// The rows with the stage's rate as its angles show it, between the samples beside each.
fn with_own_rate(mut rows: Vec<RotatingRow>) -> Vec<RotatingRow> {
    let angles: Vec<f64> = rows.iter().map(|row| row.stage_rad).collect();
    for (row, beside) in rows.iter_mut().skip(1).zip(angles.windows(3)) {
        row.stage_rate_rad_s = 0.5 * (beside[2] - beside[0]) * RATE_HZ;
    }
    rows
}

impl BaseChange {
    /// How far the base has come from its attitude.
    fn lean(&self, time_s: f64) -> Attitude {
        let [azimuth, pitch, roll] = self.rates_rad_s.map(|rate| rate * time_s);
        let turned = self.turn.filter(|(at, _)| *at <= time_s).map_or(0.0, |(_, by)| by);
        Attitude { azimuth_rad: azimuth + turned, pitch_rad: pitch, roll_rad: roll }
    }

    /// The motion at a time; none of a base that stands.
    fn at(&self, time_s: f64) -> Option<BaseMotion> {
        let stands = self.turn.is_none() && self.rates_rad_s == [0.0; 3];
        (!stands).then(|| BaseMotion { lean: self.lean(time_s), rates_rad_s: self.rates_rad_s })
    }
}

/// The answer of a session against the truth.
fn answer(session: &Session, truth_deg: f64) -> Result<Answer, String> {
    let conclusion = session.conclusion().ok_or("the session did not end")?;
    let azimuth = conclusion.verdict.map_err(|refusal| refusal.to_string())?;
    // Where the noise is not stated, what its estimate leaves stands for the limit.
    let limit = |fit: Fit| degrees(if fit.limit > 0.0 { fit.limit } else { fit.budget.noise });
    let limit = conclusion.fit.map_or(f64::NAN, limit);
    let error = azimuth_error(degrees(azimuth.angle), truth_deg);
    Ok(Answer { error, sigma: degrees(azimuth.sigma), limit })
}

/// Azimuth of the plain mean of all turns of both senses, °: nothing is checked, nothing left out.
fn unchecked_deg(session: &Session) -> Option<f64> {
    let conclusion = session.conclusion()?;
    let common = &session.setting().common;
    let mean = |of: &dyn Fn(&Stretch) -> Complex| {
        let stretches = session.follower().stretches();
        let turned = |stretch: &&Stretch| !stretch.turns().is_empty();
        let both = [-1.0, 1.0].map(|sense| {
            stretches.iter().filter(turned).find(|stretch| stretch.sense.signed(sense) > 0.0)
        });
        let [counter, clockwise] = both.map(|stretch| stretch.map(of));
        Some((counter? + clockwise?).scaled(0.5))
    };
    let rate = mean(&|stretch| {
        let frequency = stretch.sense.signed(stretch.speed());
        let coupling = coupling::nearest(&conclusion.couplings, frequency);
        let response = coupling.map_or(Complex::default(), |found| found.response(frequency));
        average(stretch, |turn| {
            Complex::of_signal(turn.rate) - response * Complex::of_signal(turn.turning)
        })
    })?;
    let force = mean(&|stretch| average(stretch, |turn| Complex::of_signal(turn.force)))?;
    let tilt = force.scaled(1.0 / common.latitude.gravity());
    let vertical = common.latitude.vertical_rate();
    let (azimuth, _) = Lean::of(tilt).azimuth(rate - tilt.scaled(vertical));
    Some(degrees(azimuth))
}

/// The mean of something over a stretch's turns.
fn average(stretch: &Stretch, of: impl Fn(&Turn) -> Complex) -> Complex {
    let turns = stretch.turns();
    let sum = turns.iter().map(of).fold(Complex::default(), |sum, part| sum + part);
    sum.scaled(1.0 / turns.len().max(1) as f64)
}

/// The answer of a drawn instrument without any fault.
pub fn healthy(seed: u64) -> Result<Answer, String> {
    Bench::drawn(seed).align().0
}

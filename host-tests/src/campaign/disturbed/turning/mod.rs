//! A gyro, or a molecular-electronic sensor, on a platform that turns all the time: drawn instruments, and what goes
//! wrong with platform, base, sensor and accelerometer.

mod classes;
mod plain;

use std::f64::consts::TAU;

use hal_mock::earth::EARTH_RATE_RAD_S;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::stage::{Ripple, Unevenness};
use hal_mock::turntable::{Segment, Turntable, TurntableConfiguration};
use orientation::alignment::rotating::Session;
use orientation::alignment::{Method, Solution};
use orientation::units::Radians;

use super::Platform;
use super::axes::shown;
use super::class::{Aligned, Subject};
use super::unit::{Grade, Rig, Unit};
use crate::assumptions::unseen;
use crate::campaign::chance::Chance;
use crate::methods::asked::Asked;
use crate::methods::rotating::replay;
use crate::recording::{Body, Header, RotatingRow, Sensor};

/// A platform that turns all the time.
pub(super) const PLATFORM: Platform = Platform::of::<Instrument>("turning", classes::classes);

/// The random stream of an instrument: none of those that a world draws from.
const DRAWN: u64 = 2_011;
/// The random stream of what a molecular-electronic sensor is, and part of the instruments that have one.
const MOLECULAR: u64 = 2_014;
const MOLECULAR_PART: f64 = 0.25;
/// N of its gyro, °/√h.
const N: [f64; 2] = [1e-3, 2e-2];
/// Turns of the rate-modulated stretch, its depth, relative, and its frequency in turns.
const MODULATED: (f64, f64, f64) = (12.0, 0.25, 0.83);
/// Time in which the platform takes on another rate, s.
const RAMP_SECONDS: f64 = 3.0;

/// A drawn instrument on its platform.
#[derive(Clone, Debug)]
struct Instrument {
    unit: Unit,
    unevenness: Unevenness,
    start_rad: f64,
    /// How long the platform's rate is modulated, and how long it then turns either way, s; how fast, rad/s.
    modulated_s: f64,
    either_s: f64,
    speed: f64,
    /// Whether the stage's rate is the encoder's own.
    rate_is_encoders: bool,
    /// How many times as fast the platform turns after that; none of a gyro.
    second: Option<f64>,
}

impl Instrument {
    /// A healthy gyro at a drawn place; what is stated about it is true.
    fn with_gyro(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let grade = Grade::drawn(&mut chance, N);
        let zero_sigma_deg = chance.scaled(0.002, 0.05);
        let kappa = grade.g_sensitivity(&mut chance);
        let turn_hz = chance.scaled(0.08, 0.3);
        let unevenness = Unevenness {
            first: ripple(&mut chance, 1e-4, 3e-3),
            second: ripple(&mut chance, 1e-5, 2e-4),
        };
        let elevation =
            |chance: &mut Chance| (chance.sign() * chance.between(0.2, 1.2)).to_radians();
        let instruments = grade.instruments(&mut chance, Self::RATE_HZ, kappa, elevation);
        let header = Header {
            sensor: Some(Sensor::Gyro),
            encoder_zero_sigma_deg: Some(zero_sigma_deg),
            ..grade.header(Self::RATE_HZ, chance.happens(0.7))
        };
        let mut rig = Self {
            unit: Unit::new(seed, &instruments, header),
            unevenness,
            start_rad: chance.between(0.0, TAU),
            modulated_s: MODULATED.0 / turn_hz,
            either_s: chance.between(120.0, 240.0),
            speed: TAU * turn_hz,
            rate_is_encoders: false,
            second: None,
        };
        rig.unit.slips.push((0.0, zero_sigma_deg.to_radians() * chance.normal()));
        rig.rate_is_encoders = chance.happens(0.5);
        rig
    }

    /// Puts a molecular-electronic sensor of unknown gain, lag and g-sensitivity in its place, which needs two speeds.
    fn make_molecular(&mut self, chance: &mut Chance) {
        let second = chance.between(1.6, 3.0);
        let instruments = &mut self.unit.instruments;
        let horizontal = EARTH_RATE_RAD_S * instruments.latitude_deg.to_radians().cos();
        let [along, across] =
            [instruments.pitch_deg, instruments.roll_deg].map(|angle| angle.to_radians().sin());
        let ratio = chance.scaled(0.01, 0.3);
        let size = ratio * self.speed * horizontal / along.hypot(across);
        let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
        let tangent = chance.scaled(0.03, 1.0);
        instruments.gyro.molecular = Some(MolecularConfiguration {
            force_rad_s2_g: [size * cosine, size * sine],
            high_pass_hz: 0.0,
            lag_s: tangent / (second * self.speed),
        });
        self.unit.header.sensor = Some(Sensor::Met);
        self.second = Some(second);
    }

    fn segments(&self) -> Vec<Segment> {
        let (_, depth, part) = MODULATED;
        let modulated = Segment::steady(self.speed, self.modulated_s);
        let even = |rate: f64| Segment::steady(rate, self.either_s).after(RAMP_SECONDS);
        let speeds = [Some(1.0), self.second].into_iter().flatten();
        let first = modulated.modulated(depth, part * self.speed / TAU);
        let both = speeds.flat_map(|times| [even(times * self.speed), even(-times * self.speed)]);
        [first].into_iter().chain(both).collect()
    }

    /// The recording.
    fn rows(&self) -> Vec<RotatingRow> {
        let segments = self.segments();
        let configuration = TurntableConfiguration {
            instruments: self.unit.instruments,
            unevenness: self.unevenness,
            start_rad: self.start_rad,
            segments: &segments,
            ..TurntableConfiguration::default()
        };
        let mut turntable = Turntable::new(&configuration, self.unit.seed);
        let (mut drifting, mut column) = self.at_work();
        let mut rows: Vec<RotatingRow> = Vec::new();
        let unit = &self.unit;
        let mut befalls = |time_s: f64, angle_rad: f64| {
            (unit.base.at(time_s), drifting.rate(&unit.drift, time_s, angle_rad))
        };
        while let Some(sample) = turntable.next_on(&mut befalls) {
            let [along, across, _] = shown(&unit.axes, sample.force_m_s2);
            rows.push(RotatingRow {
                line: rows.len() as u64 + 1,
                time_s: sample.time_s,
                stage_rad: unit.shown_rad(sample.stage_rad, sample.time_s),
                stage_rate_rad_s: unit.sense() * sample.stage_rate_rad_s,
                rate_rad_s: column.show(sample.rate_rad_s),
                force_m_s2: along,
                across_m_s2: Some(across),
                force_is_new: true,
            });
        }
        if self.rate_is_encoders { with_own_rate(rows) } else { rows }
    }
}

impl Subject for Instrument {
    const NAME: &'static str = "turning-";
    const FAULT: u64 = 2_012;

    /// One of four has a molecular-electronic sensor.
    fn drawn(seed: u64) -> Self {
        let mut chance = Chance::new(seed, MOLECULAR);
        let mut rig = Self::with_gyro(seed);
        if chance.happens(MOLECULAR_PART) {
            rig.make_molecular(&mut chance);
        }
        rig
    }

    fn seed(&self) -> u64 {
        self.unit.seed
    }

    fn align(&self) -> Aligned {
        let body = Body::Rotating(self.rows());
        replay(&self.unit.header, &body, &Asked::default())
            .map_or_else(Aligned::refused, |replay| aligned(&replay.session, self.truth_deg()))
    }
}

impl Rig for Instrument {
    const MEAN: &'static str = "turn";
    const MIDWAY: &'static str = "mid-way";
    /// The noise of a turn does not depend on it.
    const RATE_HZ: f64 = 50.0;

    fn unit(&self) -> &Unit {
        &self.unit
    }

    fn unit_mut(&mut self) -> &mut Unit {
        &mut self.unit
    }

    fn seconds(&self) -> f64 {
        self.segments().iter().map(|segment| segment.seconds).sum()
    }

    /// In the even turns, with a quarter of them on either side at least.
    fn some_time(&self, chance: &mut Chance) -> f64 {
        let even_s = self.seconds() - self.modulated_s;
        self.modulated_s + even_s * chance.between(0.25, 0.75)
    }

    /// 1σ of either part of a turn's phasor, rad/s.
    fn mean_sigma(&self) -> f64 {
        self.sample_sigma() * (2.0 * self.speed / TAU / Self::RATE_HZ).sqrt()
    }

    /// Rates of the gyro in the even turns, rad/s.
    fn rates(&self) -> Vec<f64> {
        let even = (self.modulated_s + RAMP_SECONDS) * Self::RATE_HZ;
        self.rows().iter().skip(even as usize).map(|row| row.rate_rad_s).collect()
    }
}

/// What a session found, and the plain mean of all turns.
fn aligned(session: &Session, truth_deg: f64) -> Aligned {
    // Where the noise is not stated, what its estimate leaves stands for the limit.
    let noise =
        session.conclusion().and_then(|found| found.fit).map_or(0.0, |fit| fit.budget.noise.0);
    let limited = |Solution { azimuth, limit }: Solution| Solution {
        azimuth,
        limit: if limit.0 > 0.0 { limit } else { Radians(noise) },
    };
    let verdict = session.verdict().map(|verdict| verdict.map(limited));
    let plain_deg = plain::azimuth_deg(session);
    Aligned::of(verdict, plain_deg, &unseen::of_platform(session), truth_deg)
}

/// A ripple of a size between two values.
fn ripple(chance: &mut Chance, low: f64, high: f64) -> Ripple {
    Ripple { relative: chance.scaled(low, high), phase_rad: chance.between(0.0, TAU) }
}

/// The rows with the stage's rate as its angles show it, between the samples beside each.
fn with_own_rate(mut rows: Vec<RotatingRow>) -> Vec<RotatingRow> {
    let angles: Vec<f64> = rows.iter().map(|row| row.stage_rad).collect();
    for (row, beside) in rows.iter_mut().skip(1).zip(angles.windows(3)) {
        row.stage_rate_rad_s = 0.5 * (beside[2] - beside[0]) * Instrument::RATE_HZ;
    }
    rows
}

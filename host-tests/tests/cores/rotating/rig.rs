//! A simulated platform, the session that looks at it, and what came of it.

use std::f64::consts::{PI, TAU};

use hal_mock::disturbance::Effect;
use hal_mock::gyro::DEGREE_PER_HOUR;
use hal_mock::instruments::{Instruments, InstrumentsConfiguration};
use hal_mock::stage::{StageState, Unevenness};
use hal_mock::turntable::{Segment, TurningSample, Turntable, TurntableConfiguration};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::conclusion::Conclusion;
use orientation::alignment::rotating::session::{Procedure, Session};
use orientation::alignment::rotating::{Sensor, Setting};
use orientation::alignment::site::Site;
use orientation::alignment::{Input, Method, Request};
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::signal::Sample;
use orientation::units::{Angle, AngularRate, Instant, Radians, Seconds, SpecificForce};

/// A platform as the simulation knows it, and what the solver is reported of it.
#[derive(Clone, Debug)]
pub struct Case {
    pub instruments: InstrumentsConfiguration,
    pub unevenness: Unevenness,
    pub start_rad: f64,
    pub segments: Vec<Segment>,
    pub setting: Setting,
    /// Whether the platform's rate is taken from the encoder instead of from the recording.
    pub is_by_encoder: bool,
}

/// A sample as an instrument hands it over.
pub fn sample(from: &TurningSample) -> Sample {
    let force = from.force_m_s2.map(SpecificForce::from_m_per_s2);
    Sample {
        time: Instant::from_seconds(from.time_s),
        stage: Angle::from_rad(from.stage_rad),
        rate: AngularRate::from_rad_per_s(from.rate_rad_s),
        force: Some(force),
        ..Sample::default()
    }
}

/// Replays samples as a recording.
fn replayed(
    setting: &Setting,
    period: f64,
    is_by_encoder: bool,
    samples: impl Iterator<Item = TurningSample>,
) -> Conclusion {
    let procedure = Procedure::recorded(Seconds(period));
    let mut session = Session::new(*setting, procedure).expect("a recording has no speeds");
    for turning in samples {
        let sample = sample(&turning);
        if is_by_encoder {
            session.feed(Input::Sample(&sample));
        } else {
            session.take_recorded(&sample, turning.stage_rate_rad_s as f32);
        }
    }
    session.feed(Input::End);
    session.conclusion().expect("the session has ended").clone()
}

/// Turns with amplitude `depth` about `speed`, at 0.83 of once per turn.
pub fn modulated(speed: f64, turns: f64) -> Segment {
    Segment::steady(speed, turns * TAU / speed).modulated(0.25, 0.83 * speed / TAU)
}

/// A rate-modulated stretch, and so many turns in both senses.
pub fn both_senses(speed: f64, turns: f64) -> Vec<Segment> {
    let seconds = turns * TAU / speed;
    let even = |rate: f64| Segment::steady(rate, seconds).after(2.0);
    vec![modulated(speed, 8.0), even(speed), even(-speed)]
}

/// A flat sensor at a latitude, of a known N in °/√h.
pub fn flat(latitude_deg: f64, n: f64) -> Setting {
    let mut site = Site::at(Latitude::from_degrees(latitude_deg).expect("a latitude"));
    site.noise = StatedNoise::Whole(GyroNoise::from_field_units(n, 0.0, 0.0, 0.0));
    site.required_sigma = Radians(PI);
    Setting::new(site, Sensor::GYRO)
}

/// A molecular-electronic sensor there.
pub fn molecular(latitude_deg: f64, n: f64) -> Setting {
    Setting { sensor: Sensor::MOLECULAR, ..flat(latitude_deg, n) }
}

impl Case {
    pub fn configuration(&self) -> TurntableConfiguration<'_> {
        TurntableConfiguration {
            instruments: self.instruments,
            unevenness: self.unevenness,
            start_rad: self.start_rad,
            segments: &self.segments,
            ..TurntableConfiguration::default()
        }
    }

    /// What the session makes of its recording.
    pub fn conclude(&self, seed: u64) -> Conclusion {
        self.conclude_as(&self.configuration(), seed)
    }

    /// What the session makes of another configuration, a fault in it perhaps.
    pub fn conclude_as(&self, configuration: &TurntableConfiguration, seed: u64) -> Conclusion {
        let period = 1.0 / self.instruments.rate_hz;
        replayed(&self.setting, period, self.is_by_encoder, Turntable::new(configuration, seed))
    }

    /// What the platform's instruments show.
    pub fn samples(&self, seed: u64) -> Vec<TurningSample> {
        Turntable::new(&self.configuration(), seed).collect()
    }

    /// What the session makes of samples, as a recording.
    pub fn replay(&self, samples: &[TurningSample]) -> Conclusion {
        let period = 1.0 / self.instruments.rate_hz;
        replayed(&self.setting, period, self.is_by_encoder, samples.iter().copied())
    }

    /// Error of a conclusion's azimuth, and its σ, rad.
    pub fn error(&self, conclusion: &Conclusion) -> Result<(f64, f64), Refusal> {
        let azimuth = conclusion.verdict?;
        let away = azimuth.angle.0 - self.instruments.azimuth_deg.to_radians();
        Ok((away.sin().atan2(away.cos()), azimuth.sigma.0))
    }
}

/// Root of the mean square.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// What a plant did, driven by a session.
pub struct Driven {
    pub session: Session,
    pub seconds: f64,
    pub commands: Vec<f64>,
}

/// A motor that takes on a rate with this acceleration, rad/s².
const ACCELERATION: f64 = 1.5;

/// Drives a motor, a gear and instruments by what a session commands, for an hour at most; `fault` may
/// change a sample or the commanded rate.
pub fn driven(
    case: &Case,
    procedure: Procedure,
    seed: u64,
    mut fault: impl FnMut(&mut TurningSample, &mut f64),
) -> Driven {
    let rate_hz = case.instruments.rate_hz;
    let mut session = Session::new(case.setting, procedure).expect("a sound procedure");
    let mut instruments = Instruments::new(&case.instruments, seed);
    let mut motor = StageState { angle_rad: case.start_rad, rate_rad_s: 0.0 };
    let (mut wanted, mut commands) = (0.0, Vec::new());
    let most = (3600.0 * rate_hz) as u64;
    for number in 0..most {
        let time_s = number as f64 / rate_hz;
        let stage = case.unevenness.stage(motor);
        instruments.turn(stage);
        let mut turning = TurningSample {
            time_s,
            stage_rad: instruments.shown_rad(),
            stage_rate_rad_s: stage.rate_rad_s,
            rate_rad_s: instruments.rate(time_s, &Effect::default()),
            force_m_s2: instruments.force(&Effect::default()),
        };
        let mut obeyed = wanted;
        fault(&mut turning, &mut obeyed);
        match session.feed(Input::Sample(&sample(&turning))) {
            Request::Turn(rate) => {
                wanted = rate.0;
                commands.push(wanted);
            }
            Request::Done => return Driven { session, seconds: time_s, commands },
            _ => {}
        }
        let most = ACCELERATION / rate_hz;
        let before = motor.rate_rad_s;
        motor.rate_rad_s += (obeyed - before).clamp(-most, most);
        motor.angle_rad += 0.5 * (before + motor.rate_rad_s) / rate_hz;
    }
    session.feed(Input::End);
    Driven { session, seconds: 3600.0, commands }
}

/// The seeds of a campaign, on all cores.
pub fn over<T: Send>(seeds: std::ops::Range<u64>, run: impl Fn(u64) -> T + Sync + Send) -> Vec<T> {
    use rayon::prelude::*;
    seeds.into_par_iter().map(run).collect()
}

/// °/h/g as rad/s/g.
pub fn per_g(degrees_per_hour: f64) -> f64 {
    degrees_per_hour * DEGREE_PER_HOUR
}

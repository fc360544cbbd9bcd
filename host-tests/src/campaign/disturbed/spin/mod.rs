//! A spinning body with one gyro and two accelerometers: drawn flights, and what goes wrong with their sensors.

mod classes;
mod plain;

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::spin::profile::Profile;
use hal_mock::spin::{SpinConfiguration, SpinWorld};

use super::Platform;
use super::class::{Aligned, Subject};
use crate::campaign::chance::Chance;
use crate::campaign::statistics::Answer;
use crate::methods::asked::Asked;
use crate::methods::spin::errors::wrapped;
use crate::methods::spin::replay;
use crate::output::degrees;
use crate::recording::{Body, Header, SpinRow};

/// A spinning body.
pub(super) const PLATFORM: Platform = Platform::of::<Recorded>("spin", classes::classes);

/// The random stream of a flight: none of those that a world draws from.
const DRAWN: u64 = 2_031;

/// A drawn flight; what is stated about its gyro is true.
#[derive(Clone, Debug)]
struct Flight {
    seed: u64,
    /// Body and gyros; not yet how they turn, the lift and the accelerometers' noise.
    body: SpinConfiguration<'static>,
    /// Rate of the roll and lift, rad/s and m/s², at some times, s.
    spin_rad_s: [(f64, f64); 3],
    lift_m_s2: [(f64, f64); 3],
    noise_m_s2: f64,
    header: Header,
}

impl Flight {
    /// Draws a healthy flight.
    fn drawn(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let (seconds, rate_hz) =
            (chance.between(0.8, 2.0), chance.one_of(&[8_000.0, 10_000.0, 14_400.0]));
        let spin = chance.sign() * TAU * chance.between(40.0, 100.0);
        let lift = chance.scaled(8.0, 50.0);
        let n = chance.scaled(0.05, 5.0);
        let (bias, scale) = (chance.scaled(10.0, 200.0), chance.scaled(1e-3, 1e-2));
        let gyro = GyroConfiguration {
            n_deg_sqrt_h: n,
            bias_sigma_deg_h: bias,
            scale_sigma: scale,
            ..GyroConfiguration::default()
        };
        let header = Header {
            rate_hz: Some(rate_hz),
            gyro_n_deg_sqrt_h: chance.happens(0.7).then_some(n),
            gyro_bias_deg_h: Some(bias),
            gyro_scale_sigma: Some(scale),
            ..Header::default()
        };
        let roll_rad = chance.between(0.0, TAU);
        let spin_rad_s = changing(&mut chance, seconds, spin, 0.05);
        let lift_m_s2 = changing(&mut chance, seconds, lift, 0.2);
        let radius_m = [0, 1].map(|_| chance.between(-0.02, 0.02));
        let (gyros, usual) = ([gyro; 3], SpinConfiguration::default());
        let body = SpinConfiguration { rate_hz, seconds, roll_rad, radius_m, gyros, ..usual };
        let noise_m_s2 = lift * chance.scaled(3e-3, 0.1);
        Self { seed, body, spin_rad_s, lift_m_s2, noise_m_s2, header }
    }

    /// What its sensors show.
    fn recorded(&self) -> Recorded {
        let mut configuration = SpinConfiguration {
            spin_rad_s: Profile(&self.spin_rad_s),
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: self.noise_m_s2 / (0.5 * self.body.rate_hz).sqrt(),
                bias_sigma_m_s2: 0.1,
                ..AccelerometerConfiguration::default()
            },
            ..self.body
        };
        configuration.forces.lift_m_s2 = Profile(&self.lift_m_s2);
        let mut world = SpinWorld::new(&configuration, self.seed);
        let (mut rows, mut rolls_rad) = (Vec::new(), Vec::new());
        while let Some(sample) = world.next() {
            let [rate_rad_s, ..] = sample.rate_rad_s;
            let (line, time_s) = (rows.len() as u64 + 1, sample.time_s);
            let force_m_s2 = sample.force_m_s2;
            rows.push(SpinRow { line, time_s, rate_rad_s, force_m_s2, across_rad_s: None });
            rolls_rad.push(world.truth().roll_rad);
        }
        let (seed, lift_m_s2) = (self.seed, self.lift_m_s2[0].1);
        Recorded { seed, rows, rolls_rad, lift_m_s2, header: self.header.clone() }
    }
}

/// A value that changes by up to such a part of itself a second, another way after the middle.
fn changing(chance: &mut Chance, seconds: f64, value: f64, part: f64) -> [(f64, f64); 3] {
    let half = 0.5 * seconds;
    let mut step = |before: f64| before * (1.0 + chance.between(-part, part) * half);
    let middle = step(value);
    [(0.0, value), (half, middle), (seconds, step(middle))]
}

/// A flight as it was recorded, and the true roll at each sample.
#[derive(Clone, Debug)]
struct Recorded {
    seed: u64,
    rows: Vec<SpinRow>,
    rolls_rad: Vec<f64>,
    /// Lift at the start, m/s².
    lift_m_s2: f64,
    header: Header,
}

impl Recorded {
    /// Error of a roll at the last sample, °.
    fn error_deg(&self, roll_rad: f64) -> f64 {
        degrees(wrapped(roll_rad - self.rolls_rad.last().copied().unwrap_or(f64::NAN)))
    }

    /// The roll at the end.
    fn answer(&self) -> Result<Answer, String> {
        let body = Body::Spin(self.rows.clone());
        let replay = replay(&self.header, &body, &Asked::default());
        let replay = replay.map_err(|error| error.to_string())?;
        if let Some(reason) = replay.refusal() {
            return Err(reason);
        }
        let end = &replay.answer().end;
        let limit = replay.bounds.as_ref().and_then(|bounds| bounds.last()).copied();
        Ok(Answer {
            error: self.error_deg(end.roll_rad),
            sigma: end.sigma_rad.map_or(f64::NAN, degrees),
            limit: limit.map_or(f64::NAN, degrees),
        })
    }
}

impl Subject for Recorded {
    const NAME: &'static str = "spin-";
    const FAULT: u64 = 2_032;

    /// Draws a healthy flight.
    fn drawn(seed: u64) -> Self {
        Flight::drawn(seed).recorded()
    }

    fn seed(&self) -> u64 {
        self.seed
    }

    fn align(&self) -> Aligned {
        let unchecked = plain::roll(&self.rows, &self.header);
        Aligned {
            answer: self.answer(),
            unchecked_deg: unchecked.map(|roll_rad| self.error_deg(roll_rad)),
            unseen_deg: 0.0,
        }
    }
}

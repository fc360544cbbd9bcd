//! Recordings of kind `imu`: pitch, roll and the turn about the vertical, kept from the first sample to the last.
//!
//! The keeper gets the samples as the board gives them to it, and no truth; [`errors`] holds what it said
//! against what was true.

pub mod errors;
pub mod outcome;

use std::io::{self, BufWriter, Write};
use std::mem::discriminant;
use std::path::Path;

use orientation::attitude::{Gyro, Keeper, Report, Setting, Trust};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::units::{
    DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, MetresPerSecondSquared, RadiansPerSecond, Seconds,
};
use serde::Serialize;

use crate::assumptions::or_assumed;
use crate::methods::asked::Asked;
use crate::methods::error::ReplayError;
use crate::methods::stops::{check_stuck, missing, samples};
use crate::output::{azimuth_error, degrees};
use crate::recording::period::period_s;
use crate::recording::{Body, Header, Short};
use crate::setting::noise;

/// Latitude where none is known, °: the Earth's rate about the vertical is then off by 15 °/h at most.
const LATITUDE_DEG: f64 = 45.0;

/// What the keeper said after a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Time on the recording's clock, s.
    pub time_s: f64,
    /// Quaternion (w, x, y, z) from body axes to north, east, down up to a constant heading.
    pub attitude: [f64; 4],
    /// 1σ of pitch and of roll, rad.
    pub level_sigma: f64,
    /// Biases of the gyros, rad/s.
    pub biases: [RadiansPerSecond; 3],
    /// 1σ of the biases.
    pub bias_sigmas: [RadiansPerSecond; 3],
}

/// A state, and for how long it was met, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Met {
    /// In words, as the board has them, without the time they hold.
    pub state: &'static str,
    /// How long, s.
    pub seconds: f64,
}

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// After each sample.
    pub moments: Vec<Moment>,
    /// The last report.
    pub last: Report,
    /// The states in the order in which they were first met.
    pub states: Vec<Met>,
    /// How far the level could be relied on, each from when on, s on the recording's clock.
    pub phases: Vec<(f64, Trust)>,
    /// Turn about the vertical since the first sample, rad, whole turns included.
    pub turned: f64,
    /// Length of the recording, s.
    pub seconds: f64,
    /// What had to be assumed.
    pub assumed: Vec<String>,
    /// Why there is no result.
    pub refusal: Option<String>,
}

/// Replays the rows of a recording.
///
/// # Errors
/// What keeps the keeper from beginning.
pub fn replay(header: &Header, body: &Body, asked: &Asked) -> Result<Replay, ReplayError> {
    let rows = samples::rows(body).ok_or_else(|| missing(body))?;
    let period_s = period_s(header.rate_hz, &rows, |row| row.time_s);
    check_stuck(&rows, period_s)?;
    let mut assumed = Vec::new();
    let latitude = latitude(header, asked, &mut assumed);
    let mut keeper = Keeper::new(&setting(header, latitude, period_s, &mut assumed));
    let (last, (moments, states, phases)) = (keeper.report(), Default::default());
    let mut replay =
        Replay { moments, last, states, phases, turned: 0.0, seconds: 0.0, assumed, refusal: None };
    for (sample, row) in samples::samples(&rows, period_s).zip(rows.iter()) {
        keeper.push(&sample);
        replay.push(row.time_s, &keeper.report(), period_s);
    }
    let seconds = replay.states.iter().map(|met| met.seconds).sum();
    let refusal = refusal(&replay.last, asked.required_sigma());
    Ok(Replay { seconds, refusal, ..replay })
}

/// The user's latitude, the header's, or the one that is assumed.
fn latitude(header: &Header, asked: &Asked, assumed: &mut Vec<String>) -> Latitude {
    let stated = header.latitude_deg.and_then(Latitude::from_degrees);
    let usual = Latitude::from_degrees(LATITUDE_DEG).unwrap_or_else(|| unreachable!());
    let words = || format!("latitude {LATITUDE_DEG}°: none is stated");
    or_assumed(asked.latitude.or(stated), usual, assumed, words)
}

/// What is known of the sensors: a coarse unit's, where the header does not say otherwise.
fn setting(
    header: &Header,
    latitude: Latitude,
    period_s: f64,
    assumed: &mut Vec<String>,
) -> Setting {
    let coarse = Setting::coarse(latitude, Seconds(period_s));
    let gyros = coarse.gyros.map(|gyro| known(header, gyro));
    let [gyro, ..] = gyros;
    let walk = gyro.noise.angle_random_walk.0 / DEGREE_PER_SQRT_HOUR;
    let (bias, percent) = (gyro.bias_sigma.degrees_per_hour(), 100.0 * gyro.scale_sigma);
    let of_gyros = [
        (header.gyro_n_deg_sqrt_h, format!("gyro noise of a coarse unit: N {walk:.2} °/√h")),
        (header.gyro_bias_deg_h, format!("gyro biases of a coarse unit: {bias:.0} °/h")),
        (header.gyro_scale_sigma, format!("gyro scale and axes of a coarse unit: {percent:.1} %")),
    ];
    let unknown = of_gyros.into_iter().filter(|(stated, _)| stated.is_none());
    assumed.extend(unknown.map(|(_, words)| words));
    let usual = coarse.force_bias_sigma;
    let words = || format!("accelerometer biases of a coarse unit: {} m/s²", Short(usual.0));
    let force_bias_sigma = or_assumed(header.accelerometer_bias_m_s2, usual.0, assumed, words);
    Setting { gyros, force_bias_sigma: MetresPerSecondSquared(force_bias_sigma), ..coarse }
}

/// The gyro as the header knows it.
fn known(header: &Header, gyro: Gyro) -> Gyro {
    let bias = header.gyro_bias_deg_h.map(|bias| bias * DEGREE_PER_HOUR);
    Gyro {
        noise: known_noise(header, gyro.noise),
        bias_sigma: bias.map_or(gyro.bias_sigma, RadiansPerSecond),
        scale_sigma: header.gyro_scale_sigma.unwrap_or(gyro.scale_sigma),
    }
}

/// Noise of the gyros as the header knows it; what is stated beside an N that is not counts all the same.
fn known_noise(header: &Header, assumed: GyroNoise) -> GyroNoise {
    let stated = noise(header);
    if header.gyro_n_deg_sqrt_h.is_some() {
        return stated;
    }
    let [b, k] = [header.gyro_b_deg_h, header.gyro_k_deg_h_sqrt_h];
    GyroNoise {
        bias_instability: b.map_or(assumed.bias_instability, |_| stated.bias_instability),
        rate_random_walk: k.map_or(assumed.rate_random_walk, |_| stated.rate_random_walk),
        ..assumed
    }
}

impl Replay {
    /// Adds what the keeper says after a sample.
    fn push(&mut self, time_s: f64, report: &Report, period_s: f64) {
        let seconds = self.moments.last().map_or(period_s, |before| time_s - before.time_s);
        self.meet(name(report.state.trust), seconds);
        let trust = report.state.trust;
        if self.phases.last().is_none_or(|(_, before)| discriminant(before) != discriminant(&trust))
        {
            self.phases.push((time_s, trust));
        }
        if let Some(before) =
            self.moments.last().filter(|_| self.last.state.trust != Trust::Starting)
        {
            let [from, to] = [before.attitude, report.attitude].map(|q| degrees(heading(q)));
            self.turned += azimuth_error(to, from).to_radians();
        }
        self.moments.push(Moment {
            time_s,
            attitude: report.attitude,
            level_sigma: report.level_sigma.0,
            biases: report.biases,
            bias_sigmas: report.bias_sigmas,
        });
        self.last = *report;
    }

    fn meet(&mut self, state: &'static str, seconds: f64) {
        match self.states.iter_mut().find(|met| met.state == state) {
            Some(met) => met.seconds += seconds,
            None => self.states.push(Met { state, seconds }),
        }
    }
}

/// Why the last report is no result.
fn refusal(last: &Report, required_sigma: f64) -> Option<String> {
    let (sigma, most) = (last.level_sigma.degrees(), degrees(required_sigma));
    match last.state.trust {
        Trust::Starting => Some("no level was found".to_owned()),
        Trust::RotationLost => Some(format!("at the end, {}", last.state)),
        _ if sigma > most || sigma.is_nan() => {
            Some(format!("pitch and roll are good to {sigma:.2}° only, {most:.2}° is wanted"))
        }
        _ => None,
    }
}

/// Reliability of the level in a word.
pub(super) fn name(trust: Trust) -> &'static str {
    match trust {
        Trust::Starting => "starting",
        Trust::Level => "level",
        Trust::Coasting => "coasting",
        Trust::FreeFall => "free fall",
        Trust::NoForce => "no force",
        Trust::RotationLost => "rotation lost",
    }
}

/// Heading of body x, rad.
fn heading([w, x, y, z]: [f64; 4]) -> f64 {
    f64::atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))
}

/// Writes the attitude after each sample and 1σ of either tilt: `t_s,qw,qx,qy,qz,sigma_tilt_rad`.
///
/// # Errors
/// The file cannot be made or written.
pub fn write_attitude(path: &Path, moments: &[Moment]) -> io::Result<()> {
    let mut file = BufWriter::new(std::fs::File::create(path)?);
    writeln!(file, "t_s,qw,qx,qy,qz,sigma_tilt_rad")?;
    for Moment { time_s, attitude: [w, x, y, z], level_sigma, .. } in moments {
        writeln!(file, "{time_s},{w:.9},{x:.9},{y:.9},{z:.9},{level_sigma:.7}")?;
    }
    file.flush()
}

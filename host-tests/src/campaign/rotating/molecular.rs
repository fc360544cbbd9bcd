//! A molecular-electronic sensor of unknown gain, lag and g-sensitivity: what one speed leaves of the
//! g-sensitivity, and what two speeds do.

use std::f64::consts::TAU;

use hal_mock::earth::EARTH_RATE_RAD_S;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::Sensor;
use rustfft::num_complex::Complex;
use serde::Serialize;

use super::world::{Integrating, LATITUDE_DEG, MISALIGNMENT_DEG, TILT_DEG, World};
use super::{Solved, solve};
use crate::campaign::chance::Chance;
use crate::campaign::statistics::{Answer, Precision, greatest, rms};
use crate::campaign::{Tick, one_by_one, over};
use crate::output::azimuth_error;

/// Both speeds, turns a second.
pub const SPEEDS_HZ: [f64; 2] = [0.1, 0.2];
/// Time each way, s.
pub const SECONDS: f64 = 200.0;
/// Integrated g-sensitivities over the horizontal Earth rate, at the slower speed.
pub const RATIOS: [f64; 3] = [0.01, 0.1, 0.3];
/// Axis misalignments, °: of a sensor that was aligned, and of one that was not.
pub const MISALIGNMENTS_DEG: [f64; 2] = [0.0, MISALIGNMENT_DEG];
/// How many rows there are.
pub const COUNT: usize = RATIOS.len() * MISALIGNMENTS_DEG.len();
/// Phase of the sensor at the slower speed, °, from … to.
pub const PHASES_DEG: [f64; 2] = [5.0, 20.0];
/// Angle random walk of the runs with noise, °/√h.
pub const WALK: f64 = 0.002;

/// The random stream from which sensors are drawn.
const SENSOR_DRAWN: u64 = 1_001;

/// Many runs at one ratio. Errors in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Non-orthogonality of sensitive axis and platform axis.
    pub coupling_deg: f64,
    /// The ratio ρ.
    pub ratio: f64,
    /// What §4 bounds the error of one speed by, ρ²/2.
    pub bound_deg: f64,
    /// RMS of the error of one speed, without noise.
    pub one_speed_rms_deg: f64,
    /// Greatest error of one speed, without noise.
    pub one_speed_greatest_deg: f64,
    /// RMS of what §4 predicts for it, run by run.
    pub predicted_rms_deg: f64,
    /// Greatest difference of the two.
    pub off_prediction_deg: f64,
    /// RMS of the error of two speeds, without noise.
    pub two_speeds_rms_deg: f64,
    /// Greatest error of two speeds, without noise.
    pub two_speeds_greatest_deg: f64,
    /// RMS error over the limit without G and H, with noise.
    pub noise_ratio: f64,
    /// RMS of that limit.
    pub plain_limit_deg: f64,
    /// The errors with noise against the limit that knows of G and H, and σ.
    #[serde(flatten)]
    pub precision: Precision,
}

/// One run's sensor in its world, without noise.
struct Draw {
    sensor: Integrating,
    world: World,
}

/// Errors of one run, °.
struct Run {
    one_speed: f64,
    predicted: f64,
    two_speeds: f64,
    /// Limit without G and H, with noise.
    plain_limit: f64,
    answer: Result<Answer, Refusal>,
}

/// Runs each ratio at each misalignment with seeds 1 to `runs`; `tick` after each.
#[must_use]
pub fn rows(runs: usize, tick: Tick<'_>) -> Vec<Row> {
    let at = |misalignment| RATIOS.map(|ratio| (misalignment, ratio));
    let cases = MISALIGNMENTS_DEG.into_iter().flat_map(at);
    one_by_one(cases, tick, |(misalignment, ratio)| row(misalignment, ratio, runs, tick))
}

fn row(coupling_deg: f64, ratio: f64, runs: usize, tick: Tick<'_>) -> Row {
    let runs = over(runs, tick, |seed| run(coupling_deg, ratio, seed));
    let column = |of: fn(&Run) -> f64| runs.iter().map(of);
    let plain_limit_deg = rms(column(|run| run.plain_limit));
    let precision = Precision::of(runs.iter().map(|run| &run.answer));
    Row {
        coupling_deg,
        ratio,
        bound_deg: (0.5 * ratio * ratio).to_degrees(),
        one_speed_rms_deg: rms(column(|run| run.one_speed)),
        one_speed_greatest_deg: greatest(column(|run| run.one_speed)),
        predicted_rms_deg: rms(column(|run| run.predicted)),
        off_prediction_deg: greatest(column(|run| run.one_speed - run.predicted)),
        two_speeds_rms_deg: rms(column(|run| run.two_speeds)),
        two_speeds_greatest_deg: greatest(column(|run| run.two_speeds)),
        noise_ratio: precision.rms_deg / plain_limit_deg,
        plain_limit_deg,
        precision,
    }
}

impl Draw {
    /// Phase and direction of the g-sensitivity from a seed, the platform's world too.
    fn of(coupling_deg: f64, ratio: f64, seed: u64) -> Self {
        let mut chance = Chance::new(seed, SENSOR_DRAWN);
        let [least, most] = PHASES_DEG;
        let sensor = Integrating {
            ratio,
            toward_deg: chance.between(0.0, 360.0),
            lag_deg: chance.between(least, most),
            speed_hz: SPEEDS_HZ[0],
        };
        let molecular = Some(sensor.sensor());
        Self { sensor, world: World { coupling_deg, molecular, ..World::drawn(seed, &[], 0.0) } }
    }

    /// What §4 predicts for one speed, °: half of arg(1 + γ²) with γ = G/(w E′), carried over from E′ to
    /// the azimuth.
    fn predicted_deg(&self) -> f64 {
        let latitude = LATITUDE_DEG.to_radians();
        let [horizontal, vertical] =
            [latitude.cos(), latitude.sin()].map(|part| EARTH_RATE_RAD_S * part);
        let azimuth = self.world.azimuth_deg.to_radians();
        let uphill = self.world.uphill_deg.to_radians();
        let tilt = Complex::from_polar(TILT_DEG.to_radians().sin(), -uphill);
        let [along, across] = self.sensor.force_rad_s2_g();
        let felt = Complex::from_polar(horizontal, azimuth) + tilt * vertical;
        let speed = TAU * self.sensor.speed_hz;
        let ratio = Complex::new(along, across) * tilt / speed / felt;
        let off = 0.5 * (1.0 + ratio * ratio).arg();
        let north = |angle: f64| {
            // arg(Ω_h e^{jA} + Ω_v F) = angle, solved for A.
            let across = (tilt * Complex::from_polar(1.0, -angle)).im * vertical / horizontal;
            angle - across.asin()
        };
        azimuth_error(north(felt.arg() + off).to_degrees(), self.world.azimuth_deg)
    }
}

fn run(coupling_deg: f64, ratio: f64, seed: u64) -> Run {
    let [first, _] = SPEEDS_HZ;
    let draw = Draw::of(coupling_deg, ratio, seed);
    let world = &draw.world;
    let both = |world: &World| solve(world, Sensor::MOLECULAR, &SPEEDS_HZ, SECONDS, seed);
    let noisy = both(&World { n_deg_sqrt_h: WALK, ..world.clone() });
    let error = |solved: Solved| {
        let fit = solved.fit;
        let azimuth = fit.map_or(f64::NAN, |fit| fit.azimuth.degrees());
        azimuth_error(azimuth, world.azimuth_deg)
    };
    Run {
        one_speed: error(solve(world, Sensor::MOLECULAR, &[first], SECONDS, seed)),
        predicted: draw.predicted_deg(),
        two_speeds: error(both(world)),
        plain_limit: noisy.fit.map_or(f64::NAN, |fit| fit.plain_limit.degrees()),
        answer: noisy.answer,
    }
}

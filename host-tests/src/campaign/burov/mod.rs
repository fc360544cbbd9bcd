//! Burov's paper by simulation: its example, its devices, schedules under drift, and its five classes.

pub mod classes;
pub mod devices;
pub mod drift;
pub(super) mod report;

use std::fmt;

use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::schedule::Schedule;
use orientation::alignment::stepwise::setting::Setting;
use orientation::alignment::stepwise::{self, Session};
use orientation::alignment::{Method, Refusal};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::planner::{Conditions, Plan, Rotation};
use orientation::units::{DEGREE_PER_HOUR, MetresPerSecondSquared, Seconds};
use serde::Serialize;

use super::statistics::Answer;
use crate::{planning, simulate};

/// Latitude of the simulations, °.
pub const LATITUDE_DEG: f64 = 48.0;
/// Sample rate, Hz; the noise of a dwell does not depend on it.
const RATE_HZ: f64 = 12.5;
/// Upper cut-off of the flicker, Hz: below half the sample rate, above all that a dwell lets pass.
const FLICKER_HIGH_HZ: f64 = 5.0;
/// Turn-on bias, °/h.
pub(crate) const BIAS_DEG_H: f64 = 1.0;
/// 1σ of either accelerometer bias, m/s²: a good 1 mg.
const FORCE_BIAS: f64 = 0.01;

/// A gyro by its coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Grade {
    /// N, °/√h.
    pub n_deg_sqrt_h: f64,
    /// B, °/h.
    pub b_deg_h: f64,
    /// K, °/h/√h.
    pub k_deg_h_sqrt_h: f64,
    /// R, °/h².
    pub r_deg_h2: f64,
}

impl Grade {
    /// Noise of a gyro of this grade.
    pub fn noise(&self) -> GyroNoise {
        let [n, b, k, r] = self.values();
        GyroNoise::from_field_units(n, b, k, r)
    }

    /// N, B, K and R.
    pub(super) fn values(&self) -> [f64; 4] {
        [self.n_deg_sqrt_h, self.b_deg_h, self.k_deg_h_sqrt_h, self.r_deg_h2]
    }

    /// What a planner is given about it on such a stage.
    fn conditions(&self, rotation: Rotation) -> Conditions {
        planning::conditions(self.noise(), rotation)
    }

    /// The gyro as it is simulated, with its ramp R to the full.
    pub(crate) fn simulated(&self) -> GyroConfiguration {
        GyroConfiguration {
            n_deg_sqrt_h: self.n_deg_sqrt_h,
            b_deg_h: self.b_deg_h,
            k_deg_h_sqrt_h: self.k_deg_h_sqrt_h,
            r_deg_h2: self.r_deg_h2,
            flicker_high_hz: Some(FLICKER_HIGH_HZ),
            bias_sigma_deg_h: BIAS_DEG_H,
            ..GyroConfiguration::default()
        }
    }
}

impl fmt::Display for Grade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [n, b, k, r] = self.values();
        write!(f, "N {n} °/√h, B {b} °/h, K {k} °/h/√h, R {r} °/h²")
    }
}

/// An alignment to simulate: a gyro, a plan for it and how the stage turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Gyro that is planned for.
    pub grade: Grade,
    /// The plan.
    pub plan: Plan,
    /// The stage.
    pub rotation: Rotation,
}

/// The latitude of the simulations.
///
/// # Panics
/// Never: it is a constant within ±90°.
pub(crate) fn latitude() -> Latitude {
    Latitude::from_degrees(LATITUDE_DEG).unwrap_or_else(|| unreachable!())
}

impl Trial {
    /// One alignment through samples, filter and session.
    fn answer(&self, seed: u64) -> Result<Answer, Refusal> {
        let azimuth_deg = super::azimuth_deg(seed);
        let procedure = Procedure::new(Schedule::Planned(self.plan), Seconds(1.0 / RATE_HZ));
        let mut session = Session::new(self.setting(), procedure)
            .map_err(|_| Refusal::Stepwise(stepwise::Refusal::TooFewPositions { positions: 0 }))?;
        let longest = 2.0 * self.plan.seconds.0 + 60.0;
        simulate::run(&mut session, &self.world(azimuth_deg), &[], self.rotation, longest, seed);
        Answer::of(session.verdict().unwrap_or(Err(Refusal::TimeExhausted)), azimuth_deg)
    }

    fn setting(&self) -> Setting {
        let site = super::site(LATITUDE_DEG, self.grade.values());
        Setting::new(Site { accelerometer_bias_sigma: MetresPerSecondSquared(FORCE_BIAS), ..site })
    }

    fn world(&self, azimuth_deg: f64) -> InstrumentsConfiguration {
        let mut world = InstrumentsConfiguration {
            latitude_deg: LATITUDE_DEG,
            azimuth_deg,
            pitch_deg: 0.7,
            roll_deg: -0.4,
            rate_hz: RATE_HZ,
            gyro: self.grade.simulated(),
            ..InstrumentsConfiguration::default()
        };
        world.accelerometer.bias_sigma_m_s2 = FORCE_BIAS;
        world
    }
}

/// 3σ of an azimuth along one axis for a rate error in rad/s, at the equator, °; times sec φ elsewhere.
fn three_sigma_secant(rate_error: f64) -> f64 {
    // Ω is 15.041067 °/h.
    3.0 * (rate_error / DEGREE_PER_HOUR / 15.041_067).to_degrees()
}

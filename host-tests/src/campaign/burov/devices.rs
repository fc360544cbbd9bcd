//! The paper's example and its Table 2: devices OIUS-1000 with and without autocompensation.

use orientation::noise::model::GyroNoise;
use orientation::planner::burov;
use orientation::units::{DEGREE_PER_HOUR, Seconds};
use serde::Serialize;

use super::{Grade, three_sigma_secant};

/// Time of gyrocompassing, s.
pub const SECONDS: f64 = 300.0;
/// Time of a rotation, s.
pub const ROTATION: f64 = 2.0;
/// Time that the paper gives a gyro without autocompensation, h.
const HOUR: f64 = 1.0;

/// The paper's example: N and R of its Fig. 5, B of its text.
pub const EXAMPLE: Grade =
    Grade { n_deg_sqrt_h: 0.001, b_deg_h: 0.007, k_deg_h_sqrt_h: 0.0, r_deg_h2: 0.127 };

/// Table 2: three devices under a gradient of 20 °C/h.
const DEVICES: [(&str, Grade); 3] = [
    ("OIUS-1000 No. 11030", Grade { n_deg_sqrt_h: 0.001_05, ..EXAMPLE }),
    ("OIUS-1000 No. 11031", Grade { n_deg_sqrt_h: 0.000_91, ..EXAMPLE }),
    ("OIUS-1000 No. 12003", Grade { n_deg_sqrt_h: 0.000_91, r_deg_h2: 0.153, ..EXAMPLE }),
];

/// A device with and without autocompensation.
#[derive(Clone, Debug, Serialize)]
pub struct Device {
    /// Name of the device.
    pub name: &'static str,
    /// Noise of its gyro.
    pub gyro: Grade,
    /// Best number of positions.
    pub positions: u32,
    /// Burov's rate error Δω(n), as [`orientation::planner::burov`] has it, °/h, 1σ.
    pub rate_error_deg_h: f64,
    /// Rate error with the flicker floor B√(2 ln 2/π), °/h, 1σ.
    pub with_flicker_deg_h: f64,
    /// Azimuth along one axis, 3σ, in ° times sec φ.
    pub three_sigma_secant_deg: f64,
    /// Full azimuth, √2 of that.
    pub full_three_sigma_secant_deg: f64,
    /// Without autocompensation over an hour, 3σ, in ° times sec φ.
    pub without_secant_deg: f64,
}

/// Δω over the number of positions: the paper's Fig. 6 with the values beside the best.
pub(crate) fn curve(positions: std::ops::RangeInclusive<u32>) -> Vec<(u32, f64)> {
    let noise = EXAMPLE.noise();
    let of = |n| burov::rate_error(&noise, n, Seconds(SECONDS), Seconds(ROTATION));
    positions.filter_map(|n| Some((n, of(n)?.degrees_per_hour()))).collect()
}

/// The example and the devices of Table 2.
#[must_use]
pub fn devices() -> Vec<Device> {
    let example = [("the paper's example", EXAMPLE)];
    example.into_iter().chain(DEVICES).filter_map(|(name, gyro)| device(name, gyro)).collect()
}

fn device(name: &'static str, gyro: Grade) -> Option<Device> {
    let noise = gyro.noise();
    let best = burov::best(&noise, Seconds(SECONDS), Seconds(ROTATION))?;
    let total = best.rate_error.0.hypot(burov::flicker_floor(&noise).0);
    let one_axis = three_sigma_secant(total);
    Some(Device {
        name,
        gyro,
        positions: best.positions,
        rate_error_deg_h: best.rate_error.degrees_per_hour(),
        with_flicker_deg_h: total / DEGREE_PER_HOUR,
        three_sigma_secant_deg: one_axis,
        full_three_sigma_secant_deg: std::f64::consts::SQRT_2 * one_axis,
        without_secant_deg: three_sigma_secant(uncompensated(&noise)),
    })
}

/// The ramp's part of the Allan deviation over an hour, R τ/√2, rad/s: what the paper states for a
/// gyro that is never turned.
fn uncompensated(noise: &GyroNoise) -> f64 {
    noise.rate_ramp.0 * HOUR * 3600.0 * std::f64::consts::FRAC_1_SQRT_2
}

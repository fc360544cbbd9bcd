//! What a recording's header says about place and instrument, as the site of an alignment.

use orientation::alignment::site::Site;
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::units::{GSensitivity, MetresPerSecondSquared};

use crate::assumptions::or_assumed;
use crate::methods::asked::Question;
use crate::recording::{Body, Header};

/// 1σ of a scale factor of which nothing is known, relative: between fibre-optic and micromachined gyros.
const SCALE_SIGMA: f64 = 0.01;
/// 1σ of an accelerometer bias of which nothing is known, m/s²: 25 mg, the offset that an ADXL355 may have.
const FORCE_BIAS_SIGMA: f64 = 0.25;

/// Builds the site for a latitude from the header's keys.
pub fn describe(of: &Question, latitude: Latitude, assumed: &mut Vec<String>) -> Site {
    let Question { header, body, .. } = *of;
    let scale_sigma = or_assumed(header.gyro_scale_sigma, SCALE_SIGMA, assumed, || {
        "gyro scale factor to 1 % (gyro_scale_sigma)".to_owned()
    });
    let accelerometer_bias_sigma =
        or_assumed(header.accelerometer_bias_m_s2, FORCE_BIAS_SIGMA, assumed, || {
            "accelerometer bias to 0.25 m/s² (accelerometer_bias_m_s2)".to_owned()
        });
    let kappa_known = header.g_sensitivity_sigma_deg_h_g.is_some();
    let kappa_sigma = or_assumed(header.g_sensitivity_sigma_deg_h_g, 0.0, assumed, || {
        "g-sensitivity to 50000 °/h/g for each (°/√h)² of N, 100 °/h/g at most (g_sensitivity_sigma_deg_h_g)".to_owned()
    });
    let white_known = header.gyro_n_deg_sqrt_h.is_some_and(|n| n > 0.0);
    let shown = match body {
        Body::Stage(_) => Some("dwells"),
        Body::Rotating(_) => Some("turns"),
        _ => None,
    };
    let shown = shown.filter(|_| !white_known);
    assumed.extend(shown.map(|shown| format!("white noise as the {shown} show it")));
    if noise(header) == noise(header).white_part() {
        assumed.push("no gyro drift (B, K, R)".to_owned());
    }
    let exact = match body {
        Body::Imu(_) | Body::Static(_) | Body::Spin(_) | Body::Rotating(_) => "latitude exact",
        Body::Stage(_) | Body::Dwells(_) => "latitude and encoder exact",
    };
    assumed.push(exact.to_owned());
    let stated = if white_known { StatedNoise::Whole } else { StatedNoise::ExceptWhite };
    let kappa = header.g_sensitivity_deg_h_g.unwrap_or_default();
    Site {
        noise: stated(noise(header)),
        scale_sigma,
        g_sensitivity: kappa.map(GSensitivity::from_degrees_per_hour),
        g_sensitivity_sigma: GSensitivity::from_degrees_per_hour(kappa_sigma),
        g_sensitivity_known: kappa_known,
        accelerometer_bias_sigma: MetresPerSecondSquared(accelerometer_bias_sigma),
        ..Site::at(latitude)
    }
}

/// The gyro's noise as the header has it; what is absent is zero.
pub(crate) fn noise(header: &Header) -> GyroNoise {
    GyroNoise::from_field_units(
        header.gyro_n_deg_sqrt_h.unwrap_or(0.0),
        header.gyro_b_deg_h.unwrap_or(0.0),
        header.gyro_k_deg_h_sqrt_h.unwrap_or(0.0),
        header.gyro_r_deg_h2.unwrap_or(0.0),
    )
}

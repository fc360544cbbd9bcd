//! What a recording's header says about place and instrument, as the solver's setting.

use orientation::align::setting::Setting;
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::units::DEGREE_PER_HOUR;

use crate::recording::{Body, Header};

/// A setting, and in words what had to be assumed for it.
#[derive(Clone, Debug)]
pub struct Described {
    /// The setting.
    pub setting: Setting,
    /// What the header does not say and how it was taken.
    pub assumed: Vec<String>,
}

/// Builds the setting for a latitude from the header's keys.
#[must_use]
pub fn describe(header: &Header, body: &Body, latitude: Latitude) -> Described {
    let mut assumed = Vec::new();
    let mut or_zero = |value: Option<f64>, words: &str| {
        value.unwrap_or_else(|| {
            assumed.push(words.to_owned());
            0.0
        })
    };
    let scale_sigma = or_zero(header.gyro_scale_sigma, "gyro scale factor exact");
    let accelerometer_bias_sigma =
        or_zero(header.accelerometer_bias_m_s2, "accelerometer free of bias");
    let kappa_sigma = if header.g_sensitivity_deg_h_g.is_some() {
        or_zero(header.g_sensitivity_sigma_deg_h_g, "g-sensitivity exact")
    } else {
        or_zero(header.g_sensitivity_sigma_deg_h_g, "no g-sensitivity")
    };
    let white_known = header.gyro_n_deg_sqrt_h.is_some_and(|n| n > 0.0);
    match body {
        Body::Stage(_) if !white_known => {
            assumed.push("white noise as the dwells show it".to_owned());
        }
        Body::Rotating(_) if !white_known => {
            assumed.push("white noise as the turns show it".to_owned());
        }
        _ => {}
    }
    if noise(header) == noise(header).white_part() {
        assumed.push("no gyro drift (B, K, R)".to_owned());
    }
    let exact = match body {
        Body::Imu(_) | Body::Static(_) | Body::Spin(_) => "latitude exact",
        Body::Stage(_) | Body::Rotating(_) | Body::Dwells(_) => "latitude and encoder exact",
    };
    assumed.push(exact.to_owned());
    let kappa = header.g_sensitivity_deg_h_g.unwrap_or_default();
    let setting = Setting {
        noise: noise(header),
        white_known,
        scale_sigma,
        g_sensitivity: kappa.map(|part| part * DEGREE_PER_HOUR),
        g_sensitivity_sigma: kappa_sigma * DEGREE_PER_HOUR,
        accelerometer_bias_sigma,
        ..Setting::at(latitude)
    };
    Described { setting, assumed }
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

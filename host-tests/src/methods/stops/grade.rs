//! What is taken of a unit where its header is silent: gyros of one grade come with accelerometers of that grade.
//!
//! P. D. Groves, "Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems", 2nd ed.,
//! table 4.1 and §4.4.2: biases of 0.01 °/h come with 0.03 to 0.1 mg and some 10⁻⁵ of scale error, 1 °/h with
//! 1 mg and up to 10⁻³, 100 °/h with 10 mg. What is stated counts, zero too.

use orientation::units::DEGREE_PER_HOUR;

use crate::output::significant;
use crate::recording::{Header, Short};

/// Bias of gyros of which nothing is stated, °/h: a worse one hardly finds north.
const UNKNOWN_DEG_H: f64 = 1.0;
/// 1σ of the accelerometers' biases beside gyros of 1 °/h, m/s²: 2 mg.
const FORCE_BIAS: f64 = 2e-2;
/// 1σ of the scale errors of gyros: the tactical grade's, for who has better ones states it.
const SCALE: f64 = 5e-4;
/// 1σ of a g-sensitivity over that of the bias, per g: what gravity alone makes of a good gyro's bias when it is
/// turned over.
const G_SENSITIVITY: f64 = 0.5;

/// The header with what it does not state of scale, accelerometers and g-sensitivity filled in.
#[must_use]
pub fn filled(header: &Header, assumed: &mut Vec<String>) -> Header {
    let bias = header.gyro_bias_deg_h.unwrap_or(UNKNOWN_DEG_H);
    // Grades rise with the root: four decades of gyros have two of accelerometers.
    let grade = bias.sqrt();
    let mut or = |value: Option<f64>, usual: f64, words: &str, unit: &str| {
        value.or_else(|| {
            assumed.push(format!(
                "{words} unknown, {}{unit} (1σ) as usual beside gyros of {} °/h",
                significant(usual, 2),
                Short(bias)
            ));
            Some(usual)
        })
    };
    let mut filled = header.clone();
    filled.gyro_scale_sigma = or(header.gyro_scale_sigma, SCALE, "gyro scale errors", "");
    filled.accelerometer_bias_m_s2 =
        or(header.accelerometer_bias_m_s2, FORCE_BIAS * grade, "accelerometer biases", " m/s²");
    if header.g_sensitivity_deg_h_g.is_none() {
        let sigma = header.g_sensitivity_sigma_deg_h_g;
        filled.g_sensitivity_sigma_deg_h_g =
            or(sigma, G_SENSITIVITY * bias, "g-sensitivity", " °/h/g");
        filled.g_sensitivity_deg_h_g = Some([0.0; 2]);
    }
    filled
}

/// What gravity makes of the gyros' g-sensitivity, 1σ, rad/s: a bias, for a vehicle stands upright.
pub(crate) fn g_sensitivity(header: &Header) -> f64 {
    let [along, across] = header.g_sensitivity_deg_h_g.unwrap_or_default();
    let sigma = header.g_sensitivity_sigma_deg_h_g.unwrap_or_default();
    along.hypot(across).hypot(sigma) * DEGREE_PER_HOUR
}

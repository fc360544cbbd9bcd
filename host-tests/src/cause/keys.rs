//! Noise and σ that are not those of the dwells, and keys that are missing: what they would show is unknown, not zero.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::Refusal as Stepwise;
use orientation::units::DEGREE;

use super::NO_NOISE;
use crate::methods::asked::Question;
use crate::methods::stepwise;
use crate::output::significant;
use crate::recording::{Body, Header, Short};

/// Factor by which a noise is not the one stated.
const OTHER_NOISE: f64 = 1.5;
/// σ of a dwell below which no gyro is, rad/s: 10⁻⁶ °/√h over a day.
const LEAST_SIGMA: f64 = 1e-13;
/// Fewest dwells that are not alike by chance.
const FEWEST: usize = 3;
/// Bias instabilities that are tried, °/h: from a laser gyro's to a cheap one's.
const DRIFTS: [f64; 8] = [0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0];
/// g-sensitivities that are tried, 1σ, °/h/g.
const G_SENSITIVITIES: [f64; 3] = [1.0, 10.0, 100.0];
/// The greatest that is tried for each (°/√h)² of N, °/h/g: a score of times what such gyros usually have.
const MOST_PER_NOISE: f64 = 1e6;

/// What averaged dwells hold that no gyro shows.
pub fn impossible(body: &Body) -> Option<String> {
    let Body::Dwells(rows) = body else { return None };
    let least = rows.iter().map(|row| row.sigma_rad_s).fold(f64::INFINITY, f64::min);
    if least < LEAST_SIGMA {
        let least = Short(least);
        return Some(format!(
            "column sigma_rad_s: {least} rad/s is less than the noise of any gyro: state 1σ of each mean rate, \
             N over the root of its seconds"
        ));
    }
    let alike =
        rows.windows(2).all(|pair| pair[0].rate_rad_s.to_bits() == pair[1].rate_rad_s.to_bits());
    (alike && rows.len() >= FEWEST).then(|| {
        let rate = Short(rows[0].rate_rad_s);
        format!(
            "column rate_rad_s: all {} dwells show the same {rate} rad/s, without noise and Earth rate: a stuck gyro, \
             or what wrote the column",
            rows.len()
        )
    })
}

/// Whether the noise that is stated is not the one that the dwells show.
pub fn noise(of: &Question) -> Option<String> {
    let Question { header, body, asked } = *of;
    let stated = header.gyro_n_deg_sqrt_h.filter(|_| matches!(body, Body::Stage(_)))?;
    let silent = Header { gyro_n_deg_sqrt_h: None, ..header.clone() };
    let replay = stepwise::replay(&silent, body, asked, |_| {}).ok()?;
    let conclusion = replay.session.conclusion().filter(|found| found.verdict.is_ok())?;
    let shown = conclusion.angle_random_walk.0 / DEGREE * 60.0;
    let is_other = shown > OTHER_NOISE * stated || stated > OTHER_NOISE * shown;
    is_other.then(|| {
        format!(
            "key gyro_N_deg_sqrt_h says {} °/√h, but the dwells show {} °/√h: correct it, or leave it out",
            Short(stated),
            significant(shown, 3)
        )
    })
}

/// Keys of drift and g-sensitivity that are missing, where a usual one of either would explain the dwells.
pub fn missing(of: &Question, refusal: &Refusal) -> Option<String> {
    let Question { header, body, asked } = *of;
    let is_scattered = match refusal {
        Refusal::ResidualsNotWhite { ratio }
        | Refusal::Stepwise(Stepwise::NoiseNotAsStated { ratio }) => *ratio <= NO_NOISE,
        Refusal::ResidualsCorrelated { .. } | Refusal::EarthRateMismatch { .. } => true,
        _ => false,
    };
    let explains = |header: Header| {
        let replay = stepwise::replay(&header, body, asked, |_| {});
        replay.is_ok_and(|replay| {
            replay.session.conclusion().is_some_and(|found| {
                matches!(found.verdict, Ok(_) | Err(Refusal::BudgetNotMet { .. }))
            })
        })
    };
    // A drift wide enough hides any Earth rate.
    let is_rate = matches!(refusal, Refusal::EarthRateMismatch { .. });
    let of_drift = || drift(header, &explains).filter(|_| !is_rate);
    is_scattered.then(|| of_drift().or_else(|| g_sensitivity(header, &explains)))?
}

/// The drift that would.
fn drift(header: &Header, explains: &dyn Fn(Header) -> bool) -> Option<String> {
    let names = [
        (header.gyro_b_deg_h, "gyro_B_deg_h"),
        (header.gyro_k_deg_h_sqrt_h, "gyro_K_deg_h_sqrt_h"),
        (header.gyro_r_deg_h2, "gyro_R_deg_h2"),
    ];
    if names.iter().any(|(stated, _)| stated.is_some()) {
        return None;
    }
    let with = |drift: &f64| Header { gyro_b_deg_h: Some(*drift), ..header.clone() };
    let drift = DRIFTS.into_iter().find(|drift| explains(with(drift)))?;
    let names = names.map(|(_, name)| name).join(", ");
    Some(format!(
        "keys {names} are missing, which is unknown, not zero: a drift of some {drift} °/h (B) would explain it; \
         state what the gyro has"
    ))
}

/// The g-sensitivity that would.
fn g_sensitivity(header: &Header, explains: &dyn Fn(Header) -> bool) -> Option<String> {
    let stated = [
        (header.g_sensitivity_deg_h_g.is_some(), "g_sensitivity_deg_h_g"),
        (header.g_sensitivity_sigma_deg_h_g.is_some(), "g_sensitivity_sigma_deg_h_g"),
    ];
    let missing: Vec<&str> =
        stated.into_iter().filter(|(is_stated, _)| !is_stated).map(|(_, name)| name).collect();
    let with = |sigma: &f64| Header { g_sensitivity_sigma_deg_h_g: Some(*sigma), ..header.clone() };
    let most = header.gyro_n_deg_sqrt_h.map_or(f64::INFINITY, |n| MOST_PER_NOISE * n * n);
    let all = G_SENSITIVITIES.into_iter().filter(|sigma| !missing.is_empty() && *sigma <= most);
    let sigma = all.into_iter().find(|sigma| explains(with(sigma)))?;
    let (keys, are) = if missing.len() > 1 { ("keys", "are") } else { ("key", "is") };
    let names = missing.join(", ");
    Some(format!(
        "{keys} {names} {are} missing, which is unknown, not zero: a g-sensitivity of some {sigma} °/h/g would \
         explain it; state what the gyro has"
    ))
}

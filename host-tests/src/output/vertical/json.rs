//! The JSON object of an attitude that was kept.

use orientation::keep::Report;
use serde::Serialize;

use crate::output::{degrees, degrees_per_hour};
use crate::vertical::errors::Errors;
use crate::vertical::{Met, Replay};

/// The object.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// `vertical`.
    pub method: &'static str,
    /// `ok` or `refused`.
    pub status: &'static str,
    /// Why it was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Pitch of the body at the end; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_deg: Option<f64>,
    /// Roll of the body at the end; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_deg: Option<f64>,
    /// 1σ of either at the end.
    pub sigma_deg: f64,
    /// Turned about the vertical since the first sample, clockwise from above, whole turns included.
    pub turned_deg: f64,
    /// The state at the end, in words.
    pub state: String,
    /// The states that were met.
    pub states: Vec<State>,
    /// Length of the recording.
    pub seconds: f64,
    /// Biases of the gyros forward, right, down, °/h.
    pub bias_dph: [f64; 3],
    /// Their 1σ, °/h.
    pub bias_sigma_dph: [f64; 3],
    /// Whether a bias is beyond five of the 1σ stated or assumed for it, which is not believed any more then.
    pub bias_beyond_stated: bool,
    /// The errors, where the recording carries a truth.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub errors: Option<ErrorObject>,
    /// What was assumed.
    pub assumed: Vec<String>,
}

/// A state, and for how long it was met.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct State {
    /// In words.
    pub state: &'static str,
    /// How long.
    pub seconds: f64,
}

/// The errors where the truth is known and counts.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ErrorObject {
    /// RMS angle between the true vertical and the kept one.
    pub inclination_rmse_deg: f64,
    /// RMS of the heading after one constant offset.
    pub heading_rmse_deg: f64,
    /// Per cent of the tilts within 1, 2 and 3 σ.
    pub coverage_percent: [f64; 3],
    /// Samples that counted.
    pub samples: usize,
}

impl From<&Errors> for ErrorObject {
    fn from(errors: &Errors) -> Self {
        let Errors { off, inclination_rmse_deg, heading_rmse_deg, coverage_percent } = errors;
        Self {
            inclination_rmse_deg: *inclination_rmse_deg,
            heading_rmse_deg: *heading_rmse_deg,
            coverage_percent: *coverage_percent,
            samples: off.len(),
        }
    }
}

/// The object of a replay, with its errors where the truth is known.
#[must_use]
pub fn object(replay: &Replay, errors: Option<&Errors>) -> Object {
    let Report { pitch, roll, level_sigma, state, biases, bias_sigmas, .. } = replay.last;
    let found = replay.refusal.is_none();
    Object {
        method: "vertical",
        status: if found { "ok" } else { "refused" },
        reason: replay.refusal.clone(),
        pitch_deg: found.then(|| degrees(pitch)),
        roll_deg: found.then(|| degrees(roll)),
        sigma_deg: degrees(level_sigma),
        turned_deg: degrees(replay.turned),
        state: state.to_string(),
        states: replay
            .states
            .iter()
            .map(|&Met { state, seconds }| State { state, seconds })
            .collect(),
        seconds: replay.seconds,
        bias_dph: biases.map(degrees_per_hour),
        bias_sigma_dph: bias_sigmas.map(degrees_per_hour),
        bias_beyond_stated: replay.last.is_bias_beyond_stated,
        errors: errors.map(ErrorObject::from),
        assumed: replay.assumed.clone(),
    }
}

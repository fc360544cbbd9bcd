//! The JSON object of the roll of a spinning body.

use serde::Serialize;

use crate::output::degrees;
use crate::recording::Truth;
use crate::spin::errors::{Errors, bound_rms};
use crate::spin::track::Track;
use crate::spin::{Replay, name};

/// The object; rolls count whole turns, errors do not.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// `spin`.
    pub method: &'static str,
    /// `ok` or `refused`.
    pub status: &'static str,
    /// Why it was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Roll at the last sample; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_rad_end: Option<f64>,
    /// Its standard deviation; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_deg: Option<f64>,
    /// Roll less truth at the last sample, within ±180, where the recording carries one; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_deg: Option<f64>,
    /// Cramér–Rao bound at the last sample, for the noise that is stated or that the turns show.
    pub limit_deg: Option<f64>,
    /// The gyro's scale error, gyro/true − 1.
    pub scale_error: Option<f64>,
    /// Its 1σ.
    pub scale_sigma: Option<f64>,
    /// What the phase lock is doing at the end.
    pub state: String,
    /// The lift at the end, m/s².
    pub lift: Option<f64>,
    /// RMS error after the first 0.1 s, where the recording carries the truth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rms_deg: Option<f64>,
    /// RMS of the bounds over the same samples.
    pub limit_rms_deg: Option<f64>,
    /// By how many turns the count went wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns_lost: Option<u64>,
    /// Every method; the last one is the answer.
    pub methods: Vec<MethodObject>,
    /// Noise of an accelerometer in a sample, m/s².
    pub force_noise_m_s2: f64,
    /// Samples.
    pub samples: usize,
    /// From the first to the last.
    pub seconds: f64,
    /// What was assumed.
    pub assumed: Vec<String>,
}

/// A method.
#[derive(Clone, Debug, Serialize)]
pub struct MethodObject {
    /// Its name.
    pub name: &'static str,
    /// Roll at the last sample.
    pub roll_rad_end: f64,
    /// RMS error after the first 0.1 s, where the recording carries the truth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rms_deg: Option<f64>,
    /// By how many turns the count went wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns_lost: Option<u64>,
    /// How many corrections it made.
    pub corrections: usize,
}

impl MethodObject {
    /// Of a track; the truth is for its errors alone.
    #[must_use]
    pub fn of(track: &Track, truth: &Truth) -> Self {
        let errors = Errors::of(track, &truth.roll_rad);
        Self {
            name: name(track.method),
            roll_rad_end: track.end.roll_rad,
            rms_deg: errors.as_ref().and_then(|errors| errors.rms_rad).map(degrees),
            turns_lost: errors.map(|errors| errors.turns_lost),
            corrections: track.corrections.len(),
        }
    }
}

/// The object of a replay; the truth is for its errors alone.
#[must_use]
pub fn object(replay: &Replay, truth: &Truth) -> Object {
    let (answer, reason) = (replay.answer(), replay.refusal());
    let errors = Errors::of(answer, &truth.roll_rad);
    let methods: Vec<MethodObject> =
        replay.tracks.iter().map(|track| MethodObject::of(track, truth)).collect();
    let (end, is_ok) = (&answer.end, reason.is_none());
    let bounds = replay.bounds.as_deref();
    Object {
        method: "spin",
        status: if is_ok { "ok" } else { "refused" },
        reason,
        roll_rad_end: is_ok.then_some(end.roll_rad),
        sigma_deg: end.sigma_rad.filter(|_| is_ok).map(degrees),
        error_deg: errors.as_ref().and_then(Errors::end_rad).filter(|_| is_ok).map(degrees),
        limit_deg: bounds.and_then(<[f64]>::last).copied().map(degrees),
        scale_error: end.scale.map(|[scale, _]| scale),
        scale_sigma: end.scale.map(|[_, sigma]| sigma),
        state: end.state.to_string(),
        lift: end.lift,
        rms_deg: errors.as_ref().and_then(|errors| errors.rms_rad).map(degrees),
        limit_rms_deg: bounds.and_then(|bounds| bound_rms(answer, bounds)).map(degrees),
        turns_lost: errors.map(|errors| errors.turns_lost),
        methods,
        force_noise_m_s2: replay.noise.force,
        samples: answer.rolls_rad.len(),
        seconds: end.time_s,
        assumed: replay.assumed.clone(),
    }
}

//! The JSON object of an alignment on a turning platform.

use orientation::align::rotating::average::Average;
use orientation::align::rotating::conclusion::Conclusion;
use orientation::align::rotating::coupling::Coupling;
use orientation::align::rotating::solution::Fit;
use serde::Serialize;

use super::{averages, columns, is_molecular, pitch_and_roll, tilt};
use crate::output::degrees;
use crate::output::json::{BudgetObject, Verdict};
use crate::rotating::Replay;

/// The object; its keys are those of every method that gives an azimuth, then its own.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// `rotating`.
    pub method: &'static str,
    /// The azimuth, or why there is none.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Cramér–Rao bound for the model's columns, where the noise is known.
    pub limit_deg: Option<f64>,
    /// The same for a sensor of known gain, lag and g-sensitivity.
    pub plain_limit_deg: Option<f64>,
    /// The 1σ parts, where there is a fit.
    pub budget: Option<BudgetObject>,
    /// The greatest part beside noise, where it makes up more than half of the variance.
    pub dominant: Option<String>,
    /// Whole turns that took part.
    pub positions: u32,
    /// Their time in seconds.
    pub seconds: f64,
    /// Pitch of the body.
    pub pitch_deg: Option<f64>,
    /// Roll of the body.
    pub roll_deg: Option<f64>,
    /// Earth rate found over expected; none of a sensor whose gain is not known.
    pub earth_rate_ratio: Option<f64>,
    /// 1σ of the ratio.
    pub earth_rate_ratio_sigma: Option<f64>,
    /// Columns used.
    pub model: Vec<&'static str>,
    /// Turns left out.
    pub excluded: Vec<Excluded>,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// `gyro`, or `met` for a molecular-electronic sensor.
    pub sensor: &'static str,
    /// How far the sensitive axis stands from the platform's plane, up positive; none where no uneven
    /// turn showed it.
    pub coupling_deg: Option<f64>,
    /// Its 1σ.
    pub coupling_sigma_deg: Option<f64>,
    /// By how much the sensor lags behind the encoder where the platform was uneven, s.
    pub lag_s: Option<f64>,
    /// Tilt of the platform.
    pub tilt_deg: Option<f64>,
    /// Integrated g-sensitivity over the Earth rate at the slower speed, ρ; of a molecular-electronic
    /// sensor.
    pub met_ratio: Option<f64>,
    /// What the slower speed alone is off by for it; its 1σ where there is only one speed.
    pub one_speed_bias_deg: Option<f64>,
    /// The azimuth after each stage of compensation.
    pub stages: Option<Stages>,
    /// Both senses at each speed.
    pub stretches: Vec<Stretch>,
}

/// The azimuth after each stage of compensation, °.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Stages {
    /// Clockwise at the first speed, as it came.
    pub raw_deg: f64,
    /// The same without the platform's unevenness.
    pub without_unevenness_deg: f64,
    /// Both senses together.
    pub both_senses_deg: f64,
    /// Everything.
    pub full_deg: f64,
}

/// Turns in one sense at one speed.
#[derive(Clone, Debug, Serialize)]
pub struct Stretch {
    /// `clockwise` or `counter-clockwise`.
    pub sense: String,
    /// Turns a second.
    pub speed_hz: f64,
    /// Turns that took part.
    pub turns: u32,
    /// Turns left out.
    pub left_out: u32,
    /// Time in those that took part.
    pub seconds: f64,
    /// Unevenness once per turn, relative to the speed.
    pub unevenness: f64,
}

/// Turns left out.
#[derive(Clone, Debug, Serialize)]
pub struct Excluded {
    /// Their sense.
    pub sense: String,
    /// Their speed, turns a second.
    pub speed_hz: f64,
    /// How many.
    pub turns: u32,
    /// Why.
    pub reason: &'static str,
}

/// Why turns are left out.
pub const DISTURBED: &str = "disturbed: too far from the other turns";

impl From<&Average> for Stretch {
    fn from(average: &Average) -> Self {
        Self {
            sense: average.sense.to_string(),
            speed_hz: average.speed / std::f64::consts::TAU,
            turns: average.turns,
            left_out: average.left_out,
            seconds: average.seconds,
            unevenness: average.turning.size() / average.speed,
        }
    }
}

impl Stages {
    /// The stages in words, with their azimuths.
    #[must_use]
    pub fn named(&self) -> [(&'static str, f64); 4] {
        [
            ("raw, clockwise", self.raw_deg),
            ("without the unevenness", self.without_unevenness_deg),
            ("both senses", self.both_senses_deg),
            ("everything", self.full_deg),
        ]
    }
}

impl From<&Fit> for Stages {
    fn from(fit: &Fit) -> Self {
        Self {
            raw_deg: degrees(fit.stages.raw),
            without_unevenness_deg: degrees(fit.stages.coupling),
            both_senses_deg: degrees(fit.stages.senses),
            full_deg: degrees(fit.stages.full),
        }
    }
}

/// The turns that were left out.
pub(super) fn excluded(conclusion: &Conclusion) -> Vec<Excluded> {
    let disturbed = averages(conclusion).filter(|average| average.left_out > 0).map(Stretch::from);
    let left_out = disturbed.map(|Stretch { sense, speed_hz, left_out, .. }| Excluded {
        sense,
        speed_hz,
        turns: left_out,
        reason: DISTURBED,
    });
    left_out.collect()
}

/// What one speed leaves of an integrated g-sensitivity, rad: what the second speed showed, or the 1σ
/// that a single one leaves.
pub(super) fn one_speed(replay: &Replay, conclusion: &Conclusion, fit: &Fit) -> Option<f64> {
    let bias = if conclusion.pairs.len() > 1 { fit.one_speed } else { fit.budget.g_sensitivity };
    is_molecular(replay).then_some(bias)
}

/// The object of a replay; `truth_deg` is for its error alone.
#[must_use]
pub fn object(replay: &Replay, conclusion: &Conclusion, truth_deg: Option<f64>) -> Object {
    let fit = conclusion.fit.as_ref();
    let bounded = fit.filter(|_| replay.noise_is_known());
    let flat = fit.filter(|fit| fit.ratio_sigma.is_finite());
    let attitude = fit.map(|fit| pitch_and_roll(fit).map(degrees));
    let coupling = conclusion.couplings.first();
    Object {
        method: "rotating",
        verdict: Verdict::of(&conclusion.verdict, truth_deg),
        limit_deg: bounded.map(|fit| degrees(fit.limit)),
        plain_limit_deg: bounded.map(|fit| degrees(fit.plain_limit)),
        budget: fit.map(|fit| (&fit.budget).into()),
        dominant: fit.and_then(|fit| fit.budget.dominant()).map(|source| source.to_string()),
        positions: averages(conclusion).map(|average| average.turns).sum(),
        seconds: averages(conclusion).map(|average| average.seconds).sum(),
        pitch_deg: attitude.map(|[pitch, _]| pitch),
        roll_deg: attitude.map(|[_, roll]| roll),
        earth_rate_ratio: flat.map(|fit| fit.ratio),
        earth_rate_ratio_sigma: flat.map(|fit| fit.ratio_sigma),
        model: columns(replay, conclusion),
        excluded: excluded(conclusion),
        assumed: replay.assumed.clone(),
        sensor: if replay.session.setting().sensor.is_flat { "gyro" } else { "met" },
        coupling_deg: coupling.map(|coupling| degrees(coupling.angle())),
        coupling_sigma_deg: coupling.map(|coupling| degrees(coupling.sine_sigma)),
        lag_s: coupling.map(Coupling::lag),
        tilt_deg: fit.map(|fit| degrees(tilt(fit))),
        met_ratio: fit.filter(|_| is_molecular(replay)).map(|fit| fit.molecular.size()),
        one_speed_bias_deg: fit.and_then(|fit| one_speed(replay, conclusion, fit)).map(degrees),
        stages: fit.map(Into::into),
        stretches: averages(conclusion).map(Into::into).collect(),
    }
}

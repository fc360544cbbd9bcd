//! One JSON object for each result.

use orientation::align::budget::Budget;
use orientation::align::conclusion::{Azimuth, Conclusion};
use orientation::align::stepwise::Fit;
use orientation::error::Refusal;
use serde::Serialize;

use super::{azimuth_error, columns, degrees};
use crate::positions::{Autocompensation, autocompensation};
use crate::replay::{Method, Replay};

/// The object of a method that gives an azimuth.
#[derive(Clone, Debug, Serialize)]
pub struct AzimuthObject {
    /// The method.
    pub method: &'static str,
    /// The criterion.
    pub criterion: String,
    /// The azimuth, or why there is none.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Cramér–Rao bound, where the noise is known.
    pub limit_deg: Option<f64>,
    /// The 1σ parts, where there is a fit.
    pub budget: Option<BudgetObject>,
    /// The greatest part beside noise, where it makes up more than half of the variance.
    pub dominant: Option<String>,
    /// Dwells that took part.
    pub positions: usize,
    /// Their standstill in seconds.
    pub seconds: f64,
    /// Pitch of the body, where it was measured.
    pub pitch_deg: Option<f64>,
    /// Roll of the body, where it was measured.
    pub roll_deg: Option<f64>,
    /// Earth rate found over expected; none of two positions, which take it for granted.
    pub earth_rate_ratio: Option<f64>,
    /// 1σ of the ratio.
    pub earth_rate_ratio_sigma: Option<f64>,
    /// Columns used.
    pub model: Vec<&'static str>,
    /// `free` or `known`.
    pub horizontal_earth_rate: Option<&'static str>,
    /// Dwells left out.
    pub excluded: Vec<Excluded>,
    /// The positions and what plain least squares makes of them; of method `positions`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub autocompensation: Option<Autocompensation>,
    /// What was assumed.
    pub assumed: Vec<String>,
}

/// An azimuth, or why there is none.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// `ok` or `refused`.
    pub status: &'static str,
    /// Why it was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Azimuth of body x, [0, 360); only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth_deg: Option<f64>,
    /// Its standard deviation; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_deg: Option<f64>,
    /// Azimuth less truth, where the recording carries one; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_deg: Option<f64>,
}

impl Verdict {
    /// Of a conclusion's verdict; `truth_deg` is for its error alone.
    #[must_use]
    pub fn of(verdict: &Result<Azimuth, Refusal>, truth_deg: Option<f64>) -> Self {
        let azimuth = verdict.as_ref().ok();
        let found = azimuth.map(|azimuth| degrees(azimuth.angle));
        Self {
            status: if verdict.is_ok() { "ok" } else { "refused" },
            reason: verdict.as_ref().err().map(ToString::to_string),
            azimuth_deg: found,
            sigma_deg: azimuth.map(|azimuth| degrees(azimuth.sigma)),
            error_deg: found.zip(truth_deg).map(|(azimuth, truth)| azimuth_error(azimuth, truth)),
        }
    }
}

/// The budget in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct BudgetObject {
    noise: f64,
    drift: f64,
    g_sensitivity: f64,
    accelerometer: f64,
    encoder: f64,
    latitude: f64,
    scale: f64,
    temperature: f64,
    /// Of a vehicle that drove.
    #[serde(skip_serializing_if = "Option::is_none")]
    displacement: Option<f64>,
}

/// A dwell left out.
#[derive(Clone, Debug, Serialize)]
pub struct Excluded {
    /// Number of the dwell, from one.
    pub dwell: usize,
    /// Its stage angle.
    pub stage_deg: f64,
    /// When it began.
    pub from_s: f64,
    /// When it ended.
    pub to_s: f64,
    /// Why.
    pub reason: String,
}

impl From<&Budget> for BudgetObject {
    fn from(budget: &Budget) -> Self {
        Self {
            noise: degrees(budget.noise),
            drift: degrees(budget.drift),
            g_sensitivity: degrees(budget.g_sensitivity),
            accelerometer: degrees(budget.accelerometer),
            encoder: degrees(budget.encoder),
            latitude: degrees(budget.latitude),
            scale: degrees(budget.scale),
            temperature: degrees(budget.temperature),
            displacement: (budget.displacement > 0.0).then(|| degrees(budget.displacement)),
        }
    }
}

/// The object of a replay; `truth_deg` is for its error alone.
#[must_use]
pub fn azimuth(replay: &Replay, conclusion: &Conclusion, truth_deg: Option<f64>) -> AzimuthObject {
    let fit = conclusion.fit.as_ref();
    let seen = fit.filter(|fit| !fit.model.is_single_axis);
    let tilt = conclusion.tilt.measured.then_some(&conclusion.tilt);
    let kept = || {
        let dwells = replay.session.dwells().iter().zip(&conclusion.disturbances);
        dwells.filter(|(_, why)| why.is_none()).map(|(dwell, _)| dwell)
    };
    AzimuthObject {
        method: replay.method.name(),
        criterion: replay.criterion_name(),
        verdict: Verdict::of(&conclusion.verdict, truth_deg),
        limit_deg: fit.filter(|_| replay.noise_is_known()).map(|fit| degrees(fit.limit)),
        budget: fit.map(|fit| (&fit.budget).into()),
        dominant: fit.and_then(|fit| fit.budget.dominant()).map(|source| source.to_string()),
        positions: kept().count(),
        seconds: kept().map(|dwell| dwell.seconds).sum(),
        pitch_deg: tilt.map(|tilt| degrees(tilt.pitch())),
        roll_deg: tilt.map(|tilt| degrees(tilt.roll())),
        earth_rate_ratio: seen.map(|fit| fit.ratio),
        earth_rate_ratio_sigma: seen.map(|fit| fit.ratio_sigma),
        model: fit.map(columns).unwrap_or_default(),
        horizontal_earth_rate: fit.map(earth_rate),
        excluded: excluded(replay, conclusion),
        autocompensation: (replay.method == Method::Positions)
            .then(|| autocompensation(&replay.session, conclusion)),
        assumed: replay.assumed.clone(),
    }
}

/// How the Earth rate entered a fit.
#[must_use]
pub fn earth_rate(fit: &Fit) -> &'static str {
    if fit.earth_rate_is_free() { "free" } else { "known" }
}

/// The dwells that were left out.
#[must_use]
pub fn excluded(replay: &Replay, conclusion: &Conclusion) -> Vec<Excluded> {
    let dwells = replay.session.dwells().iter().zip(&conclusion.disturbances).enumerate();
    dwells
        .filter_map(|(index, (dwell, why))| {
            why.map(|why| Excluded {
                dwell: index + 1,
                stage_deg: degrees(dwell.stage.rad()),
                from_s: dwell.start().max(0.0),
                to_s: dwell.end(),
                reason: why.to_string(),
            })
        })
        .collect()
}

//! The JSON object of an alignment from stops.

use orientation::align::stops::conclusion::{Conclusion, Found};
use orientation::align::stops::inclination::pitch_and_roll;
use orientation::align::stops::stop;
use orientation::units::wrapped;
use serde::Serialize;

use super::columns;
use crate::output::json::{BudgetObject, Verdict};
use crate::output::{azimuth_error, degrees, degrees_per_hour};
use crate::recording::Truth;
use crate::stops::Replay;

/// The object; its keys are those of every method that gives an azimuth, then its own.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// `siap` or `static`.
    pub method: &'static str,
    /// The azimuth at the end, or why there is none.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Azimuth of body x at the beginning, [0, 360); only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_azimuth_deg: Option<f64>,
    /// Its standard deviation; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_sigma_deg: Option<f64>,
    /// It less the truth, where the recording carries one; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_error_deg: Option<f64>,
    /// Cramér–Rao bound, where the noise is known.
    pub limit_deg: Option<f64>,
    /// The 1σ parts, where there is a solution.
    pub budget: Option<BudgetObject>,
    /// The greatest part beside noise, where it makes up more than half of the variance.
    pub dominant: Option<String>,
    /// Stops.
    pub positions: usize,
    /// Their time in seconds.
    pub seconds: f64,
    /// Pitch of the body at the last stop.
    pub pitch_deg: Option<f64>,
    /// Roll of the body at the last stop.
    pub roll_deg: Option<f64>,
    /// Angle by which the Earth turned gravity between the first stop and the last, over that expected.
    pub earth_rate_ratio: Option<f64>,
    /// 1σ of the ratio.
    pub earth_rate_ratio_sigma: Option<f64>,
    /// What the solution found.
    pub model: Vec<&'static str>,
    /// What was left out.
    pub excluded: Vec<Excluded>,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// Biases of the gyros forward, right, down, °/h, where they could be told from the Earth rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias_dph: Option<[f64; 3]>,
    /// Their 1σ, °/h.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias_sigma_dph: Option<[f64; 3]>,
    /// What the paper's method makes of the first and the last stop.
    pub plain: Option<Plain>,
    /// The stops.
    pub stops: Vec<Stop>,
}

/// The paper's method: azimuths of the least inclination U between the first stop and the last. It finds
/// that at the first stop; what the gyros turned leads to the end.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Plain {
    /// At the end, in closed form, [0, 360).
    pub azimuth_deg: f64,
    /// Its standard deviation.
    pub sigma_deg: f64,
    /// At the first stop, in closed form.
    pub start_azimuth_deg: f64,
    /// At the first stop, where Brent's search finds the least U in the angle form.
    pub brent_deg: f64,
    /// The same in the paper's form.
    pub euler_deg: f64,
    /// The least U itself, in the angle form.
    pub inclination_deg: f64,
}

impl Plain {
    /// Of what was found.
    #[must_use]
    pub fn of(found: &Found) -> Self {
        let plain = &found.plain;
        let turned = found.azimuth.angle - found.start.angle;
        Self {
            azimuth_deg: degrees(wrapped(plain.azimuth + turned)),
            sigma_deg: degrees(plain.sigma),
            start_azimuth_deg: degrees(plain.azimuth),
            brent_deg: degrees(plain.angle.at),
            euler_deg: degrees(plain.euler.at),
            inclination_deg: degrees(plain.angle.value),
        }
    }
}

/// A stop.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Stop {
    /// When it began, on the recording's clock.
    pub from_s: f64,
    /// When it ended.
    pub to_s: f64,
    /// Pitch of the body.
    pub pitch_deg: f64,
    /// Roll of the body.
    pub roll_deg: f64,
    /// How far it lies from the first, north and east, where that was known.
    pub displacement_m: Option<[f64; 2]>,
}

/// What was left out.
#[derive(Clone, Debug, Serialize)]
pub struct Excluded {
    /// Number of the stop, from one, where it was at one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<usize>,
    /// How much of what, and why.
    pub reason: String,
}

impl Stop {
    /// Of the session's stop, whose zero is at `zero_s`.
    #[must_use]
    pub fn of(stop: &stop::Stop, zero_s: f64) -> Self {
        let [pitch, roll] = pitch_and_roll(&stop.force.mean());
        Self {
            from_s: zero_s + stop.from,
            to_s: zero_s + stop.to,
            pitch_deg: degrees(pitch),
            roll_deg: degrees(roll),
            displacement_m: stop.displacement,
        }
    }
}

/// What was left out: seconds of stops, means, rest rates.
fn excluded(replay: &Replay, found: Option<&Found>) -> Vec<Excluded> {
    let stops = replay.session.stops().iter().enumerate();
    let blown = stops.filter(|(_, stop)| stop.left_out > 0).map(|(index, stop)| {
        let seconds = stop.left_out;
        let reason = format!("{seconds} s: a blow, or an accelerometer at its limit");
        Excluded { stop: Some(index + 1), reason }
    });
    let anywhere = |reason: String| Excluded { stop: None, reason };
    let of_found = found.into_iter().flat_map(|found| {
        let [left_out, of] = found.left_out;
        let means = format!("{left_out} of {of} means of the force: disturbed");
        let turning = format!("rest rates of {} stop(s): the vehicle turned", found.turning);
        let both = [(left_out > 0, means), (found.turning > 0, turning)];
        both.into_iter().filter_map(|(is_there, reason)| is_there.then_some(reason))
    });
    blown.chain(of_found.map(anywhere)).collect()
}

/// The object of a replay; the truth is for its errors alone.
#[must_use]
pub fn object(replay: &Replay, conclusion: &Conclusion, truth: &Truth) -> Object {
    let found = conclusion.found.as_ref();
    let start = found.filter(|_| conclusion.verdict.is_ok()).map(|found| found.start);
    let start_deg = start.map(|azimuth| degrees(azimuth.angle));
    let observed = found.filter(|found| found.are_biases_observed);
    let stops = replay.session.stops();
    Object {
        method: replay.method.name(),
        verdict: Verdict::of(&conclusion.verdict, truth.azimuth_deg),
        start_azimuth_deg: start_deg,
        start_sigma_deg: start.map(|azimuth| degrees(azimuth.sigma)),
        start_error_deg: start_deg.zip(truth.start_azimuth_deg).map(|(a, b)| azimuth_error(a, b)),
        limit_deg: found.filter(|_| replay.noise_is_known()).map(|found| degrees(found.limit)),
        budget: found.map(|found| (&found.budget).into()),
        dominant: found.and_then(|found| found.budget.dominant()).map(|source| source.to_string()),
        positions: stops.len(),
        seconds: stops.iter().map(stop::Stop::seconds).sum(),
        pitch_deg: found.map(|found| degrees(found.level[0])),
        roll_deg: found.map(|found| degrees(found.level[1])),
        earth_rate_ratio: found.map(|found| found.plain.ratio),
        earth_rate_ratio_sigma: found.map(|found| found.plain.ratio_sigma),
        model: found.map(|_| columns(replay)).unwrap_or_default(),
        excluded: excluded(replay, found),
        assumed: replay.assumed.clone(),
        bias_dph: observed.map(|found| found.biases.map(degrees_per_hour)),
        bias_sigma_dph: observed.map(|found| found.bias_sigmas.map(degrees_per_hour)),
        plain: found.map(Plain::of),
        stops: stops.iter().map(|stop| Stop::of(stop, replay.zero_s)).collect(),
    }
}

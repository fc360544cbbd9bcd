//! The roll of a body in fast rotation.

mod figures;

use orientation::units::TURN;
use serde::Serialize;

use crate::methods::spin::errors::{Errors, bound_rms};
use crate::methods::spin::track::Track;
use crate::methods::spin::{Replay, name};
use crate::outcome::{Finished, Outcome};
use crate::output::degrees;
use crate::recording::{Body, Truth};
use crate::report::{Columns, Lines, Part, Table};

/// What the roll of a spinning body adds; rolls count whole turns, errors do not.
#[derive(Clone, Debug, Serialize)]
pub struct SpinDetails {
    /// Roll at the last sample, rad; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_rad_end: Option<f64>,
    /// The gyro's scale error, gyro/true − 1.
    pub scale_error: Option<f64>,
    /// 1σ of the scale error.
    pub scale_sigma: Option<f64>,
    /// What the phase lock is doing at the end.
    pub state: String,
    /// What it was doing before, in order.
    pub states: Vec<StateDetails>,
    /// The lift at the end, m/s².
    pub lift: Option<f64>,
    /// RMS error after the first 0.1 s, °, where the recording carries the truth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rms_deg: Option<f64>,
    /// RMS of the Cramér–Rao bounds over those samples, °.
    pub limit_rms_deg: Option<f64>,
    /// By how many turns the count went wrong, where the recording carries the truth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns_lost: Option<u64>,
    /// Every method; the last one is the answer.
    pub methods: Vec<MethodDetails>,
    /// Noise of an accelerometer in a sample, m/s².
    pub force_noise_m_s2: f64,
    /// Samples.
    pub samples: usize,
}

/// What the phase lock did from a moment on.
#[derive(Clone, Debug, Serialize)]
pub struct StateDetails {
    /// When the state began, s.
    pub from_s: f64,
    /// State of the phase lock, in words.
    pub state: String,
}

/// A method on the samples.
#[derive(Clone, Debug, Serialize)]
pub struct MethodDetails {
    /// Name of the method in tables.
    pub name: &'static str,
    /// Roll at the last sample, rad.
    pub roll_rad_end: f64,
    /// RMS error after the first 0.1 s, °, where the recording carries the truth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rms_deg: Option<f64>,
    /// By how many turns the count went wrong, where the recording carries the truth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns_lost: Option<u64>,
    /// How many corrections it made.
    pub corrections: usize,
}

impl MethodDetails {
    /// The details of a track; the truth is for its errors alone.
    fn of(track: &Track, truth: &Truth) -> Self {
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

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let (answer, reason) = (self.answer(), self.refusal());
        let errors = Errors::of(answer, &truth.roll_rad);
        let (end, is_ok) = (&answer.end, reason.is_none());
        let bounds = self.bounds.as_deref();
        let states = answer.states.iter();
        let states =
            states.map(|(from_s, of)| StateDetails { from_s: *from_s, state: of.to_string() });
        let details = SpinDetails {
            roll_rad_end: is_ok.then_some(end.roll_rad),
            scale_error: end.scale.map(|[scale, _]| scale),
            scale_sigma: end.scale.map(|[_, sigma]| sigma),
            state: end.state.to_string(),
            states: states.collect(),
            lift: end.lift,
            rms_deg: errors.as_ref().and_then(|errors| errors.rms_rad).map(degrees),
            limit_rms_deg: bounds.and_then(|bounds| bound_rms(answer, bounds)).map(degrees),
            turns_lost: errors.as_ref().map(|errors| errors.turns_lost),
            methods: self.tracks.iter().map(|track| MethodDetails::of(track, truth)).collect(),
            force_noise_m_s2: self.noise.force,
            samples: answer.rolls_rad.len(),
        };
        Outcome {
            sigma_deg: end.sigma_rad.filter(|_| is_ok).map(degrees),
            error_deg: errors.as_ref().and_then(Errors::end_rad).filter(|_| is_ok).map(degrees),
            limit_deg: bounds.and_then(<[f64]>::last).copied().map(degrees),
            seconds: self.period_s * answer.rolls_rad.len() as f64,
            assumed: self.assumed.clone(),
            ..Outcome::new("spin", details)
        }
        .settled(reason)
    }

    fn titles(&self) -> [&'static str; 2] {
        ["Roll of the spinning body in", "No roll at the end of"]
    }

    fn parts(&self, outcome: &Outcome) -> Vec<Part> {
        let Some(details) = outcome.details::<SpinDetails>() else { return Vec::new() };
        let states = Columns::of("States of the phase lock", &details.states)
            .fixed("from, s", 4, |it| it.from_s)
            .column("state", |it| &it.state);
        vec![lines(outcome, details).into(), methods(details).into(), states.into()]
    }

    fn figures(&self, _: &Outcome, truth: &Truth, _: Option<&Body>) -> Vec<Part> {
        let rest = [figures::sigmas(self, truth), figures::lift(self), figures::scale(self)];
        figures::errors(self, truth).into_iter().chain(rest).map(Part::from).collect()
    }
}

fn lines(outcome: &Outcome, details: &SpinDetails) -> Lines {
    let mut lines = Lines::default();
    if let Some((roll, sigma)) = details.roll_rad_end.zip(outcome.sigma_deg) {
        let turns = (roll / TURN).floor();
        let angle = degrees(roll - turns * TURN);
        let text = format!("{turns} turns and {angle:.5}° ± {sigma:.5}° (1σ); {roll:.6} rad");
        lines.add("roll at the end", text);
        if let Some(error) = outcome.error_deg {
            let sigmas = error / sigma;
            lines.add("truth", format!("the error is {error:+.5}°, {sigmas:+.2} σ"));
        }
    }
    let limit = outcome.limit_deg.map(|limit| format!("{limit:.5}° (Cramér–Rao)"));
    lines.add_found("limit", limit);
    lines.add("state", &details.state);
    lines.add_found("lift", details.lift.map(|lift| format!("{lift:.3} m/s²")));
    let scale = details.scale_error.zip(details.scale_sigma);
    let words = |(scale, sigma)| format!("{scale:+.4e} ± {sigma:.1e} (1σ)");
    lines.add_found("gyro's scale error", scale.map(words));
    let noise = details.force_noise_m_s2;
    lines.add("force noise", format!("{noise:.2e} m/s² a sample, as the turns show it"));
    lines
}

/// How each method did; only corrections where there is no truth.
fn methods(details: &SpinDetails) -> Table {
    let limit = details
        .limit_rms_deg
        .map(|limit| vec!["limit".to_owned(), String::new(), format!("{limit:.5}"), String::new()]);
    let title = "Methods: errors within half a turn, after the first 0.1 s";
    Columns::of(title, &details.methods)
        .column("method", |method| method.name)
        .column("corrections", |method| method.corrections)
        .found("RMS error, °", 5, |method| method.rms_deg)
        .found("turns lost", 0, |method| method.turns_lost.map(|turns| turns as f64))
        .table(limit)
}

//! The roll of a body in fast rotation.

mod figures;

use orientation::roll::{Condition, State};
use orientation::units::TURN;
use serde::Serialize;

use crate::methods::spin::errors::{Errors, bound_rms};
use crate::methods::spin::track::Track;
use crate::methods::spin::{Replay, name};
use crate::outcome::keys::Keys;
use crate::outcome::{Finished, Outcome};
use crate::output::{degrees, fixed, places_of, signed};
use crate::recording::{Body, Truth};
use crate::report::{Columns, Lines, Part, Table};

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

impl Replay {
    /// RMS of the Cramér–Rao bounds after the first 0.1 s, °.
    fn limit_rms_deg(&self) -> Option<f64> {
        self.bounds.as_deref().and_then(|bounds| bound_rms(self.answer(), bounds)).map(degrees)
    }

    /// What the roll of a spinning body adds; rolls count whole turns, errors do not.
    fn details(&self, methods: &[MethodDetails; 3], is_ok: bool) -> Keys {
        let (answer, [.., shown]) = (self.answer(), methods);
        let end = &answer.end;
        let state = |(from_s, state): &(f64, State)| {
            Keys::default().with("from_s", from_s).with("state", state.to_string())
        };
        Keys::default()
            .with_found("roll_rad_end", is_ok.then_some(end.roll_rad))
            .with("scale_error", end.scale.map(|[scale, _]| scale))
            .with("scale_sigma", end.scale.map(|[_, sigma]| sigma))
            .with("state", end.state.to_string())
            .with("states", answer.states.iter().map(state).collect::<Vec<_>>())
            .with("lift", end.lift)
            .with_found("rms_deg", shown.rms_deg)
            .with("limit_rms_deg", self.limit_rms_deg())
            .with_found("turns_lost", shown.turns_lost)
            .with("methods", methods)
            .with("force_noise_m_s2", self.noise.force)
            .with("samples", answer.rolls_rad.len())
    }
}

impl Replay {
    /// That the lock is lost at the end.
    fn degradations(&self) -> Vec<String> {
        let state = &self.answer().end.state;
        let is_lost = state.condition != Condition::Locked;
        is_lost.then(|| format!("not locked at the end: {state}")).into_iter().collect()
    }

    /// Length of the record.
    fn circumstances(&self) -> Vec<[String; 2]> {
        let (count, period_s) = (self.answer().rolls_rad.len(), self.period_s);
        let (seconds, hertz) = (count as f64 * period_s, 1.0 / period_s);
        let time = format!("{seconds:.2} s, {count} samples at {hertz:.0} Hz");
        Lines::default().with("time", time).lines
    }
}

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let (answer, reason) = (self.answer(), self.refusal());
        let errors = Errors::of(answer, &truth.roll_rad);
        let (end, is_ok) = (&answer.end, reason.is_none());
        let methods = self.tracks.each_ref().map(|track| MethodDetails::of(track, truth));
        let limit = self.bounds.as_deref().and_then(<[f64]>::last).copied();
        let outcome = Outcome {
            sigma_deg: end.sigma_rad.filter(|_| is_ok).map(degrees),
            error_deg: errors.as_ref().and_then(Errors::end_rad).filter(|_| is_ok).map(degrees),
            limit_deg: limit.map(degrees),
            seconds: self.period_s * answer.rolls_rad.len() as f64,
            assumed: self.assumed.clone(),
            ..Outcome::new("spin", self.details(&methods, is_ok), Vec::new())
        };
        let parts = vec![
            Part::from(table(&methods, self.limit_rms_deg())).detail(),
            states(answer).detail(),
        ];
        let found = at_end(self, outcome.sigma_deg);
        let facts = facts(self, &outcome).lines;
        let (degradations, circumstances) = (self.degradations(), self.circumstances());
        Outcome { found, facts, degradations, circumstances, parts, ..outcome }.settled(reason)
    }

    fn titles(&self) -> [&'static str; 2] {
        ["Roll of the spinning body in", "No roll at the end of"]
    }

    fn figures(&self, _: &Outcome, truth: &Truth, _: Option<&Body>) -> Vec<Part> {
        let answer = figures::error(self, truth).into_iter().chain([figures::sigmas(self, truth)]);
        let mut page: Vec<Part> = answer.map(Part::from).collect();
        page.push(figures::timeline(self.answer()).into());
        let others = [figures::scale(self), figures::lift(self)].into_iter();
        page.extend(others.map(Part::from));
        page.extend(figures::errors(self, truth).into_iter().map(|one| Part::from(one).detail()));
        page
    }
}

fn states(answer: &Track) -> Part {
    Columns::of("States of the phase lock", &answer.states)
        .fixed("from, s", 4, |(from_s, _)| *from_s)
        .column("state", |(_, state)| state)
        .into()
}

/// The roll at the last sample, in words; none where there is none.
fn at_end(replay: &Replay, sigma_deg: Option<f64>) -> Option<[String; 2]> {
    let angle = degrees(replay.answer().end.roll_rad.rem_euclid(TURN));
    let words = |sigma: f64| format!("{angle:.5}° ± {sigma:.5}° (1σ)");
    sigma_deg.map(|sigma| ["roll at the end".to_owned(), words(sigma)])
}

/// What else is said first.
fn facts(replay: &Replay, outcome: &Outcome) -> Lines {
    let (end, noise) = (&replay.answer().end, replay.noise.force);
    let truth = outcome.sigma_deg.zip(outcome.error_deg).map(|(sigma, error)| {
        format!("the error is {}°, {} σ", signed(error, 5), signed(error / sigma, 2))
    });
    let whole = (end.roll_rad / TURN).floor();
    let turns = format!("{whole} since the beginning: {:.6} rad in all", end.roll_rad);
    let scale = |found: [f64; 2]| {
        let [scale, sigma] = found.map(|relative| 1e6 * relative);
        let places = places_of(sigma);
        format!("{} ± {} ppm (1σ)", signed(scale, places), fixed(sigma, places))
    };
    Lines::default()
        .with_found("turns", outcome.sigma_deg.map(|_| turns))
        .with_found("truth", truth)
        .with_found("limit", outcome.limit_deg.map(|limit| format!("{limit:.5}° (Cramér–Rao)")))
        .with("state", end.state.to_string())
        .with_found("lift", end.lift.map(|lift| format!("{lift:.3} m/s²")))
        .with_found("gyro's scale error", end.scale.map(scale))
        .with("force noise", format!("{noise:.4} m/s² a sample, as the turns show it"))
}

fn table(methods: &[MethodDetails], limit_rms_deg: Option<f64>) -> Table {
    let limit = limit_rms_deg
        .map(|limit| vec!["limit".to_owned(), String::new(), format!("{limit:.5}"), String::new()]);
    let title = "Methods: errors within half a turn, after the first 0.1 s";
    Columns::of(title, methods)
        .column("method", |method| method.name)
        .column("corrections", |method| method.corrections)
        .found("RMS error, °", 5, |method| method.rms_deg)
        .found("turns lost", 0, |method| method.turns_lost.map(|turns| turns as f64))
        .table(limit)
}

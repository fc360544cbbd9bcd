//! Rolls against the truth; only a check comes here.

use orientation::units::TURN;

use super::track::Track;
use crate::campaign::statistics::rms;

/// Time from the first sample after which a method must have found the roll, s.
pub const SETTLED_S: f64 = 0.1;

/// From when on, s, the errors of a track count.
fn settled_s(track: &Track) -> f64 {
    track.times_s.first().copied().unwrap_or_default() + SETTLED_S
}

/// The errors of a track.
#[derive(Clone, Debug)]
pub struct Errors {
    /// Error of each sample, rad, within ±π; not a number where the truth is not known.
    pub wrapped_rad: Vec<f64>,
    /// RMS after [`SETTLED_S`], rad; none of nothing.
    pub rms_rad: Option<f64>,
    /// By how many turns the count went wrong at most after that time.
    pub turns_lost: u64,
}

impl Errors {
    /// Compares a track with the true rolls of its samples, rad; none where there are not as many.
    #[must_use]
    pub fn of(track: &Track, truth_rad: &[f64]) -> Option<Self> {
        (truth_rad.len() == track.rolls_rad.len()).then(|| Self::between(track, truth_rad))
    }

    /// Compares a track with as many true rolls, rad.
    pub(crate) fn between(track: &Track, truth_rad: &[f64]) -> Self {
        let whole: Vec<f64> =
            track.rolls_rad.iter().zip(truth_rad).map(|(roll, truth)| roll - truth).collect();
        let wrapped_rad: Vec<f64> = whole.iter().map(|error| wrapped(*error)).collect();
        let from_s = settled_s(track);
        let settled = || {
            let both = whole.iter().zip(&wrapped_rad).zip(&track.times_s);
            both.filter(move |((error, _), time_s)| **time_s >= from_s && error.is_finite())
        };
        let turns: Vec<f64> =
            settled().map(|((whole, wrapped), _)| ((whole - wrapped) / TURN).round()).collect();
        let settled: Vec<f64> = settled().map(|((_, wrapped), _)| *wrapped).collect();
        // Turns are counted from any one.
        let first = turns.first().copied().unwrap_or_default();
        let turns_lost = turns.iter().fold(0.0, |most, turn| f64::max(most, (turn - first).abs()));
        let rms_rad = (!settled.is_empty()).then(|| rms(&settled));
        Self { wrapped_rad, rms_rad, turns_lost: turns_lost as u64 }
    }

    /// The error at the last sample, rad, where its truth is known.
    #[must_use]
    pub fn end_rad(&self) -> Option<f64> {
        self.wrapped_rad.last().copied().filter(|error| error.is_finite())
    }
}

/// RMS of the bounds after [`SETTLED_S`], rad.
pub(crate) fn bound_rms(track: &Track, bounds: &[f64]) -> Option<f64> {
    let (both, from_s) = (bounds.iter().zip(&track.times_s), settled_s(track));
    let settled: Vec<f64> =
        both.filter(|(_, time_s)| **time_s >= from_s).map(|(bound, _)| *bound).collect();
    (!settled.is_empty()).then(|| rms(&settled))
}

/// An angle within ±π, rad.
#[must_use]
pub fn wrapped(angle: f64) -> f64 {
    angle - (angle / TURN).round() * TURN
}

//! The paper's figures: the error of the roll over a second without correction and with it (Fig. 7), and
//! between corrections (Fig. 8); beside them what the same samples give with interpolated extrema and by
//! phase lock.

use orientation::units::TURN;
use serde::Serialize;

use super::world::{Flight, Recorded, SCALE_ERROR, STEADY};
use crate::methods::spin::errors::Errors;
use crate::methods::spin::name;
use crate::methods::spin::track::Track;
use crate::output::degrees;

/// Turns a second: the paper's hundred, and a little more, so that samples fall everywhere on the turn.
pub const TURNS_PER_S: f64 = 100.37;
/// Length of the fragment, s.
pub const FRAGMENT_S: f64 = 0.03;

/// The paper's second.
#[derive(Clone, Debug, Serialize)]
pub struct Paper {
    /// Error after a second without correction: 36° of 100 turns.
    pub uncorrected_deg: f64,
    /// What the error grows by from a correction to the last sample before the next, in the mean.
    pub growth_deg: f64,
    /// Corrections a turn.
    pub corrections_per_turn: f64,
    /// RMS errors after the first 0.1 s.
    pub methods: Vec<(&'static str, f64)>,
    /// Scale error that the phase lock found less the true one.
    pub scale_miss: f64,
    /// Time, s, and error, °, without correction and of each method, in the order of [`METHODS`](crate::methods::spin::METHODS).
    #[serde(skip)]
    pub curves: [Vec<(f64, f64)>; 4],
}

/// Flies the paper's second.
#[must_use]
pub fn paper() -> Paper {
    let spin_rad_s = &[(0.0, TURNS_PER_S * TURN)];
    let recorded = Flight { roll_rad: 0.4, spin_rad_s, ..STEADY }.fly(1);
    let all = recorded.tracked();
    let uncorrected = uncorrected(&recorded);
    let [(extrema, of_extrema), _, (locked, _)] = &all;
    let [first, second, third] =
        all.each_ref().map(|(track, errors)| track.over_time(&errors.wrapped_rad));
    let turned = recorded.rolls_rad.last().map_or(f64::NAN, |roll| (roll - 0.4) / TURN);
    Paper {
        uncorrected_deg: uncorrected.last().map_or(f64::NAN, |(_, error)| *error),
        growth_deg: growth(extrema, of_extrema),
        corrections_per_turn: extrema.corrections.len() as f64 / turned,
        methods: all.iter().map(|(track, errors)| (name(track.method), rms_deg(errors))).collect(),
        scale_miss: locked.end.scale.map_or(f64::NAN, |[scale, _]| scale - SCALE_ERROR),
        curves: [uncorrected, first, second, third],
    }
}

/// RMS of the errors after the first 0.1 s, °; not a number of none.
pub(super) fn rms_deg(errors: &Errors) -> f64 {
    degrees(errors.rms_rad.unwrap_or(f64::NAN))
}

/// The error of the gyro's own angle, which starts right.
fn uncorrected(recorded: &Recorded) -> Vec<(f64, f64)> {
    let mut angle = recorded.rolls_rad.first().copied().unwrap_or_default();
    let both = recorded.samples.iter().zip(&recorded.rolls_rad);
    let error = both.map(|(sample, roll)| {
        angle += sample.turned[0].rad();
        (sample.time.seconds(), degrees(angle - roll))
    });
    error.collect()
}

/// What an error grows by from one correction to the last sample before the next, °, in the mean.
fn growth(track: &Track, errors: &Errors) -> f64 {
    let settled = track.corrections.len() / 10;
    let pairs = track.corrections.windows(2).skip(settled);
    let grown = |pair: &[usize]| errors.wrapped_rad[pair[1] - 1] - errors.wrapped_rad[pair[0]];
    let (sum, count) =
        pairs.fold((0.0, 0.0), |(sum, count), pair| (sum + grown(pair), count + 1.0));
    degrees(sum / count)
}

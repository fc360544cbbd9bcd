//! What each turn of a platform shows by itself, for figures.
//!
//! Plain `f64` on the rows of a recording, beside what the session found: a figure that shows
//! something else than the result is a reason to look.

use std::f64::consts::TAU;

use orientation::math::regression::{Column, Regression};
use rustfft::num_complex::Complex;

use crate::recording::RotatingRow;
use crate::spectrum::{Line, amplitudes, hann};

/// A signal of the rows, in SI units.
pub type Signal<'a> = &'a dyn Fn(&RotatingRow) -> f64;

/// Whole turns in a stretch, from its first row on.
#[must_use]
pub fn whole_turns(rows: &[RotatingRow]) -> usize {
    let [Some(first), Some(last)] = [rows.first(), rows.last()] else { return 0 };
    ((last.stage_rad - first.stage_rad).abs() / TAU).floor() as usize
}

/// Rows of the first so many turns.
fn first_turns(rows: &[RotatingRow], turns: usize) -> &[RotatingRow] {
    let Some(first) = rows.first() else { return rows };
    let within = |row: &RotatingRow| (row.stage_rad - first.stage_rad).abs() < TAU * turns as f64;
    &rows[..rows.iter().take_while(|row| within(row)).count()]
}

/// The rows of each whole turn.
pub(super) fn each_turn(rows: &[RotatingRow]) -> impl Iterator<Item = &[RotatingRow]> {
    let edge = |turns| first_turns(rows, turns).len();
    (0..whole_turns(rows)).map(move |turn| &rows[edge(turn)..edge(turn + 1)])
}

/// The signal's phasor over rows, a of Re{a e^{jθ}}, with constant and trend taken off; none where the
/// rows do not show it.
#[must_use]
pub fn phasor(rows: &[RotatingRow], signal: Signal<'_>) -> Option<Complex<f64>> {
    let begin = rows.first()?;
    let mut regression = Regression::<4>::default();
    for row in rows {
        let (sine, cosine) = row.stage_rad.sin_cos();
        let since = row.time_s - begin.time_s;
        regression.push(&[cosine, -sine, 1.0, since], signal(row) - signal(begin));
    }
    let [re, im, ..] = regression.solve(&[Column::Free; 4])?.coefficients;
    Some(Complex::new(re, im))
}

/// The time of the middle of each whole turn, s, and its phasor.
#[must_use]
pub fn phasors(rows: &[RotatingRow], signal: Signal<'_>) -> Vec<(f64, Complex<f64>)> {
    let of_turn = |turn: &[RotatingRow]| {
        let [first, last] = [turn.first()?, turn.last()?];
        Some((first.time_s.midpoint(last.time_s), phasor(turn, signal)?))
    };
    each_turn(rows).filter_map(of_turn).collect()
}

/// Samples in a second; zero of fewer than two rows.
#[must_use]
pub fn rate_hz(rows: &[RotatingRow]) -> f64 {
    in_a_second(rows, |_, _| (rows.len() - 1) as f64)
}

/// Mean frequency of the turn, Hz, clockwise positive; zero of fewer than two rows.
#[must_use]
pub fn turn_hz(rows: &[RotatingRow]) -> f64 {
    in_a_second(rows, |first, last| (last.stage_rad - first.stage_rad) / TAU)
}

/// How much of something between the first row and the last comes to pass in a second; zero of fewer than two rows.
fn in_a_second(rows: &[RotatingRow], of: impl Fn(&RotatingRow, &RotatingRow) -> f64) -> f64 {
    match [rows.first(), rows.last()] {
        [Some(first), Some(last)] if last.time_s > first.time_s => {
            of(first, last) / (last.time_s - first.time_s)
        }
        _ => 0.0,
    }
}

/// The signal's amplitude spectrum over the stretch's whole turns, through Hann's window: what keeps
/// step with the turn then falls on a line.
#[must_use]
pub fn spectrum(rows: &[RotatingRow], signal: Signal<'_>) -> Vec<Line> {
    let whole = first_turns(rows, whole_turns(rows));
    let values: Vec<f64> = whole.iter().map(signal).collect();
    amplitudes(&values, rate_hz(rows), hann)
}

/// The rows without what the sensor shows of the platform's rate and of its derivative: `sine` of the one,
/// `quadrature`, s, of the other.
#[must_use]
pub fn freed(rows: &[RotatingRow], sine: f64, quadrature: f64) -> Vec<RotatingRow> {
    let of = |index: usize| {
        let (row, before) = (&rows[index], &rows[index.saturating_sub(1)]);
        let after = &rows[(index + 1).min(rows.len() - 1)];
        let seconds = (after.time_s - before.time_s).max(f64::MIN_POSITIVE);
        let quickening = (after.stage_rate_rad_s - before.stage_rate_rad_s) / seconds;
        let felt = sine * row.stage_rate_rad_s + quadrature * quickening;
        RotatingRow { rate_rad_s: row.rate_rad_s - felt, ..*row }
    };
    (0..rows.len()).map(of).collect()
}

//! White noise of gyros and accelerometers as a recording shows it, where it is not stated, or as a check of
//! what was stated.
//!
//! It is taken where the vehicle stood, from the spectrum of the rates: N² is what the noise that is noise of
//! the angle (quantisation, dither; rising with the square of the frequency, −1 in an Allan deviation) leaves
//! beneath it, and what sway and engine, whose lines stand above it, leave between them. The coefficients are
//! those of the Allan variance, which cannot distinguish a line from a slope.

use super::floor::{Floor, Spectrum};
use crate::recording::ImuRow;

/// White noise of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct White {
    /// Angle random walk N, that of the three gyros together, rad/√s.
    pub angle_random_walk: f64,
    /// 1σ of [`Self::angle_random_walk`], relative.
    pub relative_sigma: f64,
    /// Noise of each sample's angle, 1σ, rad: quantisation and dither.
    pub angle: f64,
    /// Noise density of the accelerometers, that of the three together, one-sided, m/s²/√Hz.
    pub force: f64,
}

/// Rows for each fresh sample from which on a recorder is taken to hold them: noise repeats itself seldom.
const HELD: f64 = 1.2;
/// Fewest samples at rest that say something of noise: a spectrum of three axes with a dozen lines beside the
/// first, which are the window's.
const LEAST_SAMPLES: usize = 64;
/// Longest stretch of one spectrum, s: lines of a sixtieth of a Hz distinguish N from noise of the angle.
const LONGEST_S: f64 = 60.0;
/// Most stretches that are looked at: more show nothing new.
const MOST_STRETCHES: usize = 64;
/// Time after the wheels stand in which a body rocks, and before they roll again, s.
const ROCKING_S: [f64; 2] = [4.0, 2.0];
/// Length of a stretch that is quiet or not, s: the stop criteria look for as long.
const QUIET_S: f64 = 10.0;
/// How much more power than in the quietest stretch there may be in a quiet one.
const QUIET_POWER: f64 = 3.0;

/// Estimates the noise where the vehicle stood, or where it was quietest if that is not known. Samples that a
/// recorder held count once. None where there are too few samples at rest; zero where they have no noise.
#[must_use]
pub fn at_rest(rows: &[ImuRow], stops_s: Option<&[[f64; 2]]>, period_s: f64) -> Option<White> {
    let mut fresh = rows.to_vec();
    fresh.dedup_by(|next, row| next.sample == row.sample);
    let held = rows.len() as f64 / fresh.len().max(1) as f64;
    if held < HELD {
        return of_samples(rows, stops_s, period_s);
    }
    of_samples(&fresh, stops_s, held * period_s)
}

/// Estimates as if each sample had noise of its own.
fn of_samples(rows: &[ImuRow], stops_s: Option<&[[f64; 2]]>, period_s: f64) -> Option<White> {
    let rests = rests(rows, stops_s, period_s);
    let longest = ((LONGEST_S / period_s) as usize).max(LEAST_SAMPLES);
    let stretches = stretches(&rests, longest);
    if stretches.iter().map(|stretch| stretch.len()).sum::<usize>() < LEAST_SAMPLES {
        return None;
    }
    let floor = |of: fn(&ImuRow) -> [f64; 3]| {
        let mut spectrum = Spectrum::new(period_s);
        for stretch in &stretches {
            for axis in 0..3 {
                let signal: Vec<f64> = stretch.iter().map(|row| of(row)[axis]).collect();
                spectrum.push(&signal);
            }
        }
        spectrum.floor()
    };
    let Floor { white, relative_sigma, angle } = floor(|row| row.sample.rates_rad_s)?;
    let force = floor(|row| row.sample.force_m_s2)?;
    Some(White {
        angle_random_walk: white.sqrt(),
        relative_sigma,
        angle: angle.sqrt(),
        // One side of the spectrum holds both.
        force: (2.0 * force.white).sqrt(),
    })
}

/// Parts of a rest that show the same rate where nothing moves.
const PARTS: usize = 4;

/// The length of the mean rate in each part of the longest rest, rad/s; zero of no rows.
pub(crate) fn rest_rates(
    rows: &[ImuRow],
    stops_s: Option<&[[f64; 2]]>,
    period_s: f64,
) -> [f64; PARTS] {
    let rests = rests(rows, stops_s, period_s);
    let longest = rests.into_iter().max_by_key(|rest| rest.len()).unwrap_or_default();
    let size = longest.len() / PARTS;
    std::array::from_fn(|part| rate(&longest[part * size..(part + 1) * size]))
}

/// The length of the mean rate of rows, rad/s.
fn rate(rows: &[ImuRow]) -> f64 {
    let count = rows.len().max(1) as f64;
    let sum = |axis: usize| rows.iter().map(|row| row.sample.rates_rad_s[axis]).sum::<f64>();
    (0..3).map(|axis| (sum(axis) / count).powi(2)).sum::<f64>().sqrt()
}

/// The rows where the vehicle stood, or was quietest if that is not known.
fn rests<'a>(rows: &'a [ImuRow], stops_s: Option<&[[f64; 2]]>, period_s: f64) -> Vec<&'a [ImuRow]> {
    match stops_s {
        Some(stops) => stops.iter().map(|stop| stood(rows, *stop)).collect(),
        None => quiet(rows, period_s),
    }
}

/// The rows of a stop, once the body no longer rocks, where that leaves the better part of it.
fn stood(rows: &[ImuRow], [from, to]: [f64; 2]) -> &[ImuRow] {
    let [first, last] = ROCKING_S;
    let whole = first + last < 0.5 * (to - from);
    let [from, to] = if whole { [from + first, to - last] } else { [from, to] };
    let begin = rows.partition_point(|row| row.time_s <= from);
    let end = rows.partition_point(|row| row.time_s <= to);
    &rows[begin..end.max(begin)]
}

/// The quietest stretches, neighbours together.
fn quiet(rows: &[ImuRow], period_s: f64) -> Vec<&[ImuRow]> {
    let size = ((QUIET_S / period_s) as usize).max(LEAST_SAMPLES);
    let powers: Vec<f64> = rows.chunks_exact(size).map(power).collect();
    let least = powers.iter().copied().fold(f64::INFINITY, f64::min);
    let is_quiet = |index: &usize| powers[*index] <= QUIET_POWER * least;
    let quiet: Vec<usize> = (0..powers.len()).filter(is_quiet).collect();
    if quiet.is_empty() {
        return vec![rows];
    }
    let runs = quiet.chunk_by(|a, b| a + 1 == *b);
    runs.map(|run| &rows[run[0] * size..(run[0] + run.len()) * size]).collect()
}

/// Power of the three rates about their mean.
fn power(rows: &[ImuRow]) -> f64 {
    let count = rows.len() as f64;
    let of = |axis: usize| {
        let rate = |row: &ImuRow| row.sample.rates_rad_s[axis];
        let mean = rows.iter().map(rate).sum::<f64>() / count;
        rows.iter().map(|row| (rate(row) - mean).powi(2)).sum::<f64>() / count
    };
    (0..3).map(of).sum()
}

/// Stretches of no more than so many rows, each half over the one before, and not too many of them.
fn stretches<'a>(rests: &[&'a [ImuRow]], longest: usize) -> Vec<&'a [ImuRow]> {
    let of = |rest: &&'a [ImuRow]| {
        let rest = *rest;
        let size = longest.min(rest.len());
        let starts = (0..=rest.len() - size).step_by((size / 2).max(1));
        starts.map(move |start| &rest[start..start + size]).collect::<Vec<_>>()
    };
    let all: Vec<_> = rests.iter().flat_map(of).filter(|rows| rows.len() > 8).collect();
    let every = all.len().div_ceil(MOST_STRETCHES).max(1);
    all.into_iter().step_by(every).collect()
}

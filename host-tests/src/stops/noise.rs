//! White noise of gyros and accelerometers as a recording shows it, where nobody stated it.
//!
//! Third differences leave white noise but take away what changes slowly: a drift, the Earth, the sway of
//! a body at a frequency far below that of the samples. They are taken where they are smallest.

use crate::recording::ImuRow;

/// White noise of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct White {
    /// Angle random walk N, the mean of the three gyros, rad/√s.
    pub angle_random_walk: f64,
    /// Noise density of the accelerometers, the mean of the three, one-sided, m/s²/√Hz.
    pub force: f64,
}

/// Rows for each fresh sample from which on a recorder is taken to hold them: noise repeats itself seldom.
const HELD: f64 = 1.2;
/// Samples of a stretch that is quiet or not.
const STRETCH: usize = 1000;
/// Stretches in the shortest recording.
const LEAST_STRETCHES: usize = 8;
/// One stretch in so many is quiet, at the least.
const QUIET: usize = 10;
/// Variance of a third difference of white noise of variance one: 1 + 9 + 9 + 1.
const THIRD: f64 = 20.0;

/// Estimates the noise where the vehicle stood, or of all of the recording where that is not known. Samples
/// that a recorder held count once.
#[must_use]
pub fn estimate(rows: &[ImuRow], stops_s: Option<&[[f64; 2]]>, period_s: f64) -> White {
    let mut fresh = rows.to_vec();
    fresh.dedup_by(|next, row| next.sample == row.sample);
    let held = rows.len() as f64 / fresh.len().max(1) as f64;
    if held < HELD {
        return of_samples(rows, stops_s, period_s);
    }
    of_samples(&fresh, stops_s, held * period_s)
}

/// Estimates as if each sample had noise of its own.
fn of_samples(rows: &[ImuRow], stops_s: Option<&[[f64; 2]]>, period_s: f64) -> White {
    let is_within = |row: &ImuRow| {
        stops_s
            .is_none_or(|stops| stops.iter().any(|[from, to]| (*from..=*to).contains(&row.time_s)))
    };
    let size = STRETCH.min(rows.len() / LEAST_STRETCHES).max(4);
    let stretches = rows.chunks(size).filter(|stretch| stretch.iter().all(is_within));
    let of_kind = |of: fn(&ImuRow) -> [f64; 3]| {
        let mut found: Vec<f64> =
            stretches.clone().filter_map(|stretch| variance(stretch, of)).collect();
        found.sort_by(f64::total_cmp);
        let quiet = found.len().div_ceil(QUIET);
        found.iter().take(quiet).sum::<f64>() / quiet.max(1) as f64
    };
    let rate = of_kind(|row| row.sample.rates_rad_s);
    let force = of_kind(|row| row.sample.force_m_s2);
    White {
        angle_random_walk: (rate * period_s).sqrt(),
        // Half of the sample rate is the band.
        force: (2.0 * force * period_s).sqrt(),
    }
}

/// Variance of one sample's noise, the mean of three axes, from the third differences of a stretch.
fn variance(rows: &[ImuRow], of: fn(&ImuRow) -> [f64; 3]) -> Option<f64> {
    let squares = rows.windows(4).map(|four| {
        let [a, b, c, d] = [of(&four[0]), of(&four[1]), of(&four[2]), of(&four[3])];
        let third = |axis: usize| d[axis] - 3.0 * (c[axis] - b[axis]) - a[axis];
        (0..3).map(|axis| third(axis) * third(axis)).sum::<f64>()
    });
    let count = squares.len();
    (count > 0).then(|| squares.sum::<f64>() / (3.0 * THIRD * count as f64))
}

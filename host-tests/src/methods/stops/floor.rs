//! The floor of a spectrum: white noise, and noise of the integral beneath whatever stands out of them.
//!
//! The frequencies are put into groups, whose medians lines and blows hardly move. The floor is the sum of a
//! constant and of what white noise of the integral makes, 4 A² sin²(π f T)/T, that most groups lie on and
//! none far below; those above it hold sway, drift or an engine and do not count.

use std::f64::consts::{LN_2, PI, TAU};

use crate::spectrum::transformed;

/// Nuttall's window of four terms with a continuous first derivative: side lobes of −93 dB, which fall by 18 dB
/// an octave (A. H. Nuttall 1981), so that a sway of degrees does not hide arcseconds.
const WINDOW: [f64; 4] = [0.355_768, -0.487_396, 0.144_232, -0.012_604];
/// Lines of a spectrum that the window widens its mean into.
const FIRST: usize = 4;
/// Lines of one spectrum that the window makes depend on each other: its noise bandwidth.
const BANDWIDTH: f64 = 2.0;
/// Frequencies of neighbouring groups over each other.
const GROUP: f64 = 1.35;
/// Fewest values of a group.
const LEAST_VALUES: usize = 24;
/// Deviation of a group from the floor beyond which it stands out, in its 1σ.
const OUTSTANDING: f64 = 3.0;
/// Repetitions of the fit once it is known which groups lie on the floor.
const REPETITIONS: usize = 20;

/// The floor of a spectrum, two-sided.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Floor {
    /// White part of the spectrum, unit²·s: of a rate, N².
    pub white: f64,
    /// 1σ of the root of [`Self::white`], relative.
    pub relative_sigma: f64,
    /// Variance of the white noise of the integral, unit²·s².
    pub angle: f64,
}

/// Values of the spectrum over frequency.
#[derive(Clone, Debug)]
pub struct Spectrum {
    period_s: f64,
    values: Vec<(f64, f64)>,
}

/// Values of neighbouring frequencies.
#[derive(Clone, Copy, Debug)]
struct Group {
    /// What white noise of the integral of variance one makes at the middle of the frequencies, s⁻¹.
    rise: f64,
    /// Level of the values: that of the exponential distribution which has their median.
    level: f64,
    /// 1σ of the level, relative.
    sigma: f64,
}

impl Spectrum {
    /// A filter without samples yet, which come with this period, s.
    #[must_use]
    pub const fn new(period_s: f64) -> Self {
        Self { period_s, values: Vec::new() }
    }

    /// Adds the spectrum of a stretch of samples.
    pub fn push(&mut self, signal: &[f64]) {
        let count = signal.len();
        let weights: Vec<f64> = (0..count).map(|index| weight(index, count)).collect();
        let power: f64 = weights.iter().map(|weight| weight * weight).sum();
        let buffer = transformed(signal, &weights);
        let line = |index: usize| {
            let frequency = index as f64 / (count as f64 * self.period_s);
            (frequency, buffer[index].norm_sqr() * self.period_s / power)
        };
        self.values.extend((FIRST..count.div_ceil(2)).map(line));
    }

    /// The floor; none where there are too few values.
    #[must_use]
    pub fn floor(mut self) -> Option<Floor> {
        self.values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let groups = self.groups();
        let first = groups.first()?;
        let candidates = |of: fn(&Group) -> f64| groups.iter().map(of).collect::<Vec<f64>>();
        let whites = candidates(|group| group.level);
        let mut angles = candidates(|group| group.level / group.rise);
        angles.push(0.0);
        let pairs =
            whites.iter().flat_map(|white| angles.iter().map(move |angle| [*white, *angle]));
        let costs = pairs.map(|pair| (cost(&groups, pair), pair));
        let best =
            costs.min_by(|a, b| a.0.total_cmp(&b.0)).map_or([first.level, 0.0], |best| best.1);
        Some(refined(&groups, best))
    }

    /// Groups of neighbouring frequencies.
    fn groups(&self) -> Vec<Group> {
        let mut groups = Vec::new();
        let mut rest = &self.values[..];
        while let Some((lowest, _)) = rest.first() {
            let wide = rest.partition_point(|(frequency, _)| *frequency < GROUP * lowest);
            let count = wide.max(LEAST_VALUES);
            if rest.len() < count {
                break;
            }
            let (group, left) = rest.split_at(count);
            groups.push(self.group(group));
            rest = left;
        }
        groups
    }

    fn group(&self, values: &[(f64, f64)]) -> Group {
        let count = values.len() as f64;
        let rise = |frequency: f64| 4.0 * (PI * frequency * self.period_s).sin().powi(2);
        let mean = values.iter().map(|(frequency, _)| rise(*frequency)).sum::<f64>() / count;
        let median = crate::median::median(values.iter().map(|(_, value)| *value));
        // The median of an exponential distribution is ln 2 of its mean, known to 1/(ln 2 √n) of it.
        let sigma = (BANDWIDTH / count).sqrt() / LN_2;
        Group { rise: mean / self.period_s, level: median / LN_2, sigma }
    }
}

/// The window's weight of a sample.
fn weight(index: usize, count: usize) -> f64 {
    let angle = TAU * (index as f64 + 0.5) / count as f64;
    (0..4).map(|k| WINDOW[k] * (k as f64 * angle).cos()).sum()
}

/// The floor at a group.
fn at(group: &Group, [white, angle]: [f64; 2]) -> f64 {
    white + angle * group.rise
}

/// How far a group lies from a floor, in its 1σ.
fn off(group: &Group, floor: [f64; 2]) -> f64 {
    (group.level / at(group, floor).max(f64::MIN_POSITIVE)).max(1e-9).ln() / group.sigma
}

/// How badly groups lie on a floor: what is below counts in full, what stands out of it only so much.
fn cost(groups: &[Group], floor: [f64; 2]) -> f64 {
    let of = |group: &Group| {
        let off = off(group, floor);
        if off > 0.0 { off.min(OUTSTANDING).powi(2) } else { off * off }
    };
    groups.iter().map(of).sum()
}

/// The floor by least squares of the groups that lie on it.
fn refined(groups: &[Group], mut floor: [f64; 2]) -> Floor {
    let mut relative_sigma = 1.0;
    for _ in 0..REPETITIONS {
        let (mut normal, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
        for group in groups.iter().filter(|group| off(group, floor) < OUTSTANDING) {
            let weight = (group.sigma * at(group, floor)).powi(-2);
            let row = [1.0, group.rise];
            for i in 0..2 {
                right[i] += weight * row[i] * group.level;
                (0..2).for_each(|j| normal[i][j] += weight * row[i] * row[j]);
            }
        }
        if normal[0][0].is_finite() && normal[0][0] > 0.0 {
            let (next, sigma) = solved(normal, right);
            floor = next;
            relative_sigma = if next[0] > 0.0 { 0.5 * sigma / next[0] } else { 1.0 };
        }
    }
    let [white, angle] = floor;
    Floor { white, relative_sigma, angle }
}

/// Both parts, neither below zero, and the 1σ of the white one; of that one never less than its 1σ.
fn solved(normal: [[f64; 2]; 2], right: [f64; 2]) -> ([f64; 2], f64) {
    let [[a, b], [_, d]] = normal;
    let determinant = a * d - b * b;
    let (alone, alone_sigma) = (right[0] / a, a.sqrt().recip());
    if determinant <= 1e-12 * a * d {
        return ([alone, 0.0], alone_sigma);
    }
    let white = (d * right[0] - b * right[1]) / determinant;
    let angle = (a * right[1] - b * right[0]) / determinant;
    let sigma = (d / determinant).sqrt();
    if angle <= 0.0 { ([alone, 0.0], alone_sigma) } else { ([white.max(sigma), angle], sigma) }
}

//! An oracle for the etalon search: brute force over all 129 600 azimuths in exact integers.
//!
//! It shares nothing with the search but the table's entries: it unfolds the quarter itself, rounds
//! the rates itself and evaluates every index of every objective.

use std::sync::LazyLock;

use hal_mock::noise::Generator;
use orientation::alignment::stepwise::etalon;
use orientation::alignment::stepwise::etalon::{Accepted, Criterion, Limit, Series};
use orientation::math::reference_table::{QUARTER_COSINE, Table};

/// Grid steps in a turn.
pub const TURN: i32 = 129_600;

/// The criteria in the order of [`compare`]'s outcomes.
pub const CRITERIA: [&str; 5] =
    ["maximum likelihood", "least squares", "least absolute", "within squares", "within absolute"];

/// One turn of the cosine.
static CIRCLE: LazyLock<Vec<i64>> = LazyLock::new(|| (0..TURN).map(unfolded).collect());

/// The cosine at grid index `k`, 0 to 129 599, from the quarter table.
#[must_use]
pub fn unfolded(k: i32) -> i64 {
    let entry = |k: i32| QUARTER_COSINE.entry(k as usize).map_or(0, i64::from);
    if k <= 32_400 {
        entry(k)
    } else if k <= 64_800 {
        -entry(64_800 - k)
    } else if k <= 97_200 {
        -entry(k - 64_800)
    } else {
        entry(129_600 - k)
    }
}

/// Uniform integer in `from` to `to`, both included.
fn integer(random: &mut Generator, from: i32, to: i32) -> i32 {
    from + (random.uniform() * f64::from(to - from + 1)) as i32
}

/// One measured series.
#[derive(Clone, Debug)]
pub struct Case {
    /// Dwell rates over the horizontal Earth rate.
    pub ratios: Vec<f64>,
    /// Grid steps between positions.
    pub step: i32,
}

impl Case {
    /// The noise-free series at `azimuth` (rad) of `count` positions.
    #[must_use]
    pub fn clean(azimuth: f64, count: i32, step: i32) -> Self {
        let angle =
            |i: i32| azimuth + f64::from(i * step) * (std::f64::consts::TAU / f64::from(TURN));
        Self { ratios: (0..count).map(|i| angle(i).cos()).collect(), step }
    }

    /// Adds normal noise of standard deviation `sigma` and a constant `drift`.
    #[must_use]
    pub fn disturbed(mut self, random: &mut Generator, sigma: f64, drift: f64) -> Self {
        for ratio in &mut self.ratios {
            *ratio += drift + sigma * random.gaussian();
        }
        self
    }

    /// The values in table units, rounded and clamped as `Series` documents.
    fn values(&self) -> Vec<i64> {
        let limit = 1_i64 << 40;
        let units = |ratio: &f64| (ratio * 2_147_483_648.0).round() as i64;
        self.ratios.iter().map(|ratio| units(ratio).clamp(-limit, limit)).collect()
    }
}

/// The change of the mean-removed series per radian of azimuth, as a norm.
fn sensitivity(azimuth: f64, count: i32, step: i32) -> f64 {
    let slopes = Case::clean(azimuth + std::f64::consts::FRAC_PI_2, count, step).ratios;
    let mean = slopes.iter().sum::<f64>() / f64::from(count);
    slopes.iter().map(|slope| (slope - mean).powi(2)).sum::<f64>().sqrt()
}

/// A case as users meet them: any azimuth, 3 to 64 positions, any step either way, a drift, and
/// noise worth up to 1° (1σ) of azimuth.
pub fn ordinary(random: &mut Generator) -> Case {
    let (azimuth, count) = (std::f64::consts::TAU * random.uniform(), integer(random, 3, 64));
    let step = integer(random, 1, 64_799) * (2 * integer(random, 0, 1) - 1);
    let sigma = random.uniform().to_radians() * sensitivity(azimuth, count, step);
    let drift = random.gaussian();
    Case::clean(azimuth, count, step).disturbed(random, sigma, drift)
}

/// The paper's settings: 60 dwells on a 28° arc, or round the circle.
pub fn paper(random: &mut Generator) -> Case {
    let step = [168, -168, 2160][integer(random, 0, 2) as usize];
    let azimuth = std::f64::consts::TAU * random.uniform();
    Case::clean(azimuth, 60, step).disturbed(random, 1.48e-3, 0.001)
}

/// A case of 127 to 1 024 positions, with noise from hardly any to what hides the signal.
pub fn long(random: &mut Generator) -> Case {
    let (azimuth, count) = (std::f64::consts::TAU * random.uniform(), integer(random, 127, 1024));
    let step = integer(random, 1, 64_799) * (2 * integer(random, 0, 1) - 1);
    let (sigma, drift) = (10_f64.powf(8.0 * random.uniform() - 6.0), random.gaussian());
    Case::clean(azimuth, count, step).disturbed(random, sigma, drift)
}

/// A case made to break a search; `kind` is taken modulo 10.
pub fn adversarial(random: &mut Generator, kind: usize) -> Case {
    let grid = std::f64::consts::TAU / f64::from(TURN);
    let azimuth = std::f64::consts::TAU * random.uniform();
    let direction = 2 * integer(random, 0, 1) - 1;
    let step = direction * integer(random, 1, 64_799);
    let count = integer(random, 3, 64);
    let small = direction * integer(random, 1, 30);
    let closed = [(3, 43_200), (4, 32_400), (5, 25_920), (12, 10_800), (60, 2160), (64, 2025)];
    let (whole, turn) = closed[integer(random, 0, 5) as usize];
    match kind % 10 {
        // Truth on the grid, no noise.
        0 => Case::clean((azimuth / grid).round() * grid, count, step),
        // The shortest arcs.
        1 => {
            let (count, sigma) = (integer(random, 3, 8), 1e-6 * random.uniform());
            Case::clean(azimuth, count, direction).disturbed(random, sigma, 0.1)
        }
        2 => {
            let sigma = 10_f64.powf(-6.0 * random.uniform());
            Case::clean(azimuth, 3, step).disturbed(random, sigma, 0.0)
        }
        // Noise that hides the signal.
        3 => {
            let sigma = 100.0 * random.uniform();
            Case::clean(azimuth, count, step).disturbed(random, sigma, 0.0)
        }
        // No signal at all: every index nearly ties.
        4 => Case { ratios: vec![integer(random, -2, 2).into(); whole as usize], step: turn },
        // Truth half-way between two indices, mirrored about north or east.
        5 => {
            let half = (f64::from(integer(random, 0, 4) * 32_400) + 0.5) * grid;
            Case::clean(half - f64::from(step * (count - 1)) * grid / 2.0, count, step)
        }
        // Almost mirror-tied.
        6 => {
            let sigma = 1e-5 * random.uniform();
            let step = direction * (64_800 - integer(random, 1, 3));
            Case::clean(azimuth, count, step).disturbed(random, sigma, 0.0)
        }
        // On and near an axis of the ellipse: two equal minima.
        7 => {
            let shift = azimuth - f64::from(small * (count - 1)) * grid / 2.0;
            let mirror = -azimuth - f64::from(small * (count - 1)) * grid / 2.0;
            let (one, other) =
                (Case::clean(shift, count, small), Case::clean(mirror, count, small));
            let pairs = one.ratios.iter().zip(&other.ratios);
            Case { ratios: pairs.map(|(a, b)| f64::midpoint(*a, *b)).collect(), step: small }
        }
        // Values at and beyond the clamp.
        8 => Case::clean(azimuth, count, step).disturbed(random, 400.0, 0.0),
        // Short noisy arcs, where many indices compete.
        _ => {
            let sigma = random.uniform().to_radians() * sensitivity(azimuth, count, small);
            Case::clean(azimuth, count, small).disturbed(random, sigma, 0.0)
        }
    }
}

/// All objectives at all indices.
struct Objectives {
    centred: Vec<u128>,
    squares: Vec<u128>,
    absolute: Vec<u128>,
}

impl Objectives {
    fn new(values: &[i64], step: i32) -> Self {
        let mut all = Self { centred: Vec::new(), squares: Vec::new(), absolute: Vec::new() };
        let stride = step.rem_euclid(TURN);
        let mut residuals = vec![0_i64; values.len()];
        for k in 0..TURN {
            let mut position = k;
            for (residual, value) in residuals.iter_mut().zip(values) {
                *residual = CIRCLE[position as usize] - value;
                position += stride;
                position -= if position >= TURN { TURN } else { 0 };
            }
            all.push(&residuals);
        }
        all
    }

    fn push(&mut self, residuals: &[i64]) {
        let sum: i128 = residuals.iter().map(|&d| i128::from(d)).sum();
        let squares: i128 = residuals.iter().map(|&d| i128::from(d) * i128::from(d)).sum();
        self.centred.push((residuals.len() as i128 * squares - sum * sum) as u128);
        let steps = || residuals.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
        self.squares.push(steps().map(|step| u128::from(step) * u128::from(step)).sum());
        self.absolute.push(u128::from(steps().sum::<u64>()));
    }
}

/// The lowest index of the least objective.
fn least(objective: &[u128]) -> (i32, u128) {
    let mut best = (0, objective[0]);
    for (k, &value) in (0..).zip(objective) {
        if value < best.1 {
            best = (k, value);
        }
    }
    best
}

/// The smallest arc that covers every index with an objective of at most `limit`.
fn covering(objective: &[u128], limit: u128) -> Accepted {
    let set: Vec<i32> = (0..TURN).filter(|&k| objective[k as usize] <= limit).collect();
    let Some((&first, &last)) = set.first().zip(set.last()) else { return Accepted::Nothing };
    // Candidate arcs begin at each accepted index and end at the one before it, cyclically.
    let mut arcs = vec![(last - first, first)];
    arcs.extend(set.windows(2).map(|pair| (pair[0] + TURN - pair[1], pair[1])));
    let (width, first) = arcs.into_iter().min().unwrap_or((0, 0));
    if set.len() == objective.len() {
        return Accepted::Everything;
    }
    Accepted::Arc { first, middle: (first + width / 2) % TURN, width }
}

/// A limit that tries the edges of the accepted set: below, at and just above the minimum, at the
/// objective of some index, at and just below the maximum.
fn limit(random: &mut Generator, objective: &[u128]) -> u128 {
    let minimum = least(objective).1;
    let maximum = objective.iter().copied().max().unwrap_or(0);
    let any = objective[integer(random, 0, TURN - 1) as usize];
    match integer(random, 0, 9) {
        0 => minimum.saturating_sub(1),
        1 => minimum,
        2 => minimum + minimum / 100_000,
        3 => minimum + minimum / 50 + 1,
        4 => maximum,
        5 => maximum - u128::from(maximum > 0),
        6 => maximum - maximum / 1_000_000,
        _ => any,
    }
}

/// What one criterion made of one case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Whether search and oracle agree in every field.
    pub agrees: bool,
    /// The exact evaluations of the search.
    pub evaluations: u32,
    /// Both answers, to print on a mismatch.
    pub answers: String,
}

impl Outcome {
    fn new<T: PartialEq + std::fmt::Debug>(found: &T, expected: &T, evaluations: u32) -> Self {
        let answers = format!("found {found:?}, expected {expected:?}");
        Self { agrees: found == expected, evaluations, answers }
    }
}

/// Holds every criterion to the brute force on one case.
///
/// # Panics
/// Where the case is no series that can be matched; the families make none such.
#[expect(clippy::unwrap_used, reason = "the families make only series that can be matched")]
pub fn compare(case: &Case, random: &mut Generator) -> [Outcome; 5] {
    let table = Table::built_in();
    let series = Series::new(case.ratios.iter().copied(), case.step).unwrap();
    let all = Objectives::new(&case.values(), case.step);
    let search = |criterion, objective: &[u128]| {
        let found = etalon::search(table, &series, criterion);
        Outcome::new(&(found.index, found.objective), &least(objective), found.evaluations)
    };
    let accept = |limit, bound, objective: &[u128]| {
        let found = etalon::accepted(table, &series, limit);
        Outcome::new(&found.accepted, &covering(objective, bound), found.evaluations)
    };
    let squares = limit(random, &all.squares);
    let absolute = limit(random, &all.absolute);
    [
        search(Criterion::MaximumLikelihood, &all.centred),
        search(Criterion::LeastSquares, &all.squares),
        search(Criterion::LeastAbsolute, &all.absolute),
        accept(Limit::WithinSquares(squares), squares, &all.squares),
        accept(Limit::WithinAbsolute(absolute as u64), absolute, &all.absolute),
    ]
}

//! Mean of a stretch: the phasors of its turns are freed of drift and axis misalignment, and
//! disturbed turns are excluded.

use heapless::Vec;

use super::change::MEDIAN_OF_NEIGHBOURS;
use super::misalignment::{self, AxisMisalignment};
use super::tilting::Tilting;
use super::turn::{Sense, Stretch, TURNS, Turn};
use crate::math::{Column, Complex, Regression, chi_square_tail, median};

/// Squared distance of a turn from the mean of the others, in variances of either part, beyond
/// which it is excluded (exp(−x/2): one sound turn in 40 000).
const OUTLIER: f64 = 21.0;

/// Probability of the scatter of the turns' mean rates about a line, below which the drift counts
/// as curved.
const BENT: f64 = 1e-3;

/// Number of neighbour differences at which the correction of a median for small samples doubles
/// the variance.
const FEW_NEIGHBOURS: f64 = 2.0;

/// Mean phasors of a stretch. A phasor a stands for the signal Re{a e^{jθ}}.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Average {
    /// Sense of rotation.
    pub sense: Sense,
    /// Mean speed, rad/s, > 0.
    pub speed: f64,
    /// Number of turns of the platform that are used.
    pub turns: u32,
    /// Number of turns of the platform that are excluded.
    pub left_out: u32,
    /// Number of excluded entries before the first one used, and after the last one used.
    pub ends: [u16; 2],
    /// Total time in the turns used, s.
    pub seconds: f64,
    /// Middle of the turns used, s.
    pub middle: f64,
    /// Phasor of the gyro's rate as measured, rad/s.
    pub raw: Complex,
    /// Phasor of the gyro's rate without drift and axis misalignment, rad/s: Q₊ or Q₋ (MET 2018).
    pub phasor: Complex,
    /// Phasor of the platform's rate, rad/s: its unevenness once per turn.
    pub turning: Complex,
    /// Phasor of the force along the sensitive axis, m/s².
    pub force: Complex,
    /// Phasor of the force 90° clockwise of the sensitive axis, m/s²; zero where that axis is not
    /// measured.
    pub across: Complex,
    /// Sum of the squared distances of the turns' forces from their mean, (m/s²)².
    pub force_scatter: f64,
    /// Mean force along the sensitive axis, m/s².
    pub mean_force: f64,
    /// Variance of either part of `phasor` in units of that of one turn of the platform.
    pub share: f64,
    /// Sum of the squared distances of the turns' phasors from their mean, (rad/s)².
    pub scatter: f64,
    /// Sum of the squared distances including the excluded turns, about the mean of all, (rad/s)².
    pub scatter_of_all: f64,
    /// Squared linear drift of the phasor from turn to turn, over its variance in units of that of
    /// a turn, (rad/s)².
    pub trend: f64,
    /// Degrees of freedom of `scatter` and `force_scatter`.
    pub degrees: u32,
}

/// Turns of a stretch as compensated phasors.
struct Turns<'a> {
    /// Turns as they were recorded.
    all: &'a [Turn],
    /// Part of the platform's steady rate that the gyro shows.
    steady: f64,
    /// Compensated phasors, rad/s.
    phasors: Vec<Complex, TURNS>,
    /// Drift that was removed from each phasor, rad/s².
    slopes: [f32; TURNS],
    /// Whether each turn is used.
    is_kept: [bool; TURNS],
}

/// Phasors of the turns without the response to the platform's unevenness.
impl<'a> Turns<'a> {
    fn of(stretch: &'a Stretch, misalignments: &[AxisMisalignment], steady: f64) -> Self {
        let frequency = stretch.sense.signed(stretch.speed());
        let misalignment = misalignment::nearest(misalignments, frequency);
        let response = misalignment
            .map_or(Complex::default(), |misalignment| misalignment.response(frequency));
        let all = &stretch.turns;
        let phasor = |turn: &Turn| {
            Complex::of_signal(turn.rate) - response * Complex::of_signal(turn.turning)
        };
        let (phasors, slopes) = (all.iter().map(phasor).collect(), [0.0; TURNS]);
        Self { all, steady, phasors, slopes, is_kept: [true; TURNS] }
    }

    /// Removes the gyro's drift from the phasors, as the turns used show it: a line, or where their
    /// mean rates curve by more than noise (of which a turn's has half the variance of a phasor)
    /// the local slope between neighbours.
    fn free(&mut self, variance: f64) {
        let slope = self.slope();
        let degrees = self.count() as f64 - 2.0;
        let chi_square = self.bend() * degrees / (0.5 * variance).max(f64::MIN_POSITIVE);
        let is_bent = degrees > 1.0 && chi_square_tail(chi_square, degrees) < BENT;
        for index in 0..self.all.len() {
            let beyond = if is_bent { self.beyond(index, slope) } else { 0.0 };
            let leak = Complex::of_signal(self.all[index].leak);
            let more = slope + beyond - f64::from(self.slopes[index]);
            self.phasors[index] = self.phasors[index] - leak.scaled(more);
            self.slopes[index] = (slope + beyond) as f32;
        }
    }

    /// Slope of the gyro's rate in a turn beyond the common one, rad/s²: the smaller of those from
    /// and to its neighbours, zero where they differ in sign. A step of the rate makes no slope in
    /// the turns beside it.
    fn beyond(&self, index: usize, slope: f64) -> f64 {
        let between = |one: usize, other: usize| {
            let seconds = f64::from(self.all[other].middle - self.all[one].middle);
            (self.own_rate(other) - self.own_rate(one)) / seconds - slope
        };
        let last = self.all.len() - 1;
        let before = between(index.max(1) - 1, index.max(1));
        let after = between(index.min(last - 1), index.min(last - 1) + 1);
        if before * after <= 0.0 {
            0.0
        } else if before.abs() < after.abs() {
            before
        } else {
            after
        }
    }

    /// Indices of the turns used.
    fn kept(&self) -> impl Iterator<Item = usize> {
        (0..self.all.len()).filter(|&index| self.is_kept[index])
    }

    /// Number of turns used.
    fn count(&self) -> usize {
        self.kept().count()
    }

    /// Mean of a real quantity over the turns used.
    fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        self.kept().map(of).sum::<f64>() / self.count().max(1) as f64
    }

    /// Mean of a complex quantity over the turns used.
    fn mean_complex(&self, of: impl Fn(usize) -> Complex) -> Complex {
        self.kept().map(of).sum::<Complex>().scaled(1.0 / self.count().max(1) as f64)
    }

    /// Least-squares slope of a quantity over the times of the turns, and the sum of squares of the
    /// times about their mean.
    fn slope_of(&self, of: impl Fn(usize) -> f64) -> (f64, f64) {
        let time = |index: usize| f64::from(self.all[index].middle);
        let middle = self.mean(time);
        let (mut product, mut square) = (0.0, 0.0);
        for index in self.kept() {
            let away = time(index) - middle;
            product += away * of(index);
            square += away * away;
        }
        (if square > 0.0 { product / square } else { 0.0 }, square)
    }

    /// Drift of the gyro's rate, rad/s²; zero with a single turn. A change of the platform's speed,
    /// as at its start, does not count as drift.
    fn slope(&self) -> f64 {
        if self.count() < 2 {
            return 0.0;
        }
        self.slope_of(|index| self.own_rate(index)).0
    }

    /// Mean of the gyro's rate over a turn without the platform's part, rad/s.
    fn own_rate(&self, index: usize) -> f64 {
        let turn = &self.all[index];
        f64::from(turn.offset) - self.steady * f64::from(turn.speed)
    }

    /// Squared distance of a turn's phasor from another, (rad/s)².
    fn distance(&self, index: usize, from: Complex) -> f64 {
        (self.phasors[index] - from).power()
    }

    /// Number of entries excluded before the first one used, and after the last one used.
    fn ends(&self) -> [u16; 2] {
        let first = self.kept().next().unwrap_or(0);
        let last = self.kept().last().unwrap_or(0);
        [first, self.all.len() - 1 - last].map(|count| count as u16)
    }

    /// Excludes the turn that is furthest from the mean while one is beyond the limit; at most a
    /// third.
    fn leave_out(&mut self, variance: f64) {
        for _ in 0..self.all.len() / 3 {
            let mean = self.mean_complex(|index| self.phasors[index]);
            let count = self.count() as f64;
            let far = |index: usize| (index, self.distance(index, mean));
            let furthest = self
                .kept()
                .map(far)
                .fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
            // The mean includes the turn itself, which shortens its distance by (n − 1)/n in power.
            if furthest.1 * count / (count - 1.0) <= OUTLIER * variance {
                return;
            }
            self.is_kept[furthest.0] = false;
        }
    }

    /// Variance of either part of the mean in units of a turn's, including the contribution of the
    /// drift's slope. The variance of the turns' mean rates is half that of a phasor, or what they
    /// show where they do not lie on a line, as after a disturbance of some turns.
    fn share(&self, square: f64, variance: f64) -> f64 {
        let own = 1.0 / self.count() as f64;
        if self.count() < 2 || square <= 0.0 {
            return own;
        }
        let leak = self.mean_complex(|index| Complex::of_signal(self.all[index].leak)).size();
        let is_bent = self.slopes.iter().take(self.all.len()).any(|slope| *slope != self.slopes[0]);
        // The local slopes have already followed the curvature.
        let bend = if is_bent { 0.0 } else { self.bend() };
        let offset = (bend / variance.max(f64::MIN_POSITIVE)).max(0.5);
        own + 0.5 * leak * leak * offset / square
    }

    /// Variance of the turns' mean rates about a line, (rad/s)².
    fn bend(&self) -> f64 {
        let (slope, square) = self.slope_of(|index| self.own_rate(index));
        let mean = self.mean(|index| self.own_rate(index));
        let scatter = self.mean(|index| {
            let away = self.own_rate(index) - mean;
            away * away
        });
        let count = self.count() as f64;
        (count * scatter - slope * slope * square).max(0.0) / (count - 2.0).max(1.0)
    }
}

impl Average {
    /// Mean of a stretch whose turns have phasors of this variance in either part, (rad/s)²; `None`
    /// with fewer than two turns. The gyro shows the part `steady` of the platform's steady rate
    /// ([`steady_part`]). Each turn that is used is passed to `each` with its phasor.
    pub(crate) fn of(
        stretch: &Stretch,
        misalignments: &[AxisMisalignment],
        steady: f64,
        variance: f64,
        tilting: &Tilting,
        mut each: impl FnMut(&Turn, Complex),
    ) -> Option<Self> {
        let mut turns = Turns::of(stretch, misalignments, steady);
        let since = stretch.since as f64 * 1e-6;
        for (phasor, turn) in turns.phasors.iter_mut().zip(turns.all) {
            *phasor = *phasor - tilting.vertical_part(since + f64::from(turn.middle));
        }
        if turns.count() < 2 {
            return None;
        }
        turns.free(variance);
        let mean = turns.mean_complex(|index| turns.phasors[index]);
        let scatter_of_all = turns.kept().map(|index| turns.distance(index, mean)).sum();
        turns.leave_out(variance);
        let count = turns.count();
        if count < 2 {
            return None;
        }
        turns.free(variance);
        turns.kept().for_each(|index| each(&turns.all[index], turns.phasors[index]));
        let joined = stretch.joined;
        let turn = |index: usize| &turns.all[index];
        let phasor = turns.mean_complex(|index| turns.phasors[index]);
        let force = turns.mean_complex(|index| Complex::of_signal(turn(index).force));
        let apart = |index: usize| (Complex::of_signal(turn(index).force) - force).power();
        let (cosine, square) = turns.slope_of(|index| turns.phasors[index].re);
        let (sine, _) = turns.slope_of(|index| turns.phasors[index].im);
        Some(Self {
            sense: stretch.sense,
            speed: stretch.speed(),
            turns: count as u32 * joined,
            left_out: (turns.all.len() - count) as u32 * joined,
            ends: turns.ends(),
            seconds: turns.kept().map(|index| f64::from(turn(index).seconds)).sum(),
            middle: since + turns.mean(|index| f64::from(turn(index).middle)),
            raw: turns.mean_complex(|index| Complex::of_signal(turn(index).rate)),
            phasor,
            turning: turns.mean_complex(|index| Complex::of_signal(turn(index).turning)),
            force,
            across: turns.mean_complex(|index| Complex::of_signal(turn(index).across)),
            force_scatter: turns.kept().map(apart).sum(),
            mean_force: turns.mean(|index| f64::from(turn(index).mean_force)),
            share: turns.share(square, variance) / f64::from(joined),
            scatter: turns.kept().map(|index| turns.distance(index, phasor)).sum(),
            scatter_of_all,
            trend: (cosine * cosine + sine * sine) * square,
            degrees: 2 * (count as u32 - 1),
        })
    }

    /// Number of turns of the platform that were joined to one entry.
    pub(super) fn joined(&self) -> f64 {
        f64::from(self.turns) / (0.5 * f64::from(self.degrees) + 1.0)
    }
}

/// Part of the platform's steady rate that the gyro shows: the slope of its mean rates over the
/// speeds of the stretches. It is zero for a sensor without response at zero frequency, and
/// undetermined (zero) with one sense alone.
pub(super) fn steady_part(stretches: &[Stretch]) -> f64 {
    let mut regression = Regression::<2>::default();
    for stretch in stretches {
        let mut rates: Vec<f64, TURNS> =
            stretch.turns.iter().map(|turn| f64::from(turn.offset)).collect();
        let speed = stretch.sense.signed(stretch.speed());
        regression.push(&[1.0, speed], median(&mut rates));
    }
    let found = regression.solve(&[Column::Free; 2]);
    found.map_or(0.0, |found| found.coefficients[1])
}

/// Median magnitude of a turn's phasor, rad/s, which disturbed turns hardly affect.
pub(super) fn typical_size(stretch: &Stretch, misalignments: &[AxisMisalignment]) -> f64 {
    let turns = Turns::of(stretch, misalignments, 0.0);
    let mut sizes: Vec<f64, TURNS> = turns.phasors.iter().map(|phasor| phasor.size()).collect();
    median(&mut sizes)
}

/// Variance of either part of a turn's phasor from the differences of neighbours, (rad/s)², by a
/// median, which disturbed turns hardly affect, raised for a small sample; zero without neighbours.
pub(super) fn variance_of_neighbours(
    stretches: &[Stretch],
    misalignments: &[AxisMisalignment],
) -> f64 {
    let mut squares: Vec<f64, { 4 * TURNS }> = Vec::new();
    for stretch in stretches {
        let turns = Turns::of(stretch, misalignments, 0.0);
        for index in 1..turns.all.len() {
            // Four stretches hold no more differences than the vector's capacity.
            let _ = squares.push(turns.distance(index, turns.phasors[index - 1]));
        }
    }
    let few = 1.0 + FEW_NEIGHBOURS / squares.len().max(1) as f64;
    few * median(&mut squares) / MEDIAN_OF_NEIGHBOURS
}

//! Detection of changes from turn to turn in quantities that should stay constant: the direction of
//! the Earth rate, and the tilt.
//!
//! A base that turns about the vertical, or an encoder that creeps, makes the direction of the
//! Earth rate drift from turn to turn; a base that was turned, or an encoder that slipped, makes it
//! step. A base that tilts makes the force's phasor drift. Each is fitted over the turns of both
//! senses together, beside the part that changes with the sense alone, such as a lag. The prior
//! knowledge of the lag is used, because the change between the senses determines a lag twice as
//! well as the turns within them.

use heapless::Vec;

use super::turn::{STRETCHES, Stretch, TURNS, Turn};
use crate::math::{COLUMNS, Column, Complex, Regression, Solution, median, sort};

/// Greatest number of turns of all stretches.
const MARKS: usize = STRETCHES * TURNS;

/// Marks of all turns.
pub(crate) type Marks = Vec<Mark, MARKS>;

/// Value of a quantity in one turn that should stay constant.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mark {
    /// Middle of the turn, s.
    pub time: f32,
    /// Factor of the part that changes with the sense: its sign, or the signed speed.
    pub odd: f32,
    /// Whether the turn belongs to the second speed.
    pub is_second: bool,
    /// Number of turns of the platform that the mark stands for.
    pub turns: f32,
    /// The value; the second part is zero for a quantity with one part.
    pub value: [f32; 2],
}

impl Mark {
    /// Mark of a turn, or of joined ones, of the first speed of a stretch, with this value.
    pub(crate) fn of(stretch: &Stretch, turn: &Turn, value: Complex) -> Self {
        Self {
            time: (stretch.since as f64 * 1e-6 + f64::from(turn.middle)) as f32,
            odd: stretch.sense.signed(1.0) as f32,
            is_second: false,
            turns: stretch.joined as f32,
            value: [value.re as f32, value.im as f32],
        }
    }
}

/// Hypothesis on the change of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// The quantity is constant.
    Steady,
    /// The quantity changes linearly with time.
    Rate,
    /// The quantity steps after a time, s.
    Step(f64),
}

/// Column of the constant part. The columns of a fit are: constant, part that changes with the
/// sense, both again for the second speed, change.
const ONE: usize = 0;
/// Column of the change.
const CHANGE: usize = 4;

/// Result of a fit. Variances are those of the less certain part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    /// Hypothesis that was fitted.
    pub shape: Shape,
    /// Value at the end.
    pub at_end: [f64; 2],
    /// Variance of the value at the end.
    pub variance: f64,
    /// The change: a rate per second, or a step, later less earlier.
    pub change: [f64; 2],
    /// Variance of the change.
    pub change_variance: f64,
    /// Chi-square of the residuals.
    pub chi_square: f64,
    /// Degrees of freedom of chi-square.
    pub degrees: f64,
    /// Reduction of chi-square against a constant value, in units of the scatter that remains.
    pub gain: f64,
}

/// Marks of all turns in the order of time, with the prior knowledge for their fit.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    /// Marks in the order of time.
    marks: Marks,
    /// Prior knowledge of the part that changes with the sense, for each part of the value.
    odd: [Column; 2],
    /// Variance of either part of one turn's value, and whether it is known independently of these
    /// turns.
    variance: f64,
    is_known: bool,
    /// Number of parts of the values, one or two.
    parts: usize,
    /// Time, s, to which the value of a linear change refers: the end, shifted by the lever.
    end: f64,
}

/// Increase of the scatter over the degrees of freedom, because it is itself estimated (F instead
/// of chi-square).
const FEW: f64 = 11.0;
/// Median of the squared distance of two neighbours over the variance of either part, for two
/// parts: 2 · 2 ln 2.
pub(super) const MEDIAN_OF_NEIGHBOURS: f64 = 2.772_588_722_239_781;
/// Least relative information of a step where the other columns explain it.
const LEAST_INFORMATION: f64 = 1e-6;
/// Least number of turns on either side of a step.
const FEWEST: f64 = 2.0;

impl Record {
    /// Record of values with two parts, whose noise follows from differences of neighbours and is
    /// at least `least`.
    pub(crate) fn of_phasors(marks: Marks, odd: [Column; 2], least: f64) -> Self {
        let mut record = Self { marks, odd, variance: 0.0, is_known: false, parts: 2, end: 0.0 };
        record.in_order();
        record.variance = record.of_neighbours().max(least * least);
        record
    }

    /// Record of values with one part and this variance for one turn. The value at the end of a
    /// linear change is extrapolated by `lever` seconds beyond the end.
    pub(crate) fn of_angles(
        marks: Marks,
        odd: Column,
        (variance, is_known): (f64, bool),
        lever: f64,
    ) -> Self {
        let odd = [odd; 2];
        let mut record = Self { marks, odd, variance, is_known, parts: 1, end: 0.0 };
        record.in_order();
        record.end += lever;
        if !is_known {
            record.odd = [Column::Free; 2];
            record.variance *= record.scatter().unwrap_or(1.0);
            record.odd = odd;
        }
        record
    }

    /// Sorts the marks by time and sets the end.
    fn in_order(&mut self) {
        sort(&mut self.marks, |one, other| one.time < other.time);
        self.end = self.marks.last().map_or(0.0, |mark| f64::from(mark.time));
    }

    /// Variance of either part of one turn's value, from neighbours of the same sense and speed.
    fn of_neighbours(&self) -> f64 {
        let mut squares: Vec<f64, MARKS> = Vec::new();
        for pair in self.marks.windows(2) {
            let [one, other] = [pair[0], pair[1]];
            if one.odd == other.odd && one.is_second == other.is_second {
                let apart = [0, 1].map(|part| f64::from(one.value[part] - other.value[part]));
                let square = apart[0] * apart[0] + apart[1] * apart[1];
                // There are fewer pairs than marks, so the push cannot fail.
                let _ = squares.push(square * f64::from(one.turns.min(other.turns)));
            }
        }
        median(&mut squares) / MEDIAN_OF_NEIGHBOURS
    }

    /// Regression row of a mark.
    fn row(&self, mark: &Mark, shape: Shape) -> [f64; COLUMNS] {
        let (time, odd) = (f64::from(mark.time), f64::from(mark.odd));
        let second = f64::from(u8::from(mark.is_second));
        let change = match shape {
            Shape::Steady => 0.0,
            Shape::Rate => time - self.end,
            Shape::Step(after) => -f64::from(u8::from(time < after)),
        };
        [1.0, odd, second, second * odd, change, 0.0, 0.0]
    }

    /// Selection of the columns for one part of the value.
    fn model(&self, shape: Shape, part: usize) -> [Column; COLUMNS] {
        let (is_two, odd) = (self.marks.iter().any(|mark| mark.is_second), self.odd[part]);
        // With two speeds nothing is assumed in common where the difference of the senses is free.
        let second = if is_two && odd == Column::Free { Column::Free } else { Column::Absent };
        let change = if shape == Shape::Steady { Column::Absent } else { Column::Free };
        [Column::Free, odd, second, second, change, Column::Absent, Column::Absent]
    }

    /// Fit of one part of the value.
    #[inline(never)]
    fn solution(&self, shape: Shape, part: usize) -> Option<Solution<COLUMNS>> {
        let mut regression = Regression::<COLUMNS>::default();
        for mark in &self.marks {
            let weight = libm::sqrt(f64::from(mark.turns) / self.variance);
            let row = self.row(mark, shape).map(|value| value * weight);
            regression.push(&row, f64::from(mark.value[part]) * weight);
        }
        regression.solve(&self.model(shape, part))
    }

    /// Fit of all parts, without its gain.
    fn found(&self, shape: Shape) -> Option<Found> {
        let first = self.solution(shape, 0)?;
        let second = if self.parts > 1 { Some(self.solution(shape, 1)?) } else { None };
        let both = |column: usize| {
            [Some(&first), second.as_ref()]
                .map(|one| one.map_or(0.0, |one| one.coefficients[column]))
        };
        let greater = |column: usize| {
            let of = |one: &Solution<COLUMNS>| one.covariance[column][column];
            of(&first).max(second.as_ref().map_or(0.0, of))
        };
        let degrees = first.degrees + second.as_ref().map_or(0, |second| second.degrees);
        Some(Found {
            shape,
            at_end: both(ONE),
            variance: greater(ONE),
            change: both(CHANGE),
            change_variance: greater(CHANGE),
            chi_square: first.chi_square + second.map_or(0.0, |second| second.chi_square),
            degrees: degrees as f64,
            gain: 0.0,
        })
    }

    /// Ratio of the marks' scatter about a linear change to their variance; `None` without degrees
    /// of freedom.
    fn scatter(&self) -> Option<f64> {
        let found = self.found(Shape::Rate)?;
        (found.degrees > 0.0 && found.chi_square > 0.0).then(|| found.chi_square / found.degrees)
    }

    /// Factor by which the noise power exceeds the assumed one.
    fn excess(&self, found: &Found) -> f64 {
        let shown = found.chi_square / found.degrees.max(1.0);
        if self.is_known {
            shown.max(1.0)
        } else {
            shown.max(1.0) * (1.0 + FEW / found.degrees.max(1.0))
        }
    }

    /// Gain in chi-square that chance achieves by choosing among all places of a step.
    pub(crate) fn places(&self) -> f64 {
        2.0 * libm::log(self.marks.len().max(1) as f64)
    }

    /// Time from the first mark to the last, s.
    pub(crate) fn seconds(&self) -> f64 {
        self.marks.first().map_or(0.0, |mark| self.end - f64::from(mark.time))
    }

    /// Weighted middle of all turns, s.
    pub(crate) fn middle(&self) -> f64 {
        let turns = |mark: &Mark| f64::from(mark.turns);
        let moment: f64 = self.marks.iter().map(|mark| turns(mark) * f64::from(mark.time)).sum();
        moment / self.marks.iter().map(turns).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// Time from the middle of all turns to the end, s.
    pub(crate) fn to_end(&self) -> f64 {
        self.end - self.middle()
    }

    /// Fit of a constant value.
    pub(crate) fn steady(&self) -> Option<Found> {
        self.found(Shape::Steady)
    }

    /// Fit of a change, with its gain against a constant value; `None` where the turns do not
    /// determine it.
    pub(crate) fn changing(&self, shape: Shape, steady: &Found) -> Option<Found> {
        let found = self.found(shape).filter(|found| found.degrees > 0.0)?;
        let excess = self.excess(&found);
        let gain = (steady.chi_square - found.chi_square).max(0.0) / excess.max(f64::MIN_POSITIVE);
        Some(Found {
            gain,
            variance: found.variance * excess,
            change_variance: found.change_variance * excess,
            ..found
        })
    }

    /// Most likely step: the greatest sum of residuals after it, less the part that the other
    /// columns explain.
    #[inline(never)]
    pub(crate) fn likeliest_step(&self) -> Option<Shape> {
        let first = self.solution(Shape::Steady, 0)?;
        let second = self.solution(Shape::Steady, self.parts - 1)?;
        let (mut weight, mut shared, mut sums) = (0.0, [0.0; CHANGE], [0.0; 2]);
        let (mut best, mut found) = (0.0, None);
        let all: f64 = self.marks.iter().map(|mark| f64::from(mark.turns)).sum();
        for pair in self.marks.windows(2) {
            let mark = &pair[0];
            let row = self.row(mark, Shape::Steady);
            let turns = f64::from(mark.turns);
            weight += turns;
            for (sum, value) in shared.iter_mut().zip(row) {
                *sum += turns * value / self.variance;
            }
            for (sum, (solution, value)) in
                sums.iter_mut().zip([&first, &second].into_iter().zip(mark.value))
            {
                *sum += turns * (f64::from(value) - fitted(&row, solution));
            }
            let information = weight / self.variance - leverage(&shared, &first);
            let least = LEAST_INFORMATION * weight / self.variance;
            let power: f64 = sums.iter().take(self.parts).map(|sum| sum * sum).sum();
            let gain = power / (self.variance * self.variance) / information.max(least);
            let is_within = weight >= FEWEST && all - weight >= FEWEST;
            if is_within && gain > best {
                best = gain;
                found = Some(Shape::Step(0.5 * f64::from(pair[0].time + pair[1].time)));
            }
        }
        found
    }

    /// Step at the reversal of the platform, if it reversed exactly once.
    pub(crate) fn change_of_sense(&self) -> Option<Shape> {
        let is_turned = |pair: &&[Mark]| (pair[0].odd > 0.0) != (pair[1].odd > 0.0);
        let mut turned = self.marks.windows(2).filter(is_turned);
        let first = turned.next().filter(|_| turned.next().is_none())?;
        Some(Shape::Step(0.5 * f64::from(first[0].time + first[1].time)))
    }

    /// Whether a time separates exactly the two senses of rotation.
    pub(crate) fn is_between_senses(&self, after: f64) -> bool {
        let is_clockwise = |mark: &Mark| mark.odd > 0.0;
        let is_late = |mark: &Mark| f64::from(mark.time) > after;
        let first = self.marks.first().is_some_and(is_clockwise);
        self.marks.iter().all(|mark| is_late(mark) == (is_clockwise(mark) != first))
    }
}

/// Fitted value of a row.
fn fitted(row: &[f64; COLUMNS], solution: &Solution<COLUMNS>) -> f64 {
    row.iter().zip(solution.coefficients).map(|(value, coefficient)| value * coefficient).sum()
}

/// Leverage of summed columns: rowᵀ·covariance·row.
fn leverage(sums: &[f64; CHANGE], solution: &Solution<COLUMNS>) -> f64 {
    let of = |(index, one): (usize, &f64)| {
        let row = &solution.covariance[index];
        one * sums.iter().zip(row).map(|(other, value)| other * value).sum::<f64>()
    };
    sums.iter().enumerate().map(of).sum()
}

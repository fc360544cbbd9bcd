//! What changes over the turns although it should stay: the Earth rate's direction, and the tilt.
//!
//! A base that turns about the vertical, or an encoder that creeps, lets the Earth rate's direction drift from turn
//! to turn; a base that was turned, or an encoder that slipped, lets it step. A base that tilts lets the force's
//! phasor drift. Each is fitted over the turns of both senses together, beside what changes with the sense alone, as
//! a lag makes it: that much is known of a lag beforehand, the senses' change tells twice as much as their turns do.

use heapless::Vec;

use super::turn::TURNS;
use super::turn_accumulator::STRETCHES;
use crate::align::regression::{COLUMNS, Column, Regression, Solution};
use crate::math::{median, sort};

/// Most turns of all stretches.
pub const MARKS: usize = STRETCHES * TURNS;

/// What a turn shows of something that should stay.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mark {
    /// Its middle, s.
    pub time: f32,
    /// How what changes with the sense counts in it: its sign, or its signed speed.
    pub odd: f32,
    /// Whether it is of the second speed.
    pub is_second: bool,
    /// How many turns of the platform it stands for.
    pub turns: f32,
    /// The value; the second part of one that has but one is zero.
    pub value: [f32; 2],
}

/// How something that should stay may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Not at all.
    Steady,
    /// Evenly with the time.
    Rate,
    /// At once, after a time, s.
    Step(f64),
}

/// Columns of a fit: what stays, what changes with the sense, both at the second speed, the change.
const ONE: usize = 0;
const ODD: usize = 1;
const SECOND: usize = 2;
const SECOND_ODD: usize = 3;
const CHANGE: usize = 4;

/// What a fit found. Variances are those of the part that is known less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Which change it is.
    pub shape: Shape,
    /// The value at the end, and its variance.
    pub at_end: [f64; 2],
    /// Variance of that.
    pub variance: f64,
    /// The change: a rate, 1/s, or a step, later less earlier.
    pub change: [f64; 2],
    /// Variance of that.
    pub change_variance: f64,
    /// Chi-square of what is left.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub degrees: f64,
    /// By how much it lowers chi-square beside a value that stays, in the scatter that it leaves.
    pub gain: f64,
}

/// The turns, in the order of time.
#[derive(Clone, Debug)]
pub struct Record {
    marks: Vec<Mark, MARKS>,
    /// What is known of what changes with the sense, in either part.
    odd: [Column; 2],
    /// Variance of either part of one turn's value; whether it is known, else as these turns show it.
    variance: f64,
    is_known: bool,
    /// How many parts the values have.
    parts: usize,
    /// When a value that changes evenly is that of the end, s: then or, as a lever has it, before or after.
    end: f64,
}

/// What a scatter that is itself estimated takes off a gain, over its degrees of freedom (F instead of chi-square).
const FEW: f64 = 11.0;
/// Median of the squared distance of two neighbours over the variance of either part, of two parts.
const MEDIAN_OF_NEIGHBOURS: f64 = 2.772_588_722_239_781;
/// Information that is left where the other columns take all of it, relative.
const LEAST_INFORMATION: f64 = 1e-6;
/// Turns that must lie on either side of a step.
const FEWEST: f64 = 2.0;

impl Record {
    /// Marks of values with two parts whose noise their neighbours show.
    #[must_use]
    pub fn of_phasors(marks: Vec<Mark, MARKS>, odd: [Column; 2], least: f64) -> Self {
        let mut record = Self { marks, odd, variance: 0.0, is_known: false, parts: 2, end: 0.0 };
        record.in_order();
        record.variance = record.of_neighbours().max(least * least);
        record
    }

    /// Marks of values with one part, of which one turn has this variance. One that changes evenly is at the end what it
    /// would be so many seconds after it.
    #[must_use]
    pub fn of_angles(
        marks: Vec<Mark, MARKS>,
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

    fn in_order(&mut self) {
        sort(&mut self.marks, |one, other| one.time < other.time);
        self.end = self.marks.last().map_or(0.0, |mark| f64::from(mark.time));
    }

    /// Variance of either part of one turn's value, from neighbours in one sense.
    fn of_neighbours(&self) -> f64 {
        let mut squares: Vec<f64, MARKS> = Vec::new();
        for pair in self.marks.windows(2) {
            let [one, other] = [pair[0], pair[1]];
            if one.odd == other.odd && one.is_second == other.is_second {
                let apart = [0, 1].map(|part| f64::from(one.value[part] - other.value[part]));
                let square = apart[0] * apart[0] + apart[1] * apart[1];
                // There are no more pairs than marks.
                let _ = squares.push(square * f64::from(one.turns.min(other.turns)));
            }
        }
        median(&mut squares) / MEDIAN_OF_NEIGHBOURS
    }

    /// The columns of a mark.
    fn row(&self, mark: &Mark, shape: Shape) -> [f64; COLUMNS] {
        let (time, odd) = (f64::from(mark.time), f64::from(mark.odd));
        let second = f64::from(u8::from(mark.is_second));
        let mut row = [0.0; COLUMNS];
        row[ONE] = 1.0;
        row[ODD] = odd;
        row[SECOND] = second;
        row[SECOND_ODD] = second * odd;
        row[CHANGE] = match shape {
            Shape::Steady => 0.0,
            Shape::Rate => time - self.end,
            Shape::Step(after) => -f64::from(u8::from(time < after)),
        };
        row
    }

    fn model(&self, shape: Shape, part: usize) -> [Column; COLUMNS] {
        let is_two = self.marks.iter().any(|mark| mark.is_second);
        // Of two speeds nothing is taken for granted where the senses' difference is free.
        let second =
            if is_two && self.odd[part] == Column::Free { Column::Free } else { Column::Absent };
        let mut model = [Column::Absent; COLUMNS];
        model[ONE] = Column::Free;
        model[ODD] = self.odd[part];
        model[SECOND] = second;
        model[SECOND_ODD] = second;
        model[CHANGE] = if shape == Shape::Steady { Column::Absent } else { Column::Free };
        model
    }

    /// The fit of one part.
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

    /// A fit without its gain.
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

    /// By how much the marks scatter more than their variance says, in power, whatever changes evenly.
    fn scatter(&self) -> Option<f64> {
        let found = self.found(Shape::Rate)?;
        (found.degrees > 0.0 && found.chi_square > 0.0).then(|| found.chi_square / found.degrees)
    }

    /// By how much the noise is greater than was thought, in power.
    fn excess(&self, found: &Found) -> f64 {
        let shown = found.chi_square / found.degrees.max(1.0);
        if self.is_known {
            shown.max(1.0)
        } else {
            shown.max(1.0) * (1.0 + FEW / found.degrees.max(1.0))
        }
    }

    /// What chance gains in chi-square by choosing among all places at which a step may be.
    #[must_use]
    pub fn places(&self) -> f64 {
        2.0 * libm::log(self.marks.len().max(1) as f64)
    }

    /// From the first mark to the last, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.marks.first().map_or(0.0, |mark| self.end - f64::from(mark.time))
    }

    /// The middle of all turns, s.
    #[must_use]
    pub fn middle(&self) -> f64 {
        let turns = |mark: &Mark| f64::from(mark.turns);
        let moment: f64 = self.marks.iter().map(|mark| turns(mark) * f64::from(mark.time)).sum();
        moment / self.marks.iter().map(turns).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// From there to the end, s.
    #[must_use]
    pub fn to_end(&self) -> f64 {
        self.end - self.middle()
    }

    /// The value that stays.
    #[must_use]
    pub fn steady(&self) -> Option<Found> {
        self.found(Shape::Steady)
    }

    /// How well a change explains the turns beside a value that stays; `None` where they cannot tell.
    #[must_use]
    pub fn changing(&self, shape: Shape, steady: &Found) -> Option<Found> {
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

    /// After which time a step is likeliest, s: the greatest sum of what is left behind it, less what the other
    /// columns take of it.
    #[must_use]
    #[inline(never)]
    pub fn likeliest_step(&self) -> Option<Shape> {
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

    /// A step where the platform turned back, if it did so once.
    #[must_use]
    pub fn change_of_sense(&self) -> Option<Shape> {
        let is_turned = |pair: &&[Mark]| (pair[0].odd > 0.0) != (pair[1].odd > 0.0);
        let mut turned = self.marks.windows(2).filter(is_turned);
        let first = turned.next().filter(|_| turned.next().is_none())?;
        Some(Shape::Step(0.5 * f64::from(first[0].time + first[1].time)))
    }

    /// Whether nothing but the sense tells what lies before a time from what lies after it.
    #[must_use]
    pub fn is_between_senses(&self, after: f64) -> bool {
        let is_clockwise = |mark: &Mark| mark.odd > 0.0;
        let is_late = |mark: &Mark| f64::from(mark.time) > after;
        let first = self.marks.first().is_some_and(is_clockwise);
        self.marks.iter().all(|mark| is_late(mark) == (is_clockwise(mark) != first))
    }
}

fn fitted(row: &[f64; COLUMNS], solution: &Solution<COLUMNS>) -> f64 {
    row.iter().zip(solution.coefficients).map(|(value, coefficient)| value * coefficient).sum()
}

/// How much of some columns' sums the fit takes: rowᵀ·covariance·row.
fn leverage(sums: &[f64; CHANGE], solution: &Solution<COLUMNS>) -> f64 {
    let of = |(index, one): (usize, &f64)| {
        let row = &solution.covariance[index];
        one * sums.iter().zip(row).map(|(other, value)| other * value).sum::<f64>()
    };
    sums.iter().enumerate().map(of).sum()
}

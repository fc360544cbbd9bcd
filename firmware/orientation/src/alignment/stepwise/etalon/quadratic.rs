//! Exact minimum of a sum of squares over the table, without evaluating every index.
//!
//! The root of the continuous objective is within a known bound of the root of the exact one, so
//! only indices whose continuous root lies within that bound of the best exact root can win. They
//! lie next to the (at most two) minima and are evaluated exactly.

use libm::{fabs, sqrt};

use super::answer::{Acceptance, Match};
use super::arc::{Cover, Judge, last_within};
use super::exact::Squares;
use super::landscape::Landscape;
use super::series::Series;
use crate::math::reference_table::TURN;
use crate::math::{Table, sort};

/// Sum of squares over one series, in continuous and exact form.
struct Objective<'a> {
    /// Reference table.
    table: Table,
    /// Measured series.
    series: &'a Series,
    /// Kind of the sum.
    squares: Squares,
    /// Continuous objective.
    landscape: Landscape,
    /// Bound on the difference of the roots of both forms.
    rounding: f64,
    /// Bound on the rounding of the continuous form.
    slack: f64,
    /// Continuous value below which the short arithmetic is exact.
    small: f64,
}

impl<'a> Objective<'a> {
    fn new(table: Table, series: &'a Series, squares: Squares) -> Self {
        let landscape = Landscape::new(table, series, squares);
        Self {
            table,
            series,
            squares,
            landscape,
            rounding: landscape.rounding(series.count(), squares),
            slack: landscape.slack(),
            // Half the limit leaves room for the difference between continuous and exact.
            small: 0.5 * squares.small_limit(series.count()),
        }
    }

    /// Continuous objective at index `k`.
    fn continuous(&self, k: i32) -> f64 {
        self.landscape.at(self.table, k)
    }

    /// Whether the sign of the slope at `k` is uncertain.
    fn is_flat(&self, k: i32) -> bool {
        fabs(self.landscape.slope(self.table, k)) <= self.landscape.slope_error()
    }

    /// Exact objective at `k`, where the continuous one is `near`.
    fn exact(&self, k: i32, near: f64) -> u128 {
        self.squares.at(self.table, self.series, k, near < self.small)
    }

    /// Largest continuous value at which the exact one may still be `value`.
    fn reach(&self, value: f64) -> f64 {
        let root = sqrt(value) + self.rounding;
        root * root + self.slack
    }

    /// Largest continuous value at which the exact one is certainly within `value`.
    fn surety(&self, value: f64) -> f64 {
        let root = sqrt(value) - self.rounding;
        if root < 0.0 { f64::NEG_INFINITY } else { root * root - self.slack }
    }
}

/// Best index so far, and the level below which an index is worth evaluating.
struct Best {
    /// Best index so far.
    index: i32,
    /// Exact objective at the best index.
    objective: u128,
    /// Minimum from which the walk to that index started.
    origin: i32,
    /// Greatest continuous value whose exact value may still win.
    reach: f64,
    /// Number of exact evaluations.
    evaluations: u32,
}

impl Best {
    /// Evaluates the first index.
    fn at(objective: &Objective, k: i32, near: f64) -> Self {
        let value = objective.exact(k, near);
        let reach = objective.reach(value as f64);
        Self { index: k, objective: value, origin: k, reach, evaluations: 1 }
    }

    /// Evaluates `origin` + `sign`, + 2 `sign`, … below `limit` steps as far as they can compete;
    /// returns how far that is.
    fn walk(&mut self, objective: &Objective, origin: i32, sign: i32, limit: i32) -> i32 {
        let place = |distance: i32| (origin + sign * distance).rem_euclid(TURN);
        // The minimum may lie beyond `origin`, by the two steps of rounding or anywhere where it is
        // flat.
        let mut last = 0;
        while last + 1 < limit && (last < 2 || objective.is_flat(place(last))) {
            last += 1;
            let near = objective.continuous(place(last));
            if near <= self.reach {
                self.offer(objective, place(last), near, origin);
            }
        }
        // Beyond that the objective rises.
        let (reach, flat) = (self.reach, last);
        last = last_within(|k| objective.continuous(place(k)) <= reach, flat, limit, 1);
        for distance in flat + 1..=last {
            self.offer(objective, place(distance), reach, origin);
        }
        last
    }

    /// Evaluates an index exactly and keeps it if it is better, or equal and lower.
    fn offer(&mut self, objective: &Objective, k: i32, near: f64, origin: i32) {
        let value = objective.exact(k, near);
        self.evaluations += 1;
        if (value, k) < (self.objective, self.index) {
            let reach = self.reach.min(objective.reach(value as f64));
            *self = Self { index: k, objective: value, origin, reach, ..*self };
        }
    }
}

/// Index of the least exact objective; see [`super::search`].
pub(super) fn search(table: Table, series: &Series, squares: Squares) -> Match {
    let objective = Objective::new(table, series, squares);
    let bounds = objective.landscape.bounds();
    let [mut first, mut second] = objective.landscape.minima(table, &bounds);
    let (mut near, mut other) = (objective.continuous(first), objective.continuous(second));
    if other < near {
        core::mem::swap(&mut first, &mut second);
        core::mem::swap(&mut near, &mut other);
    }
    let mut best = Best::at(&objective, first, near);
    let above = best.walk(&objective, first, 1, TURN);
    let below = best.walk(&objective, first, -1, TURN - above);
    if (second - (first - below)).rem_euclid(TURN) > above + below {
        if other <= best.reach {
            best.offer(&objective, second, other, second);
        }
        let above = best.walk(&objective, second, 1, TURN);
        best.walk(&objective, second, -1, TURN - above);
    }
    Match {
        index: best.index,
        objective: best.objective,
        azimuth: objective.landscape.refine(best.origin),
        evaluations: best.evaluations,
    }
}

/// Arc on which the objective is at most `limit`; see [`super::accepted`].
pub(super) fn within(table: Table, series: &Series, squares: Squares, limit: u128) -> Acceptance {
    let objective = Objective::new(table, series, squares);
    let bounds = objective.landscape.bounds();
    let [first, second] = objective.landscape.minima(table, &bounds);
    let [third, fourth] = objective.landscape.maxima(table, &bounds);
    let (sure, reach) = (objective.surety(limit as f64), objective.reach(limit as f64));
    // The exact value is near the limit wherever the side is unsure.
    let accepts = |k: i32| objective.exact(k, reach) <= limit;
    let continuous = |k: i32| objective.continuous(k);
    let judge = Judge { continuous: &continuous, sure, reach, accepts: &accepts };
    let mut anchors = [first, second, third, fourth];
    sort(&mut anchors, |a, b| a < b);
    let mut cover = Cover::default();
    let ends = [anchors[1], anchors[2], anchors[3], anchors[0] + TURN];
    for (from, to) in anchors.into_iter().zip(ends) {
        segment(&mut cover, &judge, &objective, from, to);
    }
    cover.finish()
}

/// Judges the indices `from` to `to` − 1 between two stationary points of the objective: one by one
/// where it is flat, by bisection between.
fn segment(cover: &mut Cover, judge: &Judge, objective: &Objective, from: i32, to: i32) {
    // A stationary point is known to one step, and its bounds were rounded by another.
    let mut rise = (from + 2).min(to - 1);
    while rise < to - 1 && objective.is_flat(rise) {
        rise += 1;
    }
    let mut fall = (to - 2).max(rise + 1);
    while fall > rise + 1 && objective.is_flat(fall) {
        fall -= 1;
    }
    cover.judge_each(judge, from, rise);
    cover.judge_monotone(judge, rise + 1, fall - 1);
    cover.judge_each(judge, fall, to - 1);
}

//! The smallest arc that covers an accepted set, built while walking once round the circle.

use super::answer::{Acceptance, Accepted};
use crate::math::reference_table::TURN;

/// Side of the limit on which the continuous objective and its error bound put one index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    /// The index is certainly accepted.
    Inside,
    /// The index is too near the limit and must be evaluated exactly.
    Unsure,
    /// The index is certainly rejected.
    Outside,
}

/// Comparison of single indices with a limit: by the continuous objective, and exactly.
pub(super) struct Judge<'a> {
    /// Continuous objective at an index.
    pub(super) continuous: &'a dyn Fn(i32) -> f64,
    /// Largest continuous value at which the exact one is certainly within the limit.
    pub(super) sure: f64,
    /// Largest continuous value at which the exact one may be within the limit.
    pub(super) reach: f64,
    /// Whether the exact objective at an index is within the limit.
    pub(super) accepts: &'a dyn Fn(i32) -> bool,
}

impl Judge<'_> {
    /// The side on which the continuous objective and its error bound put index `k`.
    fn side(&self, k: i32) -> Side {
        match (self.continuous)(k) {
            value if value <= self.sure => Side::Inside,
            value if value <= self.reach => Side::Unsure,
            _ => Side::Outside,
        }
    }
}

/// Accepted indices seen so far, in increasing order from the start of the walk.
///
/// Indices are unwrapped: one walk covers one turn from any start.
#[derive(Debug, Default)]
pub(super) struct Cover {
    /// First accepted index.
    first: Option<i32>,
    /// Latest accepted index.
    last: i32,
    /// Length of the largest gap so far.
    gap: i32,
    /// Index at which the arc after that gap begins.
    start: i32,
    /// Number of exact evaluations.
    evaluations: u32,
}

impl Cover {
    /// Adds the accepted run `from` to `to`, both included; an empty run changes nothing.
    pub(super) fn accept(&mut self, from: i32, to: i32) {
        if from > to {
            return;
        }
        if self.first.is_none() {
            self.first = Some(from);
        } else {
            self.close(from);
        }
        self.last = to;
    }

    /// Closes the gap that runs up to the accepted index `next`; of equal gaps the one whose arc
    /// begins at the lowest index is kept.
    fn close(&mut self, next: i32) {
        let (gap, start) = (next - self.last - 1, next.rem_euclid(TURN));
        if gap > self.gap || (gap == self.gap && gap > 0 && start < self.start) {
            self.gap = gap;
            self.start = start;
        }
    }

    /// Judges every index from `from` to `to` by itself.
    pub(super) fn judge_each(&mut self, judge: &Judge, from: i32, to: i32) {
        for k in from..=to {
            match judge.side(k) {
                Side::Inside => self.accept(k, k),
                Side::Unsure => self.accept_exactly(judge, k, k),
                Side::Outside => {}
            }
        }
    }

    /// Judges `from` to `to`, between which the continuous objective is monotone, by bisection:
    /// only the indices at the crossing are evaluated exactly.
    pub(super) fn judge_monotone(&mut self, judge: &Judge, from: i32, to: i32) {
        if from > to {
            return;
        }
        match (judge.side(from), judge.side(to)) {
            (Side::Inside, Side::Inside) => self.accept(from, to),
            (Side::Outside, Side::Outside) => {}
            (start, end) if start <= end => {
                let (sure, unsure) = crossing(judge, from - 1, to + 1);
                self.accept(from, sure);
                self.accept_exactly(judge, sure + 1, unsure);
            }
            _ => {
                let (sure, unsure) = crossing(judge, to + 1, from - 1);
                self.accept_exactly(judge, unsure, sure - 1);
                self.accept(sure, to);
            }
        }
    }

    /// Evaluates every index of a run exactly.
    fn accept_exactly(&mut self, judge: &Judge, from: i32, to: i32) {
        for k in from..=to {
            self.evaluations += 1;
            if (judge.accepts)(k) {
                self.accept(k, k);
            }
        }
    }

    /// Result after the walk once round the circle.
    pub(super) fn finish(mut self) -> Acceptance {
        Acceptance { accepted: self.accepted(), evaluations: self.evaluations }
    }

    /// The arc, once the walk is done.
    fn accepted(&mut self) -> Accepted {
        let Some(first) = self.first else { return Accepted::Nothing };
        self.close(first + TURN);
        if self.gap == 0 {
            return Accepted::Everything;
        }
        let width = TURN - 1 - self.gap;
        let middle = (self.start + width / 2).rem_euclid(TURN);
        Accepted::Arc { first: self.start, middle, width }
    }
}

/// Last certain index, and last index that is not certainly rejected, on the way from `near`
/// (beyond the certain end) to `far` (beyond the other).
fn crossing(judge: &Judge, near: i32, far: i32) -> (i32, i32) {
    let sure = last_within(|k| judge.side(k) == Side::Inside, near, far, TURN);
    (sure, last_within(|k| judge.side(k) != Side::Outside, sure, far, 1))
}

/// Last index that is `within` on the way from `near` (not evaluated, taken as within) to `far`
/// (not evaluated, taken as beyond).
///
/// Strides from `near` double, beginning with `stride`, until an index is beyond; then it bisects.
pub(super) fn last_within(within: impl Fn(i32) -> bool, near: i32, far: i32, stride: i32) -> i32 {
    let (mut near, mut far, mut stride) = (near, far, stride);
    while (far - near).abs() > 1 {
        let half = (far - near).abs() / 2;
        let k = near + half.min(stride) * (far - near).signum();
        if within(k) {
            near = k;
            stride = stride.saturating_mul(2);
        } else {
            far = k;
        }
    }
    near
}

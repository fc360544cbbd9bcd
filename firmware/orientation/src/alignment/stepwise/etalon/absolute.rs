//! Exact minimum of a sum of absolute values over the table, without evaluating every index.
//!
//! On each piece between two zero crossings the continuous sum is one sinusoid. The set where it is
//! below a level touches an end of the piece or surrounds the sinusoid's minimum, so walks from
//! those three places meet every index that can win.

use libm::floor;

use super::answer::{Acceptance, Match};
use super::arc::{Cover, Judge};
use super::exact;
use super::series::Series;
use super::sweep::{Piece, Sweep};
use crate::math::reference_table::{STEP, TURN};
use crate::math::{Table, sort};

/// Best index so far, and the level below which a piece is worth evaluating.
struct Best<'a> {
    /// Reference table.
    table: Table,
    /// Measured series.
    series: &'a Series,
    /// Bound on the difference between the continuous and the exact sum.
    rounding: f64,
    /// Best index so far.
    index: i32,
    /// Exact sum at the best index.
    objective: u64,
    /// Greatest continuous sum whose exact value may still win.
    reach: f64,
    /// Number of exact evaluations.
    evaluations: u32,
}

impl Best<'_> {
    /// Evaluates an index exactly and keeps it if it is better, or equal and lower.
    fn offer(&mut self, k: i32) {
        let value = exact::absolute(self.table, self.series, k);
        self.evaluations += 1;
        if (value, k) < (self.objective, self.index) {
            self.index = k;
            self.objective = value;
            self.reach = value as f64 + self.rounding;
        }
    }

    /// Evaluates from `from` towards `to`, both included, as far as the piece can compete; returns
    /// the first index that cannot, or the one beyond `to`.
    fn walk(&mut self, piece: &Piece, from: i32, to: i32, sign: i32) -> i32 {
        let mut k = from;
        while (to - k) * sign >= 0 && piece.at(self.table, k) <= self.reach {
            // The first guess was evaluated before, so it is skipped.
            if k != self.index {
                self.offer(k);
            }
            k += sign;
        }
        k
    }

    /// Evaluates every index of the piece that can compete.
    fn cover(&mut self, piece: &Piece) {
        let (first, last) = piece.indices();
        if first > last || !piece.dips_to(self.reach) {
            return;
        }
        let first = self.walk(piece, first, last, 1);
        let last = self.walk(piece, last, first, -1);
        if first > last {
            return;
        }
        let middle = floor(piece.minimum()) as i32;
        if (first..=last).contains(&middle) {
            self.walk(piece, middle, first, -1);
            self.walk(piece, middle + 1, last, 1);
        }
    }
}

/// Grid index at which the continuous sum is least.
fn guess(table: Table, sweep: &Sweep) -> i32 {
    let (mut index, mut least) = (0, f64::INFINITY);
    for piece in sweep.pieces() {
        let (first, last) = piece.indices();
        if first > last || !piece.dips_to(least) {
            continue;
        }
        let middle = (floor(piece.minimum()) as i32).clamp(first, last);
        for k in [first, middle, (middle + 1).min(last), last] {
            let value = piece.at(table, k);
            if value < least {
                (index, least) = (k, value);
            }
        }
    }
    index
}

/// Index of the least exact sum; see [`super::search`].
#[inline(never)]
pub(super) fn search(table: Table, series: &Series) -> Match {
    let mut sweep = Sweep::empty();
    sweep.fill(series);
    let mut best = Best {
        table,
        series,
        rounding: sweep.rounding,
        index: TURN,
        objective: u64::MAX,
        reach: f64::INFINITY,
        evaluations: 0,
    };
    best.offer(guess(table, &sweep));
    for piece in sweep.pieces() {
        best.cover(&piece);
    }
    Match {
        index: best.index,
        objective: u128::from(best.objective),
        azimuth: crate::units::wrapped(refine(&sweep, best.index) * STEP),
        evaluations: best.evaluations,
    }
}

/// Place within one step of index `k` at which the continuous sum is least, in grid steps.
fn refine(sweep: &Sweep, k: i32) -> f64 {
    let (mut place, mut least) = (f64::from(k), f64::INFINITY);
    for piece in sweep.pieces() {
        for turn in [-TURN, 0, TURN] {
            // Stretch of the piece within one step of k, for this number of turns.
            let from = piece.from.max(f64::from(k + turn - 1));
            let to = piece.to.min(f64::from(k + turn + 1));
            if from > to {
                continue;
            }
            for position in [from, to, piece.minimum().max(from).min(to)] {
                let value = piece.at_fraction(position);
                if value < least {
                    (place, least) = (position, value);
                }
            }
        }
    }
    place
}

/// Arc on which the sum is at most `limit`; see [`super::accepted`].
#[inline(never)]
pub(super) fn within(table: Table, series: &Series, limit: u64) -> Acceptance {
    let mut sweep = Sweep::empty();
    sweep.fill(series);
    let accepts = |k: i32| exact::absolute(table, series, k) <= limit;
    let rounding = sweep.rounding;
    let mut cover = Cover::default();
    for piece in sweep.pieces() {
        let above = |k: i32| piece.at(table, k) - limit as f64;
        let judge =
            Judge { continuous: &above, sure: -rounding, reach: rounding, accepts: &accepts };
        let (first, last) = piece.indices();
        if first <= last && piece.dips_to(limit as f64 + rounding) {
            let mut turns = [piece.minimum(), piece.maximum()].map(|turn| floor(turn) as i32);
            sort(&mut turns, |a, b| a < b);
            let mut from = first;
            for turn in turns.into_iter().filter(|turn| (first..last).contains(turn)) {
                cover.judge_monotone(&judge, from, turn);
                from = turn + 1;
            }
            cover.judge_monotone(&judge, from, last);
        }
    }
    cover.finish()
}

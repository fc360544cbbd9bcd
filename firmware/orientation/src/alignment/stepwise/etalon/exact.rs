//! Objectives in exact integers over the stored table: the reference that every search must agree
//! with.
//!
//! With d the table's cosines minus the measured values, an objective depends on d only through
//! d − constant (the unknown drift). Near the answer those differences are small, so 32-bit
//! residuals and 64-bit sums serve there; callers prove it by a bound first, and elsewhere the
//! 128-bit form is taken.

use super::series::Series;
use crate::math::Table;

/// Kind of the sum of squares that is minimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Squares {
    /// Mean-removed squares, n Σd² − (Σd)²: n times the sum of squares about the mean.
    Centred,
    /// Squares of the differences, Σ(dᵢ₊₁ − dᵢ)².
    Differences,
}

impl Squares {
    /// The objective at grid index `k`; `small` promises that its value is at most
    /// [`Self::small_limit`].
    pub(super) fn at(self, table: Table, series: &Series, k: i32, small: bool) -> u128 {
        match (self, small) {
            (Self::Centred, true) => centred_small(table, series, k),
            (Self::Centred, false) => centred(table, series, k),
            (Self::Differences, true) => differences_small(table, series, k),
            (Self::Differences, false) => differences(table, series, k),
        }
    }

    /// Greatest objective for which the short arithmetic is exact.
    ///
    /// Differences: J = Σe² ≤ 2⁶² bounds every |e| by 2³¹. Centred: J/n = ‖d − mean‖² ≤ b bounds every
    /// |dᵢ − d₀| by √(2b) and their sum of squares by (1 + n) b, which is less than 2⁶³ with b = 2⁵⁶ up to
    /// 126 positions, and with b = 2⁶²/(1 + n) beyond.
    pub(super) fn small_limit(self, count: f64) -> f64 {
        const TWO_56: f64 = 72_057_594_037_927_936.0;
        const TWO_62: f64 = 64.0 * TWO_56;
        const MANY: f64 = 126.0;
        match self {
            Self::Centred if count <= MANY => count * TWO_56,
            Self::Centred => count * (TWO_62 / (1.0 + count)),
            Self::Differences => TWO_62,
        }
    }
}

/// First residual, from which the others are counted.
fn first(table: Table, series: &Series, k: i32) -> i64 {
    table.cos(k) - series.values().first().copied().unwrap_or(0)
}

/// Mean-removed squares in 64-bit arithmetic.
#[inline(never)]
fn centred_small(table: Table, series: &Series, k: i32) -> u128 {
    let origin = first(table, series, k) as i32;
    let (mut squares, mut sum) = (0_i64, 0_i64);
    table.residuals(k, series.step(), series.values(), |d| {
        let d = i64::from((d as i32).wrapping_sub(origin));
        squares += d * d;
        sum += d;
    });
    let count = series.values().len() as i128;
    (count * i128::from(squares) - i128::from(sum) * i128::from(sum)) as u128
}

/// Mean-removed squares in 128-bit arithmetic.
#[inline(never)]
fn centred(table: Table, series: &Series, k: i32) -> u128 {
    let (mut squares, mut sum) = (0_i128, 0_i128);
    table.residuals(k, series.step(), series.values(), |d| {
        squares += i128::from(d) * i128::from(d);
        sum += i128::from(d);
    });
    (series.values().len() as i128 * squares - sum * sum) as u128
}

/// Squares of the differences in 64-bit arithmetic.
#[inline(never)]
fn differences_small(table: Table, series: &Series, k: i32) -> u128 {
    let mut before = first(table, series, k) as i32;
    let mut squares = 0_i64;
    table.residuals(k, series.step(), series.values(), |d| {
        let step = i64::from((d as i32).wrapping_sub(before));
        before = d as i32;
        squares += step * step;
    });
    squares as u128
}

/// Squares of the differences in 128-bit arithmetic.
#[inline(never)]
fn differences(table: Table, series: &Series, k: i32) -> u128 {
    let mut before = first(table, series, k);
    let mut squares = 0_u128;
    table.residuals(k, series.step(), series.values(), |d| {
        let step = u128::from((d - before).unsigned_abs());
        before = d;
        squares += step * step;
    });
    squares
}

/// Sum of absolute differences Σ|dᵢ₊₁ − dᵢ| at grid index `k`; at most 1 023 · 2⁴².
pub(super) fn absolute(table: Table, series: &Series, k: i32) -> u64 {
    let mut before = first(table, series, k);
    let mut sum = 0;
    table.residuals(k, series.step(), series.values(), |d| {
        sum += (d - before).unsigned_abs();
        before = d;
    });
    sum
}

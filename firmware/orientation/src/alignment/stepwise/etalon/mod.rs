//! Reference table (etalon) and its search: the azimuth that best explains a series of dwells.
//!
//! ```text
//!  rates / Ω_h, step ─▶ Series ─┬─▶ search(Criterion) ─▶ Match: index, azimuth below the grid
//!  QUARTER_COSINE ────▶ Table ──┴─▶ accepted(Limit) ───▶ Acceptance: arc of accepted indices
//! ```
//!
//! The gyro dwells at n positions one uniform step apart; position i measures `Z_i` = `Ω_h` cos(A +
//! iΔ) + S + noise, with an unknown constant drift S. Sokolov 2019 compares the differences of
//! neighbours with a table of reference values (the etalon series) for every azimuth on a 10″ grid
//! and takes the best of them by exhaustive search. Here the same answer, bit for bit that of an
//! exhaustive search in exact integers over the stored table with the lowest index on a tie, comes
//! from a few exact evaluations: a continuous form of the objective and a rigorous bound on table
//! rounding determine which indices can win (asserted against the exhaustive search in
//! `host-tests/tests/cores/etalon.rs`).
//!
//! * *Azimuth index* k, 0 to 129 599: the azimuth of the sensitive axis **at the first position**
//!   is k · 10″, clockwise from north. The paper reports the n-th position: add (n − 1) Δ.
//! * *Table units*: 2³¹ is the horizontal Earth rate `Ω_h` = Ω cos φ. A limit of α °/h is
//!   α/`Ω_h` · 2³¹ units, `Ω_h` in °/h; a limit on squares is the square of that. The paper's "5″"
//!   taken as 5 °/h accepts the whole quarter it searches, taken as 5″/h = 0.0014 °/h nothing.
//!
//! Nothing here allocates or recurses. On a Cortex-M4 with 60 positions in the paper's settings a
//! search for a least sum of squares takes 0.13 to 0.18 M instructions and 1.6 KiB of stack, for a
//! least sum of absolute values 2.9 M and 5.6 KiB. The cost follows the series: without Earth rate
//! in it (all values equal on a full circle) every index may win and all 129 600 are evaluated.

mod absolute;
mod answer;
mod arc;
mod exact;
mod landscape;
mod quadratic;
pub mod series;
mod sweep;

pub use answer::{Acceptance, Accepted, Match};
pub use series::{Series, SeriesError};

use crate::math::Table;
use exact::Squares;

/// Objective that is minimised, with d the table's cosines at a candidate azimuth minus the
/// measured values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Mean-removed least squares n Σd² − (Σd)²: the maximum-likelihood answer for white noise and
    /// a constant drift, and the default.
    MaximumLikelihood,
    /// Sum of squares of differences Σ(dᵢ₊₁ − dᵢ)² (Sokolov 2019).
    LeastSquares,
    /// Sum of absolute differences Σ|dᵢ₊₁ − dᵢ| (Sokolov 2019).
    LeastAbsolute,
}

/// Limit by which azimuths are accepted (Sokolov 2019).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Limit on Σ(dᵢ₊₁ − dᵢ)², in squared table units.
    WithinSquares(u128),
    /// Limit on Σ|dᵢ₊₁ − dᵢ|, in table units.
    WithinAbsolute(u64),
}

/// Finds the azimuth index with the least exact objective over the whole circle.
#[must_use]
pub fn search(table: Table, series: &Series, criterion: Criterion) -> Match {
    match criterion {
        Criterion::MaximumLikelihood => quadratic::search(table, series, Squares::Centred),
        Criterion::LeastSquares => quadratic::search(table, series, Squares::Differences),
        Criterion::LeastAbsolute => absolute::search(table, series),
    }
}

/// Finds the smallest arc that covers every azimuth index whose exact objective meets `limit`.
#[must_use]
pub fn accepted(table: Table, series: &Series, limit: Limit) -> Acceptance {
    match limit {
        Limit::WithinSquares(limit) => {
            quadratic::within(table, series, Squares::Differences, limit)
        }
        Limit::WithinAbsolute(limit) => absolute::within(table, series, limit),
    }
}

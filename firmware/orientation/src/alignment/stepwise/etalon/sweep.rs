//! A sum of absolute values as a continuous function of azimuth: one sinusoid between two
//! crossings.
//!
//! Term i is |uᵢ(A) − wᵢ| with uᵢ = Re(gᵢ e^{jA}) the difference of two cosines and wᵢ the measured
//! one. Each term crosses zero at most twice round the circle, so the sum consists of at most
//! 2(n − 1) + 1 pieces Re(G e^{jA}) − W, and a sweep through the sorted crossings yields them.

use core::f64::consts::PI;

use heapless::Vec;
use libm::{acos, atan2, ceil, fabs, sincos};

use super::series::{CAPACITY, Series};
use crate::math::reference_table::{ONE, QUARTER, STEP, TURN};
use crate::math::{Table, sort};

/// One turn in grid steps.
const CIRCLE: f64 = TURN as f64;
/// Greatest number of partial sums of a sweep: one for every crossing.
const PARTIAL_SUMS: f64 = (2 * CAPACITY) as f64;

/// One term uᵢ(A) − wᵢ, in table units.
#[derive(Clone, Copy, Debug)]
struct Term {
    /// Real part of gᵢ.
    re: f64,
    /// Imaginary part of gᵢ.
    im: f64,
    /// Measured difference wᵢ.
    offset: f64,
}

/// Place at which a term changes sign: to positive if it rises.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// Place on the circle, grid steps with fraction.
    at: f64,
    /// Index of the term.
    term: u16,
    /// Whether the term becomes positive.
    rises: bool,
}

/// A stretch of the circle on which the sum is `re` cos A − `im` sin A − `offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Real part of the phasor G.
    re: f64,
    /// Imaginary part of the phasor G.
    im: f64,
    /// Constant W.
    offset: f64,
    /// Beginning and end of the stretch, grid steps with fraction.
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Piece {
    /// First and last grid index on the piece; first > last when there is none.
    pub(super) fn indices(&self) -> (i32, i32) {
        (ceil(self.from) as i32, ceil(self.to) as i32 - 1)
    }

    /// Sum at grid index `k`, with cosine and sine from the table.
    pub(super) fn at(&self, table: Table, k: i32) -> f64 {
        let (c, s) = table.phasor(k);
        (c * self.re - s * self.im) * (1.0 / ONE) - self.offset
    }

    /// Sum at `position`, grid steps with fraction.
    pub(super) fn at_fraction(&self, position: f64) -> f64 {
        let (s, c) = sincos(position * STEP);
        c * self.re - s * self.im - self.offset
    }

    /// Whether the piece's sinusoid reaches down to `value` anywhere on the circle.
    pub(super) fn dips_to(&self, value: f64) -> bool {
        let height = -(value + self.offset);
        height <= 0.0 || self.re * self.re + self.im * self.im >= height * height
    }

    /// Place of the sinusoid's minimum, grid steps in [0, 129 600); it may lie outside of the
    /// piece.
    pub(super) fn minimum(&self) -> f64 {
        circle(atan2(self.im, -self.re) / STEP)
    }

    /// Place of the sinusoid's maximum, grid steps in [0, 129 600); it may lie outside of the
    /// piece.
    pub(super) fn maximum(&self) -> f64 {
        circle(atan2(-self.im, self.re) / STEP)
    }

    /// Adds a multiple of a term to the piece.
    fn turn(&mut self, term: Term, times: f64) {
        self.re += times * term.re;
        self.im += times * term.im;
        self.offset += times * term.offset;
    }
}

/// Reduces a position in grid steps to [0, 129 600) from at most a few turns outside.
fn circle(position: f64) -> f64 {
    let turned = position - CIRCLE * libm::floor(position / CIRCLE);
    // Rounding may leave the position slightly outside.
    if (0.0..CIRCLE).contains(&turned) { turned } else { 0.0 }
}

/// The terms, their crossings in order, and the sum's first piece (3.6 KiB on the board).
pub(super) struct Sweep {
    /// Terms of the sum.
    terms: Vec<Term, CAPACITY>,
    /// Crossings in the order of their place.
    crossings: Vec<Crossing, { 2 * CAPACITY }>,
    /// Piece at index 0, before the first crossing.
    start: Piece,
    /// Bound on the difference between a piece at a grid index and the exact sum there.
    pub(super) rounding: f64,
}

impl Sweep {
    /// Sweep without terms; [`Self::fill`] it in place, so that it is never moved on the stack.
    pub(super) fn empty() -> Self {
        let start = Piece { re: 0.0, im: 0.0, offset: 0.0, from: 0.0, to: CIRCLE };
        Self { terms: Vec::new(), crossings: Vec::new(), start, rounding: 0.0 }
    }

    /// Adds the terms of `series` and sorts their crossings.
    pub(super) fn fill(&mut self, series: &Series) {
        let half = f64::from(series.step()) * (0.5 * STEP);
        let radius = 2.0 * ONE * libm::sin(fabs(half));
        let quarter = f64::from(QUARTER * series.step().signum());
        for (index, pair) in (0_i32..).zip(series.values().windows(2)) {
            let phase = (f64::from(index) + 0.5) * f64::from(series.step()) + quarter;
            self.add(radius, circle(phase), (pair[1] - pair[0]) as f64);
        }
        // Positions are not negative, so their bit patterns are ordered as the numbers are.
        sort(&mut self.crossings, |a, b| a.at.to_bits() < b.at.to_bits());
    }

    /// Adds the term `radius` · cos(A + `phase`) − `offset`, with the phase in grid steps.
    fn add(&mut self, radius: f64, phase: f64, offset: f64) {
        // Nearer to tangency than this, rounding could swap the two crossings, and the term is zero
        // to 1e-3 units between them.
        const TANGENT: f64 = 1.0 - 1e-13;
        let (sine, cosine) = sincos(phase * STEP);
        let term = Term { re: radius * cosine, im: radius * sine, offset };
        let mut positive = offset < 0.0;
        let ratio = offset / radius;
        if fabs(ratio) < TANGENT {
            let width = acos(ratio) * (0.5 * CIRCLE / PI);
            let (rise, fall) = (circle(-phase - width), circle(-phase + width));
            positive = rise > fall;
            self.cross(rise, true);
            self.cross(fall, false);
        }
        self.start.turn(term, if positive { 1.0 } else { -1.0 });
        // The bound grows by one unit for the two entries, and by the rounding of the partial sums.
        self.rounding += 1.0 + (radius + fabs(offset)) * (PARTIAL_SUMS * f64::EPSILON);
        // The rounding of the table's cos A and sin A acts on the piece's sinusoid.
        self.rounding += 0.7072 * radius / ONE;
        // A series holds fewer terms than the capacity, so the push cannot fail.
        let _ = self.terms.push(term);
    }

    /// Stores a crossing of the term that is being added.
    fn cross(&mut self, at: f64, rises: bool) {
        // Two crossings for each of fewer terms than the capacity always fit.
        let _ = self.crossings.push(Crossing { at, term: self.terms.len() as u16, rises });
    }

    /// Pieces from index 0 round the circle, empty ones included.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let mut state = self.start;
        let end = Crossing { at: CIRCLE, term: u16::MAX, rises: false };
        self.crossings.iter().copied().chain(core::iter::once(end)).map(move |crossing| {
            let piece = Piece { to: crossing.at, ..state };
            state.from = crossing.at;
            if let Some(&term) = self.terms.get(usize::from(crossing.term)) {
                state.turn(term, if crossing.rises { 2.0 } else { -2.0 });
            }
            piece
        })
    }
}

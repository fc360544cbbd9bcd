//! The integer arithmetic of one second-order section.
//!
//! Two trapezoidal integrators in a loop (the state-variable form of the bilinear transform). With
//! input x, levels L and the doubled slope E:
//!
//! ```text
//! W = m E + f (x − L)      E ← 4W − E      L′ = L + 4 f W      y = (L + L′) / 2
//! ```
//!
//! Eliminating E and L gives yₙ = −a₁yₙ₋₁ − a₂yₙ₋₂ + p (xₙ + 2xₙ₋₁ + xₙ₋₂)/4 with
//! p = 1 + a₁ + a₂ = 8f² and 1 − a₂ = 2 − 4m − 4f² (asserted in `host-tests/tests/cores/butterworth.rs`
//! against scipy's coefficients). Why this form:
//!
//! * A constant input can only rest at E = 0, L = x: the gain at zero frequency is 1 whatever the
//!   rounding of f and m.
//! * p is tiny at low cutoffs, (2π fc/fs)². Its root f ≈ 2.2 fc/fs fits 32 bits with a relative
//!   step of 10⁻⁵ at fc/fs = 10⁻⁵, and rounding inside the loop passes only one factor 1/f.
//! * There is no input history to keep, and y is passed on as the sum L + L′, a scale of 2.
//!
//! Products keep the upper 64 of 96 bits (`umull`, `umlal`, `smlal` on a Cortex-M4), rounded down.

#![expect(clippy::inline_always, reason = "else they are calls where the compiler saves flash")]

use core::sync::atomic::{Ordering, compiler_fence};

/// The gains m and f of one section, both in [0, 1/2) in steps of 2⁻³².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Gains {
    /// m, how much of the slope stays.
    pub(super) memory: i32,
    /// f, the frequency gain of both integrators.
    pub(super) frequency: i32,
}

/// State of one section: its two integrators, in steps of its input.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    /// Doubled slope E.
    slope: i64,
    /// Level L.
    level: i64,
}

impl State {
    /// Steady state for the constant `input`: E = 0 and L = `input`.
    pub(super) const fn at_rest(input: i64) -> Self {
        Self { slope: 0, level: input }
    }

    /// Takes one input and returns the output, doubled.
    #[inline(always)]
    pub(super) fn update(&mut self, gains: Gains, input: i64) -> i64 {
        let Self { slope, level } = *self;
        let change = 4 * weighted_sum(input - level, gains.frequency, slope, gains.memory);
        self.slope = change - slope;
        let next = level + scaled(change, gains.frequency);
        // The fence emits no instruction. It makes LLVM read L again rather than hold it, and keeps
        // it from interleaving two sections: both have more live values than a Cortex-M4 has
        // registers.
        compiler_fence(Ordering::SeqCst);
        let output = self.level + next;
        self.level = next;
        output
    }
}

/// ⌊`value` · `gain` / 2³²⌋.
#[inline(always)]
fn scaled(value: i64, gain: i32) -> i64 {
    upper(low_product(value, gain)) + high_product(value, gain)
}

/// ⌊(`a` · `gain_a` + `b` · `gain_b`) / 2³²⌋.
#[inline(always)]
fn weighted_sum(a: i64, gain_a: i32, b: i64, gain_b: i32) -> i64 {
    // Gains are below 2³¹, so each product is below 2⁶³ and the sum fits.
    let low = low_product(a, gain_a) + low_product(b, gain_b);
    upper(low) + high_product(a, gain_a) + high_product(b, gain_b)
}

/// The upper half of a non-negative product.
#[inline(always)]
fn upper(product: u64) -> i64 {
    i64::from((product >> 32) as u32)
}

/// The signed upper half of `value` times `gain`.
#[inline(always)]
fn high_product(value: i64, gain: i32) -> i64 {
    i64::from((value >> 32) as i32) * i64::from(gain)
}

/// The unsigned lower half of `value` times `gain`, which is not negative.
#[inline(always)]
fn low_product(value: i64, gain: i32) -> u64 {
    u64::from(value as u32) * u64::from(gain as u32)
}

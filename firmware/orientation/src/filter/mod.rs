//! Butterworth low-pass of order 2 to 8 in wide fixed point.
//!
//! [`Coefficients`] are designed once in `f64` and never change; a [`Filter`] is the state of one
//! signal. The work per sample is integer only, without branches or loops that depend on data.
//!
//! ```
//! use orientation::{filter::{Coefficients, Filter}, units::AngularRate};
//!
//! let low_pass = Coefficients::<3>::low_pass(1.0, 100.0)?; // order 6, 1 Hz at 100 samples/s
//! let mut filter = Filter::at_rest(AngularRate(72_921));
//! assert_eq!(filter.update(&low_pass, AngularRate(72_921)), AngularRate(72_921));
//! # Ok::<(), orientation::filter::DesignError>(())
//! ```

mod design;
mod sections;

pub use design::{Coefficients, DesignError, Section};

use crate::units::AngularRate;
use sections::State;

/// Fraction bits of the last section's output; [`Filter`] documents the headroom that they leave.
const OUTPUT_BITS: u32 = 28;

/// The state of one filtered signal, order 2·`SECTIONS`.
///
/// Figures, asserted in `host-tests/tests/cores/butterworth.rs` for all orders and fc/fs of 10⁻⁵ to 1/4:
/// a constant comes out exact; the error against the same filter in `f64` is at most 0.30 LSB RMS,
/// of which rounding the output alone is 0.289. `cargo cost` counts the instructions of a sample.
///
/// **No overflow.** The largest internal value is the step 4W of the last section, whose L1 norm
/// (the sum of its absolute impulse response, so the peak that full scale ±2³¹ can reach with the
/// worst input there is) is at most 5.8 for orders up to 8 and fc/fs up to 1/4. In steps of
/// 2⁻²⁷ LSB this is 5.8 · 2⁵⁸ < 2⁶¹, a quarter of `i64`. The sections come in order of growing
/// quality factor, which keeps the earlier norms smaller.
///
/// Sections past 1 to 4 do not compile:
/// ```compile_fail
/// let filter = orientation::filter::Filter::<5>::at_rest(Default::default());
/// ```
#[derive(Clone, Debug)]
pub struct Filter<const SECTIONS: usize> {
    /// States of the sections, in the order in which the signal passes them.
    sections: [State; SECTIONS],
}

impl<const SECTIONS: usize> Filter<SECTIONS> {
    /// Fraction bits of the first section's input: every section passes its output on doubled.
    const INPUT_BITS: u32 = OUTPUT_BITS - SECTIONS as u32;

    /// Steady state for the constant input `x` (any value), as if it had been applied for ever.
    #[must_use]
    pub fn at_rest(x: AngularRate) -> Self {
        const { assert!(SECTIONS >= 1 && SECTIONS <= 4, "a filter has 1 to 4 sections") };
        let input = widen(x.0, Self::INPUT_BITS);
        Self { sections: core::array::from_fn(|index| State::at_rest(input << index)) }
    }

    /// Takes the sample `x` (any value), returns the filtered rate in the same unit.
    ///
    /// Rounds to nearest (ties up) and saturates: the step response overshoots, so an input near
    /// full scale may clip the output, which recovers completely because the state does not clip.
    ///
    /// Use one set of `coefficients` per filter. For another cutoff begin anew with
    /// [`Filter::at_rest`] at the last output: the state of one cutoff means a step to another.
    #[inline]
    pub fn update(&mut self, coefficients: &Coefficients<SECTIONS>, x: AngularRate) -> AngularRate {
        let mut signal = widen(x.0, Self::INPUT_BITS);
        signal = self.section::<0>(coefficients, signal);
        signal = self.section::<1>(coefficients, signal);
        signal = self.section::<2>(coefficients, signal);
        signal = self.section::<3>(coefficients, signal);
        AngularRate(narrow(signal))
    }

    /// Passes the signal through one section, if there is one at this index. A loop would not be
    /// unrolled where the compiler saves flash, and an index that is no constant would be checked.
    #[inline]
    fn section<const INDEX: usize>(
        &mut self,
        coefficients: &Coefficients<SECTIONS>,
        signal: i64,
    ) -> i64 {
        if INDEX >= SECTIONS {
            return signal;
        }
        self.sections[INDEX].update(coefficients.gains[INDEX], signal)
    }
}

/// `value` · 2^`bits`, for 1 to 31 bits.
#[inline]
fn widen(value: i32, bits: u32) -> i64 {
    // Put together from halves: LLVM spends one instruction on each, four on the plain shift.
    let low = (value as u32) << bits;
    (i64::from(value >> (32 - bits)) << 32) | i64::from(low)
}

/// `wide` / 2^[`OUTPUT_BITS`], rounded to nearest and saturated.
#[inline]
fn narrow(wide: i64) -> i32 {
    const LIMIT: i32 = 1 << (OUTPUT_BITS - 1);
    let rounded = wide + (1 << (OUTPUT_BITS - 1));
    // Saturating the upper half is one instruction; the lower half then follows the sign.
    let high = (rounded >> 32) as i32;
    let clamped = high.clamp(-LIMIT, LIMIT - 1);
    let low = if clamped == high { rounded as u32 } else { !(high >> 31) as u32 };
    (clamped << (32 - OUTPUT_BITS)) | (low >> OUTPUT_BITS).cast_signed()
}

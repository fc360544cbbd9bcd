//! Design of the Butterworth coefficients, and of the step-response sums that the dwell average
//! needs.
//!
//! Bilinear transform with prewarping, g = tan(π fc/fs). The poles of order 2S lie at the angles
//! θ = π(2i + 1)/(4S) from the real axis, k = 1/Q = 2 cos θ, and each section has
//! p = 1 + a₁ + a₂ = 4g²/n and 1 − a₂ = 2gk/n with n = 1 + gk + g². (Oppenheim and Schafer,
//! *Discrete-Time Signal Processing*, 3rd edition, §7.2; scipy's `butter` is the oracle in tests.)

use super::sections::Gains;
use core::f64::consts::PI;

/// Highest cutoff as a part of the sample rate; beyond it p would not fit the gains.
const HIGHEST_RATIO: f64 = 0.25;

/// Lowest cutoff as a part of the sample rate; below it the gains lose their fourth digit.
const LOWEST_RATIO: f64 = 1e-5;

/// Steps of the fixed-point gains in one.
const GAIN_STEPS: f64 = 4_294_967_296.0;

/// Deviation from the final value below which a step counts as settled.
const SETTLED: f64 = 1e-6;

/// Reason for which a low-pass cannot be designed, with its remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignError {
    /// Cutoff or sample rate is zero, negative, infinite or not a number: give both in Hz.
    NotPositive,
    /// The cutoff is above a quarter of the sample rate: lower it or sample faster.
    CutoffTooHigh,
    /// The cutoff is below 10⁻⁵ of the sample rate: raise it or average samples first.
    CutoffTooLow,
}

crate::words! { DesignError:
    Self::NotPositive => "cutoff and sample rate must be positive numbers: give both in Hz";
    Self::CutoffTooHigh =>
        "the cutoff is above 1/4 of the sample rate: lower the cutoff or sample faster";
    Self::CutoffTooLow =>
        "the cutoff is below 1/100000 of the sample rate: raise it or average samples first";
}

impl core::error::Error for DesignError {}

/// One section p (1 + z⁻¹)²/4 / (1 + a₁z⁻¹ + a₂z⁻²) as the quantised gains realise it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// p = 1 + a₁ + a₂, within 2·10⁻⁵ of its value at fc/fs = 10⁻⁵ and closer above. It keeps
    /// digits that the sum of a₁ and a₂ in `f64` loses.
    pub p: f64,
    /// a₁ in (−2, 0], within 1.4·10⁻⁹ of the design.
    pub a1: f64,
    /// a₂ in [0, 1), within 4.7·10⁻¹⁰ of the design.
    pub a2: f64,
}

/// An immutable low-pass of order 2·`SECTIONS`, 1 to 4 sections (others do not compile).
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients<const SECTIONS: usize> {
    /// Gains of the sections in order of growing quality factor.
    pub(super) gains: [Gains; SECTIONS],
    /// Σ (1 − s(k)) over k ≥ 0 in samples, s being the unit step response and s(0) the output at
    /// the sample that brings the step: the delay of slow signals. Closed form, Σ (1 − a₂)/p.
    pub lag: f64,
    /// Σ (1 − s(k))² over k ≥ 0 in samples, summed until settled, to 10⁻⁹ of its value.
    pub lag_power: f64,
    /// The first k from which on |1 − s| stays below 10⁻⁶, in samples: 3.1, 5.5, 8.0 and 10.7
    /// periods of the cutoff for orders 2, 4, 6 and 8, up to 1.6 times that towards fc/fs = 1/4.
    pub settling: u32,
}

impl<const SECTIONS: usize> Coefficients<SECTIONS> {
    /// Designs the low-pass with −3 dB at `cutoff_hz` for `rate_hz` samples per second.
    ///
    /// The ratio of the two is 10⁻⁵ to 1/4. The response stays within 0.001 dB of the ideal one
    /// down to −60 dB. The design follows its own step response in `f64` for about one and a half
    /// times the filter's [settling](Self::settling): on a small core, design a filter of many
    /// thousand samples at start, not in passing.
    ///
    /// # Errors
    /// [`DesignError`] if an argument or the ratio is out of range.
    pub fn low_pass(cutoff_hz: f64, rate_hz: f64) -> Result<Self, DesignError> {
        const { assert!(SECTIONS >= 1 && SECTIONS <= 4, "a filter has 1 to 4 sections") };
        let ratio = checked_ratio(cutoff_hz, rate_hz)?;
        let tangent = libm::tan(PI * ratio);
        let gains = core::array::from_fn(|index| {
            let angle = PI * (2 * index + 1) as f64 / (4 * SECTIONS) as f64;
            Gains::of(tangent, 2.0 * libm::cos(angle))
        });
        let (settling, lag_power) = step_response(&gains);
        let lag = gains.iter().map(|section| section.loss() / section.p()).sum();
        Ok(Self { gains, lag, lag_power, settling })
    }

    /// Σ s(k) and Σ s(k)² over the first `samples` samples of the unit step response; followed in
    /// `f64` where it has not settled by then.
    #[must_use]
    pub fn step_sums(&self, samples: u32) -> [f64; 2] {
        if samples >= self.settling {
            let count = f64::from(samples);
            return [count - self.lag, count - 2.0 * self.lag + self.lag_power];
        }
        let mut states = [(0.0, 1.0); SECTIONS];
        (0..samples).fold([0.0, 0.0], |[sum, squares], _| {
            let response = 1.0 - fall(&self.gains, &mut states);
            [sum + response, squares + response * response]
        })
    }

    /// The sections as they are realised, in order of growing quality factor.
    #[must_use]
    pub fn quantised(&self) -> [Section; SECTIONS] {
        self.gains.map(|gains| Section {
            p: gains.p(),
            a1: gains.p() + gains.loss() - 2.0,
            a2: 1.0 - gains.loss(),
        })
    }
}

/// Checks both frequencies, Hz, and returns the cutoff as a fraction of the sample rate, 10⁻⁵ to
/// 1/4.
fn checked_ratio(cutoff_hz: f64, rate_hz: f64) -> Result<f64, DesignError> {
    let is_usable = |value: f64| value.is_finite() && value > 0.0;
    if !is_usable(cutoff_hz) || !is_usable(rate_hz) {
        return Err(DesignError::NotPositive);
    }
    match cutoff_hz / rate_hz {
        ratio if ratio > HIGHEST_RATIO => Err(DesignError::CutoffTooHigh),
        ratio if ratio < LOWEST_RATIO => Err(DesignError::CutoffTooLow),
        ratio => Ok(ratio),
    }
}

impl Gains {
    /// Fixed-point gains of a section from the prewarped frequency `g` = tan(π fc/fs) and `k` =
    /// 1/Q; each rounds to nearest.
    fn of(g: f64, k: f64) -> Self {
        let n = 1.0 + g * k + g * g;
        let frequency = libm::round(g / libm::sqrt(2.0 * n) * GAIN_STEPS);
        // The rounded f enters m, so that the rounding of f does not affect the damping.
        let realised = frequency / GAIN_STEPS;
        let memory = 0.5 - 0.5 * g * k / n - realised * realised;
        Self { memory: libm::round(memory * GAIN_STEPS) as i32, frequency: frequency as i32 }
    }

    /// Frequency gain f as a fraction.
    fn f(self) -> f64 {
        f64::from(self.frequency) / GAIN_STEPS
    }

    /// Memory gain m as a fraction.
    fn m(self) -> f64 {
        f64::from(self.memory) / GAIN_STEPS
    }

    /// Section constant p = 1 + a₁ + a₂ = 8f².
    fn p(self) -> f64 {
        8.0 * self.f() * self.f()
    }

    /// Damping term 1 − a₂ = 2 − 4m − 4f².
    fn loss(self) -> f64 {
        2.0 - 4.0 * self.m() - 4.0 * self.f() * self.f()
    }
}

/// Settling in samples and Σ (1 − s(k))², from the free decay of a filter at rest at 1 towards 0.
fn step_response<const SECTIONS: usize>(gains: &[Gains; SECTIONS]) -> (u32, f64) {
    // States below this limit cannot lift the output to `SETTLED` again.
    const STILL: f64 = 1e-3 * SETTLED;
    let mut states = [(0.0, 1.0); SECTIONS];
    let (mut settling, mut power, mut count) = (0, 0.0, 0);
    let moves = |(slope, level): &(f64, f64)| libm::fabs(*slope) + libm::fabs(*level) > STILL;
    while states.iter().any(moves) {
        let rest = fall(gains, &mut states);
        power += rest * rest;
        count += 1;
        if libm::fabs(rest) >= SETTLED {
            settling = count;
        }
    }
    (settling, power)
}

/// One sample of the sections without input: [`super::sections::State::update`] in `f64`.
fn fall(gains: &[Gains], states: &mut [(f64, f64)]) -> f64 {
    gains.iter().zip(states).fold(0.0, |input, (gains, (slope, level))| {
        let before = *level;
        let change = 4.0 * (gains.m() * *slope + gains.f() * (input - before));
        *slope = change - *slope;
        *level += gains.f() * change;
        0.5 * (before + *level)
    })
}

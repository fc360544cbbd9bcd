//! Covariance of the terms of two Allan variances, for each power law of noise.
//!
//! A term is a second difference of the angle. With s the generalised autocovariance of the angle
//! (C. A. Greenhall, "The generalized autocovariance", 1999), the covariance of a term of span m and
//! one of span M whose middles lie u apart is the second difference of s with width m, of which that
//! with width M is taken. The laws, τ₀ the lattice's step:
//!
//! | noise | s(u) | second difference of width m |
//! |---|---|---|
//! | Q | Q² at 0, else 0 | Q² (1 at ±m, −2 at 0) |
//! | N | −N²τ₀·\|u\|/2 | −N²τ₀·(m − \|u\|)₊ |
//! | B | B²τ₀²/(2π)·u² ln\|u\| | B²τ₀²/(2π)·m²·(2 ln\|u\| + 3 − …) |
//! | K | K²τ₀³·\|u\|³/12 | K²τ₀³·(m²·\|u\|/2 + (m − \|u\|)₊³/6) |
//!
//! Lags are integers, so that hats are exact in `f32`; what is large and cancels (s itself) never
//! appears.

/// A pair of spans on their common lattice, m ≤ M, and the weights of the laws.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernel {
    /// Span of the shorter terms m, steps.
    pub short: i32,
    /// Span of the longer terms M, steps.
    pub long: i32,
    /// Weight of the shape of each law, Q, N, B and K, in the covariance.
    pub weights: [f32; 4],
}

impl Kernel {
    /// Covariance of two terms whose middles lie `lag` steps apart.
    pub(crate) fn at(&self, lag: i32) -> f32 {
        let [q, n, b, k] = self.weights;
        let (m, long) = (self.short as f32, self.long as f32);
        let mut sum = 0.0;
        for (place, factor) in [(lag + self.long, 1.0), (lag, -2.0), (lag - self.long, 1.0)] {
            let distance = place.abs();
            let hat = (self.short - distance).max(0) as f32 / m;
            let comb = if distance == 0 { -2.0 } else { f32::from(distance == self.short) };
            sum += factor * (q * comb - n * hat + k * (m / long) * hat * hat * hat / 6.0);
            if b > 0.0 {
                sum += factor * b * flicker(distance as f32 / m, long / m);
            }
        }
        // The second part of K: the second difference of |u|/2 is a triangle of the longer width.
        sum + k * (self.long - lag.abs()).max(0) as f32 / long
    }
}

/// Second difference of width 1 of u² ln(|u|/`scale`). The scale cancels in the second difference
/// of width M/m that is taken of it.
fn flicker(u: f32, scale: f32) -> f32 {
    if u < 2.0 {
        return square_log(u + 1.0) - 2.0 * square_log(u) + square_log(u - 1.0)
            - 2.0 * libm::logf(scale);
    }
    // (1 + x)² ln(1 + x) + (1 − x)² ln(1 − x) = 3x² − Σ x²ᵏ/(k(k−1)(2k−1)); the rest is below 4e-6.
    let square = 1.0 / (u * u);
    let series = 1.0 / 6.0 + square * (1.0 / 30.0 + square * (1.0 / 84.0 + square / 180.0));
    2.0 * libm::logf(u / scale) + 3.0 - square * series
}

/// Function u² ln|u|, continued by zero at u = 0.
fn square_log(u: f32) -> f32 {
    if u == 0.0 { 0.0 } else { u * u * libm::logf(u.abs()) }
}

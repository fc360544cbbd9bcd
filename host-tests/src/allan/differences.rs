//! Sums of squared differences of one segment's phase, each in one pass.
//!
//! `x` is the phase in units of one period: the running sum of n rates, n + 1 values from zero; `m`
//! is the averaging factor. The definitions are those of NIST SP 1065,
//! section 5.2.

/// Squares and how many they are.
#[derive(Clone, Copy, Default)]
pub(super) struct Sum {
    /// Sum of the squares.
    pub squares: f64,
    /// How many.
    pub terms: u64,
}

impl Sum {
    /// Squares of both, and how many they are.
    pub fn with(self, other: Self) -> Self {
        Self { squares: self.squares + other.squares, terms: self.terms + other.terms }
    }

    /// Sums the squares of these differences.
    fn of(differences: impl Iterator<Item = f64>) -> Self {
        differences.fold(Self::default(), |sum, difference| Self {
            squares: sum.squares + difference * difference,
            terms: sum.terms + 1,
        })
    }
}

/// The places at which a span of `width` steps can begin.
fn starts(x: &[f64], width: usize) -> std::ops::Range<usize> {
    0..x.len().saturating_sub(width)
}

/// Second differences at every `stride`-th place.
pub(super) fn second(x: &[f64], m: usize, stride: usize) -> Sum {
    Sum::of(starts(x, 2 * m).step_by(stride).map(|i| x[i + 2 * m] - 2.0 * x[i + m] + x[i]))
}

/// Third differences at every `stride`-th place.
pub(super) fn third(x: &[f64], m: usize, stride: usize) -> Sum {
    let difference = |i| x[i + 3 * m] - 3.0 * (x[i + 2 * m] - x[i + m]) - x[i];
    Sum::of(starts(x, 3 * m).step_by(stride).map(difference))
}

/// Means of m neighbouring second differences, from a sum that slides.
pub(super) fn modified(x: &[f64], m: usize) -> Sum {
    let difference = |i: usize| x[i + 2 * m] - 2.0 * x[i + m] + x[i];
    let places = starts(x, 3 * m - 1);
    if places.is_empty() {
        return Sum::default();
    }
    let mut sum: f64 = (0..m).map(difference).sum();
    Sum::of(places.map(|i| {
        let mean = sum / m as f64;
        if i + 3 * m < x.len() {
            sum += difference(i + m) - difference(i);
        }
        mean
    }))
}

/// Second differences around every inner place of the phase, which is continued beyond its ends by
/// reflection through them. Segments shorter than two windows take no part.
pub(super) fn total(x: &[f64], m: usize) -> Sum {
    let last = x.len() - 1;
    if 2 * m > last {
        return Sum::default();
    }
    let before = |i: usize| if i >= m { x[i - m] } else { 2.0 * x[0] - x[m - i] };
    let after = |i: usize| {
        if i + m <= last { x[i + m] } else { 2.0 * x[last] - x[2 * last - i - m] }
    };
    Sum::of((1..last).map(|i| before(i) - 2.0 * x[i] + after(i)))
}

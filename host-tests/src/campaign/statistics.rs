//! What many errors amount to.

/// Root mean square; zero of none.
#[must_use]
pub fn rms(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// The least absolute value; not a number of none.
#[must_use]
pub fn least(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(f64::NAN, f64::min)
}

/// Per cent of errors within one, two and three of their standard deviations.
#[must_use]
pub fn coverage(errors: &[f64], sigmas: &[f64]) -> [f64; 3] {
    [1.0, 2.0, 3.0].map(|factor| {
        let pairs = errors.iter().zip(sigmas);
        let inside = pairs.filter(|(error, sigma)| error.abs() <= factor * **sigma).count();
        100.0 * inside as f64 / errors.len().max(1) as f64
    })
}

/// What a normal distribution covers, per cent.
pub const NORMAL_COVERAGE: [f64; 3] = [68.27, 95.45, 99.73];

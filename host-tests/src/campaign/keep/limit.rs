//! What a gyro leaves at least to an azimuth that it stores after a rest.

use orientation::noise::model::GyroNoise;

/// Variance of the difference of two adjacent means, over `a` and over `b` seconds, (rad/s)².
///
/// N and Q of either; K²(a + b)/3; R²(a + b)²/4; and of flicker with S(f) = B²/(π f), whatever its
/// cut-offs, B²/π · (a + b)/(ab) · [(a + b) ln(a + b) − a ln a − b ln b], which for a = b is twice the
/// Allan variance (2 ln 2/π)B².
#[must_use]
pub fn adjacent_variance(noise: &GyroNoise, a: f64, b: f64) -> f64 {
    let whole = a + b;
    let (bias, k, r) = (noise.bias_instability, noise.rate_random_walk, noise.rate_ramp);
    // (a + b) ln(a + b) − a ln a − b ln b without the logarithms of units.
    let entropy = -a * (a / whole).ln() - b * (b / whole).ln();
    noise.own_variance(a)
        + noise.own_variance(b)
        + k.0 * k.0 * whole / 3.0
        + 0.25 * r.0 * r.0 * whole * whole
        + bias.0 * bias.0 / std::f64::consts::PI * whole / (a * b) * entropy
}

/// 1σ of an azimuth, rad, that had `start`, rad, when it was handed over after a rest of `rest` seconds, after
/// `stored` more: on a base that does not move, by a gyro whose scale is exact.
#[must_use]
pub fn stored_sigma(noise: &GyroNoise, start: f64, rest: f64, stored: f64) -> f64 {
    start.hypot(stored * adjacent_variance(noise, rest, stored).sqrt())
}

//! Angles that are compared.

/// Distance of two azimuths the short way, °.
pub fn distance(a: f64, b: f64) -> f64 {
    ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs()
}

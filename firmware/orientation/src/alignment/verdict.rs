//! Verdict of an alignment: an azimuth with its standard deviation, or the reason for none.

/// An azimuth that passed every test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Azimuth {
    /// Azimuth of body x from true north, clockwise from above, rad, [0, 2π).
    pub angle: f64,
    /// Standard deviation of the azimuth, 1σ, rad: the whole error budget.
    pub sigma: f64,
}

//! A base that turns slowly about the vertical, which an alignment takes for one that stands where its data show too
//! little of it: how slowly that is, and where it puts north.

/// What the data of an alignment show of a base that turns slowly about the vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowTurn {
    /// 1σ of the base's rate as the data show it, rad/s; infinite where they do not.
    pub sigma: f64,
    /// By how much the azimuth at the end is off where that rate is taken for none, over it, s: half the time for
    /// which the base turned, and what a tilt lets the gyro feel of the rate itself.
    pub lever: f64,
}

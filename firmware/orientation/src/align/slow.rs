//! A base that moves slowly, which an alignment takes for one that stands where its data show too little of it: how
//! slowly that is, and where it puts north.

/// What the data of an alignment show of a slow motion of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowMotion {
    /// 1σ of its rate as the data show it, rad/s; infinite where they do not.
    pub sigma: f64,
    /// By how much the azimuth at the end is off where that rate is taken for none, over it, s. Of a turn about the
    /// vertical it is half the time for which the base turned, and what a tilt lets the gyro feel of the rate itself; of
    /// a tilting, one over the horizontal Earth rate at the most.
    pub lever: f64,
}

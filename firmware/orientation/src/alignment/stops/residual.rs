//! What the solution leaves of each stop: how far the vertical levelled there is from the one to which the Earth turned it,
//! seen on the frame that the gyros carried.

use super::path::Path;
use super::place::up;
use super::plain::End;
use crate::math::rotation::{Matrix, Vector, cross, difference, turned};

/// Residual of the vertical at a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Levelled less predicted vertical, along north and east of the start, rad. Gyro biases are
    /// compensated, accelerometer biases and scale errors are not.
    pub tilt: [f64; 2],
    /// Standard deviation of either from white noise alone, 1σ, rad.
    pub sigma: f64,
}

impl Residual {
    /// Residual of a stop on a path, for the rotation from body axes to north, east, down at the start,
    /// the gyros' biases, rad/s, and their angle random walk, rad/√s.
    pub(crate) fn of(
        path: &Path,
        stop: usize,
        (start, biases): (&Matrix, &Vector),
        angle_random_walk: f64,
    ) -> Self {
        let end = End::of(path.blocks.of(stop), path.displaced(stop));
        let (carried, error) = (end.up(), turned(&end.bias, biases));
        let levelled = turned(start, &difference(&carried, &cross(&error, &carried)));
        let since = end.middle - path.start;
        let predicted = up(&path.place.navigation(since, end.displacement));
        let [north, east, _] = difference(&levelled, &predicted);
        let walked = angle_random_walk * angle_random_walk * since.max(0.0);
        let felt = path.density() / (path.gravity * path.gravity * end.seconds);
        Self { tilt: [north, east], sigma: libm::sqrt(walked + felt) }
    }
}

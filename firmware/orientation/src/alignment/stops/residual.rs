//! What the solution leaves of each stop: how far the vertical levelled there is from the one to which the Earth turned it,
//! seen on the frame that the gyros carried.

use super::drift::Drift;
use super::path::Path;
use super::place::up;
use super::plain::End;
use crate::math::rotation::{Matrix, Vector, difference, turned};
use crate::units::{Radians, RadiansPerRootSecond, RadiansPerSecond};

/// Residual of the vertical at a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Levelled less predicted vertical, along north and east of the start. Gyro biases are
    /// compensated, accelerometer biases and scale errors are not.
    pub tilt: [Radians; 2],
    /// Standard deviation of either from white noise and missing samples alone, 1σ.
    pub sigma: Radians,
}

impl Residual {
    /// Residual of a stop on a path, for the rotation from body axes to north, east, down at the start,
    /// the gyros' biases and their angle random walk.
    pub(crate) fn of(
        path: &Path,
        stop: usize,
        (start, biases): (&Matrix, &[RadiansPerSecond; 3]),
        angle_random_walk: RadiansPerRootSecond,
    ) -> Self {
        let end = End::of(path.blocks.of(stop), path.displaced(stop));
        let mut drift = before(path, stop, biases.map(|bias| bias.0));
        let _ = drift.carry(&end.bias.map(|row| row.map(|part| part as f32)));
        let levelled = turned(start, &turned(&drift.back, &end.up()));
        let since = end.middle - path.start;
        let predicted = up(&path.place.navigation(since, end.displacement));
        let [north, east, _] = difference(&levelled, &predicted);
        let walked = angle_random_walk.0 * angle_random_walk.0 * since.max(0.0)
            + f64::from(path.carried.lost);
        let felt = path.density() / (path.gravity * path.gravity * end.seconds);
        Self { tilt: [Radians(north), Radians(east)], sigma: Radians(libm::sqrt(walked + felt)) }
    }
}

/// Drift by these biases, rad/s, until a stop.
fn before(path: &Path, stop: usize, biases: Vector) -> Drift {
    let mut drift = Drift::by(biases);
    for index in 0..stop {
        for block in path.blocks.of(index).chain(path.drives.of(index)) {
            let _ = drift.carry(&block.bias);
        }
    }
    drift
}

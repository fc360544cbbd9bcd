//! Original method of Szymanowski 2003: the first stop and the last, without estimation of sensor
//! errors.

use super::Setting;
use super::block::Block;
use super::inclination::Inclination;
use super::path::Path;
use super::place::up;
use crate::math::brent::Minimum;
use crate::math::rotation::{
    Matrix, Vector, about_down, cross, dot, length, levelled, product, scaled, sum, transposed,
    turned, unit,
};
use crate::signal::strapdown::Rough;
use crate::units::Radians;

/// Part of a single stop that counts as its beginning, and as its end.
const END: f64 = 1.0 / 3.0;

/// Result of the method.
#[derive(Clone, Copy, Debug)]
pub struct Plain {
    /// Function U for any azimuth.
    pub inclination: Inclination,
    /// Azimuth of body x at the first stop by the closed form.
    pub azimuth: Radians,
    /// Standard deviation of that azimuth, 1σ; it contains all errors of the gyros.
    pub sigma: Radians,
    /// Minimum of U as an angle, by bounded minimisation.
    pub angle: Minimum,
    /// Minimum of U in the paper's form, by bounded minimisation.
    pub euler: Minimum,
    /// Angle by which the up vector turned between the stops over the predicted one.
    pub ratio: f64,
    /// Standard deviation of that ratio, 1σ.
    pub ratio_sigma: f64,
}

/// Averages of the blocks at one end of the path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct End {
    /// Mean time, s.
    pub middle: f64,
    /// Total length, s.
    pub seconds: f64,
    /// Sum of forces times seconds, on the start frame.
    force: Vector,
    /// Mean attitude.
    attitude: Matrix,
    /// Mean sensitivity to gyro biases.
    pub bias: Matrix,
    /// Displacement from the first stop, m.
    pub displacement: [f64; 2],
}

impl End {
    /// Averages of these blocks, weighted by their lengths.
    pub(crate) fn of<'a>(blocks: impl Iterator<Item = &'a Block>, displacement: [f64; 2]) -> Self {
        let mut end = Self { displacement, ..Self::default() };
        for block in blocks {
            let seconds = f64::from(block.seconds);
            end.seconds += seconds;
            end.middle += seconds * block.middle;
            end.force = sum(&end.force, &scaled(&block.force.map(f64::from), seconds));
            add(&mut end.attitude, &block.attitude, seconds);
            add(&mut end.bias, &block.bias, seconds);
        }
        let part = 1.0 / end.seconds;
        end.middle *= part;
        end.attitude = orthonormal(&end.attitude.map(|row| scaled(&row, part)));
        end.bias = end.bias.map(|row| scaled(&row, part));
        end
    }

    /// Unit vector of the mean force.
    pub(crate) fn up(&self) -> Vector {
        unit(&self.force)
    }
}

/// Adds a weighted matrix.
fn add(sums: &mut Matrix, part: &Rough, seconds: f64) {
    for (sums, part) in sums.iter_mut().zip(part) {
        *sums = sum(sums, &scaled(&part.map(f64::from), seconds));
    }
}

/// Orthonormalises the mean of nearly equal rotations, by one Newton step.
fn orthonormal(matrix: &Matrix) -> Matrix {
    let square = product(&product(matrix, &transposed(matrix)), matrix);
    core::array::from_fn(|row| {
        core::array::from_fn(|column| 1.5 * matrix[row][column] - 0.5 * square[row][column])
    })
}

impl Plain {
    /// Applies the method to a path with blocks at both of its ends; with the rotation from the
    /// frozen north, east, down of the start to the start frame.
    #[inline(never)]
    pub(crate) fn of(setting: &Setting, path: &Path) -> (Self, Matrix) {
        let (first, last) = ends(path);
        let level = levelled(&turned(&transposed(&first.attitude), &first.up()));
        // Rotation from the start frame to the first stop's level axes.
        let to_level = product(&level, &transposed(&first.attitude));
        let there = path.place.navigation(first.middle - path.start, first.displacement);
        let later = path.place.navigation(last.middle - path.start, last.displacement);
        let inclination = Inclination::new(
            turned(&to_level, &last.up()),
            turned(&transposed(&there), &up(&later)),
            product(&transposed(&last.attitude), &transposed(&to_level)),
        );
        let azimuth = inclination.closed_form();
        let north_to_level = product(&transposed(&about_down(azimuth)), &transposed(&there));
        let [carried, predicted] = inclination.turns();
        let (sigma, ratio_sigma) = sigmas(setting, path, &first, &last, predicted);
        let plain = Self {
            azimuth: Radians(azimuth),
            sigma: Radians(sigma),
            angle: inclination.minimised(Inclination::angle),
            euler: inclination.minimised(Inclination::euler),
            ratio: carried / predicted,
            ratio_sigma,
            inclination,
        };
        (plain, product(&transposed(&to_level), &north_to_level))
    }
}

/// Averages of the first stop and of the last, or of both ends of a single one.
fn ends(path: &Path) -> (End, End) {
    let last = path.stops.len().saturating_sub(1);
    let whole = path.stops.first().map_or([0.0; 2], |stop| [stop.from.0, stop.to.0]);
    let [early, late] = [END, 1.0 - END].map(|part| whole[0] + part * (whole[1] - whole[0]));
    let end = |stop: usize, is_in: &dyn Fn(f64) -> bool| {
        let blocks = path.blocks.of(stop).filter(|block| last > 0 || is_in(block.middle));
        End::of(blocks, path.displaced(stop))
    };
    (end(0, &|middle| middle <= early), end(last, &|middle| middle >= late))
}

/// Standard deviations, 1σ, of the azimuth, rad, and of the ratio of the up vector's rotation,
/// which is predicted as `turn` rad.
fn sigmas(setting: &Setting, path: &Path, first: &End, last: &End, turn: f64) -> (f64, f64) {
    let across = unit(&cross(&first.up(), &last.up()));
    let along = cross(&across, &last.up());
    let sigma = |direction: &Vector| {
        // A rotation φ of the frame moves the up vector along a direction p by φ·(up × p).
        let about = cross(&last.up(), direction);
        let site = &setting.site;
        let bias = setting.bias_sigma().0 * length(&weighted(&about, &last.bias, &first.bias));
        let scale = site.scale_sigma * length(&path.turned_about(&about));
        let force = site.accelerometer_bias_sigma.0 / path.gravity
            * length(&weighted(direction, &last.attitude, &first.attitude));
        let walk = site.noise.model().angle_random_walk;
        let noise = f64::from(path.carried.lost)
            + walk.0 * walk.0 * (last.middle - first.middle)
            + path.density() / (path.gravity * path.gravity)
                * (1.0 / first.seconds + 1.0 / last.seconds);
        let place = path.displacement_sigma(setting) * path.place.per_metre()[0];
        let parts = [bias, scale, force, place];
        libm::sqrt(parts.iter().map(|part| part * part).sum::<f64>() + noise) / turn
    };
    (sigma(&across), sigma(&along))
}

/// Difference of two matrices, multiplied from the left by a direction.
fn weighted(direction: &Vector, last: &Matrix, first: &Matrix) -> Vector {
    let columns = [transposed(last), transposed(first)];
    core::array::from_fn(|axis| {
        dot(direction, &columns[0][axis]) - dot(direction, &columns[1][axis])
    })
}

//! Szymanowski's own method: the first stop and the last, and nothing else.

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

/// Part of a single stop that counts as its beginning, and as its end.
const END: f64 = 1.0 / 3.0;

/// What the method finds.
#[derive(Clone, Copy, Debug)]
pub struct Plain {
    /// U for any azimuth.
    pub inclination: Inclination,
    /// Azimuth of body x at the first stop by the closed form, rad.
    pub azimuth: f64,
    /// Its 1σ, rad: all errors of the gyros stay in it.
    pub sigma: f64,
    /// The azimuth by bounded minimisation of U as an angle, and that angle.
    pub angle: Minimum,
    /// The same in the paper's form.
    pub euler: Minimum,
    /// Angle by which up turned between the stops over that predicted.
    pub ratio: f64,
    /// 1σ of that ratio.
    pub ratio_sigma: f64,
    /// From north, east, down at the start, frozen, to the start frame.
    pub frame: Matrix,
}

/// Mean of the blocks at either end.
#[derive(Clone, Copy, Debug, Default)]
struct End {
    middle: f64,
    seconds: f64,
    /// Sum of forces times seconds, on the start frame.
    force: Vector,
    attitude: Matrix,
    bias: Matrix,
    displacement: [f64; 2],
}

impl End {
    fn of<'a>(blocks: impl Iterator<Item = &'a Block>, displacement: [f64; 2]) -> Self {
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

    fn up(&self) -> Vector {
        unit(&self.force)
    }
}

fn add(sums: &mut Matrix, part: &Rough, seconds: f64) {
    for (sums, part) in sums.iter_mut().zip(part) {
        *sums = sum(sums, &scaled(&part.map(f64::from), seconds));
    }
}

/// A mean of nearly equal rotations made a rotation again (Newton's step).
fn orthonormal(matrix: &Matrix) -> Matrix {
    let square = product(&product(matrix, &transposed(matrix)), matrix);
    core::array::from_fn(|row| {
        core::array::from_fn(|column| 1.5 * matrix[row][column] - 0.5 * square[row][column])
    })
}

impl Plain {
    /// From the path of a vehicle that has blocks at both ends of it.
    #[must_use]
    #[inline(never)]
    pub fn of(setting: &Setting, path: &Path) -> Self {
        let (first, last) = ends(path);
        let level = levelled(&turned(&transposed(&first.attitude), &first.up()));
        // From the start frame to the first stop's level axes.
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
        Self {
            azimuth,
            sigma,
            angle: inclination.minimised(Inclination::angle),
            euler: inclination.minimised(Inclination::euler),
            ratio: carried / predicted,
            ratio_sigma,
            frame: product(&transposed(&to_level), &north_to_level),
            inclination,
        }
    }
}

/// The first stop and the last, or both ends of the only one.
fn ends(path: &Path) -> (End, End) {
    let last = path.stops.len().saturating_sub(1);
    let whole = path.stops.first().map_or([0.0; 2], |stop| [stop.from, stop.to]);
    let [early, late] = [END, 1.0 - END].map(|part| whole[0] + part * (whole[1] - whole[0]));
    let is_single = last == 0;
    let blocks = path.blocks;
    (
        End::of(
            blocks.of(0).filter(|block| !is_single || block.middle <= early),
            path.displaced(0),
        ),
        End::of(
            blocks.of(last).filter(|block| !is_single || block.middle >= late),
            path.displaced(last),
        ),
    )
}

/// 1σ of the azimuth, rad, and of the ratio of the angles by which up turned, `turn` rad as predicted.
fn sigmas(setting: &Setting, path: &Path, first: &End, last: &End, turn: f64) -> (f64, f64) {
    let across = unit(&cross(&first.up(), &last.up()));
    let along = cross(&across, &last.up());
    let sigma = |direction: &Vector| {
        // A rotation φ of the frame moves up along a direction p by φ·(up × p).
        let about = cross(&last.up(), direction);
        let common = &setting.common;
        let bias = setting.bias_sigma() * length(&weighted(&about, &last.bias, &first.bias));
        let scale = common.scale_sigma * length(&path.turned_about(&about));
        let force = common.accelerometer_bias_sigma / path.gravity
            * length(&weighted(direction, &last.attitude, &first.attitude));
        let walk = common.noise.angle_random_walk;
        let noise = walk * walk * (last.middle - first.middle)
            + path.density() / (path.gravity * path.gravity)
                * (1.0 / first.seconds + 1.0 / last.seconds);
        let place = path.displacement_sigma(setting) * path.place.per_metre()[0];
        let parts = [bias, scale, force, place];
        libm::sqrt(parts.iter().map(|part| part * part).sum::<f64>() + noise) / turn
    };
    (sigma(&across), sigma(&along))
}

/// A direction by the difference of two matrices.
fn weighted(direction: &Vector, last: &Matrix, first: &Matrix) -> Vector {
    let columns = [transposed(last), transposed(first)];
    core::array::from_fn(|axis| {
        dot(direction, &columns[0][axis]) - dot(direction, &columns[1][axis])
    })
}

//! Vectors and rotations in three dimensions.

use super::Scalar;
use core::ops::{Add, Sub};

/// A vector: three components on the axes of some frame.
pub type Vector = [f64; 3];

/// A 3×3 matrix, row by row; a rotation matrix takes components on one frame to those on another.
pub type Matrix = [Vector; 3];

/// The identity matrix.
pub(crate) const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Scalar product of two vectors.
#[must_use]
pub fn dot<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product of two vectors.
#[must_use]
pub fn cross<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Sum of two vectors.
#[must_use]
pub fn sum<T: Copy + Add<Output = T>>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Difference of two vectors.
#[must_use]
pub fn difference<T: Copy + Sub<Output = T>>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Product of a vector with a scalar.
#[must_use]
pub fn scaled<T: Scalar>(a: &[T; 3], factor: T) -> [T; 3] {
    a.map(|part| part * factor)
}

/// Euclidean length of a vector.
#[must_use]
pub fn length<T: Scalar>(a: &[T; 3]) -> T {
    dot(a, a).root()
}

/// Unit vector of the same direction; components are not finite for the zero vector.
#[must_use]
pub fn unit(a: &Vector) -> Vector {
    scaled(a, 1.0 / length(a))
}

/// Product of a rotation matrix with a vector: its components on the other frame.
#[must_use]
pub fn turned<T: Scalar>(rotation: &[[T; 3]; 3], vector: &[T; 3]) -> [T; 3] {
    [dot(&rotation[0], vector), dot(&rotation[1], vector), dot(&rotation[2], vector)]
}

/// Transposed matrix; for a rotation it is the inverse.
#[must_use]
pub fn transposed<T: Copy>(matrix: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    core::array::from_fn(|row| core::array::from_fn(|column| matrix[column][row]))
}

/// Matrix product: the rotation `b` first, then `a`.
#[must_use]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(&row, &column)))
}

/// Rotation matrix about z (down) by an angle, rad: takes components on the rotated axes to those
/// on the original ones.
#[must_use]
pub fn about_down(angle: f64) -> Matrix {
    let (sine, cosine) = libm::sincos(angle);
    [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]
}

/// Rotation matrix of a rotation vector, whose length is the angle, rad.
#[must_use]
pub fn by(rotation: &Vector) -> Matrix {
    let (cosine, factor) = half(dot(rotation, rotation));
    let [x, y, z] = scaled(rotation, factor);
    matrix([cosine, x, y, z])
}

/// Axis of a rotation times the sine of its angle: the rotation vector of a small rotation.
#[must_use]
pub fn small(rotation: &Matrix) -> Vector {
    let [[_, b, c], [d, _, f], [g, h, _]] = *rotation;
    [0.5 * (h - f), 0.5 * (c - g), 0.5 * (d - b)]
}

/// Levelling matrix from the measured up vector (unit length, body axes): takes body components
/// (forward, right, down) to level axes whose x points along the horizontal projection of body x.
/// Undefined where body x is vertical.
#[must_use]
pub fn levelled(up: &Vector) -> Matrix {
    let down = scaled(up, -1.0);
    let right = unit(&cross(&down, &[1.0, 0.0, 0.0]));
    [cross(&right, &down), right, down]
}

/// Rotation matrix of a unit quaternion w, x, y, z.
pub(crate) fn matrix<T: Scalar>([w, x, y, z]: [T; 4]) -> [[T; 3]; 3] {
    let (one, two) = (T::of(1.0), T::of(2.0));
    [
        [one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)],
        [two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)],
        [two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)],
    ]
}

/// Angle up to which sine and cosine of its half are taken from their series, rad: their errors are
/// then below 1e-16.
const SERIES: f64 = 0.02;

/// Cosine of half an angle, and sine of half the angle over the angle, from the angle's square.
fn half(square: f64) -> (f64, f64) {
    if square < SERIES * SERIES {
        let cosine = 1.0 - square * (0.125 - square * (1.0 / 384.0 - square / 46080.0));
        let factor = 0.5 - square * (1.0 / 48.0 - square / 3840.0);
        return (cosine, factor);
    }
    let angle = libm::sqrt(square);
    let (sine, cosine) = libm::sincos(0.5 * angle);
    (cosine, sine / angle)
}

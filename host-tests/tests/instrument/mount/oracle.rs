//! The mount's mechanism by 3 × 3 matrices and Rodrigues' formula, apart from any code under test.

use orientation::alignment::stepwise::mount::{FrameAngles, TwoFrame};

pub type Matrix = [[f64; 3]; 3];

/// Rotation about a unit vector, right-handed: 1 + sin·[k]× + (1 − cos)·[k]×² (Rodrigues).
pub fn about(k: [f64; 3], angle: f64) -> Matrix {
    let cross = [[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]];
    let square = times(&cross, &cross);
    let mut matrix = [[0.0; 3]; 3];
    for row in 0..3 {
        for column in 0..3 {
            matrix[row][column] = f64::from(u8::from(row == column))
                + angle.sin() * cross[row][column]
                + (1.0 - angle.cos()) * square[row][column];
        }
    }
    matrix
}

pub fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [[0.0; 3]; 3];
    for row in 0..3 {
        for column in 0..3 {
            product[row][column] = (0..3).map(|k| a[row][k] * b[k][column]).sum();
        }
    }
    product
}

pub fn apply(a: &Matrix, v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row| a[row][0] * v[0] + a[row][1] * v[1] + a[row][2] * v[2])
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub const X: [f64; 3] = [1.0, 0.0, 0.0];
pub const Y: [f64; 3] = [0.0, 1.0, 0.0];
pub const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Outer, inner and sensitive axis of a calibrated mount in the base.
///
/// The axes are built where they lie with both frames at zero, then each frame turns what it carries
/// about its own axis: not the products that the code under test forms.
pub fn axes(mount: &TwoFrame, shown: FrameAngles) -> [[f64; 3]; 3] {
    let case = times(&about(Z, mount.azimuth.0), &about(Y, mount.pitch.0));
    let outer = apply(&case, X);
    let inner_at_zero = apply(&times(&case, &about(Z, mount.frames.0)), Y);
    // Perpendicular to the inner axis and, at zero, to the outer frame's forward direction; then
    // leaning towards the inner axis.
    let perpendicular = apply(&case, Z);
    let leaning: [f64; 3] = core::array::from_fn(|i| {
        mount.gyro.0.cos() * perpendicular[i] + mount.gyro.0.sin() * inner_at_zero[i]
    });
    let by_outer = about(outer, shown.outer.0 - mount.outer_zero.0);
    let by_inner = about(inner_at_zero, shown.inner.0 - mount.inner_zero.0);
    let sensitive = apply(&by_outer, apply(&by_inner, leaning));
    [outer, apply(&by_outer, inner_at_zero), sensitive]
}

//! Integrals of the motion since the filter's last step.

use crate::math::quaternion::{Matrix, Vector};
use crate::math::rotation::{dot, length, scaled, sum};

/// Integrals of the motion since the filter's last step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stretch {
    /// Length, s.
    pub seconds: f32,
    /// Integral of the attitude's matrix, s.
    pub attitude: Matrix,
    /// Integral of the force on the level frame, north, east, down, m/s.
    pub impulse: [f32; 3],
    /// Time with valid forces, s.
    pub forced: f32,
    /// Rotation of the body about its axes, rad.
    pub turned: Vector,
    /// Integrals of the squared rates about the body's axes, rad²/s.
    pub rate_squares: [f32; 3],
    /// Variance of the level Earth rate that the biases may contain, (rad/s)²: zero once north is
    /// known. As the body turns it moves from one to another.
    pub hidden: f32,
    /// Whether the body is at rest: it does not rotate then, whatever the gyros show.
    pub is_rest: bool,
}

impl Stretch {
    /// Adds a rotation, rad, with the mean attitude over its time, s.
    pub(super) fn turn(&mut self, attitude: &Matrix, rotation: &Vector, seconds: f32) {
        for (sums, row) in self.attitude.iter_mut().zip(attitude) {
            *sums = sum(sums, &scaled(row, seconds));
        }
        let [x, y, z] = *rotation;
        let squares = scaled(&[x * x, y * y, z * z], 1.0 / seconds);
        self.rate_squares = sum(&self.rate_squares, &squares);
        self.turned = sum(&self.turned, rotation);
        self.seconds += seconds;
    }

    /// Adds a force on the level frame, m/s², over a time, s.
    pub(super) fn push(&mut self, force: &Vector, seconds: f32) {
        self.impulse = sum(&self.impulse, &scaled(force, seconds));
        self.forced += seconds;
    }

    /// Mean rates about the body's axes, rad/s.
    pub(super) fn rates(&self) -> Vector {
        scaled(&self.turned, 1.0 / self.seconds)
    }

    /// Rotation about north and east, rad.
    pub(super) fn level_turn(&self) -> [f32; 2] {
        let part = 1.0 / self.seconds;
        [dot(&self.attitude[0], &self.turned) * part, dot(&self.attitude[1], &self.turned) * part]
    }

    /// Square of the mean rate about level axes, rad²/s².
    pub(super) fn level_rate_square(&self) -> f32 {
        let part = 1.0 / self.seconds;
        let about_down = dot(&self.attitude[2], &self.turned) * part;
        let square = dot(&self.turned, &self.turned) - about_down * about_down;
        square.max(0.0) * part * part
    }

    /// Magnitude of the mean force, m/s².
    pub(super) fn force(&self) -> f32 {
        length(&self.impulse) / self.forced
    }
}

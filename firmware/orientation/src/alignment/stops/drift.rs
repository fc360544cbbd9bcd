//! What the gyros' biases turn the carried frame by, however far.
//!
//! A bias of 30 °/h turns the frame by twelve degrees in the twenty-four minutes between three
//! stops: too far for its sensitivity to biases at zero, which is linear. Of biases b, the measured
//! rotation M from the body to the start frame and the true one C differ by E = M Cᵀ, and
//!
//! ```text
//! M' = M [ω + b]×,  C' = C [ω]×   ⇒   E' = [M b]× E
//! ```
//!
//! The integral of M is the sensitivity that is carried anyway. It is known from block to block, within which the
//! biases turn the frame by little, so that E is the product of the rotations of these steps.

use super::block::Block;
use super::path::gained;
use crate::math::rotation::{IDENTITY, Matrix, Vector, by, product, scaled, turned};
use crate::signal::strapdown::Rough;

/// Removal of the drift by nominal biases from the carried frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drift {
    /// Nominal biases, rad/s.
    pub(super) biases: Vector,
    /// Rotation Eᵀ from the carried frame to the one without drift.
    pub(super) back: Matrix,
    /// Sensitivity of the carried frame to biases, s.
    sensitivity: Rough,
}

impl Drift {
    /// No drift yet by these biases, rad/s.
    pub(super) const fn by(biases: Vector) -> Self {
        Self { biases, back: IDENTITY, sensitivity: [[0.0; 3]; 3] }
    }

    /// Drifts on to where the carried frame has this sensitivity to biases, s; returns its change on the frame without
    /// drift.
    pub(super) fn carry(&mut self, sensitivity: &Rough) -> Matrix {
        let step = gained(sensitivity, &self.sensitivity);
        let on = product(&self.back, &step);
        self.back = product(&self.back, &by(&scaled(&turned(&step, &self.biases), -1.0)));
        self.sensitivity = *sensitivity;
        on
    }

    /// Mean specific force of a block on the frame without drift, m/s². Its attitude stays as it is: where the drift is
    /// of degrees, what it turns of an accelerometer's bias is far less than σ.
    pub(super) fn force(&self, block: &Block) -> Vector {
        turned(&self.back, &block.force.map(f64::from))
    }
}

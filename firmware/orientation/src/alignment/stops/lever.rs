//! Lever arm from the axis about which a vehicle sways to its sensors, estimated from the forces of
//! the sway.
//!
//! Sensors off the axis of the sway move with the body, and measure the change of their velocity v
//! = C (ω × l) in addition to gravity: C is the attitude, ω the gyros' rate, l the lever arm. Over
//! a second the mean acceleration is the difference of both ends, and linear in the lever arm. The
//! changes of the force from one second to the next estimate it by recursive least squares; its
//! effect is then subtracted, so that a swaying vehicle is aligned nearly as well as one that
//! stands still.
//!
//! ```text
//!  second before ─▶ ┐ change of velocity over a second   ┌─▶ lever, covariance
//!  second ────────▶ ┘ by metre of lever, 3×3 ─▶ least squares ─▶ force of the second without it
//! ```

use super::stop::Second;
use crate::math::rotation::{difference, dot, scaled, sum, turned};
use crate::signal::strapdown::Rough;

/// Prior 1σ of each component of the lever arm, m: the size of a large vehicle.
const FARTHEST: f32 = 3.0;
/// Variance of other changes of the force from second to second, (m/s²)²: an accelerometer noise of
/// 3 mm/s²/√Hz.
const FORCE: f32 = 1e-5;

/// Recursive estimate of the lever arm.
#[derive(Clone, Debug)]
pub(crate) struct Lever {
    /// Lever arm from the axis of the sway to the sensors, on the body's axes, m.
    arm: [f32; 3],
    /// Covariance of the lever arm, m².
    covariance: Rough,
    /// End of the latest second, s, the sensitivity of its force to the lever arm, 1/s², and that
    /// force, m/s².
    latest: Option<(f64, Rough, [f32; 3])>,
}

impl Default for Lever {
    /// Estimate without any data: zero with the prior covariance.
    fn default() -> Self {
        const FIRST: f32 = FARTHEST * FARTHEST;
        Self {
            arm: [0.0; 3],
            covariance: [[FIRST, 0.0, 0.0], [0.0, FIRST, 0.0], [0.0, 0.0, FIRST]],
            latest: None,
        }
    }
}

impl Lever {
    /// Subtracts the lever arm's effect from the force of a second at rest, and updates the
    /// estimate. `begun` is the end of the previous second, s, and its [`Second::swing`], where
    /// that was at rest too. Returns whether the corrected force is usable.
    pub(crate) fn relieve(&mut self, second: &mut Second, begun: Option<(f64, Rough)>) -> bool {
        let swing = second.swing();
        let Some((since, begun)) = begun else {
            self.latest = None;
            return self.is_known(&swing) && is_small(&turned(&swing, &self.arm));
        };
        let inverse = 1.0 / second.seconds() as f32;
        let made: Rough = core::array::from_fn(|axis| {
            difference(&swing[axis], &begun[axis]).map(|part| part * inverse)
        });
        let latest = self.latest.take().filter(|(to, ..)| *to == since);
        let Some(force) = second.block_force() else { return false };
        if let Some((_, earlier, earlier_force)) = latest {
            let change = difference(&force, &earlier_force);
            for axis in 0..3 {
                self.learn(&difference(&made[axis], &earlier[axis]), change[axis]);
            }
        }
        self.latest = Some((second.to, made, force));
        second.start_force = difference(&force, &turned(&made, &self.arm));
        self.is_known(&made)
    }

    /// Updates the estimate with the change of the force along an axis, m/s², which has this
    /// sensitivity to the lever arm.
    fn learn(&mut self, row: &[f32; 3], change: f32) {
        let with = turned(&self.covariance, row);
        let gain = with.map(|part| part / (dot(row, &with) + FORCE));
        let beyond = change - dot(row, &self.arm);
        self.arm = sum(&self.arm, &scaled(&gain, beyond));
        for (row, gain) in self.covariance.iter_mut().zip(gain) {
            *row = difference(row, &scaled(&with, gain));
        }
    }

    /// Whether the lever arm's effect is known better than a force is.
    fn is_known(&self, made: &Rough) -> bool {
        made.iter().all(|row| dot(row, &turned(&self.covariance, row)) < FORCE)
    }
}

/// Whether a force, m/s², is below the usual change of forces.
fn is_small(force: &[f32; 3]) -> bool {
    dot(force, force) < FORCE
}

//! The lever from where a vehicle rocks to where its sensors stand, found from the forces of its sway.
//!
//! Sensors that stand off the axis about which a body rocks move with it, and feel beside gravity how their velocity
//! v = C (ω × l) changes: C the attitude, ω what the gyros show, l the lever. Over a second that is the difference of
//! both ends, and linear in the lever. How the forces change from one second to the next tells it by recursive least
//! squares; what it makes is then taken off, so that a vehicle that sways is aligned nearly as well as one that does not.
//!
//! ```text
//!  second before ─▶ ┐ change of velocity over a second   ┌─▶ lever, covariance
//!  second ────────▶ ┘ by metre of lever, 3×3 ─▶ least squares ─▶ force of the second without it
//! ```

use super::stop::Second;
use crate::math::rotation::{difference, dot, scaled, sum, turned};
use crate::signal::strapdown::Rough;

/// 1σ of each component of the lever before any sway is seen, m: the size of a large vehicle.
const FARTHEST: f32 = 3.0;
/// Variance of what forces change from second to second beside, (m/s²)²: an accelerometer of 3 mm/s²/√Hz.
const FORCE: f32 = 1e-5;

/// The lever as far as it is known.
#[derive(Clone, Debug)]
pub struct Lever {
    /// From the axis of the sway to the sensors, on the body's axes, m.
    arm: [f32; 3],
    /// Covariance of that, m².
    covariance: Rough,
    /// When the latest second ended, s, what a metre of lever made of its force, 1/s², and that force, m/s².
    latest: Option<(f64, Rough, [f32; 3])>,
}

impl Default for Lever {
    /// Nothing known.
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
    /// Takes off the force of a second at rest what the lever makes of it, and learns from it; `begun` is when the second
    /// before it ended, s, and its [`Second::swing`], where that was at rest too. Whether what is left means something.
    pub fn relieve(&mut self, second: &mut Second, begun: Option<(f64, Rough)>) -> bool {
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

    /// Takes what the force along an axis changed, m/s², of which a metre of lever makes so much.
    fn learn(&mut self, row: &[f32; 3], change: f32) {
        let with = turned(&self.covariance, row);
        let gain = with.map(|part| part / (dot(row, &with) + FORCE));
        let beyond = change - dot(row, &self.arm);
        self.arm = sum(&self.arm, &scaled(&gain, beyond));
        for (row, gain) in self.covariance.iter_mut().zip(gain) {
            *row = difference(row, &scaled(&with, gain));
        }
    }

    /// Whether what a metre of lever makes is known with the lever better than a force.
    fn is_known(&self, made: &Rough) -> bool {
        made.iter().all(|row| dot(row, &turned(&self.covariance, row)) < FORCE)
    }
}

/// Whether a force, m/s², is below what forces change anyway.
fn is_small(force: &[f32; 3]) -> bool {
    dot(force, force) < FORCE
}

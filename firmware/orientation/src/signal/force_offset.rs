//! Offset of a coarse accelerometer on a base, from a better one that turns with a platform on it.
//!
//! At any moment both feel the same force. With the level axes as complex numbers, forward + j right,
//! and the better one's readings turned to the base by the stage angle θ, the coarse one exceeds them
//! by `o − b e^{jθ}`: its own offset o, and the offset b of the better one, which turns with the
//! platform. Over half a circle or more least squares separate the two. Down, where neither turns,
//! the coarse one is compared with gravity.

use crate::units::{Angle, SpecificForce};

/// Fewest pairs of readings: the noise of an LSM6DSL, 90 µg/√Hz read 200 times a second, is then
/// 0.1 mg.
const ENOUGH: u32 = 200;
/// Part of the information on the offset that must be left beside the better one's: an arc of 160°.
const SEPARATE: f32 = 0.5;
/// Standard gravity, m/s²; that of a site differs by 3 mg, which is no tilt.
const GRAVITY: f32 = 9.806_65;
/// One step of a specific force, m/s².
const STEP: f32 = 1e-6;

/// Comparison of a coarse accelerometer on a base with a better one on a platform.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForceOffset {
    /// Number of pairs.
    count: u32,
    /// Sum of `e^{jθ}`.
    heading: [f32; 2],
    /// Sum of the excess of the coarse one, m/s², and of that excess on the platform's axes.
    excess: [f32; 2],
    turned: [f32; 2],
    /// Sum of the coarse forces, m/s².
    coarse: [f32; 3],
}

impl ForceOffset {
    /// Adds the forces of one moment: on the base forward, right, down, and on the platform along the
    /// sensitive axis, 90° clockwise of it, down, with the heading of that axis in the base.
    pub fn push(
        &mut self,
        coarse: [SpecificForce; 3],
        [x, y, _]: [SpecificForce; 3],
        heading: Angle,
    ) {
        let (sine, cosine) = libm::sincosf(heading.signed_rad() as f32);
        let [forward, right, down] = coarse.map(metres);
        let [x, y] = [metres(x), metres(y)];
        let a = forward - (x * cosine - y * sine);
        let b = right - (x * sine + y * cosine);
        self.count += 1;
        add(&mut self.heading, &[cosine, sine]);
        add(&mut self.excess, &[a, b]);
        add(&mut self.turned, &[a * cosine + b * sine, b * cosine - a * sine]);
        add(&mut self.coarse, &[forward, right, down]);
    }

    /// Offset of the coarse accelerometer forward, right, down; `None` before the platform has turned
    /// far enough for it.
    #[must_use]
    pub fn offset(&self) -> Option<[SpecificForce; 3]> {
        let count = self.count as f32;
        let ([c, s], [p, q]) = (self.heading, self.turned);
        let left = count * count - (c * c + s * s);
        if self.count < ENOUGH || left < SEPARATE * count * count {
            return None;
        }
        let forward = (count * self.excess[0] - (c * p - s * q)) / left;
        let right = (count * self.excess[1] - (c * q + s * p)) / left;
        let [x, y, z] = self.coarse.map(|sum| sum / count);
        let (x, y) = (x - forward, y - right);
        let down = z + libm::sqrtf((GRAVITY * GRAVITY - x * x - y * y).max(0.0));
        Some([forward, right, down].map(|part| SpecificForce((part / STEP) as i32)))
    }
}

/// A force in m/s².
fn metres(force: SpecificForce) -> f32 {
    force.0 as f32 * STEP
}

/// Adds to sums.
fn add<const N: usize>(sums: &mut [f32; N], more: &[f32; N]) {
    for (sum, more) in sums.iter_mut().zip(more) {
        *sum += more;
    }
}

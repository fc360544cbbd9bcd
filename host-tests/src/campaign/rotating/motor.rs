//! A motor that obeys: it takes on each rate that it is sent, no faster than it can, and smoothly.

use hal_mock::stage::StageState;

/// Greatest acceleration, rad/s².
const ACCELERATION: f64 = 1.0;
/// Time constant with which the platform follows the motor, s: nothing that has inertia jumps.
const FOLLOWS: f64 = 0.08;
/// Longest step of the integration, s: a hundredth of the time constant.
const STEP: f64 = 1e-3;

/// The platform's motion, before the gear's unevenness.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motor {
    state: StageState,
    turning_rad_s: f64,
    wanted_rad_s: f64,
}

impl Motor {
    /// Sends it to a rate, rad/s.
    pub fn send(&mut self, rate_rad_s: f64) {
        self.wanted_rad_s = rate_rad_s;
    }

    /// The platform so many seconds later.
    pub fn after(&mut self, seconds: f64) -> StageState {
        let steps = (seconds / STEP).ceil().max(1.0);
        for _ in 0..steps as u32 {
            self.step(seconds / steps);
        }
        self.state
    }

    fn step(&mut self, seconds: f64) {
        let missing = self.wanted_rad_s - self.turning_rad_s;
        self.turning_rad_s += missing.abs().min(ACCELERATION * seconds).copysign(missing);
        let StageState { angle_rad, rate_rad_s } = self.state;
        let next_rad_s = rate_rad_s + (self.turning_rad_s - rate_rad_s) * seconds / FOLLOWS;
        let angle_rad = angle_rad + 0.5 * (rate_rad_s + next_rad_s) * seconds;
        self.state = StageState { angle_rad, rate_rad_s: next_rad_s };
    }
}

//! Ringing of the stage on its elastic drive: a damped oscillator behind a moving motor.
//!
//! The stage hangs on the gear by a spring. Its offset r from where the gear holds it obeys
//! r″ + 2ζω r′ + ω² r = −y″ with the gear's angle y. The gear moves at piecewise constant velocity, so
//! y″ is a row of jumps, and between two jumps r has its closed form. A ramp of many small jumps
//! leaves what a steady deceleration leaves: at most twice a/ω², and less the better it fits the period.

/// Offsets below this count as rest, rad: 1/15 000 of a step of a 21-bit encoder.
const REST_RAD: f64 = 2e-10;

/// The oscillator; without a frequency it never moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ringing {
    /// ζω, 1/s.
    decay_per_s: f64,
    /// ω√(1 − ζ²), rad/s.
    angular_rad_s: f64,
    /// Offset r from where the gear holds the stage, rad.
    pub(super) offset_rad: f64,
    /// Rate r′ of the offset, rad/s.
    pub(super) rate_rad_s: f64,
}

impl Ringing {
    /// An oscillator at rest of undamped frequency `hertz` (zero for a rigid stage) and damping ratio
    /// `damping`, [0, 1).
    pub(super) fn new(hertz: f64, damping: f64) -> Self {
        let omega = core::f64::consts::TAU * hertz;
        let angular_rad_s = omega * libm::sqrt(1.0 - damping * damping);
        Self { decay_per_s: damping * omega, angular_rad_s, ..Self::default() }
    }

    /// Whether the stage neither is off nor moves against the gear.
    pub(super) fn is_at_rest(&self) -> bool {
        self.offset_rad == 0.0 && self.rate_rad_s == 0.0
    }

    /// The gear has jumped by `jump_rad` and its velocity by `change_rad_s`: the stage does not follow
    /// at once.
    pub(super) fn kick(&mut self, jump_rad: f64, change_rad_s: f64) {
        if self.angular_rad_s > 0.0 {
            self.offset_rad -= jump_rad;
            self.rate_rad_s -= change_rad_s;
            self.settle();
        }
    }

    /// Something holds the stage.
    pub(super) fn quench(&mut self) {
        (self.offset_rad, self.rate_rad_s) = (0.0, 0.0);
    }

    /// Moves the oscillator on by `seconds`, ≥ 0.
    pub(super) fn pass(&mut self, seconds: f64) {
        if self.is_at_rest() || seconds <= 0.0 {
            return;
        }
        let (decay, angular) = (self.decay_per_s, self.angular_rad_s);
        let (offset, rate) = (self.offset_rad, self.rate_rad_s);
        let (sine, cosine) = libm::sincos(angular * seconds);
        let (envelope, sine) = (libm::exp(-decay * seconds), sine / angular);
        let stiffness = decay * decay + angular * angular;
        self.offset_rad = envelope * (offset * cosine + (rate + decay * offset) * sine);
        self.rate_rad_s = envelope * (rate * cosine - (decay * rate + stiffness * offset) * sine);
        self.settle();
    }

    /// Comes to rest when there is next to nothing left.
    fn settle(&mut self) {
        let offset_rad = libm::fabs(self.offset_rad);
        let rate_rad_s = libm::fabs(self.rate_rad_s);
        if offset_rad < REST_RAD && rate_rad_s < REST_RAD * self.angular_rad_s {
            self.quench();
        }
    }
}

//! What the chips feel and move, in physical units: what passes between a chip and the world.
//!
//! Chips ask in rising order of time; each call stands for one measurement, so noise is drawn once
//! for each.

use embassy_time::Instant;

/// A voltage between the two inputs of a converter.
pub trait AnalogueInput {
    /// The mean voltage over the conversion that ends at `now`, V.
    fn volts(&mut self, now: Instant) -> f64;
}

/// What an accelerometer feels.
pub trait ForceInput {
    /// Specific force on the chip's axes over the output period that ends at `now`, in units of
    /// 9.80665 m/s².
    fn force_g(&mut self, now: Instant) -> [f64; 3];

    /// Temperature that the chip's thermometer shows at `now`, °C.
    fn temperature_c(&mut self, now: Instant) -> f64;
}

/// What gyros and accelerometers on one chip feel.
pub trait MotionInput: ForceInput {
    /// Rate about the chip's axes over the output period that ends at `now`, rad/s.
    fn rate_rad_s(&mut self, now: Instant) -> [f64; 3];
}

/// The shaft with a magnet in front of an angle encoder.
pub trait ShaftAngle {
    /// What an ideal encoder with this magnet would show, turns, any number of them.
    fn shaft_turns(&mut self, now: Instant) -> f64;

    /// Whether the magnet's field is strong enough.
    fn magnet_is_present(&self) -> bool {
        true
    }
}

/// What a stepper motor moves.
pub trait Mechanics {
    /// The motor's field stands at `microsteps` (1/256 of a full step, from power-on) and turns at
    /// `microsteps_per_s` from `now` on.
    fn drive(&mut self, now: Instant, microsteps: f64, microsteps_per_s: f64);

    /// Whether the motor cannot follow its field, as a stage that is held or stands at an end.
    fn is_blocked(&self) -> bool;

    /// Whether the left and the right reference switch are touched.
    fn reference_switches(&self) -> [bool; 2];

    /// How far the motor has gone beyond the place at which the left switch last changed, microsteps, so that
    /// a chip that looks only now and then can tell where that was; zero where it is not known.
    fn beyond_edge(&self) -> f64 {
        0.0
    }
}

//! Source of the present roll, or fault that prevents it, with the sentences of the log.

use crate::units::{Instant, Seconds};
use crate::words::Rounded;

/// Accelerometers of the spinning body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accelerometer {
    /// Accelerometer along y.
    Y,
    /// Accelerometer along z.
    Z,
    /// Accelerometers along y and z.
    Both,
}

crate::words! { Accelerometer:
    Self::Y => "the accelerometer along y shows";
    Self::Z => "the accelerometer along z shows";
    Self::Both => "both accelerometers show";
}

/// Source of the present roll, or fault that prevents it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Condition {
    /// No lift has been detected yet.
    #[default]
    Searching,
    /// Lift and gyro agree.
    Locked,
    /// The lift is below the noise, and the gyro holds the roll.
    Holding,
    /// The body spins too slowly to evaluate its turns.
    NotSpinning,
    /// There are no usable forces.
    ForceLost,
    /// Rotation was lost, and with it the roll, until the next turns show it again.
    RotationLost,
    /// An accelerometer repeats one identical value.
    AccelerometerStuck(Accelerometer),
    /// The gyro about the longitudinal axis repeats one identical rate.
    GyroStuck,
    /// The forces rotate against the gyro: axes or signs are exchanged.
    Mirrored,
    /// The forces describe an ellipse instead of a circle: a scale or axis is wrong.
    Elliptic,
    /// The phase of the forces contradicts the gyro's angle.
    Contradicted,
}

/// Source of the present roll, or fault that prevents it, and how long it has been so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Source or fault.
    pub condition: Condition,
    /// Duration of a condition other than [`Condition::Searching`] and [`Condition::Locked`].
    pub seconds: Seconds,
}

/// Duration of a condition that may last since some time.
pub(super) fn lasted(since: Option<Instant>, now: Instant) -> Seconds {
    Seconds(since.map_or(0.0, |since| now.seconds() - since.seconds()))
}

crate::words! { State:
    Self { condition: Condition::Searching, .. } => "searching: no lift was felt yet";
    Self { condition: Condition::Locked, .. } => "locked";
    Self { condition: Condition::Holding, seconds } => "holding on the gyro for {} s: no lift", Rounded::<2>(seconds.0);
    Self { condition: Condition::NotSpinning, seconds } => "not spinning for {} s", Rounded::<2>(seconds.0);
    Self { condition: Condition::ForceLost, seconds } => "without forces for {} s", Rounded::<2>(seconds.0);
    Self { condition: Condition::RotationLost, seconds } => "rotation lost for {} s", Rounded::<2>(seconds.0);
    Self { condition: Condition::AccelerometerStuck(which), seconds } => "{} one value for {} s: stuck or dead, check supply and wires", which, Rounded::<2>(seconds.0);
    Self { condition: Condition::GyroStuck, seconds } => "the gyro about x shows one rate for {} s: stuck or dead, check supply and wires", Rounded::<2>(seconds.0);
    Self { condition: Condition::Mirrored, seconds } => "the forces go round against the gyro for {} s: swapped or turned round, check axes and signs", Rounded::<2>(seconds.0);
    Self { condition: Condition::Elliptic, seconds } => "the forces draw an ellipse for {} s: check scales and axes of the accelerometers", Rounded::<2>(seconds.0);
    Self { condition: Condition::Contradicted, seconds } => "the forces contradict the gyro for {} s: check its scale", Rounded::<2>(seconds.0);
}

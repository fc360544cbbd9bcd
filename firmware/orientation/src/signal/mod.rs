//! From raw samples to the average of one dwell, or to the phasors of a turning platform.

pub mod blocks;
pub mod butterworth;
pub mod dwell;
pub(crate) mod increment;
pub mod phasor;
pub mod rest;
pub mod strapdown;
pub mod sway;

use crate::units::{
    Angle, AngleIncrement, AngularRate, Instant, SpecificForce, SpinForce, Temperature,
};

/// One moment of the stage path: the precise gyro and what belongs to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// When it was taken.
    pub time: Instant,
    /// Encoder angle of the stage: the heading θ of the sensitive axis in the base plane. What does
    /// not stand shows another angle with every sample.
    pub stage: Angle,
    /// Rate about the gyro's sensitive axis.
    pub rate: AngularRate,
    /// Accelerometer, where a fresh reading came with this sample (it is read less often than the
    /// gyro). On a stage's platform: x along the sensitive axis, y 90° clockwise of it, z down; on the
    /// base: forward, right, down.
    pub force: Option<[SpecificForce; 3]>,
    /// Temperature at the gyro, where a fresh reading came with this sample.
    pub temperature: Option<Temperature>,
    /// Elevation of the sensitive axis above the base plane, up positive; none where the stage keeps
    /// it in that plane. It counts with samples that bring a force.
    pub elevation: Option<Angle>,
}

/// What three gyros and three accelerometers, fixed to the vehicle, measured since the sample before;
/// axes forward, right, down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InertialSample {
    /// When it ended.
    pub time: Instant,
    /// Angles turned about the axes: integrals of the rates, at the limit of their range
    /// where a gyro stood at the limit of its own.
    pub turned: [AngleIncrement; 3],
    /// Mean specific force since the last one, where a fresh reading came with this sample; none where
    /// it stood at the limit of the sensor's range.
    pub force: Option<[SpecificForce; 3]>,
}

/// What three gyros and two accelerometers on a spinning body measured; axes as in Nekrasova's paper: x forward,
/// along the spin, y up and z right at roll zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpinSample {
    /// When it was taken.
    pub time: Instant,
    /// Angles turned about the axes since the sample before, in one sample period: after a gap the last period's.
    pub turned: [AngleIncrement; 3],
    /// Forces on y and z at this moment; none where a sensor stood at the limit of its range.
    pub force: Option<[SpinForce; 2]>,
}

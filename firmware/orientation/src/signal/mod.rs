//! Signal processing: from raw samples to the average of one dwell, to the phasors of a rotating
//! platform, or to a strapdown attitude.

pub mod blocks;
pub mod dwell;
pub mod force_offset;
pub(crate) mod increment;
pub mod phasor;
pub mod rest;
pub mod strapdown;
pub mod sway;

pub(crate) use dwell::{Dwell, SampleFault};
pub(crate) use sway::SwayNoise;

use crate::units::{
    Angle, AngleIncrement, AngularRate, Instant, SpecificForce, SpinForce, Temperature,
};

/// A sample that carries its time.
pub trait Timed {
    /// Time at which the sample was taken, or its interval ended.
    fn time(&self) -> Instant;
}

/// One sample of the stage path: the precise gyro and the values that belong to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Sample {
    /// Time at which the sample was taken.
    #[cfg_attr(feature = "serde", serde(rename = "t"))]
    pub time: Instant,
    /// Encoder angle of the stage: heading θ of the sensitive axis in the base plane. While the
    /// stage moves, the angle differs from sample to sample.
    pub stage: Angle,
    /// Angular rate about the gyro's sensitive axis.
    pub rate: AngularRate,
    /// Accelerometer, where a fresh reading came with this sample (it is read less often than the
    /// gyro). On a stage's platform: x along the sensitive axis, y 90° clockwise of it, z down; on the
    /// base: forward, right, down.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub force: Option<[SpecificForce; 3]>,
    /// Temperature at the gyro, where a fresh reading came with this sample.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub temperature: Option<Temperature>,
    /// Elevation of the sensitive axis above the base plane, up positive; none where the stage keeps
    /// it in that plane. It counts with samples that bring a force.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub elevation: Option<Angle>,
}

/// Measurements of three gyros and three accelerometers fixed to the vehicle since the previous
/// sample; axes forward, right, down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct InertialSample {
    /// Time at which the sample interval ended.
    #[cfg_attr(feature = "serde", serde(rename = "t"))]
    pub time: Instant,
    /// Angles turned about the axes, the integrals of the rates. A component stands at the limit of
    /// its range where the gyro did.
    pub turned: [AngleIncrement; 3],
    /// Mean specific force since the last force reading, where a fresh reading came with this
    /// sample; none where the accelerometer stood at the limit of its range.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub force: Option<[SpecificForce; 3]>,
}

/// Measurements of three gyros and two accelerometers on a spinning body. Axes as in Nekrasova
/// 2017: x forward along the spin axis, y up and z right at roll zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpinSample {
    /// Time at which the sample was taken.
    pub time: Instant,
    /// Angles turned about the axes in one sample period; after a gap, those of the last period
    /// only.
    pub turned: [AngleIncrement; 3],
    /// Specific forces on y and z at this moment; none where a sensor stood at the limit of its
    /// range.
    pub force: Option<[SpinForce; 2]>,
}

impl Timed for Sample {
    fn time(&self) -> Instant {
        self.time
    }
}

impl Timed for InertialSample {
    fn time(&self) -> Instant {
        self.time
    }
}

impl Timed for SpinSample {
    fn time(&self) -> Instant {
        self.time
    }
}

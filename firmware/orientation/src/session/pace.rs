//! The procedure in the units of the sample path: angles as fractions of a turn, times as counts.

use super::procedure::Procedure;
use super::schedule::Position;
use crate::units::{Angle, Instant};

/// Where the stage is to stand and for how long, in the units of the sample path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) position: Position,
    pub(super) stage: Angle,
    pub(super) samples: u32,
}

impl Target {
    pub(super) fn new(position: Position, sample_seconds: f64) -> Self {
        let samples = samples(position.seconds, sample_seconds);
        Self { position, stage: Angle::from_rad(position.angle), samples }
    }
}

/// The procedure's times and angles in the units of the sample path, which knows no `f64`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// Change of angle that still counts as standing.
    pub(super) still: Angle,
    /// Distance from the target that counts as arrived.
    pub(super) arrival: Angle,
    /// Samples for the first look at the tilt.
    pub(super) level: u32,
    /// Samples of a survey.
    pub(super) survey: u32,
    /// Samples of standing that make an arrival.
    pub(super) settle: u32,
    /// Longest session, µs.
    pub(super) longest: u64,
    /// Longest rotation, µs.
    pub(super) longest_rotation: u64,
}

impl Timing {
    pub(super) fn of(procedure: &Procedure) -> Self {
        let samples = |seconds| samples(seconds, procedure.sample_seconds);
        Self {
            still: Angle::from_rad(procedure.still),
            arrival: Angle::from_rad(procedure.arrival),
            level: samples(procedure.level_seconds),
            survey: procedure.survey.map_or(0, |survey| samples(survey.seconds)),
            settle: samples(procedure.settle_seconds),
            longest: Instant::from_seconds(procedure.longest_seconds).0,
            longest_rotation: Instant::from_seconds(procedure.longest_rotation).0,
        }
    }
}

/// A time in samples, to nearest.
pub(super) fn samples(seconds: f64, sample_seconds: f64) -> u32 {
    libm::round(seconds / sample_seconds) as u32
}

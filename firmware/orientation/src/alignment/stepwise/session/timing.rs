//! Procedure in the units of the sample path: angles as fractions of a turn, times as counts, and
//! its filter.

use super::procedure::Procedure;
use super::schedule::Position;
use crate::alignment::setup::SetupError;
use crate::filter::Coefficients;
use crate::signal::dwell;
use crate::units::{Angle, Instant, RadiansPerSecond, Seconds};

/// Number of second-order sections of the stage filter: order six (Sokolov 2019).
pub(super) const SECTIONS: usize = 3;

/// Time within which an accelerometer gives a force after the gyro's samples are enough, s: many
/// times what its restart takes.
const FORCE_SECONDS: f64 = 10.0;

/// Commanded position and length of its dwell, in the units of the sample path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// Position of the schedule.
    pub(super) position: Position,
    /// Stage angle, wrapped to one turn.
    pub(super) stage: Angle,
    /// Number of samples of the dwell.
    pub(super) samples: u32,
}

impl Target {
    /// Target for a position and a sample period.
    pub(super) fn new(position: Position, sample_seconds: Seconds) -> Self {
        let samples = samples(position.seconds, sample_seconds);
        Self { position, stage: Angle::from_rad(position.angle.0), samples }
    }
}

/// Times and angles of the procedure in the units of the sample path, which needs no `f64`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// Greatest change of angle that counts as standstill.
    pub(super) still: Angle,
    /// Greatest distance from the target that counts as arrived.
    pub(super) arrival: Angle,
    /// Number of samples before the tilt is first tested.
    pub(super) level: u32,
    /// Number of samples before the tilt without any force, after which there will be none.
    pub(super) forceless: u32,
    /// Number of samples of a survey.
    pub(super) survey: u32,
    /// Number of samples of standstill that make an arrival.
    pub(super) settle: u32,
    /// Longest session, µs.
    pub(super) longest: u64,
    /// Longest rotation, µs.
    pub(super) longest_rotation: u64,
}

impl Timing {
    /// Timing of a procedure.
    pub(super) fn of(procedure: &Procedure) -> Self {
        let samples = |seconds| samples(seconds, procedure.sample_seconds);
        Self {
            still: Angle::from_rad(procedure.still.0),
            arrival: Angle::from_rad(procedure.arrival.0),
            level: samples(procedure.level_seconds),
            forceless: samples(Seconds(procedure.level_seconds.0 + FORCE_SECONDS)),
            survey: procedure.survey.map_or(0, |survey| samples(survey.seconds)),
            settle: samples(procedure.settle_seconds),
            longest: Instant::from_seconds(procedure.longest_seconds.0).0,
            longest_rotation: Instant::from_seconds(procedure.longest_rotation.0).0,
        }
    }
}

/// Filter of a procedure, and its first target.
pub(super) fn designed(
    procedure: &Procedure,
) -> Result<(Coefficients<SECTIONS>, Target), SetupError> {
    let rate = 1.0 / procedure.sample_seconds.0;
    let coefficients =
        Coefficients::low_pass(procedure.cutoff(), rate).map_err(SetupError::Filter)?;
    let samples = samples(procedure.schedule.shortest(), procedure.sample_seconds);
    let needed = dwell::shortest(&coefficients);
    if samples < needed {
        return Err(SetupError::DwellTooShort { samples, needed });
    }
    if let Some(angle) = procedure.beyond_travel() {
        return Err(SetupError::BeyondTravel(angle));
    }
    let first =
        procedure.schedule.next(&[], RadiansPerSecond(0.0)).ok_or(SetupError::NoPosition)?;
    Ok((coefficients, Target::new(first, procedure.sample_seconds)))
}

/// Converts a time to samples, rounded to nearest.
fn samples(seconds: Seconds, sample_seconds: Seconds) -> u32 {
    libm::round(seconds.0 / sample_seconds.0) as u32
}

//! Why a recording that could be read cannot be replayed.

use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::CAPACITY;
use thiserror::Error;

use super::stepwise::late::Late;
use super::stops::way::Slip;
use crate::output::counted;
use crate::recording::{Kind, Short};

/// Why a recording that could be read cannot be replayed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReplayError {
    /// Neither the header nor the user gives a latitude to a recording of this kind.
    #[error("key latitude_deg is missing: add it or give --latitude{}", without_latitude(*.0))]
    NoLatitude(Kind),
    /// A kind without positions.
    #[error("kind `{0}` has no positions to align from{noise}", noise = of_noise(*.0))]
    Kind(Kind),
    /// A kind whose stage does not turn all the time.
    #[error("kind `{0}` has no platform that turns all the time: no method rotating")]
    Stops(Kind),
    /// Elevations of a mount of two frames, without what its session was given.
    #[error(
        "column elevation_rad: two frames replay by what their run was given alone: put the line `session` back in, as \
         the run wrote it"
    )]
    Mounted,
    /// The stage never stood still long enough.
    #[error("column stage_rad: the stage stands still nowhere long enough for a dwell")]
    NoDwell,
    /// More positions than a session holds.
    #[error(
        "column stage_rad: {0} positions are more than the {CAPACITY} that a session holds: split the recording, or \
         average neighbours into kind dwells"
    )]
    TooManyPositions(usize),
    /// A kind without three gyros and three accelerometers.
    #[error("kind `{0}` is no vehicle: no method siap, static or vertical")]
    NoVehicle(Kind),
    /// A kind without a body in fast rotation.
    #[error("kind `{0}` has no spinning body: no method spin")]
    NoSpin(Kind),
    /// Fewer samples than a rate has.
    #[error("column t_s: {} too few for a rate: record for longer", counted(*.0, "sample"))]
    TooFewSamples(usize),
    /// A recording of kind `static` with one gyro.
    #[error(
        "columns gx_rad_s to az_m_s2 are missing: this method needs three gyros and three accelerometers; `meridian \
         allan` finds the noise of the one"
    )]
    OneGyro,
    /// More stops than a session holds, and how many that is.
    #[error("key stops_s: {0} stops are more than the {1} that a session holds")]
    TooManyStops(usize, usize),
    /// Displacements are not one for each stop.
    #[error("{stated} displacements for {stops} stops: state one for each stop")]
    Displacements {
        /// How many were stated.
        stated: usize,
        /// How many stops there are.
        stops: usize,
    },
    /// A sensor stood still.
    #[error(
        "column {column}: the same value for {seconds:.1} s from line {line} on: the sensor is stuck; check its supply \
         and cable, then record again or cut the recording off before"
    )]
    Stuck {
        /// Name of the column.
        column: &'static str,
        /// The line where that begins.
        line: u64,
        /// For how long, s.
        seconds: f64,
    },
    /// A column is not of the same moment as the others.
    #[error(transparent)]
    Late(#[from] Late),
    /// The header's rate is not that of the times.
    #[error(
        "key rate_hz: {} Hz, but the times of column t_s make it {found_hz:.3} Hz, {:.1} % apart: correct the one \
         that is wrong",
        Short(*stated_hz),
        100.0 * (stated_hz / found_hz - 1.0).abs()
    )]
    Rate {
        /// Rate that the header states, Hz.
        stated_hz: f64,
        /// Rate that the times have, Hz.
        found_hz: f64,
    },
    /// The gyros' rate at rest is so many times the Earth's: that of a degree in radians.
    #[error(
        "columns gx_rad_s to gz_rad_s: at rest they show {times:.1} times the Earth rate, which is 1 in rad/s and \
         57.3 in °/s: convert them to rad/s"
    )]
    DegreesPerSecond {
        /// How many times.
        times: f64,
    },
    /// No displacement lies far from the first stop, but a thousand times as far there is an azimuth.
    #[error(
        "key displacements_north_east_m: with {greatest} m at the most there is no azimuth, with as many kilometres \
         there is: state them in metres"
    )]
    Kilometres {
        /// The greatest part of one, as stated.
        greatest: f64,
    },
    /// The forces on the way to a stop contradict its displacement.
    #[error(
        "key displacements_north_east_m: from stop {stop} to the next it says {:.1} m north and {:.1} m east, the \
         forces on the way say {:.0} m and {:.0} m: {slip}",
        stated_m[0], stated_m[1], driven_m[0], driven_m[1]
    )]
    Way {
        /// The stop before, from one.
        stop: usize,
        /// How far the next one lies from it as stated, north and east, m.
        stated_m: [f64; 2],
        /// How far by the forces.
        driven_m: [f64; 2],
        /// What the displacements are likely to be.
        slip: Slip,
    },
    /// The gyros' noise is not stated, and there are too few samples at rest to estimate it from.
    #[error(
        "key gyro_N_deg_sqrt_h is missing, and the samples at rest are too few to estimate it from: state it, or stand \
         for longer"
    )]
    NoiseUnknown,
    /// The session cannot follow the recording.
    #[error("{0}")]
    Procedure(#[from] SetupError),
    /// What the header says of a run's session cannot be read, and why.
    #[error("key session: {0}: leave the line as the run wrote it, or take it out")]
    Session(String),
}

/// What a kind that has no latitude gives without one.
fn without_latitude(kind: Kind) -> &'static str {
    match kind {
        Kind::Imu | Kind::Static => "; --method vertical gives pitch and roll without it",
        _ => "",
    }
}

/// What a kind without positions is good for.
fn of_noise(kind: Kind) -> &'static str {
    if kind == Kind::Static { ": `meridian allan` finds the gyro's noise in it" } else { "" }
}

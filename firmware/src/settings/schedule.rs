//! Schedules of the carriers: what decides how long a session takes, and where it begins.

use heapless::Vec;
use orientation::alignment::rotating::turn::SPEEDS;
use orientation::alignment::setup::{SetupError, check_ranges};
use orientation::alignment::stepwise::setting::Half;
use orientation::alignment::stops::stop::STOPS;
use orientation::planner::POSITIONS;
use orientation::units::{Radians, RadiansPerSecond, Seconds, TURN};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::platform::Platform;

/// Headings of a pass on two frames.
const HEADINGS: usize = 4;
/// Shortest and longest dwell, s.
const DWELL: [f64; 2] = [0.5, 600.0];
/// Shortest and longest survey, and time that an accuracy is allowed, s.
const SURVEY: [f64; 2] = [60.0, 36_000.0];
/// Slowest and fastest turn that the platform's drive holds, rad/s.
const TURNING: [f64; 2] = [0.02 * TURN, 0.5 * TURN];
/// Greatest number of turns of either kind.
const MOST_TURNS: f64 = 1000.0;
/// Fewest rate-modulated turns that show an axis misalignment, where there are any.
const FEWEST_MODULATED: f64 = 4.0;
/// Shortest and longest stop, s.
const STOP: [f64; 2] = [10.0, 3600.0];

/// Schedule of a session on one carrier.
pub trait CarrierSchedule: Serialize + DeserializeOwned {
    /// The carrier.
    const PLATFORM: Platform;

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`], which names the first field that is not.
    fn check(&self) -> Result<(), SetupError>;
}

/// Schedule on a stage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageSchedule {
    /// Positions on the full circle, 2 to 64; the first is repeated at the end.
    pub positions: u8,
    /// Time at each position, 0.5 to 600 s.
    pub dwell: Seconds,
    /// Length of a survey at rest before the alignment, 60 to 36 000 s, after which the positions are
    /// planned anew for the noise that it has shown; [`None`] without one.
    pub survey: Option<Seconds>,
    /// Time allowed in which the session goes on until the azimuth has the required standard
    /// deviation, 60 to 36 000 s from the end of the survey or else from the beginning; [`None`] to
    /// end with the positions.
    pub allowed: Option<Seconds>,
    /// Half of the circle in which the azimuth is known to lie; two positions require it.
    pub half: Option<Half>,
}

impl CarrierSchedule for StageSchedule {
    const PLATFORM: Platform = Platform::Stage;

    fn check(&self) -> Result<(), SetupError> {
        let or_least = |time: Option<Seconds>| time.map_or(SURVEY[0], |time| time.0);
        check_ranges(&[
            ("positions", self.positions.into(), [2.0, POSITIONS as f64]),
            ("dwell", self.dwell.0, DWELL),
            ("survey", or_least(self.survey), SURVEY),
            ("allowed", or_least(self.allowed), SURVEY),
        ])
    }
}

/// Schedule on two frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoFrameSchedule {
    /// Number of times that the four headings are taken, 1 to 16.
    pub passes: u8,
    /// Time at each heading, 0.5 to 600 s.
    pub dwell: Seconds,
    /// Half of the circle in which the azimuth is known to lie, if that is known.
    pub half: Option<Half>,
}

impl CarrierSchedule for TwoFrameSchedule {
    const PLATFORM: Platform = Platform::TwoFrame;

    fn check(&self) -> Result<(), SetupError> {
        check_ranges(&[
            ("passes", self.passes.into(), [1.0, (POSITIONS / HEADINGS) as f64]),
            ("dwell", self.dwell.0, DWELL),
        ])
    }
}

/// Schedule on a platform that turns all the time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TurntableSchedule {
    /// Speeds, one or two, 0.02 to 0.5 turns per second.
    pub speeds: Vec<RadiansPerSecond, SPEEDS>,
    /// Turns at constant rate in each sense at the slower speed, 2 to 1000.
    pub turns: u32,
    /// Rate-modulated turns before them at each speed, 4 to 1000; zero to use the axis misalignment in
    /// the store.
    pub modulated_turns: u32,
}

impl CarrierSchedule for TurntableSchedule {
    const PLATFORM: Platform = Platform::Turntable;

    fn check(&self) -> Result<(), SetupError> {
        let fewest = if self.modulated_turns == 0 { 0.0 } else { FEWEST_MODULATED };
        check_ranges(&[
            ("number of speeds", self.speeds.len() as f64, [1.0, SPEEDS as f64]),
            ("turns", self.turns.into(), [2.0, MOST_TURNS]),
            ("modulated_turns", self.modulated_turns.into(), [fewest, MOST_TURNS]),
        ])?;
        self.speeds.iter().try_for_each(|speed| check_ranges(&[("speeds", speed.0, TURNING)]))
    }
}

/// Schedule in a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VehicleSchedule {
    /// Number of stops after which the session concludes, 2 to 8; three with different headings make
    /// the gyros' biases observable.
    pub stops: u8,
    /// Time for which the vehicle is to stand at each stop, 10 to 3600 s.
    pub stop: Seconds,
    /// Whether the azimuth is renewed by a new alignment, whose first stop is the last of the one
    /// before.
    pub realigns: bool,
}

impl CarrierSchedule for VehicleSchedule {
    const PLATFORM: Platform = Platform::Vehicle;

    fn check(&self) -> Result<(), SetupError> {
        check_ranges(&[
            ("stops", self.stops.into(), [2.0, STOPS as f64]),
            ("stop", self.stop.0, STOP),
        ])
    }
}

/// Start of the flight of a spinning body, which no sensor on it measures; the flight itself has no
/// schedule.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpinSchedule {
    /// Course at the start, within a turn.
    pub course: Radians,
    /// Pitch at the start, within 90°.
    pub pitch: Radians,
}

impl CarrierSchedule for SpinSchedule {
    const PLATFORM: Platform = Platform::Spin;

    fn check(&self) -> Result<(), SetupError> {
        check_ranges(&[
            ("course", self.course.0, [-TURN, TURN]),
            ("pitch", self.pitch.0, [-0.25 * TURN, 0.25 * TURN]),
        ])
    }
}

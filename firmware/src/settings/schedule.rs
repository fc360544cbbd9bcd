//! Schedules of the carriers: what decides how long a session takes, and where it begins.

use core::fmt::Debug;

use heapless::Vec;
use orientation::alignment::rotating::turn::SPEEDS;
use orientation::alignment::setup::{SetupError, check_ranges};
use orientation::alignment::stepwise::setting::Half;
use orientation::alignment::stops::stop::STOPS;
use orientation::planner::POSITIONS;
use orientation::units::{DEGREE, Radians, RadiansPerSecond, Seconds, TURN};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::calibration::{
    Calibration, FramesCalibration, PlatformCalibration, SpinCalibration, TurntableCalibration,
    VehicleCalibration,
};
use super::names::{DEGREES, List, NONE, Named, SECONDS, Unit};
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
/// Greatest course and pitch at the start of a flight, of either sign, rad.
const START: [f64; 2] = [360.0 * DEGREE, 90.0 * DEGREE];
/// Turns a second, to a millionth.
const HERTZ: Unit = Unit { places: 6, si: TURN };

/// Schedule of a session on one carrier.
pub trait CarrierSchedule:
    Clone + Debug + Default + PartialEq + Send + Serialize + DeserializeOwned + Named
{
    /// The carrier.
    const PLATFORM: Platform;
    /// What is measured of the instrument on it.
    type Calibration: Calibration;
    /// The schedule as version 1 of the record has it.
    type First: DeserializeOwned + Into<Self>;

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
    type Calibration = PlatformCalibration;
    type First = Self;

    fn check(&self) -> Result<(), SetupError> {
        let or_least = |time: Option<Seconds>| time.map_or(SURVEY[0], |time| time.0);
        check_ranges(&[
            ("positions", self.positions.into(), [2.0, POSITIONS as f64]),
            ("dwell", self.dwell.0, DWELL),
            ("survey", or_least(self.survey), SURVEY),
            ("allowed", or_least(self.allowed), SURVEY),
        ])?;
        let is_whole = self.positions > 2 || self.half.is_some() || self.survey.is_some();
        is_whole.then_some(()).ok_or(SetupError::TwoPositions)
    }
}

/// Lists the half of the circle in which the azimuth is known to lie.
fn list_half(list: &mut List<'_>, half: &mut Option<Half>) {
    const HALVES: [Option<Half>; 3] = [None, Some(Half::East), Some(Half::West)];
    let index = HALVES.iter().position(|known| known == half).unwrap_or_default();
    list.choice("half", &[NONE, "east", "west"], index, &mut |index| *half = HALVES[index]);
}

impl Named for StageSchedule {
    fn list(&mut self, list: &mut List<'_>) {
        list.few("positions", &mut self.positions);
        list.number("dwell", SECONDS, &mut self.dwell.0);
        list.time("survey", &mut self.survey);
        list.time("allowed", &mut self.allowed);
        list_half(list, &mut self.half);
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
    type Calibration = FramesCalibration;
    type First = Self;

    fn check(&self) -> Result<(), SetupError> {
        check_ranges(&[
            ("passes", self.passes.into(), [1.0, (POSITIONS / HEADINGS) as f64]),
            ("dwell", self.dwell.0, DWELL),
        ])
    }
}

impl Named for TwoFrameSchedule {
    fn list(&mut self, list: &mut List<'_>) {
        list.few("passes", &mut self.passes);
        list.number("dwell", SECONDS, &mut self.dwell.0);
        list_half(list, &mut self.half);
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
    type Calibration = TurntableCalibration;
    type First = Self;

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

/// Gives the speed of this place a value, turns a second, or takes the last one away; whether there can be such a speed.
fn set_speed(
    speeds: &mut Vec<RadiansPerSecond, SPEEDS>,
    place: usize,
    stated: Option<f64>,
) -> bool {
    let stated = stated.map(|hertz| RadiansPerSecond(hertz * TURN));
    match (speeds.get_mut(place), stated) {
        (Some(speed), Some(stated)) => *speed = stated,
        (Some(_), None) => speeds.truncate(place),
        (None, Some(stated)) => return speeds.len() == place && speeds.push(stated).is_ok(),
        (None, None) => {}
    }
    true
}

impl Named for TurntableSchedule {
    fn list(&mut self, list: &mut List<'_>) {
        for (place, name) in ["speed_1", "speed_2"].into_iter().enumerate() {
            let value = self.speeds.get(place).map_or(f64::NAN, |speed| speed.0 / TURN);
            list.optional(name, HERTZ, value, &mut |stated| {
                set_speed(&mut self.speeds, place, stated)
            });
        }
        list.count("turns", &mut self.turns);
        list.count("modulated_turns", &mut self.modulated_turns);
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
    /// Whether an alignment runs although the azimuth is known from before a restart, since when the
    /// vehicle has not moved.
    pub aligns_known: bool,
}

/// Schedule in a vehicle as version 1 of the record has it.
#[derive(Deserialize)]
pub struct FirstVehicleSchedule {
    /// As [`VehicleSchedule::stops`].
    stops: u8,
    /// As [`VehicleSchedule::stop`].
    stop: Seconds,
    /// As [`VehicleSchedule::realigns`].
    realigns: bool,
}

impl From<FirstVehicleSchedule> for VehicleSchedule {
    /// The images of that version ran an alignment at every start.
    fn from(FirstVehicleSchedule { stops, stop, realigns }: FirstVehicleSchedule) -> Self {
        Self { stops, stop, realigns, aligns_known: true }
    }
}

impl CarrierSchedule for VehicleSchedule {
    const PLATFORM: Platform = Platform::Vehicle;
    type Calibration = VehicleCalibration;
    type First = FirstVehicleSchedule;

    fn check(&self) -> Result<(), SetupError> {
        check_ranges(&[
            ("stops", self.stops.into(), [2.0, STOPS as f64]),
            ("stop", self.stop.0, STOP),
        ])
    }
}

impl Named for VehicleSchedule {
    fn list(&mut self, list: &mut List<'_>) {
        list.few("stops", &mut self.stops);
        list.number("stop", SECONDS, &mut self.stop.0);
        list.flag("realigns", &mut self.realigns);
        list.flag("align_known", &mut self.aligns_known);
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
    type Calibration = SpinCalibration;
    type First = Self;

    fn check(&self) -> Result<(), SetupError> {
        let [course, pitch] = START;
        check_ranges(&[
            ("course", self.course.0, [-course, course]),
            ("pitch", self.pitch.0, [-pitch, pitch]),
        ])
    }
}

impl Named for SpinSchedule {
    fn list(&mut self, list: &mut List<'_>) {
        list.number("course", DEGREES, &mut self.course.0);
        list.number("pitch", DEGREES, &mut self.pitch.0);
    }
}

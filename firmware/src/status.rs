//! The status of the instrument and its text, the first part of a status line.
//!
//! Numbers are kept as integers of thousandths, so that the board needs no formatting of floats.

use orientation::alignment::{Progress, Solution, rotating, stepwise, stops};
use orientation::attitude::State;
use orientation::navigation::navigator::Attitude;
use orientation::roll::{self, Condition};
use orientation::units::{DEGREES_PER_RADIAN as DEGREES, wrapped};
use orientation::words;

/// Status of the instrument. Angles are in thousandths of a degree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status {
    /// Devices are being started.
    Starting,
    /// The stage searches its index.
    Homing,
    /// The stage stands still for the survey of the gyro's noise.
    Surveying,
    /// Dwells, or turns, are being measured.
    Measuring {
        /// Number of completed dwells or turns.
        done: u16,
        /// Number of planned dwells or turns.
        of: u16,
    },
    /// The vehicle stands at a stop, with this number from 1, whose inclination is being measured.
    Levelling(u16),
    /// The stop with this number, from 1, was long enough, and the vehicle may drive on.
    MayDrive(u16),
    /// The vehicle is in motion.
    Driving,
    /// The alignment has concluded with an azimuth.
    Concluded {
        /// Azimuth of body x, clockwise from north, 0–359 999.
        azimuth: u32,
        /// The azimuth's 1σ, rounded up.
        sigma: u32,
    },
    /// The alignment has concluded without an azimuth; the log has the reason.
    Refused,
    /// The attitude is kept.
    Keeping {
        /// Azimuth of body x, 0–359 999, and its 1σ, rounded up; [`None`] if the azimuth is unknown.
        azimuth: Option<[u32; 2]>,
        /// Pitch and roll.
        level: [i32; 2],
        /// The navigator's state; [`None`] if no inertial samples arrive.
        state: Option<State>,
        /// Whether the azimuth is that saved before the loss of supply.
        is_recalled: bool,
    },
    /// The roll angle of a spinning body is tracked.
    Rolling {
        /// Roll angle and its 1σ, rounded up; [`None`] if the roll is unknown.
        roll: Option<[u32; 2]>,
        /// The source of the roll.
        condition: Condition,
    },
    /// The tracking of the roll has ended; the log has the reason.
    RollEnded,
}

impl Status {
    /// The status as long as the mechanism's angles are not valid: homing, unless the alignment is
    /// over already or an attitude is kept.
    #[must_use]
    pub fn before_homing(self) -> Self {
        match self {
            Self::Starting | Self::Surveying | Self::Measuring { .. } => Self::Homing,
            other => other,
        }
    }

    /// The status after a progress of the alignment.
    #[must_use]
    pub fn after(self, progress: &Progress) -> Self {
        let measuring =
            |done: usize, of: usize| Self::Measuring { done: done as u16, of: of as u16 };
        match *progress {
            // An attitude that is kept says more.
            _ if matches!(self, Self::Keeping { .. }) => self,
            Progress::Stepwise(
                stepwise::Progress::Begun { positions, .. }
                | stepwise::Progress::Planned { positions, .. },
            ) => measuring(0, positions),
            Progress::Stepwise(stepwise::Progress::Surveying(_)) => Self::Surveying,
            Progress::Stepwise(stepwise::Progress::Dwelled(done, of, _)) => measuring(done, of),
            Progress::Rotating(rotating::Progress::Begun { turns, .. }) => {
                measuring(0, turns as usize)
            }
            Progress::Rotating(rotating::Progress::Turned(done, of)) => {
                measuring(done as usize, of as usize)
            }
            Progress::Stops(stops::Progress::Standing) => Self::Levelling(1),
            Progress::Stops(stops::Progress::Stopped(stop, _)) => Self::Levelling(stop as u16),
            Progress::Stops(stops::Progress::MayDrive(stop, ..)) => Self::MayDrive(stop as u16),
            Progress::Stops(stops::Progress::Driving) => Self::Driving,
            Progress::Roll(roll::Progress::Tracked(angle, sigma, condition)) => {
                let angle = thousandths(wrapped(angle.0));
                Self::Rolling { roll: sigma.map(|sigma| [angle, bound(sigma.0)]), condition }
            }
            Progress::Roll(roll::Progress::Ended(_)) => Self::RollEnded,
            Progress::Concluded(Solution { azimuth, .. }) => Self::Concluded {
                azimuth: thousandths(azimuth.angle.0),
                sigma: bound(azimuth.sigma.0),
            },
            Progress::Refused(_) => Self::Refused,
            _ => self,
        }
    }
}

impl From<&Attitude> for Status {
    fn from(attitude: &Attitude) -> Self {
        let Attitude { azimuth, pitch, roll, state, is_recalled } = *attitude;
        let azimuth = azimuth.map(|it| [thousandths(it.angle.0), bound(it.sigma.0)]);
        let level = [pitch, roll].map(|angle| libm::round(angle.degrees() * 1e3) as i32);
        Self::Keeping { azimuth, level, state, is_recalled }
    }
}

/// An angle, rad, in thousandths of a degree, rounded to nearest and wrapped at a full turn.
fn thousandths(angle: f64) -> u32 {
    (libm::round(angle * DEGREES * 1e3) as i32).rem_euclid(360_000).unsigned_abs()
}

/// A 1σ, rad, in thousandths of a degree, rounded up: never less than the estimated one.
fn bound(sigma: f64) -> u32 {
    libm::ceil(sigma * DEGREES * 1e3) as u32
}

words! { Status:
    Self::Starting => "starting";
    Self::Homing => "homing";
    Self::Surveying => "surveying";
    Self::Measuring { done, of } => "measuring {}/{}", done, of;
    Self::Levelling(stop) => "levelling at stop {}", stop;
    Self::MayDrive(stop) => "stop {} done, may drive", stop;
    Self::Driving => "driving";
    Self::Concluded { azimuth, sigma } =>
        "azimuth {} sigma {}", Thousandths(azimuth), Thousandths(sigma);
    Self::Refused => "no azimuth";
    Self::Keeping { azimuth, level: [pitch, roll], state, is_recalled } =>
        "{}pitch {} roll {} {}{}",
        Kept(azimuth), Signed(pitch), Signed(roll), Motion(state), Recalled(is_recalled);
    Self::Rolling { roll: Some([roll, sigma]), condition } =>
        "roll {} sigma {} {}", Thousandths(roll), Thousandths(sigma), word(condition);
    Self::Rolling { roll: None, condition } => "roll unknown, {}", word(condition);
    Self::RollEnded => "no roll";
}

/// A number of thousandths, written as a decimal fraction.
struct Thousandths(u32);

words! { Thousandths:
    Self(number) => "{}.{:03}", number / 1000, number % 1000;
}

/// A number of thousandths with its sign, which is written apart: −0.310 has a whole part of zero.
struct Signed(i32);

words! { Signed:
    Self(number) if number < 0 => "-{}", Thousandths(number.unsigned_abs());
    Self(number) => "{}", Thousandths(number.unsigned_abs());
}

/// A kept azimuth with its 1σ.
struct Kept(Option<[u32; 2]>);

words! { Kept:
    Self(Some([azimuth, sigma])) =>
        "azimuth {} sigma {} ", Thousandths(azimuth), Thousandths(sigma);
    Self(None) => "no azimuth, ";
}

/// The state of a kept attitude.
struct Motion(Option<State>);

words! { Motion:
    Self(Some(state)) => "{}", state;
    Self(None) => "no motion measured";
}

/// Whether an azimuth is that from before a restart.
struct Recalled(bool);

words! { Recalled:
    Self(true) => ", recalled";
    Self(false) => "";
}

/// The source of a roll, in a word.
fn word(condition: Condition) -> &'static str {
    match condition {
        Condition::Searching => "searching",
        Condition::Locked => "locked",
        Condition::Holding => "holding",
        Condition::NotSpinning => "not spinning",
        Condition::ForceLost => "force lost",
        Condition::RotationLost => "rotation lost",
        Condition::AccelerometerStuck(_) => "accelerometer stuck",
        Condition::GyroStuck => "gyro stuck",
        Condition::Mirrored => "forces mirrored",
        Condition::Elliptic => "forces elliptic",
        Condition::Contradicted => "forces contradict",
    }
}

//! How far the instrument is with what it determines.

use embassy_time::Instant;
use orientation::alignment::{Azimuth, Progress, Solution, rotating, stepwise, stops};
use orientation::roll;
use orientation::units::Radians;
use orientation::words;

/// How far the instrument is with its alignment, or with the roll of a spinning body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status {
    /// Nothing begins until it is ordered.
    Waiting,
    /// Devices are being started.
    Starting,
    /// The stage searches its index.
    Homing,
    /// The stage stands still for the survey of the gyro's noise.
    Surveying,
    /// Dwells, or turns, are being measured: how many are completed, and how many are planned.
    Measuring([u16; 2]),
    /// The vehicle stands at a stop, with this number from 1, whose inclination is being measured.
    Levelling(u16),
    /// The stop with this number, from 1, was long enough, and the vehicle may drive on.
    MayDrive(u16),
    /// The vehicle is in motion.
    Driving,
    /// The alignment has concluded with an azimuth of body x, and when.
    Concluded(Azimuth, Instant),
    /// The alignment has concluded without an azimuth; the log has the reason.
    Refused,
    /// The roll angle of a spinning body is tracked: the angle and its 1σ, if it is known, and what it rests on.
    Rolling(Option<[Radians; 2]>, roll::Condition),
    /// The tracking of the roll has ended; the log has the reason.
    RollEnded,
}

impl Status {
    /// The status as long as the mechanism's angles are not valid: homing, unless the alignment is
    /// over already, or none is to begin.
    #[must_use]
    pub fn before_homing(self) -> Self {
        match self {
            Self::Starting | Self::Surveying | Self::Measuring(_) => Self::Homing,
            other => other,
        }
    }

    /// The status after a progress of the alignment.
    #[must_use]
    pub fn after(self, progress: &Progress, now: Instant) -> Self {
        let measuring = |done: usize, of: usize| Self::Measuring([done as u16, of as u16]);
        match *progress {
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
                Self::Rolling(sigma.map(|sigma| [angle, sigma]), condition)
            }
            Progress::Roll(roll::Progress::Ended(_)) => Self::RollEnded,
            Progress::Concluded(Solution { azimuth, .. }) => Self::Concluded(azimuth, now),
            Progress::Refused(_) => Self::Refused,
            _ => self,
        }
    }

    /// The step that the instrument is at, in words for whom it concerns: the driver of a vehicle, who is to stand or may
    /// drive on. [`None`] where nothing begins, and where the log tells it.
    #[must_use]
    pub fn step(self) -> Option<Step> {
        match self {
            Self::Homing => Some(Step::Homing),
            Self::Surveying => Some(Step::Surveying),
            Self::Measuring(_) => Some(Step::Measuring),
            Self::Levelling(stop) => Some(Step::Levelling(stop)),
            Self::MayDrive(stop) => Some(Step::MayDrive(stop)),
            Self::Driving => Some(Step::Driving),
            _ => None,
        }
    }
}

/// A step of an alignment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The stage searches its index.
    Homing,
    /// The noise of the gyro is being measured.
    Surveying,
    /// Dwells, or turns, are being measured.
    Measuring,
    /// The inclination at this stop of a vehicle is being measured.
    Levelling(u16),
    /// This stop of a vehicle was long enough.
    MayDrive(u16),
    /// The vehicle is in motion.
    Driving,
}

words! { Step:
    Self::Homing => "homing";
    Self::Surveying => "surveying";
    Self::Measuring => "measuring";
    Self::Levelling(stop) => "levelling at stop {}", stop;
    Self::MayDrive(stop) => "stop {} done, may drive", stop;
    Self::Driving => "driving";
}

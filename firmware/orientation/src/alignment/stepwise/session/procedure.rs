//! Procedure of a multi-position alignment: schedule, retries, travel and tolerances.

use super::schedule::{Schedule, StopRule};
use crate::alignment::period::PERIOD_TOLERANCE;
use crate::alignment::setup::{LONGEST, PERIODS, SetupError, check_ranges};
use crate::alignment::stepwise::criterion::Criterion;
use crate::planner::order::Order;
use crate::planner::{POSITIONS, Rotation};
use crate::units::{Radians, Seconds, TURN};

/// Product of the filter's cut-off and the shortest dwell: the taper then costs 1.2 % of σ.
const CUTOFF_DWELLS: f64 = 20.0;
/// Highest cut-off over the sample rate at which the filter still has an effect.
const HIGHEST_CUTOFF: f64 = 0.2;
/// Lowest cut-off over the sample rate at which the filter's coefficients are accurate enough.
const LOWEST_CUTOFF: f64 = 2.5e-4;

/// Change of the encoder angle that counts as standstill: seven steps of a 21-bit encoder.
pub const STILL: Radians = Radians(20e-6);

/// Survey of the gyro's noise, and conditions of the plan that follows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Survey {
    /// Time for which the stage stands still.
    pub seconds: Seconds,
    /// Rotation time of the stage.
    pub rotation: Rotation,
    /// Orders of positions that the stage can turn through; text does not hold them, because they
    /// belong to the mount.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub orders: &'static [Order],
    /// Length of the shortest dwell of the plan.
    pub shortest: Seconds,
    /// Total time of the plan; with [`StopRule::Accuracy`] the accuracy decides instead.
    pub plan_seconds: Seconds,
}

/// Procedure of a session.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Procedure {
    /// Positions and dwells.
    pub schedule: Schedule,
    /// Survey of the gyro's noise before the dwells, after which the schedule is planned anew; none
    /// without one.
    pub survey: Option<Survey>,
    /// Rule by which the session stops early.
    pub stop: StopRule,
    /// Criterion by which the azimuth is chosen.
    pub criterion: Criterion,
    /// Sample period.
    pub sample_seconds: Seconds,
    /// Tolerance of the time stamps' mean step against that period, relative.
    pub period_tolerance: f64,
    /// Time for which the platform is levelled before the first dwell; these samples are part of
    /// that dwell all the same.
    pub level_seconds: Seconds,
    /// Time for which the stage must stand before it counts as arrived; these samples are part
    /// of the dwell all the same. A stage that rings after its stop needs as long as it rings.
    pub settle_seconds: Seconds,
    /// Greatest number of repetitions of a disturbed dwell at its position.
    pub retries: usize,
    /// Longest time for the whole session.
    pub longest_seconds: Seconds,
    /// Longest time for one rotation.
    pub longest_rotation: Seconds,
    /// Stage travel from lowest to highest angle.
    pub travel: [Radians; 2],
    /// Change of the encoder angle that counts as standstill.
    pub still: Radians,
    /// Distance from the commanded angle that counts as arrived.
    pub arrival: Radians,
}

impl Procedure {
    /// Default procedure of the stage: a quarter of a dwell before the tilt is tested, travel
    /// −10°…370°, two repetitions, standstill within 20 µrad (seven steps of a 21-bit encoder),
    /// arrival within 0.05°, five minutes for a rotation (enough for a stage to home again), and
    /// for the session twice the dwells' time, half a minute for each dwell and a minute for
    /// everything else.
    pub fn new(schedule: Schedule, sample_seconds: Seconds) -> Self {
        let level_seconds = Seconds(0.25 * schedule.shortest().0);
        let longest = 2.0 * schedule.seconds().0 + 30.0 * schedule.len() as f64 + 60.0;
        Self {
            schedule,
            survey: None,
            stop: StopRule::AllPositions,
            criterion: Criterion::MaximumLikelihood,
            sample_seconds,
            period_tolerance: PERIOD_TOLERANCE,
            level_seconds,
            settle_seconds: Seconds(0.0),
            retries: 2,
            longest_seconds: Seconds(longest),
            longest_rotation: Seconds(300.0),
            travel: [-10.0 / 360.0 * TURN, 370.0 / 360.0 * TURN].map(Radians),
            still: STILL,
            arrival: Radians(0.05 / 360.0 * TURN),
        }
    }

    /// Procedure with a survey of the gyro's noise before the dwells; the longest time grows
    /// accordingly.
    pub fn after(self, survey: Survey) -> Self {
        let planned = survey.seconds.0 + survey.plan_seconds.0;
        let retry_budget = 2.0 * planned + 30.0 * POSITIONS as f64;
        let longest_seconds = Seconds(self.longest_seconds.0 + retry_budget);
        Self { survey: Some(survey), longest_seconds, ..self }
    }

    /// Procedure that continues until the accuracy of
    /// [`crate::alignment::site::Site::required_sigma`] is reached or `seconds` have passed.
    pub fn until_accurate(self, seconds: Seconds) -> Self {
        let retry_budget = 2.0 * seconds.0 + 30.0 * POSITIONS as f64 + 60.0;
        let longest_seconds = Seconds(self.longest_seconds.0.max(retry_budget));
        Self { stop: StopRule::Accuracy { seconds }, longest_seconds, ..self }
    }

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`].
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let (time, angle, [lowest, highest]) = ([0.0, LONGEST], [0.0, TURN], self.travel);
        check_ranges(&[
            ("sample_seconds", self.sample_seconds.0, PERIODS),
            ("period_tolerance", self.period_tolerance, [0.0, 1.0]),
            ("level_seconds", self.level_seconds.0, time),
            ("settle_seconds", self.settle_seconds.0, time),
            ("longest_seconds", self.longest_seconds.0, [0.0, f64::INFINITY]),
            ("longest_rotation", self.longest_rotation.0, [0.0, f64::INFINITY]),
            ("travel", lowest.0, [f64::NEG_INFINITY, highest.0]),
            ("travel", highest.0, [lowest.0, f64::INFINITY]),
            ("still", self.still.0, angle),
            ("arrival", self.arrival.0, angle),
        ])
    }

    /// Cut-off of the filter for this schedule, Hz.
    #[must_use]
    pub fn cutoff(&self) -> f64 {
        let rate = 1.0 / self.sample_seconds.0;
        // The method `clamp` would link a panic that formats floats, 15 KB of flash.
        (CUTOFF_DWELLS / self.schedule.shortest().0)
            .max(LOWEST_CUTOFF * rate)
            .min(HIGHEST_CUTOFF * rate)
    }

    /// First position that lies beyond the stage's travel.
    pub(super) fn beyond_travel(&self) -> Option<Radians> {
        let [low, high] = self.travel;
        let outside = |angle: Radians| !(low..=high).contains(&angle);
        match &self.schedule {
            Schedule::Listed(list) => list.iter().map(|p| p.angle).find(|&angle| outside(angle)),
            Schedule::Planned(plan) => {
                (0..plan.positions()).map(|index| plan.angle(index)).find(|&angle| outside(angle))
            }
            Schedule::TowardMaximum { start, .. } => outside(*start).then_some(*start),
        }
    }
}

//! Procedure of a session: schedule, retry budget, travel and tolerances, and the conditions that
//! make one impossible.

use super::schedule::{Schedule, StopRule};
use super::survey::Survey;
use crate::align::POSITIONS;
use crate::align::criterion::Criterion;
use crate::error::Refusal;
use crate::signal::butterworth::DesignError;
use crate::units::TURN;
use crate::words::Rounded;

/// Product of the filter's cut-off and the shortest dwell: the taper then costs 1.2 % of σ.
const CUTOFF_DWELLS: f64 = 20.0;
/// Highest cut-off over the sample rate at which the filter still has an effect.
const HIGHEST_CUTOFF: f64 = 0.2;
/// Lowest cut-off over the sample rate at which the filter's coefficients are accurate enough.
const LOWEST_CUTOFF: f64 = 2.5e-4;

/// Change of the encoder angle that counts as standstill, rad: seven steps of a 21-bit encoder.
pub const STILL: f64 = 20e-6;

/// Default tolerance of the time stamps' mean step against the period, relative: a recorder's clock
/// is far better, a converter's own oscillator is not.
pub(super) const PERIOD_TOLERANCE: f64 = 0.01;
/// Tolerance of the ADS1262's internal oscillator, 2 % (data sheet SBAS661C, §7.5, internal
/// oscillator accuracy), which holds for a board's samples.
pub const CONVERTER_TOLERANCE: f64 = 0.02;

/// Refuses samples whose time stamps show a period of `found` s where `stated` s is configured,
/// beyond a relative tolerance.
pub(super) fn contradiction(stated: f64, found: f64, tolerance: f64) -> Option<Refusal> {
    let is_off = (found / stated - 1.0).abs() > tolerance;
    is_off.then_some(Refusal::PeriodContradicted { stated: 1e3 * stated, found: 1e3 * found })
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
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Tolerance of the time stamps' mean step against that period, relative.
    pub period_tolerance: f64,
    /// Time for which the platform is levelled before the first dwell, s; these samples are part of
    /// that dwell all the same.
    pub level_seconds: f64,
    /// Time for which the stage must stand before it counts as arrived, s; these samples are part
    /// of the dwell all the same. A stage that rings after its stop needs as long as it rings.
    pub settle_seconds: f64,
    /// Greatest number of repetitions of a disturbed dwell at its position.
    pub retries: usize,
    /// Longest time for the whole session, s.
    pub longest_seconds: f64,
    /// Longest time for one rotation, s.
    pub longest_rotation: f64,
    /// Stage travel from lowest to highest angle, rad.
    pub travel: [f64; 2],
    /// Change of the encoder angle that counts as standstill, rad.
    pub still: f64,
    /// Distance from the commanded angle that counts as arrived, rad.
    pub arrival: f64,
}

impl Procedure {
    /// Default procedure of the stage: a quarter of a dwell before the tilt is tested, travel
    /// −10°…370°, two repetitions, standstill within 20 µrad (seven steps of a 21-bit encoder),
    /// arrival within 0.05°, five minutes for a rotation (enough for a stage to home again), and
    /// for the session twice the dwells' time, half a minute for each dwell and a minute for
    /// everything else.
    pub fn new(schedule: Schedule, sample_seconds: f64) -> Self {
        let level_seconds = 0.25 * schedule.shortest();
        let longest_seconds = 2.0 * schedule.seconds() + 30.0 * schedule.len() as f64 + 60.0;
        Self {
            schedule,
            survey: None,
            stop: StopRule::AllPositions,
            criterion: Criterion::MaximumLikelihood,
            sample_seconds,
            period_tolerance: PERIOD_TOLERANCE,
            level_seconds,
            settle_seconds: 0.0,
            retries: 2,
            longest_seconds,
            longest_rotation: 300.0,
            travel: [-10.0 / 360.0 * TURN, 370.0 / 360.0 * TURN],
            still: STILL,
            arrival: 0.05 / 360.0 * TURN,
        }
    }

    /// Procedure with a survey of the gyro's noise before the dwells; the longest time grows
    /// accordingly.
    pub fn after(self, survey: Survey) -> Self {
        let retry_budget = 2.0 * (survey.seconds + survey.plan_seconds) + 30.0 * POSITIONS as f64;
        let longest_seconds = self.longest_seconds + retry_budget;
        Self { survey: Some(survey), longest_seconds, ..self }
    }

    /// Procedure that continues until the accuracy of
    /// [`crate::align::setting::Setting::required_sigma`] is reached or `seconds` have passed.
    pub fn until_accurate(self, seconds: f64) -> Self {
        let retry_budget = 2.0 * seconds + 30.0 * POSITIONS as f64 + 60.0;
        let longest_seconds = self.longest_seconds.max(retry_budget);
        Self { stop: StopRule::Accuracy { seconds }, longest_seconds, ..self }
    }

    /// Cut-off of the filter for this schedule, Hz.
    #[must_use]
    pub fn cutoff(&self) -> f64 {
        let rate = 1.0 / self.sample_seconds;
        // The method `clamp` would link a panic that formats floats, 15 KB of flash.
        (CUTOFF_DWELLS / self.schedule.shortest())
            .max(LOWEST_CUTOFF * rate)
            .min(HIGHEST_CUTOFF * rate)
    }

    /// First position that lies beyond the stage's travel, rad.
    pub(super) fn beyond_travel(&self) -> Option<f64> {
        let [low, high] = self.travel;
        let outside = |angle: f64| !(low..=high).contains(&angle);
        match &self.schedule {
            Schedule::Listed(list) => list.iter().map(|p| p.angle).find(|&angle| outside(angle)),
            Schedule::Planned(plan) => {
                (0..plan.positions()).map(|index| plan.angle(index)).find(|&angle| outside(angle))
            }
            Schedule::TowardMaximum { start, .. } => outside(*start).then_some(*start),
        }
    }
}

/// Reason for which a procedure cannot begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProcedureError {
    /// The filter cannot be designed for this sample rate.
    Filter(DesignError),
    /// Dwells of this many samples are too short for the filter's lag.
    DwellTooShort {
        /// Number of samples of the shortest dwell.
        samples: u32,
        /// Number of samples that the filter needs.
        needed: u32,
    },
    /// A position lies outside the stage's travel, rad.
    BeyondTravel(f64),
    /// The schedule has no position.
    NoPosition,
    /// A rotating platform lacks speeds above zero, two turns in each sense, or a modulation of its
    /// rate-modulated turns.
    NoSpeed,
    /// The stops of a vehicle lack a sample period or a length, or there are fewer than two or too
    /// many of them.
    NoStops,
    /// The reference table (etalon) in flash fails its CRC: the firmware must be programmed again.
    TableCorrupt,
}

crate::words! { ProcedureError:
    Self::Filter(error) => "no filter for this sample rate: {}", error;
    Self::DwellTooShort { samples, needed } =>
        "the shortest dwell has {} samples; the filter needs {}", samples, needed;
    Self::BeyondTravel(angle) =>
        "position {}° is beyond the stage's travel", Rounded::<2>(angle / TURN * 360.0);
    Self::NoPosition => "there is no position";
    Self::NoStops =>
        "stops need a sample period and a length above zero, and two to eight of them";
    Self::NoSpeed =>
        "a turning platform needs one or two speeds above zero, two turns in either sense, a modulation";
    Self::TableCorrupt => "the etalon table fails its checksum";
}

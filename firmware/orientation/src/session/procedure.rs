//! How a session goes about it: schedule, retry budget, travel, and what makes a procedure impossible.

use super::schedule::{Schedule, StopRule};
use super::survey::Survey;
use crate::align::POSITIONS;
use crate::align::criterion::Criterion;
use crate::error::Refusal;
use crate::signal::butterworth::DesignError;
use crate::units::TURN;
use crate::words;
use crate::words::Rounded;

/// The filter's cut-off times the shortest dwell: its taper then costs 1.2 % of σ.
const CUTOFF_DWELLS: f64 = 20.0;
/// Highest cut-off over the sample rate, so that the filter still filters.
const HIGHEST_CUTOFF: f64 = 0.2;
/// Lowest cut-off over the sample rate at which the filter's coefficients are exact enough.
const LOWEST_CUTOFF: f64 = 2.5e-4;

/// Change of the encoder angle that still counts as standing, rad: seven steps of a 21-bit encoder.
pub const STILL: f64 = 20e-6;

/// How far the samples' times may be off their period where nothing else is stated, relative: a recorder's clock
/// is far better, a converter's own oscillator is not.
pub(super) const PERIOD_TOLERANCE: f64 = 0.01;
/// By how much the ADS1262's own oscillator may be off, 2 % (data sheet SBAS661C, §7.5: internal oscillator
/// accuracy): what a board's samples keep to.
pub const CONVERTER_TOLERANCE: f64 = 0.02;

/// Refuses samples that take `found` s by their times where they take `told` s as told, beyond a tolerance.
pub(super) fn contradiction(told: f64, found: f64, tolerance: f64) -> Option<Refusal> {
    let is_off = (found / told - 1.0).abs() > tolerance;
    is_off.then_some(Refusal::PeriodContradicted { told: 1e3 * told, found: 1e3 * found })
}

/// How the session goes about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    /// Where the stage goes.
    pub schedule: Schedule,
    /// What is learnt of the gyro first; the schedule is then made anew.
    pub survey: Option<Survey>,
    /// When it stops early.
    pub stop: StopRule,
    /// How the azimuth is found.
    pub criterion: Criterion,
    /// Sample period, s.
    pub sample_seconds: f64,
    /// How far the mean step of the samples' times may be off that period, relative.
    pub period_tolerance: f64,
    /// How long the platform is levelled before the first dwell counts, s; these samples belong to
    /// that dwell all the same.
    pub level_seconds: f64,
    /// How long the stage must stand before it counts as arrived, s; these samples belong to the
    /// dwell all the same. A stage that rings after it has stopped needs as long as it rings.
    pub settle_seconds: f64,
    /// How often a disturbed dwell is repeated at its position.
    pub retries: usize,
    /// Longest time for the whole session, s.
    pub longest_seconds: f64,
    /// Longest time for one rotation, s.
    pub longest_rotation: f64,
    /// Stage travel from lowest to highest angle, rad.
    pub travel: [f64; 2],
    /// Change of the encoder angle that still counts as standing, rad.
    pub still: f64,
    /// Distance from the commanded angle that counts as arrived, rad.
    pub arrival: f64,
}

impl Procedure {
    /// The default of the stage: a quarter of a dwell for the first look at the tilt, travel
    /// −10°…370°, two repetitions, stand within 20 µrad (seven steps of a 21-bit encoder), arrive
    /// within 0.05°, five minutes for a rotation, in which a stage can home again, and twice the
    /// dwells' time, half a minute for each and a minute for everything.
    #[must_use]
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

    /// The same, once the gyro's noise is known from a survey.
    #[must_use]
    pub fn after(self, survey: Survey) -> Self {
        let retry_budget = 2.0 * (survey.seconds + survey.plan_seconds) + 30.0 * POSITIONS as f64;
        let longest_seconds = self.longest_seconds + retry_budget;
        Self { survey: Some(survey), longest_seconds, ..self }
    }

    /// The same, until the accuracy of [`crate::align::setting::Setting::required_sigma`] is reached or
    /// so many seconds have passed.
    #[must_use]
    pub fn until_accurate(self, seconds: f64) -> Self {
        let retry_budget = 2.0 * seconds + 30.0 * POSITIONS as f64 + 60.0;
        let longest_seconds = self.longest_seconds.max(retry_budget);
        Self { stop: StopRule::Accuracy { seconds }, longest_seconds, ..self }
    }

    /// The filter's cut-off for this schedule, Hz.
    #[must_use]
    pub fn cutoff(&self) -> f64 {
        let rate = 1.0 / self.sample_seconds;
        // `clamp` would bring a panic that formats floats, 15 KB of it.
        (CUTOFF_DWELLS / self.schedule.shortest())
            .max(LOWEST_CUTOFF * rate)
            .min(HIGHEST_CUTOFF * rate)
    }

    /// The first position that is beyond the stage's travel.
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

/// Why a procedure cannot be begun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProcedureError {
    /// The filter cannot be designed for this sample rate.
    Filter(DesignError),
    /// Dwells of this many samples are too short for the filter's lag.
    DwellTooShort {
        /// Samples of the shortest dwell.
        samples: u32,
        /// Samples that are needed.
        needed: u32,
    },
    /// A position lies outside the stage's travel, rad.
    BeyondTravel(f64),
    /// There is no position.
    NoPosition,
    /// A turning platform needs speeds above zero, two turns at least, and a modulation of its uneven turns.
    NoSpeed,
    /// A vehicle's stops: no sample period, no length of a stop, one stop only, or too many.
    NoStops,
    /// The etalon table in flash fails its CRC: flash the firmware again.
    TableCorrupt,
}

words! { ProcedureError:
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

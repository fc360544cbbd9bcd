//! What a board kept after its alignment, beside the truth.

use std::cell::RefCell;
use std::f64::consts::{PI, TAU};

use hal_mock::earth::Attitude;
use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::sensor_fault::SensorFault;
use hal_mock::vehicle::Event;
use hal_mock::vehicle::motion::Motion;
use orientation::alignment::Azimuth;
use orientation::attitude::{Realigned, Report};
use orientation::navigation::Progress;
use orientation::units;
use simulated::base::{self, SimulatedBase};
use simulated::fault::{Fault, Injection};
use simulated::keep::{Day, journey};
use simulated::scenario::Scenario;

use super::{Run, RunError};

/// What alignments found to be kept, and how azimuths that came while one was kept agreed with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Realignments {
    /// What each alignment found, and the sample to which it belongs.
    pub found: Vec<(units::Instant, Azimuth)>,
    /// How often one agreed.
    pub fused: usize,
    /// When the first alignment was refused, and why; none where it was not, and where it is not told.
    pub first_refused: Option<String>,
    /// The same of the latest alignment anew.
    pub refused: Option<String>,
    /// By how many σ the latest one disagreed, so that neither is believed; none where it did not.
    pub disagreement: Option<f64>,
}

impl Realignments {
    /// Takes what a navigator reports.
    pub fn take(&mut self, progress: &Progress) {
        let Progress::HandedOver(_, realigned) = progress else { return };
        self.disagreement = match *realigned {
            Realigned::Disagrees { sigmas } => Some(sigmas),
            Realigned::Taken | Realigned::Fused { .. } => None,
        };
        self.fused += usize::from(matches!(realigned, Realigned::Fused { .. }));
    }
}

/// What goes wrong with a board on a base, in the middle of its alignment or later.
#[derive(Clone, Debug)]
pub struct KeptPlan {
    /// Faults of the chips of a stage or of two frames, of its axes, and of the coarse IMU's bus.
    pub chips: Injection,
    /// Faults of what the coarse sensors feel.
    pub base: Vec<SensorFault>,
    /// What else happens on the way.
    pub events: Vec<Event>,
}

impl KeptPlan {
    /// What a fault in the middle of the alignment does, or nothing.
    #[must_use]
    pub fn of(fault: Option<Fault>) -> Self {
        Self { chips: Injection::of(fault), base: Vec::new(), events: Vec::new() }
    }

    /// Runs a board on a base with coarse sensors, which goes along a day after the alignment, of so many
    /// seconds, where the scenario goes on; then looks at what was kept.
    ///
    /// # Errors
    /// Those of the run.
    pub(super) fn on_base<R, T>(
        &self,
        scenario: &Scenario,
        alignment_s: f64,
        run: impl FnOnce(
            &mut SimulatedBase<'_, '_, Injection>,
            Option<JourneyConfiguration<'_>>,
        ) -> Result<Run<R, T>, RunError>,
    ) -> Result<Run<R, T>, RunError> {
        let day = self.day(scenario.day(alignment_s));
        let journey = journey(&day, &self.base);
        let journey = (scenario.hold.seconds > 0.0).then_some(journey);
        let rig = RefCell::new(base::rig(scenario, journey.as_ref()));
        let mut run = run(&mut base::imu(&rig, scenario, &self.chips), journey)?;
        let rig = rig.borrow();
        let violations = base::violations(&rig).iter();
        run.violations.extend(violations.map(|violation| format!("Base: {violation}")));
        run.compare(day.configuration().motion());
        Ok(run)
    }

    /// A day with what happens on the way; of too many events the first ones.
    fn day(&self, day: Day) -> Day {
        let mut day = day;
        let room = self.events.len().min(day.events.capacity() - day.events.len());
        day.events.extend(self.events.iter().take(room).copied());
        day
    }
}

/// Something that was kept at one moment, with its truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// What the keeper reported.
    pub report: Report,
    /// What was true; not numbers where that is not known.
    pub truth: Attitude,
}

/// An angle the short way, (−π, π].
fn short(angle: f64) -> f64 {
    PI - (PI - angle).rem_euclid(TAU)
}

impl Point {
    /// Time, s from power-on.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.report.time.seconds()
    }

    /// Error of the azimuth and its stated 1σ, rad; none where it is not known.
    #[must_use]
    pub fn azimuth_error(&self) -> Option<[f64; 2]> {
        let azimuth = self.report.azimuth?;
        Some([short(azimuth.angle.0 - self.truth.azimuth_rad), azimuth.sigma.0])
    }

    /// The azimuth, its stated 1σ and its error, °; none where it is not known.
    #[must_use]
    pub fn azimuth_deg(&self) -> Option<[f64; 3]> {
        let [error, sigma] = self.azimuth_error()?;
        Some([self.report.azimuth?.angle.0, sigma, error].map(f64::to_degrees))
    }

    /// Errors of pitch and roll, rad.
    #[must_use]
    pub fn level_error(&self) -> [f64; 2] {
        let Report { pitch, roll, .. } = self.report;
        [short(pitch.0 - self.truth.pitch_rad), short(roll.0 - self.truth.roll_rad)]
    }
}

/// What was kept, once a second.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// In rising order of time.
    pub points: Vec<Point>,
}

impl<R, T> Run<R, T> {
    /// Sets the truth beside what was found and kept.
    pub(super) fn compare(&mut self, mut motion: Motion<'_>) {
        let mut truth = |at: units::Instant| {
            motion.advance(at.seconds());
            motion.attitude()
        };
        let latest = self.found.last().map(|(at, _)| *at);
        let (mut points, mut found_rad) = (Vec::with_capacity(self.reports.len()), None);
        for report in &self.reports {
            // The course goes on alone: what lies before the report is asked for first.
            let is_next = |found: &units::Instant| found_rad.is_none() && *found <= report.time;
            if let Some(found) = latest.filter(is_next) {
                found_rad = Some(truth(found).azimuth_rad);
            }
            points.push(Point { report: *report, truth: truth(report.time) });
        }
        (self.kept, self.found_rad) = (Kept { points }, found_rad);
    }
}

impl Kept {
    /// What was kept at last.
    #[must_use]
    pub fn last(&self) -> Option<&Point> {
        self.points.last()
    }

    /// Points with an azimuth, with its error and 1σ, rad.
    pub fn with_azimuth(&self) -> impl Iterator<Item = (&Point, [f64; 2])> {
        self.points.iter().filter_map(|point| Some((point, point.azimuth_error()?)))
    }
}

//! What a board kept after its alignment, beside the truth.

use std::f64::consts::{PI, TAU};

use hal_mock::earth::Attitude;
use hal_mock::vehicle::motion::Motion;
use orientation::keep::Report;

/// The true attitude at rising times.
pub trait Truths {
    /// At a time in s from the start.
    fn at(&mut self, time_s: f64) -> Attitude;
}

impl Truths for Motion<'_> {
    fn at(&mut self, time_s: f64) -> Attitude {
        self.advance(time_s);
        self.attitude()
    }
}

/// Something that was kept at one moment, with its truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// What the keeper reported.
    pub report: Report,
    /// What was true.
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
        Some([short(azimuth.angle - self.truth.azimuth_rad), azimuth.sigma])
    }

    /// Errors of pitch and roll, rad.
    #[must_use]
    pub fn level_error(&self) -> [f64; 2] {
        let Report { pitch, roll, .. } = self.report;
        [short(pitch - self.truth.pitch_rad), short(roll - self.truth.roll_rad)]
    }
}

/// What was kept, once a second.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// In rising order of time.
    pub points: Vec<Point>,
}

impl Kept {
    /// Reports with the truth of their moments.
    pub(super) fn of(reports: &[Report], mut truths: impl Truths) -> Self {
        let point =
            |report: &Report| Point { report: *report, truth: truths.at(report.time.seconds()) };
        Self { points: reports.iter().map(point).collect() }
    }

    /// What was kept at last.
    #[must_use]
    pub fn last(&self) -> Option<&Point> {
        self.points.last()
    }

    /// Those from an azimuth on.
    pub fn with_azimuth(&self) -> impl Iterator<Item = (&Point, [f64; 2])> {
        self.points.iter().filter_map(|point| Some((point, point.azimuth_error()?)))
    }
}

//! What only a simulated run has: how its board did, and what it kept after the alignment.

use std::time::Duration;

use firmware::event::Event;
use firmware::health::Health;
use firmware::remembered::Remembered;
use orientation::attitude::Realigned;
use orientation::navigation::Progress;
use serde::Serialize;

use crate::instrument::Run;
use crate::instrument::kept::{Kept, Point};
use crate::output::{degrees, positive_zero};
use crate::report::{self, Figure, Lines, Part, Series, Style};

/// What only a simulated run has.
#[derive(Clone, Debug, Serialize)]
pub struct RunDetails {
    /// Simulated time from power-on to the end, s.
    pub simulated_seconds: f64,
    /// What went wrong on the board, counted.
    pub health: HealthDetails,
    /// Stored axis misalignments that the board used; of a turntable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recalled: Option<Vec<RecalledDetails>>,
    /// Whether the gyro stands vertical at the end, to keep the azimuth; of two frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stored: Option<bool>,
    /// True angle between its axis and the vertical then, °; of two frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub truth_off_vertical_deg: Option<f64>,
    /// What was kept after the alignment, where anything was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kept: Option<KeptDetails>,
    /// Samples a second.
    #[serde(skip)]
    rate_hz: f64,
    /// Time that the run took on this machine, s.
    #[serde(skip)]
    wall_s: f64,
    /// Error of what was kept over time.
    #[serde(skip)]
    figures: Vec<Figure>,
}

/// What went wrong on the board, counted.
#[derive(Clone, Debug, Serialize)]
pub struct HealthDetails {
    /// Counts of the board itself.
    #[serde(flatten)]
    pub counts: Health,
    /// Accesses that a data sheet forbids, in words.
    pub violations: Vec<String>,
}

/// A stored axis misalignment.
#[derive(Clone, Debug, Serialize)]
pub struct RecalledDetails {
    /// Angle between the sensitive axis and the platform's plane, °.
    pub coupling_deg: f64,
    /// Speed of the turn at which it was found, turns a second.
    pub speed_hz: f64,
    /// Day on which it was found.
    pub date: String,
    /// Temperature at which it was found, °C.
    pub temperature_c: f32,
    /// In words.
    #[serde(skip)]
    words: String,
}

impl From<&Remembered> for RecalledDetails {
    fn from(found: &Remembered) -> Self {
        Self {
            coupling_deg: found.angle,
            speed_hz: found.rate / 360.0,
            date: found.day.to_string(),
            temperature_c: found.temperature,
            words: found.to_string(),
        }
    }
}

/// What was kept at last, and how well on the way.
#[derive(Clone, Debug, Serialize)]
pub struct KeptDetails {
    /// For how long the azimuth was kept, s.
    pub seconds: f64,
    /// Azimuth of body x, °; null where it was lost, or never known.
    pub azimuth_deg: Option<f64>,
    /// 1σ of the azimuth, °.
    pub sigma_deg: Option<f64>,
    /// Error of the azimuth, °.
    pub error_deg: Option<f64>,
    /// The greatest error on the way, over its σ of the moment.
    pub greatest_sigmas: Option<f64>,
    /// Pitch, °.
    pub pitch_deg: f64,
    /// Roll, °.
    pub roll_deg: f64,
    /// 1σ of either, °.
    pub level_sigma_deg: f64,
    /// Errors of pitch and roll, °.
    pub level_error_deg: [f64; 2],
    /// RMS errors of pitch and roll since an azimuth was kept, °.
    pub level_rms_deg: [f64; 2],
    /// What the keeper was about.
    pub state: String,
    /// How often a later azimuth agreed with what was kept.
    pub realigned: usize,
}

impl RunDetails {
    /// The details of a run with samples at `rate_hz` that took `wall` here.
    #[must_use]
    pub fn of<R>(run: &Run<R>, rate_hz: f64, wall: Duration) -> Self {
        Self {
            simulated_seconds: run.seconds,
            health: HealthDetails { counts: run.health, violations: run.violations.clone() },
            recalled: None,
            stored: None,
            truth_off_vertical_deg: None,
            kept: KeptDetails::of(run),
            rate_hz,
            wall_s: wall.as_secs_f64(),
            figures: figures(&run.kept),
        }
    }

    /// The lines about the run, then the figures of what was kept.
    pub(super) fn parts(&self) -> Vec<Part> {
        let kept = self.kept.as_ref().map(KeptDetails::lines);
        let lines = kept.into_iter().chain([self.lines()]).map(Part::from);
        lines.chain(self.figures.iter().cloned().map(Part::from)).collect()
    }

    fn lines(&self) -> Lines {
        let mut lines = Lines::new("The simulated board");
        for found in self.recalled.iter().flatten() {
            lines.add("recalled", &found.words);
        }
        let (seconds, rate, wall) = (self.simulated_seconds, self.rate_hz, self.wall_s);
        let ratio = seconds / wall;
        let text =
            format!("{seconds:.1} s at {rate} Hz in {wall:.2} s: {ratio:.0} times real time");
        lines.add("simulated", text);
        let Health { samples, missing, late, overflowed, lost, restarts, .. } = &self.health.counts;
        let text =
            format!("{samples} taken, {missing} missing, {late} late, {overflowed} overflowed");
        lines.add("samples", text);
        let [lost, restarts]: [u32; 2] =
            [lost, restarts].map(|counts| counts.iter().map(|n| u32::from(*n)).sum());
        lines.add("devices", format!("{lost} readings lost, {restarts} restarts"));
        for violation in &self.health.violations {
            lines.add("FORBIDDEN", violation);
        }
        if let Some((is_stored, off)) = self.stored.zip(self.truth_off_vertical_deg) {
            let what = if is_stored { "vertical, to store the azimuth" } else { "not stored" };
            lines.add("gyro", format!("{what}: truly {off:.4}° off the base's vertical"));
        }
        lines
    }
}

impl KeptDetails {
    /// What a run kept; `None` where it kept nothing.
    fn of<R>(run: &Run<R>) -> Option<Self> {
        let (kept, last) = (&run.kept, run.kept.last()?);
        let errors = last.azimuth_error();
        let greatest = kept.with_azimuth().map(|(_, [error, sigma])| error.abs() / sigma);
        let fused = |event: &Event| {
            matches!(event, Event::Navigation(Progress::HandedOver(_, Realigned::Fused { .. })))
        };
        Some(Self {
            seconds: last.report.seconds,
            azimuth_deg: last.report.azimuth.map(|azimuth| degrees(azimuth.angle)),
            sigma_deg: errors.map(|[_, sigma]| degrees(sigma)),
            error_deg: errors.map(|[error, _]| degrees(error)),
            greatest_sigmas: greatest.reduce(f64::max),
            pitch_deg: degrees(last.report.pitch),
            roll_deg: degrees(last.report.roll),
            level_sigma_deg: degrees(last.report.level_sigma),
            level_error_deg: last.level_error().map(degrees),
            level_rms_deg: level_rms(kept).map(degrees),
            state: last.report.state.to_string(),
            realigned: run.events.iter().filter(|(_, event)| fused(event)).count(),
        })
    }

    fn lines(&self) -> Lines {
        let mut lines = Lines::new(&format!("Kept for {:.0} s", self.seconds));
        match (self.azimuth_deg, self.sigma_deg, self.error_deg) {
            (Some(azimuth), Some(sigma), Some(error)) => {
                lines.add("azimuth of body x", format!("{azimuth:.4}° ± {sigma:.4}° (1σ)"));
                let (sigmas, greatest) = (error / sigma, self.greatest_sigmas.unwrap_or(0.0));
                let text =
                    format!("{error:+.4}°, {sigmas:+.2} σ; {greatest:.2} σ at most on the way");
                lines.add("its error", text);
            }
            _ => lines.add("azimuth of body x", "not known any more"),
        }
        let [pitch, roll] = [self.pitch_deg, self.roll_deg].map(|angle| positive_zero(angle, 5e-4));
        let sigma = self.level_sigma_deg;
        lines.add("pitch, roll", format!("{pitch:.3}°, {roll:.3}°, each ± {sigma:.3}° (1σ)"));
        let [pitch, roll] = self.level_rms_deg;
        lines.add("their errors", format!("{pitch:.3}°, {roll:.3}° RMS on the way"));
        lines.add("state", &self.state);
        if self.realigned > 0 {
            lines.add("realigned", format!("{} time(s)", self.realigned));
        }
        lines
    }
}

/// RMS of the errors of pitch and roll while an azimuth was kept, rad.
fn level_rms(kept: &Kept) -> [f64; 2] {
    let (mut squares, mut count) = ([0.0; 2], 0.0_f64);
    for (point, _) in kept.with_azimuth() {
        for (sum, error) in squares.iter_mut().zip(point.level_error()) {
            *sum += error * error;
        }
        count += 1.0;
    }
    squares.map(|sum| (sum / count.max(1.0)).sqrt())
}

/// The figures: the azimuth's error against its σ, and pitch and roll.
fn figures(kept: &Kept) -> Vec<Figure> {
    if kept.with_azimuth().next().is_none() {
        return Vec::new();
    }
    vec![heading(kept), level(kept)]
}

fn heading(kept: &Kept) -> Figure {
    let all =
        || kept.with_azimuth().map(|(point, [e, s])| (point.seconds(), degrees(e), degrees(s)));
    let band =
        |times: f64| all().map(move |(at, _, sigma)| report::Point::within(at, 0.0, times * sigma));
    let series = [
        Series::new("±3σ", Style::Band, band(3.0)),
        Series::new("±1σ", Style::Band, band(1.0)),
        Series::new("error", Style::Line, all().map(|(at, error, _)| (at, error))),
    ];
    let title = "Error of the kept azimuth, and its stated 1σ and 3σ";
    Figure::new(title, ["time from power-on", "s"], ["error", "°"], series)
}

fn level(kept: &Kept) -> Figure {
    let curve = |name: &str, of: &dyn Fn(&Point) -> f64| {
        let points = kept.with_azimuth().map(|(point, _)| (point.seconds(), degrees(of(point))));
        Series::new(name, Style::Line, points)
    };
    let series = [
        curve("true pitch", &|point| point.truth.pitch_rad),
        curve("true roll", &|point| point.truth.roll_rad),
        curve("error of pitch", &|point| point.level_error()[0]),
        curve("error of roll", &|point| point.level_error()[1]),
    ];
    let title = "Pitch and roll while the azimuth was kept";
    Figure::new(title, ["time from power-on", "s"], ["angle", "°"], series)
}

//! The whole instrument on simulated chips, in virtual time: one scenario in, one run out.

pub mod flash_file;
mod frames;
mod harness;
pub mod kept;
mod latest;
pub mod recorder;
pub mod replay;
mod spinning;
mod stage;
mod trial;
mod turntable;
mod vehicle;
mod wire;

pub use frames::FramesRun;
pub use spinning::{FlightPlan, SpinRun};
pub use stage::align_on;
pub use trial::{Carrier, Trial};
pub use turntable::TurntableRun;
pub use vehicle::{VehiclePlan, VehicleRun};
pub use wire::Traffic;

use embassy_time::Instant;
use firmware::event::Event;
use firmware::health::Health;
use firmware::ports::BaseReading;
use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::mount::MountError;
use orientation::alignment::{Azimuth, Progress};
use orientation::attitude::Report;
use orientation::units;

use thiserror::Error;

use self::kept::Kept;
use crate::methods::stepwise::Replay;
use crate::output::{azimuth_error, degrees};
use crate::recording::Truth;
use crate::report::Stretch;

/// A finished run of one kind of session, with what was true of its carrier.
#[derive(Clone, Debug)]
pub struct Run<R = Replay, T = ()> {
    /// The session with its conclusion, reported like a replay.
    pub replay: R,
    /// Whether the session was concluded before its own end, with what it had been given: the run was interrupted.
    pub is_cut_short: bool,
    /// What earlier alignments did that found an azimuth, too.
    pub earlier: Vec<Stretch>,
    /// What was true, where more is asked of it than an azimuth.
    pub truth: T,
    /// What the board reported, in order.
    pub events: Vec<(Instant, Event)>,
    /// What the keeper reported, once a second.
    pub reports: Vec<Report>,
    /// What coarse sensors on the base showed until the first alignment ended, with the times of reading.
    pub base: Vec<(Instant, BaseReading)>,
    /// What the link carried.
    pub lines: String,
    /// Virtual time from power-on to the end, s.
    pub seconds: f64,
    /// The azimuths that alignments handed over to be kept, and the samples to which they belong.
    pub found: Vec<(units::Instant, Azimuth)>,
    /// The true azimuth at the latest of those samples, rad; none where nothing was kept after it.
    pub found_rad: Option<f64>,
    /// What was kept after the alignment, with the truth.
    pub kept: Kept,
    /// What went wrong, counted.
    pub health: Health,
    /// What the drivers did that a data sheet forbids.
    pub violations: Vec<String>,
}

/// Difference of two azimuths, °, below which it is one that was rounded.
const ROUNDED_DEG: f64 = 1e-9;

impl<T> Run<Replay, T> {
    /// What the session concluded; every run concludes.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.replay.session.conclusion()
    }
}

impl<R, T> Run<R, T> {
    /// When the alignments that found an azimuth concluded, from power-on.
    fn conclusions(&self) -> impl DoubleEndedIterator<Item = Instant> {
        self.events.iter().filter_map(|(at, event)| {
            matches!(event, Event::Alignment(Progress::Concluded(_))).then_some(*at)
        })
    }

    /// Whether an alignment found an azimuth after another one had.
    #[must_use]
    pub fn is_realigned(&self) -> bool {
        self.conclusions().count() > 1
    }

    /// The true azimuth at the latest alignment's last sample, °, of a base that stood at an azimuth, °,
    /// until it drove.
    #[must_use]
    pub fn azimuth_deg(&self, first_deg: f64) -> f64 {
        let then = self.found_rad.map(|azimuth| degrees(azimuth).rem_euclid(360.0));
        // Of a base that has not driven since, they differ by what is rounded.
        let driven = then.filter(|azimuth| azimuth_error(*azimuth, first_deg).abs() > ROUNDED_DEG);
        driven.unwrap_or(first_deg)
    }

    /// What was kept on a base that stood at an azimuth, °, until the first alignment concluded, and what was true of the
    /// latest one.
    fn end(&self, first_deg: f64) -> (&Kept, Truth) {
        let azimuth_deg = Some(self.azimuth_deg(first_deg));
        (&self.kept, Truth { azimuth_deg, ..Truth::default() })
    }
}

/// Why a scenario could not be run; a refusal is not among them.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The latitude is outside ±90°.
    #[error("latitude {0}° is outside ±90°")]
    Latitude(f64),
    /// The session cannot begin.
    #[error("{0}")]
    Procedure(#[from] SetupError),
    /// The mount's calibration is impossible.
    #[error("{0}")]
    Mount(#[from] MountError),
    /// A sensor has a scale factor that is none.
    #[error("a sensor's scale factor is none")]
    Scale,
    /// Everything waited and nothing would have come.
    #[error("the instrument waits for something that never comes")]
    Deadlock,
}

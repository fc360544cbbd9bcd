//! The status line: one line of text per second over the serial link.
//!
//! ```text
//! measuring 5/24, faults 0
//! azimuth 213.702 sigma 0.033, faults 0
//! azimuth 250.114 sigma 0.041 pitch 1.204 roll -0.310 level, faults 0
//! ```
//!
//! Numbers are kept as integers of thousandths, so that the board needs no formatting of floats.

use core::fmt::Write as _;

use embassy_futures::select::select;
use embassy_time::{Duration, Timer, with_timeout};
use embedded_io_async::Write;
use heapless::String;
use orientation::words;

use crate::event::Event;
use crate::shared::Shared;

/// Time between two lines.
const PERIOD: Duration = Duration::from_secs(1);
/// Time limit for sending a line; the line is discarded beyond it. 160 bytes take 167 ms at 9600
/// baud (10 bits per byte).
const LONGEST: Duration = Duration::from_millis(500);
/// Capacity for the longest line, bytes: an attitude in the state with the longest name, recalled,
/// with all digits of the fault counter.
const LENGTH: usize = 160;

/// Status of the instrument. Angles are in thousandths of a degree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// The roll angle of a spinning body is tracked.
    Rolling {
        /// Roll angle and its 1σ, rounded up; [`None`] if the roll is unknown.
        roll: Option<[u32; 2]>,
        /// The state of the tracking, in a word.
        state: &'static str,
    },
    /// The tracking of the roll has ended; the log has the reason.
    RollEnded,
}

impl Status {
    /// The status of a found azimuth with its 1σ, both in degrees.
    #[must_use]
    pub fn concluded(azimuth: f64, sigma: f64) -> Self {
        // The azimuth is rounded to nearest and wrapped at a full turn; the 1σ is rounded up.
        let azimuth = libm::round(azimuth * 1e3) as u32 % 360_000;
        Self::Concluded { azimuth, sigma: libm::ceil(sigma * 1e3) as u32 }
    }

    /// Whether no other status follows.
    #[must_use]
    pub fn is_last(&self) -> bool {
        matches!(self, Self::Concluded { .. } | Self::Refused | Self::RollEnded)
    }
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
    Self::Rolling { roll: Some([roll, sigma]), state } =>
        "roll {} sigma {} {}", Thousandths(roll), Thousandths(sigma), state;
    Self::Rolling { roll: None, state } => "roll unknown, {}", state;
    Self::RollEnded => "no roll";
}

/// A number of thousandths, written as a decimal fraction.
pub(crate) struct Thousandths(pub(crate) u32);

words! { Thousandths:
    Self(number) => "{}.{:03}", number / 1000, number % 1000;
}

/// Sends a status line every second until the conclusion of the session has been sent. Runs for
/// ever beside a keeper.
pub async fn run<L: Write>(link: &mut L, shared: &Shared<'_>) {
    loop {
        let is_last = shared.status.get().is_last() && !shared.keep.is_wanted.get();
        send(link, shared).await;
        if is_last {
            return;
        }
        select(Timer::after(PERIOD), shared.concluded.wait()).await;
    }
}

/// Sends one status line. If the link does not take the line in time, the line is discarded and
/// counted; the first loss is also reported as an event.
pub async fn send<L: Write>(link: &mut L, shared: &Shared<'_>) {
    let mut line = String::<LENGTH>::new();
    let faults = shared.health.get().faults();
    // The capacity holds the longest line; a longer one would be cut.
    let _ = match shared.keep.attitude.get() {
        Some(kept) => write!(line, "{kept}, faults {faults}\r\n"),
        None => write!(line, "{}, faults {faults}\r\n", shared.status.get()),
    };
    if !matches!(with_timeout(LONGEST, link.write_all(line.as_bytes())).await, Ok(Ok(()))) {
        if shared.health.get().unsent == 0 {
            shared.report(Event::LinkSilent);
        }
        shared.count(|health| health.unsent = health.unsent.saturating_add(1));
    }
}

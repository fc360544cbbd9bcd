//! The status line: one line of text a second, for whoever listens.
//!
//! ```text
//! measuring 5/24, faults 0
//! azimuth 213.702 sigma 0.033, faults 0
//! azimuth 250.114 sigma 0.041 pitch 1.204 roll -0.310 level, faults 0
//! ```
//!
//! Numbers are integers of thousandths inside, so that no float formatting is needed on the board.

use core::fmt::{self, Write as _};

use embassy_futures::select::select;
use embassy_time::{Duration, Timer, with_timeout};
use embedded_io_async::Write;
use heapless::String;

use crate::event::Event;
use crate::ports::Observer;
use crate::shared::Shared;

/// Time between two lines.
const PERIOD: Duration = Duration::from_secs(1);
/// A link that does not take a line in this time loses it: 160 bytes take 167 ms at 9600 baud.
const LONGEST: Duration = Duration::from_millis(500);
/// Bytes that hold the longest line: an attitude whose level is being found again, remembered, with every fault counted.
const LENGTH: usize = 160;

/// What the instrument is about. Angles in thousandths of a degree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Devices are started.
    Starting,
    /// The stage looks for its index.
    Homing,
    /// The stage stands still to know the gyro.
    Surveying,
    /// Dwells are measured.
    Measuring {
        /// Dwells that are taken.
        done: u16,
        /// Dwells that are planned.
        of: u16,
    },
    /// The vehicle levels at a stop.
    Levelling {
        /// Which stop.
        stop: u16,
    },
    /// It has, and may drive.
    MayDrive {
        /// Which stop.
        stop: u16,
    },
    /// It drives.
    Driving,
    /// The azimuth is found.
    Concluded {
        /// Azimuth of body x.
        azimuth: u32,
        /// Its 1σ, rounded up.
        sigma: u32,
    },
    /// There is none; the log tells why.
    Refused,
    /// The roll of a spinning body is followed.
    Rolling {
        /// Roll and its 1σ, rounded up; none where it is not known.
        roll: Option<[u32; 2]>,
        /// What it rests on.
        state: &'static str,
    },
    /// It is followed no more; the log tells why.
    RollEnded,
}

impl Status {
    /// A found azimuth with its σ, both in degrees.
    #[must_use]
    pub fn concluded(azimuth: f64, sigma: f64) -> Self {
        // To nearest, wrapped at a full turn; σ never rounds to less than it is.
        let azimuth = libm::round(azimuth * 1e3) as u32 % 360_000;
        Self::Concluded { azimuth, sigma: libm::ceil(sigma * 1e3) as u32 }
    }

    /// Whether nothing follows.
    #[must_use]
    pub fn is_last(&self) -> bool {
        matches!(self, Self::Concluded { .. } | Self::Refused | Self::RollEnded)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Starting => f.write_str("starting"),
            Self::Homing => f.write_str("homing"),
            Self::Surveying => f.write_str("surveying"),
            Self::Measuring { done, of } => write!(f, "measuring {done}/{of}"),
            Self::Levelling { stop } => write!(f, "levelling at stop {stop}"),
            Self::MayDrive { stop } => write!(f, "stop {stop} done, may drive"),
            Self::Driving => f.write_str("driving"),
            Self::Concluded { azimuth, sigma } => write!(
                f,
                "azimuth {}.{:03} sigma {}.{:03}",
                azimuth / 1000,
                azimuth % 1000,
                sigma / 1000,
                sigma % 1000
            ),
            Self::Refused => f.write_str("no azimuth"),
            Self::Rolling { roll: Some([roll, sigma]), state } => write!(
                f,
                "roll {}.{:03} sigma {}.{:03} {state}",
                roll / 1000,
                roll % 1000,
                sigma / 1000,
                sigma % 1000
            ),
            Self::Rolling { roll: None, state } => write!(f, "roll unknown, {state}"),
            Self::RollEnded => f.write_str("no roll"),
        }
    }
}

/// Sends a status line every second until the session's end is told.
pub async fn run<L: Write, O: Observer>(link: &mut L, shared: &Shared<'_, O>) {
    loop {
        let is_last = shared.status.get().is_last() && !shared.keep.is_wanted.get();
        send(link, shared).await;
        if is_last {
            return;
        }
        select(Timer::after(PERIOD), shared.concluded.wait()).await;
    }
}

/// Sends one status line. A link that does not take it costs the line, which is counted, and told
/// the first time.
pub async fn send<L: Write, O: Observer>(link: &mut L, shared: &Shared<'_, O>) {
    let mut line = String::<LENGTH>::new();
    let faults = shared.health.get().faults();
    // The longest line fits; a longer one would be cut.
    let _ = match shared.keep.told.get() {
        Some(kept) => write!(line, "{kept}, faults {faults}\r\n"),
        None => write!(line, "{}, faults {faults}\r\n", shared.status.get()),
    };
    if !matches!(with_timeout(LONGEST, link.write_all(line.as_bytes())).await, Ok(Ok(()))) {
        if shared.health.get().unsent == 0 {
            shared.tell(Event::LinkSilent);
        }
        shared.count(|health| health.unsent = health.unsent.saturating_add(1));
    }
}

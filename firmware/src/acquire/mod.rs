//! Acquisition: on every conversion of the gyro one sample for the session, or none and the reason.
//!
//! ```text
//!  stage, turntable   gyro ─────────┬─▶ Sample          ─┐
//!                     encoder ──────┤                    ├─▶ outlet ─▶ session
//!  vehicle            three gyros ──┼─▶ InertialSample  ─┤
//!                     accelerometer ┘                    │
//!  spinning body      three gyros ──┼─▶ SpinSample      ─┘
//!                     two forces ───┘
//! ```
//!
//! What a sensor's readings must pass is the same for both kinds: `rates` for a gyro, `forces` for the
//! accelerometer. A sample goes out only whole, and its absence shows in the next one's time.

mod coarse;
mod forces;
mod in_step;
mod outlet;
mod rates;
mod spin;
mod stage;
mod triad;

pub use spin::SpinAcquisition;
pub use stage::Acquisition;
pub use triad::TriadAcquisition;

/// Equal readings in a row that are no chance: the last bits of all sensors are noise.
pub(crate) const STUCK: u32 = 64;
/// Longest time at the limit of the range, s: a slammed door is over by then.
const SATURATED_SECONDS: f64 = 5.0;
/// Periods without a conversion after which a gyro is silent.
const SILENCE: u32 = 8;

/// How often something came in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RepeatCounter<T> {
    last: Option<T>,
    count: u32,
}

impl<T: Copy + PartialEq> RepeatCounter<T> {
    pub(crate) const fn new() -> Self {
        Self { last: None, count: 0 }
    }

    /// How often this value has come in a row before.
    pub(crate) fn push(&mut self, value: T) -> u32 {
        self.count = if self.last.replace(value) == Some(value) { self.count + 1 } else { 0 };
        self.count
    }
}

/// For how many samples a sensor stood at the limit of its range.
#[derive(Clone, Copy, Debug)]
struct Limit {
    samples: u32,
    longest: u32,
}

impl Limit {
    /// Of a sensor of so many samples a second.
    fn new(sample_rate: f64) -> Self {
        Self { samples: 0, longest: (SATURATED_SECONDS * sample_rate) as u32 }
    }

    /// Whether it has stood there for too long, after so many more samples.
    fn is_exceeded(&mut self, is_there: bool, samples: u32) -> bool {
        self.samples = if is_there { self.samples + samples } else { 0 };
        self.samples > self.longest
    }
}

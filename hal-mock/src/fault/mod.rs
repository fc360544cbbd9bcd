//! Faults of the bus and of the supply, by time.
//!
//! ```text
//!  driver ─▶ FaultySpi ─▶ SpiPort ─▶ board ◀─ Blackout
//!         ◀─ FaultyReady ◀─ ReadyPin ─┘
//! ```
//!
//! Each wrapper implements the traits of what it wraps. Without a plan, and before the plan's time, it
//! passes everything on unchanged. A fault of the stage is a [`crate::plant::StageFault`], a rate
//! beyond the gyro's range or a slammed door a [`crate::disturbance::Disturbance`].

mod i2c;
mod ready;
mod spi;

use embassy_time::{Duration, Instant};

pub use self::i2c::FaultyI2c;
pub use self::ready::FaultyReady;
pub use self::spi::{BusFault, FaultPlan, FaultySpi};
use crate::chip::Select;

/// A chip loses its supply for a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blackout {
    /// The chip that loses its supply.
    pub select: Select,
    /// When it loses the supply; it has it again at once.
    pub at: Instant,
}

/// For how long a fault lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The first time it can show.
    Once,
    /// For some time from its start.
    For(Duration),
    /// From its start on, for ever.
    Always,
}

/// When a fault shows.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct When {
    /// When the fault begins.
    pub start: Instant,
    /// For how long.
    pub extent: Extent,
}

impl When {
    /// A fault that shows once, at the first access from `start` on.
    pub const fn once(start: Instant) -> Self {
        Self { start, extent: Extent::Once }
    }

    /// A fault that shows from `start` on for `duration`, the end not included.
    pub const fn during(start: Instant, duration: Duration) -> Self {
        Self { start, extent: Extent::For(duration) }
    }

    /// A fault that shows from `start` on for ever.
    pub const fn always(start: Instant) -> Self {
        Self { start, extent: Extent::Always }
    }

    /// Whether the fault shows at `now`; `shown` remembers that it has.
    fn shows(&self, now: Instant, shown: &mut bool) -> bool {
        let active = now >= self.start
            && match self.extent {
                Extent::Once => !*shown,
                Extent::For(duration) => now - self.start < duration,
                Extent::Always => true,
            };
        *shown |= active;
        active
    }
}

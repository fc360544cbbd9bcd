//! What the motor driver is told: ramp, currents, stall, switches. The default is the stage's.

use core::time::Duration;

use super::units::{Acceleration, Clock, Velocity};

/// Microsteps in one turn of the stage: 200 full steps, 256 microsteps each, gear 90:1.
pub const MICROSTEPS_PER_TURN: i32 = 200 * 256 * 90;

/// The six points of a ramp (data sheet, figure 12.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ramp {
    /// Velocity that a motion begins with, VSTART; ≤ `stop`.
    pub start: Velocity,
    /// Acceleration up to the knee, A1.
    pub first: Acceleration,
    /// Velocity between the slopes, V1; zero for `acceleration` and `deceleration` alone.
    pub knee: Velocity,
    /// Acceleration above the knee, AMAX; also both ways in velocity mode.
    pub acceleration: Acceleration,
    /// Highest velocity, VMAX.
    pub peak: Velocity,
    /// Deceleration above the knee, DMAX.
    pub deceleration: Acceleration,
    /// Deceleration below the knee, D1.
    pub last: Acceleration,
    /// Velocity that a motion ends with, VSTOP; > 0.
    pub stop: Velocity,
}

impl Ramp {
    /// Time of a motion over so many microsteps, rounded up to microseconds: exact to 10 ms where it
    /// reaches the peak, an upper bound where it does not. The clock's tolerance comes on top.
    #[must_use]
    pub fn time(&self, microsteps: u32) -> Duration {
        let (up_us, up) = self.leg(self.first, self.acceleration);
        let (down_us, down) = self.leg(self.last, self.deceleration);
        let rest = u64::from(microsteps).saturating_sub(up + down);
        let peak = u64::from(self.peak.0.unsigned_abs()).max(1);
        Duration::from_micros(up_us + down_us + (rest * 1_000_000).div_ceil(peak))
    }

    /// Microseconds and microsteps between rest and peak.
    fn leg(&self, below: Acceleration, above: Acceleration) -> (u64, u64) {
        let peak = u64::from(self.peak.0.unsigned_abs());
        let knee = u64::from(self.knee.0.unsigned_abs()).min(peak);
        let (below, above) = (u64::from(below.0).max(1), u64::from(above.0).max(1));
        let time = (knee * 1_000_000).div_ceil(below) + ((peak - knee) * 1_000_000).div_ceil(above);
        let way = knee * knee / (2 * below) + (peak * peak - knee * knee) / (2 * above);
        (time, way)
    }
}

/// Currents of the motor's coils.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Currents {
    /// While it moves, mA rms.
    pub run_ma: u16,
    /// While it stands, mA rms; ≤ `run_ma`.
    pub hold_ma: u16,
    /// Sense resistors, mΩ, > 0.
    pub sense_milliohm: u16,
}

/// When the motor counts as blocked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stall {
    /// SGT, −64 … 63: higher needs more load (13.1).
    pub threshold: i8,
    /// `StallGuard2` is silent below this velocity, where it cannot work (13.5).
    pub above: Velocity,
}

/// The level of a switch's input where it is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polarity {
    /// A normally open switch to the supply.
    ActiveHigh,
    /// A normally closed one: a broken wire counts as touched.
    ActiveLow,
}

/// The reference switches; one that is not there does not stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switches {
    /// At the lower end; it stops motions to the left.
    pub left: Option<Polarity>,
    /// At the upper end.
    pub right: Option<Polarity>,
}

/// All of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// The chip's clock.
    pub clock: Clock,
    /// How it moves to a position.
    pub ramp: Ramp,
    /// The coils' currents.
    pub currents: Currents,
    /// Whether a stall stops the motor.
    pub stall: Option<Stall>,
    /// The reference switches.
    pub switches: Switches,
    /// The motor turns the other way.
    pub reversed: bool,
}

impl Default for Ramp {
    /// The stage's: at most 0.35 rad/s; 15° take 1.20 s and 360° 18.41 s.
    fn default() -> Self {
        Self {
            start: Velocity(0),
            first: Acceleration(640_000),
            knee: Velocity(128_000),
            acceleration: Acceleration(420_000),
            peak: Velocity(256_685),
            deceleration: Acceleration(420_000),
            last: Acceleration(640_000),
            stop: Velocity(700),
        }
    }
}

impl Default for Configuration {
    /// The stage's: a motor of 1 A that is held with half of it, a stall stop from one turn of the
    /// motor a second (13.5), a left switch.
    fn default() -> Self {
        Self {
            clock: Clock::default(),
            ramp: Ramp::default(),
            currents: Currents { run_ma: 1000, hold_ma: 500, sense_milliohm: 75 },
            stall: Some(Stall { threshold: 0, above: Velocity(200 * 256) }),
            switches: Switches { left: Some(Polarity::ActiveHigh), right: None },
            reversed: false,
        }
    }
}

//! Configuration of the motor driver: ramp, currents, stall detection and switches. The default is
//! that of the stage.

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
    /// Current during a motion, mA rms.
    pub run_ma: u16,
    /// Current at rest, mA rms; ≤ `run_ma`.
    pub hold_ma: u16,
    /// Resistance of the sense resistors, mΩ, > 0.
    pub sense_milliohm: u16,
}

/// Stall detection: the load at which the motor counts as blocked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stall {
    /// Threshold SGT, −64 … 63: a higher value needs more load (13.1).
    pub threshold: i8,
    /// Velocity below which `StallGuard2` is disabled, since it cannot work there (13.5).
    pub above: Velocity,
}

/// Polarity of a reference switch: the level of its input when active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polarity {
    /// A normally open switch to the supply.
    ActiveHigh,
    /// A normally closed switch: a broken wire counts as active.
    ActiveLow,
}

/// The reference switches; `None` for a switch that is not fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switches {
    /// The switch at the lower end; it stops motions to the left.
    pub left: Option<Polarity>,
    /// The switch at the upper end; it stops motions to the right.
    pub right: Option<Polarity>,
    /// Whether switches stop the motor. The left input of a platform without ends is closed by a
    /// mark that passes once per turn: its position is latched, and the motor goes on.
    pub do_stop: bool,
}

/// The complete configuration of the motor driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// Clock of the chip.
    pub clock: Clock,
    /// Ramp of a motion to a position.
    pub ramp: Ramp,
    /// Currents of the coils.
    pub currents: Currents,
    /// Stall detection, if it is used.
    pub stall: Option<Stall>,
    /// Reference switches.
    pub switches: Switches,
    /// Whether the motor's direction is reversed.
    pub reversed: bool,
}

impl Default for Ramp {
    /// The ramp of the stage: at most 0.35 rad/s; 15° take 1.20 s and 360° 18.41 s.
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
    /// The configuration of the stage: a motor of 1 A, held with half of its current; a stall stop
    /// from one turn of the motor per second (13.5); a left switch.
    fn default() -> Self {
        Self {
            clock: Clock::default(),
            ramp: Ramp::default(),
            currents: Currents { run_ma: 1000, hold_ma: 500, sense_milliohm: 75 },
            stall: Some(Stall { threshold: 0, above: Velocity(200 * 256) }),
            switches: Switches { left: Some(Polarity::ActiveHigh), right: None, do_stop: true },
            reversed: false,
        }
    }
}

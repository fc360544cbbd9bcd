//! Velocity and acceleration in microsteps, and in the chip's own units (data sheet, 12.1).

/// Clock of the chip, its unit of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clock {
    /// The internal oscillator, 12 MHz ± 4 % (26.1): velocities have this uncertainty, positions do
    /// not.
    #[default]
    Internal,
    /// An external clock of 16 MHz at CLK.
    External16MHz,
}

/// A velocity, microsteps per second; negative is to the left, towards lower positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Velocity(pub i32);

/// An acceleration or deceleration, microsteps per second squared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Acceleration(pub u32);

/// Largest VMAX (6.3.1).
pub const LARGEST_VELOCITY: u32 = (1 << 23) - 512;

/// Largest acceleration (6.3.1).
pub const LARGEST_ACCELERATION: u32 = (1 << 16) - 1;

/// Largest time between microsteps, clocks (6.2).
const LARGEST_STEP_TIME: u32 = (1 << 20) - 1;

impl Clock {
    /// Frequency, Hz.
    #[must_use]
    pub const fn hertz(self) -> u32 {
        match self {
            Self::Internal => 12_000_000,
            Self::External16MHz => 16_000_000,
        }
    }

    /// The magnitude of a velocity in units of f/2²⁴ (0.715 microsteps/s at 12 MHz), to the nearest,
    /// at most [`LARGEST_VELOCITY`]: 6.0 million microsteps/s at 12 MHz, 8.0 million at 16 MHz.
    #[must_use]
    pub fn velocity_units(self, velocity: Velocity) -> u32 {
        let hertz = u64::from(self.hertz());
        let units = ((u64::from(velocity.0.unsigned_abs()) << 24) + hertz / 2) / hertz;
        units.min(u64::from(LARGEST_VELOCITY)) as u32
    }

    /// The velocity of VACTUAL, 24 bits with sign, to the nearest microstep per second.
    #[must_use]
    pub fn velocity(self, register: u32) -> Velocity {
        let units = i64::from((register << 8).cast_signed() >> 8);
        let scaled = units * i64::from(self.hertz());
        Velocity(((scaled + (1 << 23)) >> 24) as i32)
    }

    /// An acceleration in units of f²/2⁴¹ (65.5 microsteps/s² at 12 MHz), to the nearest, from 1 to
    /// [`LARGEST_ACCELERATION`]: 4.3 million microsteps/s² at 12 MHz, 7.6 million at 16 MHz.
    #[must_use]
    pub fn acceleration_units(self, acceleration: Acceleration) -> u32 {
        // Both frequencies are multiples of 256 Hz, so their square divides by 2¹⁶.
        let square = (u64::from(self.hertz()) / 256) * (u64::from(self.hertz()) / 256);
        let units = ((u64::from(acceleration.0) << 25) + square / 2) / square;
        units.clamp(1, u64::from(LARGEST_ACCELERATION)) as u32
    }

    /// The longest TSTEP of motions at least as fast as a velocity, clocks, rounded down, so that
    /// nothing slower passes; zero, which no motion passes, for no velocity.
    #[must_use]
    pub fn step_time(self, velocity: Velocity) -> u32 {
        let clocks = self.hertz().checked_div(velocity.0.unsigned_abs());
        clocks.map_or(0, |clocks| clocks.min(LARGEST_STEP_TIME))
    }
}

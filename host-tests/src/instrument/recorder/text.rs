//! Numbers of a row as text that reads back as the same number.

use std::fmt::{Display, Formatter, Result};

use orientation::units::{Angle, AngularRate, Instant, SpecificForce};

/// An integer of so many decimal places, written out exactly.
pub struct Scaled(i64, usize);

impl Scaled {
    /// An integer whose last so many digits are decimal places.
    pub fn new(value: impl Into<i64>, places: usize) -> Self {
        Self(value.into(), places)
    }
}

impl Display for Scaled {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self(value, places) = *self;
        let unit = 10_u64.pow(places as u32);
        let (sign, size) = (if value < 0 { "-" } else { "" }, value.unsigned_abs());
        write!(f, "{sign}{}.{:0places$}", size / unit, size % unit)
    }
}

/// A field that is empty where there is nothing.
pub struct Maybe<T>(pub Option<T>);

impl<T: Display> Display for Maybe<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        self.0.as_ref().map_or(Ok(()), |field| field.fmt(f))
    }
}

/// A time, s.
pub fn seconds(time: Instant) -> Scaled {
    Scaled(time.0.cast_signed(), 6)
}

/// A rate, rad/s; one at either limit of its range stands at the upper one, which a recording can hold.
pub fn rate(rate: AngularRate) -> Scaled {
    Scaled(if rate.is_saturated() { i32::MAX } else { rate.0 }.into(), 9)
}

/// Forces, m/s².
pub fn forces<const N: usize>(forces: [SpecificForce; N]) -> [Scaled; N] {
    forces.map(|force| Scaled(force.0.into(), 6))
}

/// An angle, rad, to a fifteenth of its steps.
pub fn angle(angle: Angle) -> String {
    format!("{:.10}", angle.rad())
}

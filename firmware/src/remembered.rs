//! A stored axis misalignment, as events and results report it.

use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::words;
use orientation::words::Rounded;

use crate::date::Day;

/// A stored axis misalignment as it is reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remembered {
    /// Elevation of the gyro's sensitive axis above the plane of rotation, °.
    pub angle: f64,
    /// Rate of the platform during the estimation, °/s.
    pub rate: f64,
    /// Date of the estimation.
    pub day: Day,
    /// Temperature during the estimation, °C.
    pub temperature: f32,
}

impl From<&AxisMisalignment> for Remembered {
    fn from(misalignment: &AxisMisalignment) -> Self {
        Self {
            angle: misalignment.angle().degrees(),
            rate: misalignment.frequency.degrees_per_second(),
            day: Day::of(misalignment.date),
            temperature: misalignment.temperature,
        }
    }
}

words! { Remembered:
    Self { angle, rate, day, temperature } =>
        "gyro's axis {}° above the platform at {} °/s, found on {} at {} °C",
        Rounded::<4>(angle), Rounded::<2>(rate), day, Rounded::<1>(f64::from(temperature));
}

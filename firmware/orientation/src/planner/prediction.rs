//! Prediction of the accuracy of dwells at given angles and times, before an azimuth is fitted.
//!
//! The rows are those of the stepwise fit on a level stage, whitened by the same filter, all in
//! single precision: a prediction for 60 dwells takes a hundredth of the instructions of a
//! conclusion, and its standard deviation is right to a thousandth. It covers noise alone; the
//! contributions of tilt, encoder and scale belong to the conclusion.

use super::order::PARTS;
use crate::math::reference_table::{ONE, TURN};
use crate::math::{COLUMNS, Column, Regression, Table};
use crate::noise::GyroNoise;
use crate::noise::whitener::Whitener;
use crate::signal::Dwell;
use crate::units::{DEGREE_PER_HOUR, RadiansPerSecond, RateRandomWalk};

/// Degrees per hour in a rad/s.
const PER_HOUR: f64 = 1.0 / DEGREE_PER_HOUR;
/// Hours in a second.
const HOURS: f32 = 1.0 / 3600.0;

/// A dwell that is planned or done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// Cosine and sine of the stage angle.
    pub unit: [f32; 2],
    /// Beginning of the dwell, s.
    pub start: f64,
    /// Length of the dwell, s.
    pub seconds: f64,
}

impl Visit {
    /// Visit at a planned position, in twenty-fourths of a turn.
    pub(crate) fn planned(part: u8, start: f64, seconds: f64) -> Self {
        let index = i32::from(part) * (TURN / i32::from(PARTS));
        let entries = [Table::built_in().cos(index), Table::built_in().sin(index)];
        Self { unit: entries.map(|entry| entry as f32 * (1.0 / ONE) as f32), start, seconds }
    }
}

impl From<&Dwell> for Visit {
    fn from(dwell: &Dwell) -> Self {
        let (sine, cosine) = libm::sincos(dwell.stage.rad());
        let unit = [cosine as f32, sine as f32];
        Self { unit, start: dwell.start().0, seconds: dwell.seconds.0 }
    }
}

/// Standard deviation, 1σ, that noise leaves to either horizontal component of the Earth rate, RMS
/// over their directions, rad/s; the azimuth's is this over `Ω_h`. Visits must be in the order of
/// time, and the shortest lasts `shortest` s; `None` where they do not determine two components.
#[must_use]
#[inline(never)]
pub fn rate_sigma(
    noise: &GyroNoise,
    shortest: f64,
    visits: impl Iterator<Item = Visit>,
) -> Option<f64> {
    let mut whitener = Whitener::<4, f32>::new(&in_degrees_per_hour(noise), shortest);
    let mut regression = Regression::<COLUMNS, f32>::default();
    let (mut first, mut own) = (None, Own::default());
    for Visit { unit: [cosine, sine], start, seconds } in visits {
        let elapsed = (start - *first.get_or_insert(start)) as f32;
        let mut row = [cosine, -sine, 1.0, elapsed * HOURS];
        whitener.whiten(start, start + seconds, own.variance(noise, seconds), &mut row);
        let [north, east, constant, hours] = row;
        regression.push(&[north, east, constant, hours, 0.0, 0.0, 0.0], 0.0);
    }
    let ramp = noise.rate_ramp.0 * (3600.0 * PER_HOUR);
    let time = if ramp > 0.0 { Column::Prior(ramp) } else { Column::Absent };
    let free = Column::Free;
    let absent = Column::Absent;
    let solution = regression.solve(&[free, free, free, time, absent, absent, absent])?;
    let [[north, ..], [_, east, ..], ..] = solution.covariance;
    Some(libm::sqrt(0.5 * (north + east)) * DEGREE_PER_HOUR)
}

/// Variance that is independent of other visits, cached for visits of equal length: a division in
/// `f64` takes long on a Cortex-M4.
#[derive(Default)]
struct Own {
    seconds: f64,
    variance: f64,
}

impl Own {
    /// Variance for this length, (°/h)².
    fn variance(&mut self, noise: &GyroNoise, seconds: f64) -> f64 {
        if self.seconds != seconds {
            self.seconds = seconds;
            self.variance = noise.own_variance(seconds) * (PER_HOUR * PER_HOUR);
        }
        self.variance
    }
}

/// Noise model with rates in °/h instead of rad/s, without the white part.
fn in_degrees_per_hour(noise: &GyroNoise) -> GyroNoise {
    GyroNoise {
        bias_instability: RadiansPerSecond(noise.bias_instability.0 * PER_HOUR),
        rate_random_walk: RateRandomWalk(noise.rate_random_walk.0 * PER_HOUR),
        ..GyroNoise::default()
    }
}

//! What a fit will make of dwells at given angles and times, before or without fitting an azimuth.
//!
//! The rows are those of the stepwise fit on a level stage, whitened by the same filter in single
//! precision: an outlook over 60 dwells takes a hundredth of the instructions of a conclusion, and
//! its standard deviation is right to a thousandth. It speaks of noise alone; what tilt, encoder and
//! scale add is the conclusion's business.

use crate::align::regression::{COLUMNS, Column, Regression, Solution};
use crate::align::stepwise::excess;
use crate::noise::model::GyroNoise;
use crate::noise::whitener::Whitener;
use crate::signal::dwell::Dwell;
use crate::units::DEGREE_PER_HOUR;

/// A dwell that is planned or done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// Stage angle, rad.
    pub angle: f64,
    /// When it begins, s.
    pub start: f64,
    /// How long it lasts, s.
    pub seconds: f64,
    /// Mean rate, rad/s; zero where it is only planned.
    pub rate: f64,
}

impl From<&Dwell> for Visit {
    fn from(dwell: &Dwell) -> Self {
        Self {
            angle: dwell.stage.rad(),
            start: dwell.start(),
            seconds: dwell.seconds,
            rate: dwell.rate,
        }
    }
}

/// What noise leaves uncertain after some dwells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlook {
    /// 1σ of either horizontal component of the Earth rate, RMS over their directions, rad/s. The
    /// azimuth's is this over `Ω_h`.
    pub rate_sigma: f64,
    /// Chi-square of the dwells about their fit; of planned ones zero.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub degrees: usize,
}

impl Outlook {
    /// The same as the dwells show it: raised where they scatter more than the noise explains.
    #[must_use]
    pub fn observed_rate_sigma(&self) -> f64 {
        self.rate_sigma * excess(self.chi_square, self.degrees)
    }
}

/// A row: the columns of the regression and the left side, in °/h and h, so that single precision
/// has room on either side.
type Row = [f32; COLUMNS + 1];

/// The outlook over visits in the order of time; `None` where they do not tell two components.
#[must_use]
#[inline(never)]
pub fn outlook(noise: &GyroNoise, visits: impl Iterator<Item = Visit> + Clone) -> Option<Outlook> {
    let first = visits.clone().next()?;
    let shortest = visits.clone().map(|visit| visit.seconds).fold(f64::INFINITY, f64::min);
    let mut whitener = Whitener::<{ COLUMNS + 1 }, f32>::new(&in_degrees_per_hour(noise), shortest);
    let mut regression = Regression::<COLUMNS>::default();
    for visit in visits {
        let mut row = row(&visit, &first);
        let (end, white) = (visit.start + visit.seconds, own_variance(noise, visit.seconds));
        whitener.whiten(visit.start, end, white, &mut row);
        let [north, east, constant, hours, none, left] = row.map(f64::from);
        regression.push(&[north, east, constant, hours, none], left);
    }
    let ramp = noise.rate_ramp * 3600.0 / DEGREE_PER_HOUR;
    let time = if ramp > 0.0 { Column::Prior(ramp) } else { Column::Absent };
    let free = Column::Free;
    let solution = regression.solve(&[free, free, free, time, Column::Absent])?;
    Some(of_solution(&solution))
}

fn of_solution(solution: &Solution<COLUMNS>) -> Outlook {
    let [[north, ..], [_, east, ..], ..] = solution.covariance;
    Outlook {
        rate_sigma: libm::sqrt(0.5 * (north + east)) * DEGREE_PER_HOUR,
        chi_square: solution.chi_square,
        degrees: solution.degrees,
    }
}

fn row(visit: &Visit, first: &Visit) -> Row {
    let (sine, cosine) = libm::sincosf(visit.angle as f32);
    let hours = (visit.start - first.start) / 3600.0;
    let left = (visit.rate - first.rate) / DEGREE_PER_HOUR;
    [cosine, -sine, 1.0, hours as f32, 0.0, left as f32]
}

/// The variance that is a visit's own, (°/h)².
fn own_variance(noise: &GyroNoise, seconds: f64) -> f64 {
    noise.own_variance(seconds) / (DEGREE_PER_HOUR * DEGREE_PER_HOUR)
}

fn in_degrees_per_hour(noise: &GyroNoise) -> GyroNoise {
    GyroNoise {
        bias_instability: noise.bias_instability / DEGREE_PER_HOUR,
        rate_random_walk: noise.rate_random_walk / DEGREE_PER_HOUR,
        ..GyroNoise::default()
    }
}

//! How an azimuth is chosen: by maximum likelihood, or by one of Sokolov's criteria on the table.
//!
//! The paper's criteria compare differences of neighbouring dwells with the etalon table. They are
//! offered for comparison: differencing colours the noise, and so each of them does worse than the
//! limit. Their standard deviation says so.

use heapless::Vec;

use super::CAPACITY;
use super::conclusion::Azimuth;
use super::etalon::table::{ONE, STEP};
use super::etalon::{self, Accepted, Limit, Series, Table};
use super::stepwise::{Fit, Problem};
use crate::error::Refusal;
use crate::math::sort;
use crate::signal::dwell::Dwell;
use crate::units::wrapped;

/// How the azimuth is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// Generalised least squares on the dwells themselves.
    MaximumLikelihood,
    /// Mean-removed least squares over the table: maximum likelihood for white noise on a level
    /// stage, in integers.
    OnTable,
    /// min Σ(δ^Et − δ)² over the table.
    LeastSquares,
    /// min Σ|δ^Et − δ| over the table.
    LeastAbsolute,
    /// The middle of what Σ(δ^Et − δ)² ≤ α₁ accepts; α₁ in (rad/s)².
    WithinSquares(f64),
    /// The middle of what Σ|δ^Et − δ| ≤ α accepts; α in rad/s.
    WithinAbsolute(f64),
}

/// Dwells at equal steps, in the order of their angle.
struct Row<'a> {
    dwells: Vec<&'a Dwell, CAPACITY>,
    /// Step in grid steps of 10″, clockwise positive.
    step: i32,
}

/// The azimuth by one of the paper's criteria; maximum likelihood is the fit's own.
///
/// The rates are first freed of what tilt does to them, to second order at the fit's azimuth, as
/// the table knows only a level stage.
///
/// # Errors
/// [`Refusal::StepsUneven`], or a bound that accepts nothing or everything.
pub fn azimuth(problem: &Problem, fit: &Fit, criterion: Criterion) -> Result<Azimuth, Refusal> {
    let row = Row::of(problem.dwells).ok_or(Refusal::StepsUneven)?;
    let ratios = row.dwells.iter().map(|dwell| problem.level_ratio(fit, dwell));
    let series = Series::new(ratios, row.step).map_err(|_| Refusal::StepsUneven)?;
    let rate = problem.setting.latitude.horizontal_rate();
    let (first, width) = match criterion {
        Criterion::MaximumLikelihood | Criterion::OnTable => {
            searched(&series, etalon::Criterion::MaximumLikelihood)
        }
        Criterion::LeastSquares => searched(&series, etalon::Criterion::LeastSquares),
        Criterion::LeastAbsolute => searched(&series, etalon::Criterion::LeastAbsolute),
        Criterion::WithinSquares(bound) => {
            let units = bound / (rate * rate) * (ONE * ONE);
            accepted(&series, Limit::WithinSquares(units as u128))?
        }
        Criterion::WithinAbsolute(bound) => {
            accepted(&series, Limit::WithinAbsolute((bound / rate * ONE) as u64))?
        }
    };
    let start = row.dwells.first().map_or(0.0, |dwell| dwell.stage.rad());
    let variance = row.variance(problem, first, criterion) + width * width / 12.0;
    let others = fit.budget.beside_noise();
    // No criterion on the same dwells can do better than maximum likelihood.
    let sigma = libm::sqrt(variance + others * others).max(fit.sigma());
    Ok(Azimuth { angle: wrapped(first - start), sigma })
}

/// The best azimuth of the first position, rad; no width.
fn searched(series: &Series, criterion: etalon::Criterion) -> (f64, f64) {
    (etalon::search(Table::built_in(), series, criterion).azimuth, 0.0)
}

/// Middle and width of the accepted arc, rad.
fn accepted(series: &Series, limit: Limit) -> Result<(f64, f64), Refusal> {
    match etalon::accepted(Table::built_in(), series, limit).accepted {
        Accepted::Nothing => Err(Refusal::NothingAccepted),
        Accepted::Everything => Err(Refusal::EverythingAccepted),
        Accepted::Arc { middle, width, .. } => {
            Ok((f64::from(middle) * STEP, f64::from(width) * STEP))
        }
    }
}

impl<'a> Row<'a> {
    /// The dwells as they came, or else sorted by angle; `None` where their steps are uneven.
    fn of(dwells: &[&'a Dwell]) -> Option<Self> {
        let mut dwells: Vec<&Dwell, CAPACITY> = Vec::from_slice(dwells).ok()?;
        if let Some(step) = even_step(&dwells) {
            return Some(Self { dwells, step });
        }
        let start = dwells.first()?.stage;
        let turned = |dwell: &Dwell| (dwell.stage - start).0.cast_signed();
        sort(&mut dwells, |a, b| turned(a) < turned(b));
        let step = even_step(&dwells)?;
        Some(Self { dwells, step })
    }

    /// What a change of azimuth does to each difference, ∂δ/∂A in units of `Ω_h`.
    fn slopes(&self, first: f64) -> Vec<f64, CAPACITY> {
        let step = f64::from(self.step) * STEP;
        let sine = |index: usize| libm::sin(first + index as f64 * step);
        (1..self.dwells.len()).map(|index| sine(index - 1) - sine(index)).collect()
    }

    /// Σ (∂z/∂A − mean)² over the dwells, in units of `Ω_h`².
    fn mean_removed_power(&self, first: f64) -> f64 {
        let step = f64::from(self.step) * STEP;
        let slope = |index: usize| -libm::sin(first + index as f64 * step);
        let count = self.dwells.len();
        let mean = (0..count).map(slope).sum::<f64>() / count as f64;
        (0..count).map(|index| (slope(index) - mean) * (slope(index) - mean)).sum()
    }

    /// Variance of the azimuth from the noise of the dwells, rad².
    ///
    /// Least squares: the error is Σ gᵢ εᵢ / Σ g² with g the slopes, ε the differences' noise.
    /// Least absolute values: Σ gᵢ sign(εᵢ) / (2 f(0) Σ g²), with f(0) the density of ε at zero and
    /// −1/3 the correlation of the signs of neighbouring differences (arcsine law of −1/2).
    ///
    /// Mean-removed least squares: σ² / Σ (g − mean of g)² with g the slopes of the dwells.
    fn variance(&self, problem: &Problem, first: f64, criterion: Criterion) -> f64 {
        let slopes = self.slopes(first);
        let power: f64 = slopes.iter().map(|g| g * g).sum();
        let dwell = self.dwells.iter().map(|dwell| problem.white_variance(dwell)).sum::<f64>()
            / self.dwells.len() as f64;
        let neighbours: f64 = slopes.windows(2).map(|g| g[0] * g[1]).sum();
        let sum = match criterion {
            Criterion::MaximumLikelihood | Criterion::OnTable => {
                return dwell / self.mean_removed_power(first);
            }
            Criterion::LeastSquares | Criterion::WithinSquares(_) => {
                2.0 * dwell * (power - neighbours)
            }
            Criterion::LeastAbsolute | Criterion::WithinAbsolute(_) => {
                core::f64::consts::PI * dwell * (power - 2.0 / 3.0 * neighbours)
            }
        };
        sum / (power * power)
    }
}

/// The step between neighbours in grid steps, where it is the same for all within one of them.
fn even_step(dwells: &[&Dwell]) -> Option<i32> {
    let [first, second, ..] = dwells else { return None };
    let last = dwells.last()?;
    let rough = (second.stage - first.stage).signed_rad();
    let step = libm::round(rough / STEP);
    let even = dwells.iter().enumerate().all(|(index, dwell)| {
        let expected = crate::units::Angle::from_rad(index as f64 * step * STEP);
        (dwell.stage - first.stage - expected).signed_rad().abs() <= STEP
    });
    (even && !core::ptr::eq(*first, *last)).then_some(step as i32)
}

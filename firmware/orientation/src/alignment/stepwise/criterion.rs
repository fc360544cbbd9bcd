//! Choice of the azimuth: by maximum likelihood, or by one of the criteria of Sokolov 2019 on the
//! reference table (etalon).
//!
//! The paper's criteria compare differences of neighbouring dwells with the table. They are offered
//! for comparison: differencing colours the noise, so each of them is worse than the Cramér–Rao
//! bound, and their standard deviations state it.

use heapless::Vec;

use super::etalon::{Accepted, Limit, Series};
use super::fit::{Fit, Problem};
use super::{CAPACITY, Refusal, etalon};
use crate::alignment::Azimuth;
use crate::math::reference_table::{ONE, STEP};
use crate::math::{Table, sort};
use crate::signal::Dwell;
use crate::units::{Radians, wrapped};

/// Criterion by which the azimuth is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Criterion {
    /// Generalised least squares on the dwells themselves.
    #[default]
    MaximumLikelihood,
    /// Mean-removed least squares over the table: maximum likelihood for white noise on a level
    /// stage, in integers.
    OnTable,
    /// Least sum of squares of the differences over the table, min Σ(δ^Et − δ)² (Sokolov 2019).
    LeastSquares,
    /// Least sum of absolute values of the differences over the table, min Σ|δ^Et − δ| (Sokolov
    /// 2019).
    LeastAbsolute,
    /// Middle of the azimuths that Σ(δ^Et − δ)² ≤ α₁ accepts; α₁ in (rad/s)².
    WithinSquares(f64),
    /// Middle of the azimuths that Σ|δ^Et − δ| ≤ α accepts; α in rad/s.
    WithinAbsolute(f64),
}

/// Dwells at equal steps, in the order of their angle.
struct Row<'a> {
    /// Dwells in the order of the steps.
    dwells: Vec<&'a Dwell, CAPACITY>,
    /// Step between positions in grid steps of 10″, clockwise positive.
    step: i32,
}

/// Azimuth by one of the paper's criteria; maximum likelihood is solved by the fit itself.
///
/// The rates are first corrected for tilt, to second order at the fit's azimuth, because the table
/// describes a level stage only. The uncertainty of an accepted arc adds width²/12 to the variance.
///
/// # Errors
/// [`Refusal::StepsUneven`] where the steps are unequal, or [`Refusal::NothingAccepted`] and
/// [`Refusal::EverythingAccepted`] where the bound does not select an arc.
pub(crate) fn azimuth(
    problem: &Problem,
    fit: &Fit,
    criterion: Criterion,
) -> Result<Azimuth, Refusal> {
    let row = Row::of(problem.dwells).ok_or(Refusal::StepsUneven)?;
    let ratios = row.dwells.iter().map(|dwell| problem.level_ratio(fit, dwell));
    let series = Series::new(ratios, row.step).map_err(|_| Refusal::StepsUneven)?;
    let rate = problem.setting.site.latitude.horizontal_rate();
    let (first, width) = match criterion {
        Criterion::MaximumLikelihood | Criterion::OnTable => {
            searched(&series, etalon::Criterion::MaximumLikelihood)
        }
        Criterion::LeastSquares => searched(&series, etalon::Criterion::LeastSquares),
        Criterion::LeastAbsolute => searched(&series, etalon::Criterion::LeastAbsolute),
        Criterion::WithinSquares(bound) => {
            let units = bound / (rate.0 * rate.0) * (ONE * ONE);
            accepted(&series, Limit::WithinSquares(units as u128))?
        }
        Criterion::WithinAbsolute(bound) => {
            accepted(&series, Limit::WithinAbsolute((bound / rate.0 * ONE) as u64))?
        }
    };
    let start = row.dwells.first().map_or(0.0, |dwell| dwell.stage.rad());
    let variance = row.variance(problem, first, criterion) + width * width / 12.0;
    let others = fit.budget.beside_noise();
    // No criterion on the same dwells can be better than maximum likelihood.
    let sigma = libm::sqrt(variance + others.0 * others.0).max(fit.sigma().0);
    Ok(Azimuth { angle: Radians(wrapped(first - start)), sigma: Radians(sigma) })
}

/// Best azimuth of the first position, rad, with a width of zero.
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
    /// Takes the dwells in their order, or else sorted by angle; `None` where their steps are
    /// unequal.
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

    /// Derivatives of the differences with respect to azimuth, ∂δ/∂A, in units of `Ω_h`.
    fn slopes(&self, first: f64) -> Vec<f64, CAPACITY> {
        let step = f64::from(self.step) * STEP;
        let sine = |index: usize| libm::sin(first + index as f64 * step);
        (1..self.dwells.len()).map(|index| sine(index - 1) - sine(index)).collect()
    }

    /// Sum of squares of the mean-removed derivatives, Σ (∂z/∂A − mean)², in units of `Ω_h`².
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

/// Step between neighbours in grid steps of 10″, where all steps are equal within one grid step.
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

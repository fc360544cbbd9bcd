//! What the positions of a recording amount to: how often each was visited, and what plain
//! autocompensation makes of them.
//!
//! The azimuth of method `positions` is that of generalised least squares, weighted for the gyro's
//! noise. In an order that cancels drift plain least squares comes within a few per cent of it
//! (Burov's autocompensation needs no more); where the order does not, the two come apart.

use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::session::Session;
use orientation::math::regression::{Column, Regression};
use orientation::units::wrapped;
use serde::Serialize;

use crate::output::degrees;

/// Angles closer than this are one position, rad.
const SAME: f64 = 1e-3;

/// Positions and what plain least squares makes of them.
#[derive(Clone, Debug, Serialize)]
pub struct Autocompensation {
    /// The different positions in the order of their first visit, °.
    pub angles_deg: Vec<f64>,
    /// How often each was visited and kept.
    pub visits: Vec<usize>,
    /// Azimuth of plain, unweighted least squares, °, where the positions determine one.
    pub plain_azimuth_deg: Option<f64>,
    /// How far that lies from the weighted azimuth, in its σ.
    pub plain_off_sigmas: Option<f64>,
}

/// Looks at the dwells that took part in a conclusion.
#[must_use]
pub fn autocompensation(session: &Session, conclusion: &Conclusion) -> Autocompensation {
    let mut positions: Vec<(f64, usize)> = Vec::new();
    let kept =
        session.dwells().iter().zip(&conclusion.disturbances).filter(|(_, why)| why.is_none());
    for (dwell, _) in kept {
        let angle = dwell.stage.rad();
        let is_same = |other: f64| wrapped(angle - other + SAME) < 2.0 * SAME;
        match positions.iter_mut().find(|(other, _)| is_same(*other)) {
            Some((_, visits)) => *visits += 1,
            None => positions.push((angle, 1)),
        }
    }
    let (angles_deg, visits) =
        positions.into_iter().map(|(angle, visits)| (degrees(angle), visits)).unzip();
    let shift = shift(session, conclusion);
    let found = conclusion.verdict.ok().zip(shift);
    Autocompensation {
        angles_deg,
        visits,
        plain_azimuth_deg: found.map(|(azimuth, shift)| degrees(wrapped(azimuth.angle.0 + shift))),
        plain_off_sigmas: found.map(|(azimuth, shift)| shift / azimuth.sigma.0),
    }
}

/// By how much the azimuth of plain least squares differs, rad: what the weighted fit's residuals,
/// drift included, still show of the Earth rate.
fn shift(session: &Session, conclusion: &Conclusion) -> Option<f64> {
    let rate = session.setting.site.latitude.horizontal_rate();
    let fit = conclusion.fit.as_ref()?;
    let mut regression = Regression::<3>::default();
    let dwells = session.dwells().iter().zip(&conclusion.residuals);
    for ((dwell, residual), why) in dwells.zip(&conclusion.disturbances) {
        if why.is_none() {
            let (sine, cosine) = dwell.stage.rad().sin_cos();
            regression.push(&[cosine, -sine, 1.0], residual.rate.0 / rate.0);
        }
    }
    let [north, east, ..] = regression.solve(&[Column::Free; 3])?.coefficients;
    let (sine, cosine) = fit.direction.azimuth.sin_cos();
    Some((cosine * east - sine * north) / fit.direction.amplitude)
}

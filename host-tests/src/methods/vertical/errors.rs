//! What the kept attitude was off: inclination and heading, as BROAD defines them.
//!
//! Source: D. Laidig, M. Caruso, A. Cereatti, T. Seel, "BROAD – A Benchmark for Robust Inertial Orientation
//! Estimation", Data 2021, 6(7), 72: the error `q ⊗ conj(q_true)` is a turn about the vertical, after one constant
//! offset, and an inclination. Both are written so that the length of a rounded quaternion does not count.

use serde::Serialize;

use super::Moment;
use crate::campaign::statistics::{coverage, rms};
use crate::output::{azimuth_error, degrees};

/// The errors of one moment, °.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// Time of the moment, s.
    pub time_s: f64,
    /// Angle between the true vertical and the kept one.
    pub inclination_deg: f64,
    /// Turn about the vertical less the constant offset.
    pub heading_deg: f64,
    /// Tilts about the two level axes.
    pub tilts_deg: [f64; 2],
    /// 1σ of either.
    pub sigma_deg: f64,
}

/// The errors wherever the truth is known and counts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Errors, moment by moment.
    #[serde(skip)]
    pub off: Vec<Off>,
    /// RMS of the inclinations, °.
    pub inclination_rmse_deg: f64,
    /// RMS of the headings after the offset, °.
    pub heading_rmse_deg: f64,
    /// Per cent of both tilts within 1, 2 and 3 σ.
    pub coverage_percent: [f64; 3],
    /// Number of moments.
    pub compared: usize,
}

impl Errors {
    /// Compares moments with the truth, row by row; none where it is nowhere known.
    #[must_use]
    pub fn of(moments: &[Moment], truth: &[Option<[f64; 4]>]) -> Option<Self> {
        let known =
            moments.iter().zip(truth).filter_map(|(moment, truth)| Some((moment, (*truth)?)));
        let mut off: Vec<Off> = known.map(|(moment, truth)| Off::of(moment, truth)).collect();
        if off.is_empty() {
            return None;
        }
        take_offset(&mut off);
        let tilts = off.iter().flat_map(|off| off.tilts_deg.map(|tilt| [tilt, off.sigma_deg]));
        Some(Self {
            inclination_rmse_deg: rms(off.iter().map(|off| off.inclination_deg)),
            heading_rmse_deg: rms(off.iter().map(|off| off.heading_deg)),
            coverage_percent: coverage(tilts),
            compared: off.len(),
            off,
        })
    }
}

impl Off {
    fn of(moment: &Moment, truth: [f64; 4]) -> Self {
        let [w, x, y, z] = error(moment.attitude, truth);
        let inclination_deg = degrees(2.0 * x.hypot(y).atan2(w.hypot(z)));
        // Where the true vertical lies on the kept frame: the way of the tilt, whatever the heading.
        let [north, east] = [x * z + w * y, y * z - w * x];
        let part = inclination_deg / north.hypot(east).max(f64::MIN_POSITIVE);
        Self {
            time_s: moment.time_s,
            inclination_deg,
            heading_deg: azimuth_error(degrees(2.0 * z.atan2(w)), 0.0),
            tilts_deg: [north * part, east * part],
            sigma_deg: degrees(moment.level_sigma),
        }
    }
}

/// `q ⊗ conj(q_true)`.
fn error([w, x, y, z]: [f64; 4], [a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [
        w * a + x * b + y * c + z * d,
        -w * b + x * a - y * d + z * c,
        -w * c + x * d + y * a - z * b,
        -w * d - x * c + y * b + z * a,
    ]
}

/// Takes the constant turn from the headings that leaves the least RMS: near their mean direction, their mean.
fn take_offset(off: &mut [Off]) {
    let sum =
        |of: fn(f64) -> f64| off.iter().map(|off| of(off.heading_deg.to_radians())).sum::<f64>();
    let near = degrees(sum(f64::sin).atan2(sum(f64::cos)));
    for off in off.iter_mut() {
        off.heading_deg = azimuth_error(off.heading_deg, near);
    }
    let mean = off.iter().map(|off| off.heading_deg).sum::<f64>() / off.len() as f64;
    for off in off.iter_mut() {
        off.heading_deg -= mean;
    }
}

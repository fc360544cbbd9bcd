//! The roll at the end of a recording when nothing is checked: the phase of the forces in every four turns of the
//! gyro, and the filter of angle and scale over all of them, whatever they show.

use std::f64::consts::TAU;

use orientation::units::DEGREE_PER_SQRT_HOUR;

use crate::methods::spin::errors::wrapped;
use crate::methods::spin::limit::{Rotating, gyro_walk};
use crate::recording::{Header, SpinRow};

/// Turns that are looked at together, as the core does.
const TOGETHER: f64 = 4.0;
/// 1σ of a scale of which nothing is known.
const ANY_SCALE: f64 = 0.1;

/// What some turns show: by how much the gyro's angle is behind, rad, the variance of that, and the angle, rad, and
/// time, s, of its middle.
struct Look {
    phase: f64,
    variance: f64,
    angle: f64,
    time_s: f64,
}

/// The roll at the last row, rad; none where there are not that many turns.
pub(super) fn roll(rows: &[SpinRow], header: &Header) -> Option<f64> {
    let angles = angles(rows);
    let looks = looks(rows, &angles);
    let period_s = header.rate_hz.map(f64::recip)?;
    let walk = header.gyro_n_deg_sqrt_h.map_or_else(
        || gyro_walk(&rows.iter().map(|row| row.rate_rad_s).collect::<Vec<f64>>(), period_s),
        |n| n * DEGREE_PER_SQRT_HOUR,
    );
    let end = *angles.last()?;
    Some(end + filtered(&looks, walk * walk, header.gyro_scale_sigma?, end)?)
}

/// The gyro's angle at each row, rad, from zero.
fn angles(rows: &[SpinRow]) -> Vec<f64> {
    let mut angle = 0.0;
    let steps = rows.windows(2).map(|pair| {
        let seconds = pair[1].time_s - pair[0].time_s;
        angle += 0.5 * (pair[0].rate_rad_s + pair[1].rate_rad_s) * seconds;
        angle
    });
    [0.0].into_iter().chain(steps.collect::<Vec<f64>>()).collect()
}

/// All of them, of the same noise: that of the one in the middle of all.
fn looks(rows: &[SpinRow], angles: &[f64]) -> Vec<Look> {
    let (mut from, mut looks) = (0, Vec::<Look>::new());
    for (to, angle) in angles.iter().enumerate() {
        if (angle - angles[from]).abs() >= TOGETHER * TAU {
            looks.extend(look(&rows[from..to], &angles[from..to]));
            from = to;
        }
    }
    let variance = crate::median::median(looks.iter().map(|look| look.variance));
    looks.into_iter().map(|look| Look { variance, ..look }).collect()
}

fn look(rows: &[SpinRow], angles: &[f64]) -> Option<Look> {
    let placed = rows.iter().zip(angles).enumerate().map(|(index, (row, angle))| {
        ((index as f64 + 0.5) / rows.len() as f64 - 0.5, *angle, row.force_m_s2)
    });
    let Rotating { up, across, variance } = Rotating::of(placed)?;
    let middle = angles.len() / 2;
    Some(Look {
        phase: (-across).atan2(up),
        variance: variance / (rows.len() as f64 * (up * up + across * across)),
        angle: angles[middle],
        time_s: rows[middle].time_s,
    })
}

/// By how much the gyro's angle is behind at an angle after all looks, rad: angle and scale error by a filter that
/// knows the gyro's walk, rad²/s, and takes every phase for the nearest.
fn filtered(looks: &[Look], walk: f64, scale_sigma: f64, end: f64) -> Option<f64> {
    let first = looks.first()?;
    let (mut behind, mut scale) = (first.phase, 0.0);
    let known = scale_sigma.max(ANY_SCALE);
    let (mut aa, mut ab, mut bb) = (first.variance, 0.0, known * known);
    for pair in looks.windows(2) {
        let (turned, seconds) = (pair[1].angle - pair[0].angle, pair[1].time_s - pair[0].time_s);
        behind -= turned * scale;
        aa += turned * (turned * bb - 2.0 * ab) + walk * seconds;
        ab -= turned * bb;
        let innovation = wrapped(pair[1].phase - behind);
        let whole = aa + pair[1].variance;
        behind += aa / whole * innovation;
        scale += ab / whole * innovation;
        bb -= ab * ab / whole;
        (aa, ab) = (aa * pair[1].variance / whole, ab * pair[1].variance / whole);
    }
    Some(behind - (end - looks.last()?.angle) * scale)
}

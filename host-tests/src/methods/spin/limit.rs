//! What the data of a spinning body can show at best: their noise, and the Cramér–Rao bound of the roll.
//!
//! Turn by turn of the gyro's angle both forces are fitted with their first harmonic, which may grow and
//! turn evenly, over a parabola, which the square of the rate draws. What is left over is noise. A sample
//! whose forces have the noise σ on a lift q is worth q²/σ² of the roll; between samples the gyro's noise
//! adds its own, and the scale error is not known. Lift and centripetal part count as known.

use std::ops::Range;

use orientation::math::regression::{Column, Regression};
use orientation::signal::SpinSample;
use orientation::units::{SpinForce, TURN};

use crate::median::median;
use crate::recording::repeated::longest;

/// Columns of the fit of one turn: 1, u, cos, sin, u cos, u sin. A parabola would be mistaken for a turn.
const COLUMNS: usize = 6;
/// Fewest samples of a turn from which noise is estimated.
const FEWEST: usize = 2 * COLUMNS;
/// The sum of the squared binomial coefficients of a sixth difference.
const SIXTH: f64 = 924.0;
/// 1σ of a roll of which nothing is known, rad: anywhere on the circle.
const UNKNOWN: f64 = TURN / 3.464_101_615_137_754_6;

/// What the noise of a recording is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Noise of each accelerometer in each sample, m/s² (1σ).
    pub force: f64,
    /// Angle random walk of the gyro, rad/√s.
    pub angle_random_walk: f64,
}

/// Turns of the gyro in a recording: the lift in each, and the noise of all.
#[derive(Clone, Debug, Default)]
pub struct Turns {
    /// For each turn the number of its first sample, and the lift, m/s².
    pub lifts: Vec<(usize, f64)>,
    /// Noise of a sample's force, m/s²: that of the turn in the middle of all, so that faults do not count.
    pub force_noise: f64,
}

impl Turns {
    /// Divides samples without gaps into turns; a part of a turn at the end belongs to the last one.
    #[must_use]
    pub fn of(samples: &[SpinSample]) -> Self {
        let mut starts = vec![0];
        let mut angle = 0.0;
        for (index, sample) in samples.iter().enumerate().skip(1) {
            angle += sample.turned[0].rad();
            if angle.abs() >= TURN {
                angle -= TURN.copysign(angle);
                starts.push(index);
            }
        }
        let bounds = starts.windows(2).map(|pair| (pair[0], pair[1]));
        let fits: Vec<(usize, [f64; 2])> = bounds
            .filter_map(|(from, to)| Some((from, of_turn(samples.get(from..to)?)?)))
            .collect();
        let variance = median(fits.iter().map(|(_, [_, variance])| *variance));
        let lifts = fits.iter().map(|(from, [lift, _])| (*from, *lift)).collect();
        Self { lifts, force_noise: variance.sqrt() }
    }

    /// The lift at a sample, m/s²: that of its turn.
    pub(crate) fn lift(&self, index: usize) -> f64 {
        let after = self.lifts.partition_point(|(from, _)| *from <= index);
        self.lifts.get(after.saturating_sub(1)).map_or(0.0, |(_, lift)| *lift)
    }
}

/// The lift of one turn, m/s², and the variance of its forces' noise.
fn of_turn(samples: &[SpinSample]) -> Option<[f64; 2]> {
    let forces: Vec<[f64; 2]> = samples
        .iter()
        .map(|sample| sample.force.map(|force| force.map(SpinForce::m_per_s2)))
        .collect::<Option<_>>()?;
    if forces.len() < FEWEST {
        return None;
    }
    let mut angle = 0.0;
    let placed = samples.iter().zip(&forces).enumerate().map(|(index, (sample, force))| {
        angle += sample.turned[0].rad();
        (index as f64 / forces.len() as f64 - 0.5, angle, *force)
    });
    let Rotating { up, across, variance } = Rotating::of(placed)?;
    let noise = 2.0 * variance / forces.len() as f64;
    Some([(up * up + across * across - noise).max(0.0).sqrt(), variance])
}

/// The force that goes round with the body's turn, as both accelerometers show it over a stretch.
pub(crate) struct Rotating {
    /// Its parts, m/s², along y and back along z where the angle of the turn is zero.
    pub(crate) up: f64,
    pub(crate) across: f64,
    /// Variance of a sample's noise.
    pub(crate) variance: f64,
}

impl Rotating {
    /// Fits samples: the place of each in the stretch, from −½ to ½, the angle, rad, and both forces.
    pub(crate) fn of(samples: impl Iterator<Item = (f64, f64, [f64; 2])>) -> Option<Self> {
        let mut fits = [Regression::<COLUMNS>::default(), Regression::default()];
        let mut first = None;
        for (u, angle, force) in samples {
            let first = first.get_or_insert(force);
            let (sine, cosine) = angle.sin_cos();
            let columns = [1.0, u, cosine, sine, u * cosine, u * sine];
            for axis in [0, 1] {
                fits[axis].push(&columns, force[axis] - first[axis]);
            }
        }
        let [y, z] = fits.map(|fit| fit.solve(&[Column::Free; COLUMNS]));
        let (y, z) = (y?, z?);
        // Both axes show the same rotating vector, a quarter of a turn apart.
        Some(Self {
            up: 0.5 * (y.coefficients[2] - z.coefficients[3]),
            across: 0.5 * (y.coefficients[3] + z.coefficients[2]),
            variance: (y.chi_square + z.chi_square) / (y.degrees + z.degrees) as f64,
        })
    }
}

/// Angle random walk of the gyro, rad/√s, where only its rates, rad/s, show it.
#[must_use]
pub fn gyro_walk(rates: &[f64], period_s: f64) -> f64 {
    white(rates) * period_s.sqrt()
}

/// White noise of a signal, 1σ of a sample: sixth differences leave nothing of what changes slowly. A stretch over
/// which it is stuck shows nothing.
#[must_use]
pub(super) fn white(rates: &[f64]) -> f64 {
    const WEIGHTS: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
    let difference = |window: &[f64]| -> f64 {
        window.iter().zip(WEIGHTS).map(|(rate, weight)| rate * weight).sum()
    };
    let stuck = stuck(rates);
    let windows = rates.windows(WEIGHTS.len()).enumerate();
    let lives = windows.filter(|(from, _)| !stuck.contains(from));
    let squares = lives.map(|(_, window)| difference(window).powi(2));
    // Of a normal variable's square the median is 0.455 of the mean.
    (median(squares) / 0.455 / SIXTH).sqrt()
}

/// How many times as long as any other a stretch of one rate is over which a gyro is stuck.
const LONGER: usize = 10;

/// Where a gyro is stuck; nowhere of one that is always so, or often for about as long: it is coarse.
#[must_use]
pub(super) fn stuck(rates: &[f64]) -> Range<usize> {
    let [first, second] = longest(rates, |rate| *rate);
    let is_alone = !second.is_empty() && first.len() > LONGER * second.len();
    if is_alone { first } else { 0..0 }
}

/// The bound of the roll at each sample, rad (1σ), from that sample and all before: with such a noise, with
/// the lift at each sample, m/s², by its number, and a scale error of such a 1σ beforehand.
#[must_use]
pub fn bounds(
    samples: &[SpinSample],
    noise: Noise,
    scale_sigma: f64,
    lift: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let (force_noise, walk) = (noise.force.max(f64::MIN_POSITIVE), noise.angle_random_walk);
    // Covariance of roll and scale error: rr, rs, ss.
    let (mut rr, mut rs, mut ss) = (UNKNOWN * UNKNOWN, 0.0, scale_sigma * scale_sigma);
    let mut before_s = samples.first().map_or(0.0, |sample| sample.time.seconds());
    let one = |(index, sample): (usize, &SpinSample)| {
        let (turned, time_s) = (sample.turned[0].rad(), sample.time.seconds());
        rr += turned * (turned * ss - 2.0 * rs) + walk * walk * (time_s - before_s);
        rs -= turned * ss;
        before_s = time_s;
        if sample.force.is_some() {
            let information = (lift(index) / force_noise).powi(2);
            let kept = 1.0 / (1.0 + rr * information);
            ss -= rs * rs * information * kept;
            (rr, rs) = (rr * kept, rs * kept);
        }
        rr.sqrt()
    };
    samples.iter().enumerate().map(one).collect()
}

//! Azimuth from both senses of rotation for a sensor of unknown gain and lag, and its g-sensitivity
//! G that integrates acceleration (MET 2018, molecular-electronic sensors).
//!
//! With γ = x + jy = G/(w E′) the phasors are Q₊ = H E′ (1 − jγ) and Q₋ = H* E′ (1 + jγ). Half of
//! arg Q₊Q₋ does not contain H; it is arg E′ plus xy and terms of fourth order. |Q₊/Q₋| gives y.
//! Since γ falls as 1/w, a second speed determines the rest. With one speed the error of the
//! azimuth is at most ρ²/2, ρ = |G|/(w `Ω_h`); with two speeds there is a noise penalty of about
//! 2.3 against a sensor without G and H.

use crate::math::Complex;

/// Greatest part x of γ that is used; it enters in fourth order only.
const GREATEST: f64 = 0.5;
/// Number of rounds in which x and y are made consistent.
const ROUNDS: usize = 4;
/// Assumed 1σ of x with a single speed and without prior knowledge of the sensor.
const ASSUMED: f64 = 0.3;

/// Tolerance for the difference of y between the speeds: the axis misalignment changes with
/// frequency.
const TOLERANCE: f64 = 0.01;

/// Half-angle quantities of both senses at one speed, which do not contain H.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Halves {
    /// Speed of the platform, rad/s.
    pub speed: f64,
    /// Half of arg Q₊Q₋, on the side of Q₊, rad.
    pub angle: f64,
    /// Phase lag of the sensor that remains, rad: arg H less x.
    pub phase: f64,
    /// Relative excess of power (|Q₊|² − |Q₋|²)/(|Q₊|² + |Q₋|²).
    pub excess: f64,
    /// Variance of `angle`, rad²; the variance of y is equal to it.
    pub variance: f64,
    /// Part of the variance that is due to quantisation, rad².
    pub rounded: f64,
}

impl Halves {
    /// Half-angle quantities from Q₊ and Q₋ with the variances of their parts, (rad/s)², and the 1σ
    /// rotation of both phasors by quantisation, rad.
    #[must_use]
    pub fn of(speed: f64, phasors: [Complex; 2], variances: [f64; 2], rounded: f64) -> Self {
        let [clockwise, counter] = phasors;
        let half = 0.5 * (clockwise * counter).angle();
        let off = |angle: f64| (clockwise * Complex::unit(-angle)).angle();
        let other = half + core::f64::consts::PI;
        let angle = if off(half).abs() <= off(other).abs() { half } else { other };
        let [more, less] = phasors.map(Complex::power);
        let rounded = rounded * rounded;
        Self {
            speed,
            angle,
            phase: off(angle),
            excess: (more - less) / (more + less),
            variance: 0.25 * (variances[0] / more + variances[1] / less) + rounded,
            rounded,
        }
    }

    /// Part y for a given x: the smaller root of 2y = excess (1 + x² + y²).
    fn sine_part(&self, x: f64) -> f64 {
        let m = self.excess;
        if m.abs() < 1e-9 {
            return 0.5 * m * (1.0 + x * x);
        }
        (1.0 - libm::sqrt((1.0 - m * m * (1.0 + x * x)).max(0.0))) / m
    }
}

/// Contribution of γ to the half angle, without its second order xy.
fn fourth_order(x: f64, y: f64) -> f64 {
    -0.5 * (libm::atan2(x, 1.0 + y) - libm::atan2(x, 1.0 - y)) - x * y
}

/// Angle of E′ and the integrated g-sensitivity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Freed {
    /// Angle arg E′, rad.
    pub angle: f64,
    /// Variance of the angle from the gyro's noise alone, rad².
    pub noise: f64,
    /// Standard deviation of the angle from quantisation, 1σ, rad.
    pub rounded: f64,
    /// Variance that an unresolved g-sensitivity adds to the angle, rad².
    pub left: f64,
    /// Ratio γ at the slower speed.
    pub ratio: Complex,
    /// Error of the angle that the slower speed alone would have, rad.
    pub one_speed: f64,
    /// Difference between the speeds' values of y, over its standard deviation.
    pub disagreement: f64,
}

/// Removes the g-sensitivity from one or two speeds; x times the speed has the prior 1σ `sigma`,
/// rad/s: zero for none, infinite for unknown. `None` without a speed.
#[must_use]
pub fn freed(halves: &[Halves], sigma: f64) -> Option<Freed> {
    let slowest = halves.iter().copied().reduce(|a, b| if b.speed < a.speed { b } else { a })?;
    if sigma == 0.0 {
        return Some(mean(halves));
    }
    let is_one = halves.len() < 2;
    let assumed = if is_one && !sigma.is_finite() { ASSUMED } else { sigma / slowest.speed };
    let mut x = 0.0;
    let mut found = Freed::default();
    for _ in 0..ROUNDS {
        let y = common_part(halves, slowest.speed, x);
        // The prior bounds xy at the slower speed.
        let spread = assumed * libm::hypot(y, libm::sqrt(slowest.variance));
        found = extrapolated(halves, slowest.speed, [x, y], spread);
        // Where y is noise only, x is not observable and shrinks to zero.
        x = (found.one_speed * y / (y * y + slowest.variance)).clamp(-GREATEST, GREATEST);
        found.ratio = Complex::new(x, y);
    }
    found.one_speed += fourth_order(found.ratio.re, found.ratio.im);
    found.disagreement = disagreement(halves, slowest.speed, found.ratio);
    Some(found)
}

/// Weighted mean of all speeds, for a sensor without such a g-sensitivity.
fn mean(halves: &[Halves]) -> Freed {
    let first = halves.first().map_or(0.0, |half| half.angle);
    let (mut information, mut sum, mut rounded) = (0.0, 0.0, 0.0);
    for half in halves {
        information += 1.0 / half.variance;
        sum += remainder(half.angle - first) / half.variance;
        rounded += half.rounded / (half.variance * half.variance);
    }
    let rounded = rounded / (information * information);
    Freed {
        angle: first + sum / information,
        noise: 1.0 / information - rounded,
        rounded: libm::sqrt(rounded),
        ..Freed::default()
    }
}

/// Part y at the slower speed, from all speeds.
fn common_part(halves: &[Halves], slowest: f64, x: f64) -> f64 {
    let (mut information, mut sum) = (0.0, 0.0);
    for half in halves {
        let scale = slowest / half.speed;
        information += scale * scale / half.variance;
        sum += scale * half.sine_part(x * scale) / half.variance;
    }
    sum / information
}

/// Least squares for arg E′ and the product xy at the slower speed, which has the prior 1σ
/// `spread`.
fn extrapolated(halves: &[Halves], slowest: f64, [x, y]: [f64; 2], spread: f64) -> Freed {
    let first = halves.first().map_or(0.0, |half| half.angle);
    // Information of the angle, of angle and product, of the product; then the right sides.
    let (mut one, mut both, mut two) = (0.0, 0.0, 1.0 / (spread * spread));
    let mut targets = [0.0; 2];
    for half in halves {
        let scale = slowest / half.speed;
        let falls = scale * scale;
        let angle = remainder(half.angle - first) - fourth_order(x * scale, y * scale);
        one += 1.0 / half.variance;
        both += falls / half.variance;
        two += falls * falls / half.variance;
        targets[0] += angle / half.variance;
        targets[1] += falls * angle / half.variance;
    }
    let determinant = one * two - both * both;
    // Squared weights of the half angles in the angle, times a part of their variances.
    let weighed = |part: fn(&Halves) -> f64| -> f64 {
        let of = |half: &Halves| {
            let scale = slowest / half.speed;
            let weight = (two - both * scale * scale) / determinant / half.variance;
            weight * weight * part(half)
        };
        halves.iter().map(of).sum()
    };
    let [all, rounded] = [weighed(|half| half.variance), weighed(|half| half.rounded)];
    Freed {
        angle: first + (two * targets[0] - both * targets[1]) / determinant,
        noise: all - rounded,
        rounded: libm::sqrt(rounded),
        left: (two / determinant - all).max(0.0),
        one_speed: (one * targets[1] - both * targets[0]) / determinant,
        ..Freed::default()
    }
}

/// Difference between the speeds' values of y beyond a tolerance, over its standard deviation: root
/// of the sum of squares.
fn disagreement(halves: &[Halves], slowest: f64, ratio: Complex) -> f64 {
    let squares = halves.iter().map(|half| {
        let scale = slowest / half.speed;
        let off = half.sine_part(ratio.re * scale) - ratio.im * scale;
        let beyond = (off.abs() - TOLERANCE).max(0.0);
        beyond * beyond / half.variance
    });
    libm::sqrt(squares.sum())
}

/// Reduces an angle to [−π, π], rad.
fn remainder(angle: f64) -> f64 {
    Complex::unit(angle).angle()
}

//! What both senses tell of a sensor whose gain and lag are unknown, and of its g-sensitivity G that
//! integrates acceleration (equations.md §4, steps 4 and 5).
//!
//! With γ = x + jy = G/(w E′): Q₊ = H E′ (1 − jγ), Q₋ = H* E′ (1 + jγ). The half of arg Q₊Q₋ is free of
//! H; beside arg E′ it holds xy and terms of fourth order. |Q₊/Q₋| gives y. Since γ falls as 1/w, two
//! speeds tell the rest.

use crate::math::Complex;

/// Greatest part x of γ that is believed; what it is for is of fourth order.
const GREATEST: f64 = 0.5;
/// Rounds in which x and y are made to agree.
const ROUNDS: usize = 4;
/// What x may be where one speed alone is at hand and nothing is known of the sensor, 1σ: γ of 0.3.
const ASSUMED: f64 = 0.3;

/// What y may differ by between the speeds: a coupling that changes with the frequency.
const TOLERANCE: f64 = 0.01;

/// Both senses at one speed, without H.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Halves {
    /// The speed, rad/s.
    pub speed: f64,
    /// Half of arg Q₊Q₋, on the side of Q₊, rad.
    pub angle: f64,
    /// Lag of the sensor that this leaves, rad: arg H less x.
    pub phase: f64,
    /// (|Q₊|² − |Q₋|²)/(|Q₊|² + |Q₋|²).
    pub excess: f64,
    /// Variance of `angle`, rad²; that of y is the same.
    pub variance: f64,
    /// The part of it that is from rounding to steps, rad².
    pub rounded: f64,
}

impl Halves {
    /// From Q₊ and Q₋ with the variances of their parts, and the 1σ of what rounding to steps turns both by, rad.
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

    /// y for an x: the smaller root of 2y = excess (1 + x² + y²).
    fn sine_part(&self, x: f64) -> f64 {
        let m = self.excess;
        if m.abs() < 1e-9 {
            return 0.5 * m * (1.0 + x * x);
        }
        (1.0 - libm::sqrt((1.0 - m * m * (1.0 + x * x)).max(0.0))) / m
    }
}

/// What γ adds to the half angle, less its second order xy.
fn fourth_order(x: f64, y: f64) -> f64 {
    -0.5 * (libm::atan2(x, 1.0 + y) - libm::atan2(x, 1.0 - y)) - x * y
}

/// arg E′ and what the integrated g-sensitivity is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Freed {
    /// arg E′, rad.
    pub angle: f64,
    /// Its variance from the gyro's noise alone, rad².
    pub noise: f64,
    /// Its 1σ from rounding to steps, rad.
    pub rounded: f64,
    /// What a g-sensitivity that is not told apart adds to it, rad².
    pub left: f64,
    /// γ at the slower speed.
    pub ratio: Complex,
    /// What one speed alone, the slower, would be off by, rad.
    pub one_speed: f64,
    /// How far the speeds disagree about y, over its standard deviation.
    pub disagreement: f64,
}

/// Frees one or two speeds of the g-sensitivity, whose x times the speed has this 1σ, rad/s: zero for
/// none, infinite for unknown.
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
        // xy of the slower speed: known to be so small.
        let spread = assumed * libm::hypot(y, libm::sqrt(slowest.variance));
        found = extrapolated(halves, slowest.speed, [x, y], spread);
        // Where y is but noise, nothing is known of x.
        x = (found.one_speed * y / (y * y + slowest.variance)).clamp(-GREATEST, GREATEST);
        found.ratio = Complex::new(x, y);
    }
    found.one_speed += fourth_order(found.ratio.re, found.ratio.im);
    found.disagreement = disagreement(halves, slowest.speed, found.ratio);
    Some(found)
}

/// The weighted mean of all speeds, where there is no such g-sensitivity.
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

/// y at the slower speed, from all speeds.
fn common_part(halves: &[Halves], slowest: f64, x: f64) -> f64 {
    let (mut information, mut sum) = (0.0, 0.0);
    for half in halves {
        let scale = slowest / half.speed;
        information += scale * scale / half.variance;
        sum += scale * half.sine_part(x * scale) / half.variance;
    }
    sum / information
}

/// Least squares for arg E′ and the product xy at the slower speed, of which only `spread` is known.
fn extrapolated(halves: &[Halves], slowest: f64, [x, y]: [f64; 2], spread: f64) -> Freed {
    let first = halves.first().map_or(0.0, |half| half.angle);
    // Information of the angle, of both, of the product; and their targets.
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
    // What the half angles themselves weigh in the angle, squared, by a part of their variances.
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

/// How far the speeds disagree about y beyond a tolerance, over its standard deviation: root of the sum
/// of squares.
fn disagreement(halves: &[Halves], slowest: f64, ratio: Complex) -> f64 {
    let squares = halves.iter().map(|half| {
        let scale = slowest / half.speed;
        let off = half.sine_part(ratio.re * scale) - ratio.im * scale;
        let beyond = (off.abs() - TOLERANCE).max(0.0);
        beyond * beyond / half.variance
    });
    libm::sqrt(squares.sum())
}

/// An angle in [−π, π].
fn remainder(angle: f64) -> f64 {
    Complex::unit(angle).angle()
}

//! Burov's optimisation: the best number of positions in a given time, and the time for a wanted
//! rate error.
//!
//! A gyro is turned between n positions in a total time `t_GC`, each rotation taking `t_rot`; its rate
//! error after autocompensation is (Burov)
//!
//! ```text
//! Δω(n)² = R²(t_GC + t_rot)²/(2n²) + K²(t_GC + t_rot)/(3n) + N²/t_w + 3Q²/t_w²,
//! t_w = t_GC − (n − 1) t_rot
//! ```
//!
//! Δω is the error of a *rate*. A horizontal gyro that measures its component along one axis only
//! has an azimuth error of `Δω/Ω_h`; a full azimuth needs two components in the same time, √2 of
//! it. The paper leaves out B, which no rotation reduces in its model; it is added as B√(2 ln 2/π).
//! Noise coefficients are in SI units here. Check: N 0.001 °/√h, R 0.127 °/h², `t_rot` 2 s and
//! `t_GC` 300 s give n = 11 and Δω = 3.6505e-3 °/h.

use crate::noise::GyroNoise;
use crate::units::{RadiansPerSecond, Seconds};

/// Fewest positions that compensate a bias.
const FEWEST: u32 = 2;
/// Most positions that are considered: more than any stage reaches in a day.
const MOST: u32 = 100_000;
/// Longest total time that is considered: a day.
pub const LONGEST: Seconds = Seconds(86_400.0);
/// Number of bisections of an interval of time: from a day to below a nanosecond.
const HALVINGS: usize = 48;
/// Number of ternary-search steps with the same final width.
const THIRDS: usize = 82;

/// Optimum of autocompensation by turning between positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Autocompensation {
    /// Number of positions n.
    pub positions: u32,
    /// Time in each position: the total less the rotations, over n.
    pub dwell: Seconds,
    /// Total time `t_GC`.
    pub seconds: Seconds,
    /// Rate error Δω(n), 1σ, without bias instability.
    pub rate_error: RadiansPerSecond,
}

/// Rate error Δω(n), 1σ, for `positions` in `seconds` of total time with the time `rotation` for
/// each rotation; `None` for fewer than two positions, or where the rotations leave no time.
#[must_use]
pub fn rate_error(
    noise: &GyroNoise,
    positions: u32,
    seconds: Seconds,
    rotation: Seconds,
) -> Option<RadiansPerSecond> {
    let (n, seconds, rotation) = (f64::from(positions), seconds.0, rotation.0);
    let whole = seconds + rotation;
    let still = seconds - (n - 1.0) * rotation;
    let [q, white, _, k, r] = noise.coefficients();
    let ramp = r * whole / n;
    let square = 0.5 * ramp * ramp
        + k * k * whole / (3.0 * n)
        + white * white / still
        + 3.0 * q * q / (still * still);
    (positions >= FEWEST && still > 0.0).then(|| RadiansPerSecond(libm::sqrt(square)))
}

/// Number of positions with the least Δω in `seconds` of total time; `None` where not even one
/// rotation fits in.
///
/// Each term of Δω² is convex in n, so their sum is convex, and the sign of its change is bisected.
/// Without noise that grows with the dwell, two positions are best.
#[must_use]
pub fn best(noise: &GyroNoise, seconds: Seconds, rotation: Seconds) -> Option<Autocompensation> {
    let of = |n| rate_error(noise, n, seconds, rotation).map_or(f64::INFINITY, |error| error.0);
    let (mut low, mut high) = (FEWEST, MOST);
    while low < high {
        let middle = u32::midpoint(low, high);
        if of(middle + 1) < of(middle) { low = middle + 1 } else { high = middle }
    }
    let rate_error = rate_error(noise, low, seconds, rotation)?;
    let n = f64::from(low);
    let dwell = (seconds.0 - (n - 1.0) * rotation.0) / n;
    Some(Autocompensation { positions: low, dwell: Seconds(dwell), seconds, rate_error })
}

/// Shortest total time in which Δω comes down to `wanted`, with its best number of positions.
///
/// # Errors
/// The least Δω, where no time up to a day reaches `wanted`.
///
/// More time is not always better: between one number of positions and the next a random walk adds
/// to the error. For each number Δω² is convex in the time, so the first sufficient time is found
/// for each, and the shortest of all is taken.
pub fn least_time(
    noise: &GyroNoise,
    wanted: RadiansPerSecond,
    rotation: Seconds,
) -> Result<Autocompensation, RadiansPerSecond> {
    let (mut longest, mut least, mut found) = (LONGEST.0, f64::INFINITY, None);
    for positions in FEWEST..=MOST {
        let turning = f64::from(positions - 1) * rotation.0;
        if turning >= longest {
            break;
        }
        let error = |seconds| rate_error(noise, positions, Seconds(seconds), rotation);
        let of = |seconds| error(seconds).map_or(f64::INFINITY, |error| error.0);
        let lowest = lowest(of, turning, longest);
        least = least.min(of(lowest));
        if of(lowest) <= wanted.0 {
            longest = first(|seconds| of(seconds) <= wanted.0, turning, lowest);
            found = best(noise, Seconds(longest), rotation);
        }
    }
    found.ok_or(RadiansPerSecond(least))
}

/// Argument of the minimum of a convex function between two times, s, by ternary search.
fn lowest(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..THIRDS {
        let third = (high - low) / 3.0;
        let (left, right) = (low + third, high - third);
        if of(left) <= of(right) { high = right } else { low = left }
    }
    high
}

/// First time, s, from which a predicate holds, by bisection: it is false at `low` and true at
/// `high`.
fn first(is_true: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_true(middle) { high = middle } else { low = middle }
    }
    high
}

/// Contribution of bias instability to a rate error, B√(2 ln 2/π); no rotation schedule
/// reduces it.
pub fn flicker_floor(noise: &GyroNoise) -> RadiansPerSecond {
    let factor = libm::sqrt(2.0 * core::f64::consts::LN_2 / core::f64::consts::PI);
    RadiansPerSecond(noise.bias_instability.0 * factor)
}

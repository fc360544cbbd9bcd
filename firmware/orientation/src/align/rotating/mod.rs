//! Azimuth from a platform that turns all the time (MET 2018; equations.md §4).
//!
//! ```text
//!  sample ─▶ turn accumulator ─turns─▶ average (drift, coupling) ─Q₊, Q₋─▶ solution ─▶ azimuth ± σ
//!                └─uneven turn─▶ coupling ──▲   accelerometer ─F──▲
//! ```
//!
//! The gyro's rate is demodulated at the turn: its phasor holds the horizontal Earth rate,
//! E = `Ω_h` e^{jA}, and what turns with it. What the platform's own unevenness makes is taken off by
//! the coupling; what changes its sign with the sense of rotation cancels between the senses; what
//! falls with the speed is told apart by a second speed; tilt is read by the accelerometer.

pub mod average;
pub mod change;
pub mod conclusion;
pub mod coupling;
pub mod heading;
pub mod level;
pub mod molecular;
pub mod part;
pub mod solution;
pub mod tilting;
pub mod turn;
pub mod turn_accumulator;

use self::coupling::Coupling;
use self::solution::SPEEDS;
use super::setting::Setting as Common;
use crate::error::Refusal;
use crate::units::{DEGREE, DEGREES_PER_RADIAN};

/// What kind of sensor turns with the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Whether it shows a rate at the platform's speed as it is; else with an unknown gain and lag, which
    /// rotation in both senses tells.
    pub is_flat: bool,
    /// 1σ of either part of a g-sensitivity that integrates acceleration (molecular-electronic): what it
    /// makes of the tilt times the platform's speed, over the horizontal Earth rate, rad/s. Zero for a
    /// gyro without; infinite for one of which nothing is known, which takes two speeds.
    pub molecular_sigma: f64,
    /// How long its output needs after a change of speed, s.
    pub settle_seconds: f64,
}

impl Sensor {
    /// A gyro as such: flat, with an ordinary g-sensitivity alone.
    pub const GYRO: Self = Self { is_flat: true, molecular_sigma: 0.0, settle_seconds: 1.0 };
    /// A molecular-electronic sensor of which nothing is known.
    pub const MOLECULAR: Self =
        Self { is_flat: false, molecular_sigma: f64::INFINITY, settle_seconds: 5.0 };
}

/// What is known before a platform begins to turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The place, the gyro, the accelerometer, the demands.
    pub common: Common,
    /// The kind of sensor.
    pub sensor: Sensor,
    /// The couplings as they were found before, one for each speed; uneven turns replace them.
    pub couplings: [Option<Coupling>; SPEEDS],
    /// How far the sensitive axis may stand from the platform's plane, rad.
    pub coupling_limit: f64,
    /// 1σ of the encoder's zero, as it turns the azimuth, rad: no turn shows it.
    pub encoder_zero_sigma: f64,
    /// Whether the encoder's error twice a turn is within [`Common::encoder_sigma`]; else what it shows of the
    /// platform's rate may be such an error.
    pub harmonics_known: bool,
    /// Step of the gyro's rates, rad/s, as far as their noise does not hide it: what they are rounded by in step with
    /// the turn is no noise.
    pub rate_step: f64,
}

/// Default of [`Setting::coupling_limit`]: 2°.
const COUPLING_LIMIT: f64 = 2.0 * DEGREE;

impl Setting {
    /// Nothing is known of the coupling; the encoder is exact.
    #[must_use]
    pub const fn new(common: Common, sensor: Sensor) -> Self {
        Self {
            common,
            sensor,
            couplings: [None; SPEEDS],
            coupling_limit: COUPLING_LIMIT,
            encoder_zero_sigma: 0.0,
            harmonics_known: true,
            rate_step: 0.0,
        }
    }

    /// Whether the sensor is mounted well enough.
    ///
    /// # Errors
    /// [`Refusal::Misaligned`]: align it mechanically.
    pub fn accept(&self, coupling: &Coupling) -> Result<(), Refusal> {
        let (angle, allowed) = (coupling.angle(), self.coupling_limit);
        if angle.abs() <= allowed {
            return Ok(());
        }
        let [angle, allowed] = [angle, allowed].map(|angle| angle * DEGREES_PER_RADIAN);
        Err(Refusal::Misaligned { angle, allowed })
    }
}

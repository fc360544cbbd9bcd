//! The measured series: the dwell rates in table units.

use heapless::Vec;

use crate::math::reference_table::{HALF, ONE, TURN};

/// Greatest number of positions in one series.
pub use crate::alignment::stepwise::CAPACITY;

/// Values are limited to ±2⁴⁰ table units (512 times the horizontal Earth rate), so that every sum
/// of the exact search stays within its integer type.
pub(crate) const LIMIT: i64 = 1 << 40;

/// Reason for which a series cannot be matched, with its remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesError {
    /// Fewer than three positions: two leave a mirrored azimuth, so measure at one more.
    TooFew,
    /// More than [`CAPACITY`] positions: average neighbours or take a larger step.
    TooMany,
    /// The step is a whole number of turns: every position looks the same way, so choose another.
    ZeroStep,
    /// The step is half a turn: azimuths A and −A give the same series, so choose another.
    MirrorTiedStep,
    /// A rate is infinite or not a number: exclude that dwell before matching.
    NotFinite,
}

/// Dwell rates over the horizontal Earth rate, at positions one uniform step apart.
#[derive(Clone, Debug)]
pub struct Series {
    /// Ratios in table units.
    values: Vec<i64, CAPACITY>,
    /// Step in grid steps, within half a turn.
    step: i32,
}

impl Series {
    /// Takes the ratios `Z_i` / `Ω_h` (dimensionless) in the order measured and the step between
    /// positions in grid steps of 10″, clockwise positive.
    ///
    /// Each ratio is rounded to the nearest 2⁻³¹ (ties away from zero) and clamped to ±2⁴⁰ steps.
    ///
    /// # Errors
    /// [`SeriesError`] names the fault and its remedy.
    pub fn new(ratios: impl IntoIterator<Item = f64>, step: i32) -> Result<Self, SeriesError> {
        let mut values = Vec::new();
        for ratio in ratios {
            values.push(to_units(ratio)?).map_err(|_| SeriesError::TooMany)?;
        }
        if values.len() < 3 {
            return Err(SeriesError::TooFew);
        }
        match step.rem_euclid(TURN) {
            0 => Err(SeriesError::ZeroStep),
            HALF => Err(SeriesError::MirrorTiedStep),
            step if step > HALF => Ok(Self { values, step: step - TURN }),
            step => Ok(Self { values, step }),
        }
    }

    /// Values of the series in table units: 2³¹ is the horizontal Earth rate.
    #[must_use]
    pub fn values(&self) -> &[i64] {
        &self.values
    }

    /// Step between positions in grid steps, reduced to less than half a turn either way.
    #[must_use]
    pub fn step(&self) -> i32 {
        self.step
    }

    /// Number of positions, 3 to [`CAPACITY`], as a floating-point number.
    pub(crate) fn count(&self) -> f64 {
        self.values.len() as f64
    }
}

/// Converts a ratio to table units, rounded and clamped.
fn to_units(ratio: f64) -> Result<i64, SeriesError> {
    if !ratio.is_finite() {
        return Err(SeriesError::NotFinite);
    }
    // The cast saturates, so the clamp also holds for ratios beyond the range of `i64`.
    Ok((libm::round(ratio * ONE) as i64).clamp(-LIMIT, LIMIT))
}

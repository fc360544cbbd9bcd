//! The attitude as the link reports it while the keeper runs.

use core::fmt;

use orientation::attitude::{Report, State};
use orientation::units::DEGREES_PER_RADIAN as DEGREES;

use crate::link::Thousandths;

/// Attitude as reported, in thousandths of a degree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeReport {
    /// Azimuth of body x, 0–359 999, and its 1σ, rounded up; [`None`] if the azimuth is unknown.
    pub azimuth: Option<[u32; 2]>,
    /// Pitch and roll.
    pub level: [i32; 2],
    /// The keeper's state; [`None`] if no inertial samples arrive.
    pub state: Option<State>,
    /// Whether the azimuth is that stored before the loss of supply.
    pub is_recalled: bool,
}

/// An angle, rad, in thousandths of a degree, rounded to nearest.
fn thousandths(angle: f64) -> i32 {
    libm::round(angle * DEGREES * 1e3) as i32
}

impl AttitudeReport {
    /// Converts a report of the keeper.
    pub(super) fn of(report: &Report, is_recalled: bool) -> Self {
        let azimuth = report.azimuth.map(|azimuth| {
            let angle = thousandths(azimuth.angle).rem_euclid(360_000).unsigned_abs();
            // The 1σ is rounded up, so that the reported value is never less than the estimated
            // one.
            [angle, libm::ceil(azimuth.sigma * DEGREES * 1e3) as u32]
        });
        let level = [report.pitch, report.roll].map(thousandths);
        Self { azimuth, level, state: Some(report.state), is_recalled }
    }
}

/// Writes a name and a number of thousandths. The sign is written apart, because −0.310 has a whole
/// part of zero.
fn write(f: &mut fmt::Formatter<'_>, name: &str, value: i32) -> fmt::Result {
    let sign = if value < 0 { "-" } else { "" };
    write!(f, "{name} {sign}{} ", Thousandths(value.unsigned_abs()))
}

impl fmt::Display for AttitudeReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.azimuth {
            Some([angle, sigma]) => {
                write!(f, "azimuth {} sigma {} ", Thousandths(angle), Thousandths(sigma))?;
            }
            None => f.write_str("no azimuth, ")?,
        }
        let [pitch, roll] = self.level;
        write(f, "pitch", pitch)?;
        write(f, "roll", roll)?;
        match self.state {
            Some(state) => state.fmt(f)?,
            None => f.write_str("no motion measured")?,
        }
        if self.is_recalled { f.write_str(", recalled") } else { Ok(()) }
    }
}

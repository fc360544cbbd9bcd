//! Refusals of a multi-position alignment, with the sentences that are printed for them.

use crate::noise::fit::FitError;
use crate::units::{Degrees, MilliG, Seconds};
use crate::words::Rounded;

/// Reason for which a multi-position alignment gives no azimuth, beside those that several methods have.
/// Quantities are in the units of its sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// Fewer than three different undisturbed positions remain.
    TooFewPositions {
        /// Number of different positions that were left.
        positions: usize,
    },
    /// Two positions 180° apart fit two azimuths (±A), and the half circle was not configured.
    SignUnknown,
    /// No azimuth in the configured half circle fits the dwells.
    NotInHalf,
    /// The measured positions do not determine the azimuth, or leave two of them.
    AzimuthUnobservable,
    /// The required standard deviation cannot be reached in the time allowed.
    OutOfReach {
        /// Least standard deviation that can be reached, 1σ.
        sigma: Degrees,
        /// Standard deviation that was required, 1σ.
        required: Degrees,
        /// Time allowed for the alignment.
        seconds: Seconds,
    },
    /// The survey (the recording at rest before the alignment) does not determine the gyro's noise.
    NoiseUnknown(FitError),
    /// No sequence of dwells and rotations fits into the time allowed.
    NoSchedule {
        /// Time allowed for the alignment.
        seconds: Seconds,
    },
    /// The uncertainty of the tilt alone exceeds the accepted standard deviation of the azimuth.
    TiltTooUncertain {
        /// Contribution of the tilt's uncertainty to the azimuth, 1σ.
        sigma: Degrees,
        /// Greatest standard deviation of the azimuth that is accepted, 1σ.
        required: Degrees,
    },
    /// The gyro drifts, and these positions do not separate the drift from the Earth rate.
    TrendNotSeparable,
    /// The tilt measured by the accelerometer stepped between two dwells.
    TiltStepped {
        /// Size of the tilt step.
        change: MilliG,
        /// Time at which the tilt stepped, s after the first dwell began.
        after: Seconds,
    },
    /// Dwells at the beginning or at the end are inconsistent with the others.
    EndDisagrees {
        /// Number of inconsistent dwells.
        dwells: usize,
        /// Time that separates the inconsistent dwells from the others.
        after: Seconds,
    },
    /// The measured rate lags behind the stage angle.
    GyroLags {
        /// Lag of the rate.
        seconds: Seconds,
    },
    /// All dwells scatter alike, as white noise does, but with another power than the stated noise.
    NoiseNotAsStated {
        /// Noise power found over the stated one.
        ratio: f64,
    },
    /// More dwells were disturbed than may be excluded.
    Disturbed {
        /// Number of disturbed dwells.
        disturbed: usize,
        /// Number of all dwells.
        positions: usize,
    },
    /// More dwells were disturbed than may be excluded, and the coarse inertial measurement unit
    /// failed that would have measured the sway of the base.
    SwayUnmeasured,
    /// The stage came to rest away from its commanded angle.
    StageNotThere {
        /// Commanded stage angle.
        target: Degrees,
        /// Stage angle at which it came to rest.
        actual: Degrees,
    },
    /// The criteria of Sokolov 2019 need equal steps that are a multiple of 10″.
    StepsUneven,
    /// No azimuth of the reference table (etalon) meets the given bound.
    NothingAccepted,
    /// Every azimuth of the reference table (etalon) meets the given bound.
    EverythingAccepted,
}

crate::words! { Refusal:
    Self::TooFewPositions { positions } =>
        "{} undisturbed position(s): three different ones are needed", positions;
    Self::SignUnknown =>
        "two positions leave two azimuths: add a third, or state whether it points east or west";
    Self::NotInHalf =>
        "no azimuth of the stated half fits: it lies in the other one, or too near the axis between them";
    reason @ Self::AzimuthUnobservable =>
        "the positions do not show the azimuth{}",
        reason.remedy();
    Self::OutOfReach { sigma, required, seconds } =>
        "σ of {}° is out of reach: {}° is the least that {} s can give",
        Rounded::<4>(required.0), Rounded::<4>(sigma.0), Rounded::<0>(seconds.0);
    Self::NoiseUnknown(why) => "the gyro's noise cannot be learnt: {}", why;
    Self::NoSchedule { seconds } => "no schedule fits into {} s", Rounded::<0>(seconds.0);
    reason @ Self::TiltTooUncertain { sigma, required } =>
        "the tilt is known too badly: it alone costs {}° of {}°{}",
        Rounded::<4>(sigma.0), Rounded::<4>(required.0),
        reason.remedy();
    Self::TrendNotSeparable =>
        "the rate drifts, and these positions do not separate it from the Earth rate: turn a full circle";
    Self::TiltStepped { change, after } =>
        "the tilt steps by {} mg after {} s: the encoder slipped, or the platform was moved",
        Rounded::<2>(change.0), Rounded::<1>(after.0);
    Self::EndDisagrees { dwells, after } =>
        "{} dwell(s) at the beginning or the end do not fit the others: after {} s the encoder slipped, the base was turned, or the gyro settled",
        dwells, Rounded::<1>(after.0);
    Self::GyroLags { seconds } =>
        "the gyro follows the stage {} s late: check its filter, and the times of its column",
        Rounded::<2>(seconds.0);
    Self::NoiseNotAsStated { ratio } =>
        "all dwells scatter alike, with {} times the stated noise power: check N, and the unit of the rates",
        Rounded::<1>(ratio);
    reason @ Self::Disturbed { disturbed, positions } =>
        "{} of {} dwells were disturbed{}", disturbed, positions,
        reason.remedy();
    Self::SwayUnmeasured =>
        "the dwells were disturbed, and the coarse IMU is missing that would measure the base's sway: check its wiring";
    Self::StageNotThere { target, actual } =>
        "the stage was sent to {}° but stands at {}°",
        Rounded::<3>(target.0), Rounded::<3>(actual.0);
    Self::StepsUneven =>
        "this criterion needs equal steps that are a multiple of 10″, none left out";
    Self::NothingAccepted => "no azimuth of the table lies within the bound";
    Self::EverythingAccepted =>
        "every azimuth of the table lies within the bound: it excludes none";
}

impl Refusal {
    /// Usual remedy, with which the sentence ends; empty where it names none.
    pub(crate) const fn remedy(&self) -> &'static str {
        match self {
            Self::AzimuthUnobservable => ": turn the stage over a longer arc",
            Self::TiltTooUncertain { .. } => "; turn a full circle or calibrate the accelerometer",
            Self::TrendNotSeparable => ": turn a full circle",
            Self::Disturbed { .. } => ": keep the platform still",
            _ => "",
        }
    }
}

//! Reasons for which an alignment ends without a result, with the sentences that are printed for
//! them: those that several methods have; what a method adds is in its own folder. A refusal
//! carries the figures that decided it, so that the operator can see how far it missed and which
//! remedy helps: level the platform, turn a longer arc, keep still, or check a sensor.

use super::budget::Source;
use super::rotating::refusal as rotating;
use super::stepwise::refusal as stepwise;
use super::stops::refusal as stops;
use crate::device::{Device, Trouble};
use crate::units::{Degrees, MilliG, Milliseconds, Seconds};
use crate::words::Rounded;

/// Reason for which no azimuth is given, in the units of its sentence. Serialised are those that the
/// samples of a recording do not show, and none of one method alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Refusal {
    /// The latitude is within 5° of a pole: the horizontal Earth rate is below 9 % of the whole.
    LatitudeTooHigh {
        /// The latitude.
        latitude: Degrees,
    },
    /// The standard deviation of the azimuth is greater than the required one.
    BudgetNotMet {
        /// Standard deviation that was reached, 1σ.
        sigma: Degrees,
        /// Greatest standard deviation that is accepted, 1σ.
        required: Degrees,
        /// Largest contribution to the error budget.
        source: Source,
    },
    /// The platform is inclined more than the method allows.
    TiltTooGreat {
        /// Tilt of the platform that was measured.
        tilt: Degrees,
        /// Greatest tilt that the configuration allows.
        allowed: Degrees,
    },
    /// The residuals of the fit are larger than the stated noise of the gyro explains.
    ResidualsNotWhite {
        /// Chi-square of the residuals over its degrees of freedom, near 1 for white noise as
        /// stated.
        ratio: f64,
    },
    /// Successive residuals correlate: the model lacks a term for something that varies slowly.
    ResidualsCorrelated {
        /// Correlation coefficient of neighbouring residuals, −1 to 1.
        correlation: f64,
    },
    /// The heading of the platform stepped between two dwells.
    HeadingStepped {
        /// Size of the heading step.
        angle: Degrees,
        /// Time at which the heading stepped, s after the first dwell began.
        after: Seconds,
    },
    /// The accelerometer's readings do not turn with the stage angle that the encoder shows.
    AccelerometerDisagrees {
        /// RMS of the readings that no constant tilt explains.
        scatter: MilliG,
    },
    /// The mean specific force on the vertical axis is not that of gravity.
    AccelerometerImplausible {
        /// Measured specific force over normal gravity, positive where it has the sign of a sensor
        /// at rest.
        ratio: f64,
    },
    /// The horizontal Earth rate found differs significantly from Ω cos φ times the gyro's scale.
    EarthRateMismatch {
        /// Horizontal Earth rate found over the expected one.
        ratio: f64,
        /// Standard deviation of the ratio, 1σ.
        sigma: f64,
    },
    /// The time allowed for the whole session ran out.
    TimeExhausted,
    /// It was ordered to end.
    Stopped,
    /// The base was in motion after a rest, before the alignment was complete.
    MovedDuringAlignment,
    /// The time stamps contradict the configured sample period.
    PeriodContradicted {
        /// Configured sample period.
        stated: Milliseconds,
        /// Sample period found from the time stamps.
        found: Milliseconds,
    },
    /// The axis misalignment is unknown: neither configured, nor measured by rate-modulated turns.
    MisalignmentUnknown,
    /// A device of the board failed permanently.
    Device {
        /// Device that failed.
        device: Device,
        /// Failure of that device.
        trouble: Trouble,
    },
    /// Refusal by a multi-position alignment alone.
    #[cfg_attr(feature = "serde", serde(skip))]
    Stepwise(stepwise::Refusal),
    /// Refusal by an alignment by continuous rotation alone.
    #[cfg_attr(feature = "serde", serde(skip))]
    Rotating(rotating::Refusal),
    /// Refusal by an inertial-frame alignment from stop to stop alone.
    #[cfg_attr(feature = "serde", serde(skip))]
    Stops(stops::Refusal),
}

impl core::error::Error for Refusal {}

crate::words! { Refusal:
    Self::LatitudeTooHigh { latitude } =>
        "latitude {}° is beyond ±85°: too little of the Earth rate is horizontal",
        Rounded::<2>(latitude.0);
    Self::BudgetNotMet { sigma, required, source } =>
        "σ would be {}°, above the accepted {}°; {} contributes most",
        Rounded::<3>(sigma.0), Rounded::<3>(required.0), source;
    reason @ Self::TiltTooGreat { tilt, allowed } =>
        "the platform is inclined by {}°, more than {}°{}",
        Rounded::<2>(tilt.0), Rounded::<1>(allowed.0),
        reason.remedy();
    Self::ResidualsNotWhite { ratio } =>
        "residuals are not white: {} times the stated noise power", Rounded::<1>(ratio);
    Self::ResidualsCorrelated { correlation } =>
        "residuals are not white: neighbours correlate by {}", Rounded::<2>(correlation);
    Self::HeadingStepped { angle, after } =>
        "the heading steps by {}° after {} s: the encoder slipped, or the base was turned",
        Rounded::<2>(angle.0), Rounded::<1>(after.0);
    Self::AccelerometerImplausible { ratio } =>
        "the accelerometer feels {} of gravity: check its axes, signs and units",
        Rounded::<3>(ratio);
    Self::AccelerometerDisagrees { scatter } =>
        "the accelerometer is off by {} mg from any tilt: check which way the encoder counts, the axes, its noise, and \
         whether it warms up",
        Rounded::<1>(scatter.0);
    Self::EarthRateMismatch { ratio, sigma } =>
        "Earth rate found is {} ± {} of the expected: check latitude and gyro scale",
        Rounded::<3>(ratio), Rounded::<3>(sigma);
    Self::TimeExhausted => "the time allowed ran out";
    Self::Stopped => "it was ordered to end";
    Self::MovedDuringAlignment => "it was in motion after a rest before it was aligned: the vehicle drove on, or it sways";
    Self::PeriodContradicted { stated, found } =>
        "samples come every {} ms, not every {} ms as stated: correct the sample rate or the times",
        Rounded::<4>(found.0), Rounded::<4>(stated.0);
    Self::MisalignmentUnknown =>
        "the axis misalignment of the sensor is not known: modulate the platform's rate first";
    Self::Device { device, trouble } => "{}: {}", device, trouble;
    Self::Stepwise(reason) => "{}", reason;
    Self::Rotating(reason) => "{}", reason;
    Self::Stops(reason) => "{}", reason;
}

impl Refusal {
    /// Usual remedy, with which the sentence ends; empty where it names none. Where a likelier cause
    /// is known it does not help.
    #[must_use]
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::TiltTooGreat { .. } => ": level it",
            Self::Stepwise(reason) => reason.remedy(),
            Self::Rotating(reason) => reason.remedy(),
            _ => "",
        }
    }
}

/// Outcome of a test that an alignment must pass.
pub type Passed = Result<(), Refusal>;

/// Refuses with this reason where a test fails.
///
/// # Errors
/// The reason.
pub(crate) fn refuse_if(is_failed: bool, reason: impl Into<Refusal>) -> Passed {
    if is_failed { Err(reason.into()) } else { Ok(()) }
}

impl From<stepwise::Refusal> for Refusal {
    fn from(reason: stepwise::Refusal) -> Self {
        Self::Stepwise(reason)
    }
}

impl From<rotating::Refusal> for Refusal {
    fn from(reason: rotating::Refusal) -> Self {
        Self::Rotating(reason)
    }
}

impl From<stops::Refusal> for Refusal {
    fn from(reason: stops::Refusal) -> Self {
        Self::Stops(reason)
    }
}

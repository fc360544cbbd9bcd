//! Why something ended without a result.

use crate::device::{Device, Trouble};
use crate::noise::fit::FitError;
use crate::words;
use crate::words::Rounded;

/// Where the standard deviation of an azimuth comes from; see [`crate::align::budget::Budget`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// White noise of the gyro.
    Noise,
    /// Bias instability, rate random walk and ramp of the gyro.
    Drift,
    /// The gyro's sensitivity to acceleration, through the tilt.
    GSensitivity,
    /// The tilt as the accelerometer knows it.
    Accelerometer,
    /// The stage encoder.
    Encoder,
    /// The latitude.
    Latitude,
    /// The gyro's scale factor.
    Scale,
    /// The temperature slope.
    Temperature,
}

words! { Source:
    Self::Noise => "gyro noise";
    Self::Drift => "gyro drift";
    Self::GSensitivity => "g-sensitivity";
    Self::Accelerometer => "tilt from the accelerometer";
    Self::Encoder => "stage encoder";
    Self::Latitude => "latitude";
    Self::Scale => "gyro scale factor";
    Self::Temperature => "temperature slope";
}

/// Why no azimuth is given. Angles in degrees, ready to print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The latitude is within 5° of a pole.
    LatitudeTooHigh {
        /// The latitude, °.
        latitude: f64,
    },
    /// Fewer than three different undisturbed positions.
    TooFewPositions {
        /// How many were left.
        positions: usize,
    },
    /// Two positions leave two azimuths, and the half in which it lies was not stated.
    SignUnknown,
    /// No azimuth of the half that was stated fits the dwells.
    NotInHalf,
    /// The measured positions do not determine the azimuth, or leave two of them.
    ArcCannotTell,
    /// The standard deviation is greater than was asked for.
    BudgetNotMet {
        /// The standard deviation, °.
        sigma: f64,
        /// The greatest that is accepted, °.
        required: f64,
        /// What contributes most.
        source: Source,
    },
    /// The standard deviation that was asked for cannot be reached in the time allowed.
    OutOfReach {
        /// The least that can be reached, °.
        sigma: f64,
        /// The one that was asked for, °.
        required: f64,
        /// The time allowed, s.
        seconds: f64,
    },
    /// The survey says nothing of the gyro's noise.
    NoiseUnknown(FitError),
    /// No schedule fits into the time.
    NoSchedule {
        /// The time, s.
        seconds: f64,
    },
    /// The platform is inclined more than the method allows.
    TiltTooGreat {
        /// The tilt, °.
        tilt: f64,
        /// The greatest allowed, °.
        allowed: f64,
    },
    /// The tilt's uncertainty alone exceeds the accepted standard deviation.
    TiltTooUncertain {
        /// What it costs in azimuth, 1σ, °.
        sigma: f64,
        /// The greatest that is accepted, °.
        required: f64,
    },
    /// The residuals are not those of the stated noise.
    ResidualsNotWhite {
        /// Chi-square over its degrees of freedom.
        ratio: f64,
    },
    /// Successive residuals go together: the model misses something that varies slowly.
    ResidualsCorrelated {
        /// Correlation of neighbours.
        correlation: f64,
    },
    /// The rate drifts, and these positions cannot tell the drift from the Earth rate.
    TrendNotSeparable,
    /// The accelerometer does not turn with the stage as its encoder does.
    AccelerometerAstray {
        /// RMS of what no tilt explains, in thousandths of gravity.
        scatter: f64,
    },
    /// The accelerometer does not feel gravity.
    AccelerometerImplausible {
        /// Its reading over gravity, downwards positive as at rest.
        ratio: f64,
    },
    /// The horizontal Earth rate found is not that of the latitude and the gyro's scale.
    EarthRateMismatch {
        /// Found over expected.
        ratio: f64,
        /// 1σ of the ratio.
        sigma: f64,
    },
    /// More dwells were disturbed than may be left out.
    Disturbed {
        /// How many were disturbed.
        disturbed: usize,
        /// Of how many.
        positions: usize,
    },
    /// The stage did not come to stand where it was sent.
    StageNotThere {
        /// Where it was sent, °.
        target: f64,
        /// Where it stood, °.
        actual: f64,
    },
    /// The time for the whole session ran out.
    TimeExhausted,
    /// The paper's criteria need equal steps that are a multiple of 10″.
    StepsUneven,
    /// No entry of the table lies within the given bound.
    NothingAccepted,
    /// Every entry of the table lies within the given bound.
    EverythingAccepted,
    /// A device of the board failed.
    Device {
        /// Which.
        device: Device,
        /// What is wrong with it.
        trouble: Trouble,
    },
}

words! { Refusal:
    Self::LatitudeTooHigh { latitude } =>
        "latitude {}° is beyond ±85°: too little of the Earth rate is horizontal",
        Rounded::<2>(latitude);
    Self::TooFewPositions { positions } =>
        "{} undisturbed position(s): three different ones are needed", positions;
    Self::SignUnknown =>
        "two positions leave two azimuths: add a third, or state whether it points east or west";
    Self::NotInHalf =>
        "no azimuth of the stated half fits: it lies in the other one, or too near the axis between them";
    Self::ArcCannotTell =>
        "the positions cannot tell the azimuth: turn the stage over a longer arc";
    Self::BudgetNotMet { sigma, required, source } =>
        "σ would be {}°, above the accepted {}°; {} contributes most",
        Rounded::<3>(sigma), Rounded::<3>(required), source;
    Self::OutOfReach { sigma, required, seconds } =>
        "σ of {}° is out of reach: {}° is the least that {} s can give",
        Rounded::<3>(required), Rounded::<3>(sigma), Rounded::<0>(seconds);
    Self::NoiseUnknown(why) => "the gyro's noise cannot be learnt: {}", why;
    Self::NoSchedule { seconds } => "no schedule fits into {} s", Rounded::<0>(seconds);
    Self::TiltTooGreat { tilt, allowed } =>
        "the platform is inclined by {}°, more than {}°: level it",
        Rounded::<2>(tilt), Rounded::<1>(allowed);
    Self::TiltTooUncertain { sigma, required } =>
        "the tilt is known too badly: it alone costs {}° of {}°; turn a full circle or calibrate the accelerometer",
        Rounded::<3>(sigma), Rounded::<3>(required);
    Self::ResidualsNotWhite { ratio } =>
        "residuals are not white: {} times the stated noise power", Rounded::<1>(ratio);
    Self::ResidualsCorrelated { correlation } =>
        "residuals are not white: neighbours correlate by {}", Rounded::<2>(correlation);
    Self::TrendNotSeparable =>
        "the rate drifts, and these positions cannot tell it from the Earth rate: turn a full circle";
    Self::AccelerometerImplausible { ratio } =>
        "the accelerometer feels {} of gravity: check its axes, signs and units",
        Rounded::<3>(ratio);
    Self::AccelerometerAstray { scatter } =>
        "the accelerometer strays by {} mg from any tilt: check which way the encoder counts, and the axes",
        Rounded::<1>(scatter);
    Self::EarthRateMismatch { ratio, sigma } =>
        "Earth rate found is {} ± {} of the expected: check latitude and gyro scale",
        Rounded::<3>(ratio), Rounded::<3>(sigma);
    Self::Disturbed { disturbed, positions } =>
        "{} of {} dwells were disturbed: keep the platform still", disturbed, positions;
    Self::StageNotThere { target, actual } =>
        "the stage was sent to {}° but stands at {}°", Rounded::<3>(target), Rounded::<3>(actual);
    Self::TimeExhausted => "the time allowed ran out";
    Self::StepsUneven =>
        "this criterion needs equal steps that are a multiple of 10″, none left out";
    Self::NothingAccepted => "no azimuth of the table lies within the bound";
    Self::EverythingAccepted =>
        "every azimuth of the table lies within the bound: it cannot tell";
    Self::Device { device, trouble } => "{}: {}", device, trouble;
}

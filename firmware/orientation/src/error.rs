//! Why something ended without a result.

use core::fmt;

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

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Noise => "gyro noise",
            Self::Drift => "gyro drift",
            Self::GSensitivity => "g-sensitivity",
            Self::Accelerometer => "tilt from the accelerometer",
            Self::Encoder => "stage encoder",
            Self::Latitude => "latitude",
            Self::Scale => "gyro scale factor",
            Self::Temperature => "temperature slope",
        })
    }
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
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.words() {
            Some(words) => f.write_str(words),
            None => self.with_numbers(f),
        }
    }
}

impl Refusal {
    /// The reasons that carry no number.
    fn words(&self) -> Option<&'static str> {
        Some(match self {
            Self::ArcCannotTell => {
                "the positions cannot tell the azimuth: turn the stage over a longer arc"
            }
            Self::TrendNotSeparable => {
                "the rate drifts, and these positions cannot tell it from the Earth rate: turn a full circle"
            }
            Self::TimeExhausted => "the time allowed ran out",
            Self::StepsUneven => {
                "this criterion needs equal steps that are a multiple of 10″, none left out"
            }
            Self::NothingAccepted => "no azimuth of the table lies within the bound",
            Self::EverythingAccepted => {
                "every azimuth of the table lies within the bound: it cannot tell"
            }
            _ => return None,
        })
    }

    /// The reasons of place, platform and stage; those of the fit follow.
    fn with_numbers(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::LatitudeTooHigh { latitude } => write!(
                f,
                "latitude {latitude:.2}° is beyond ±85°: too little of the Earth rate is horizontal"
            ),
            Self::TiltTooGreat { tilt, allowed } => write!(
                f,
                "the platform is inclined by {tilt:.2}°, more than {allowed:.1}°: level it"
            ),
            Self::AccelerometerImplausible { ratio } => write!(
                f,
                "the accelerometer feels {ratio:.3} of gravity: check its axes, signs and units"
            ),
            Self::StageNotThere { target, actual } => {
                write!(f, "the stage was sent to {target:.3}° but stands at {actual:.3}°")
            }
            Self::Disturbed { disturbed, positions } => write!(
                f,
                "{disturbed} of {positions} dwells were disturbed: keep the platform still"
            ),
            Self::TooFewPositions { positions } => {
                write!(f, "{positions} undisturbed position(s): three different ones are needed")
            }
            _ => self.of_fit(f),
        }
    }

    /// The reasons that the fit gives.
    fn of_fit(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::BudgetNotMet { sigma, required, source } => write!(
                f,
                "σ would be {sigma:.3}°, above the accepted {required:.3}°; {source} contributes most"
            ),
            Self::TiltTooUncertain { sigma, required } => write!(
                f,
                "the tilt is known too badly: it alone costs {sigma:.3}° of {required:.3}°; turn a full circle or calibrate the accelerometer"
            ),
            Self::ResidualsNotWhite { ratio } => {
                write!(f, "residuals are not white: {ratio:.1} times the stated noise power")
            }
            Self::ResidualsCorrelated { correlation } => {
                write!(f, "residuals are not white: neighbours correlate by {correlation:.2}")
            }
            Self::EarthRateMismatch { ratio, sigma } => write!(
                f,
                "Earth rate found is {ratio:.3} ± {sigma:.3} of the expected: check latitude and gyro scale"
            ),
            _ => Ok(()),
        }
    }
}

//! Why something ended without a result.

use crate::align::rotating::turn::Sense;
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
    /// Where a vehicle drove.
    Displacement,
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
    Self::Displacement => "displacement of the vehicle";
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
    AzimuthUnobservable,
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
    /// The heading of the platform stepped between two dwells.
    HeadingStepped {
        /// By how much, °.
        angle: f64,
        /// After which time, s.
        after: f64,
    },
    /// The tilt that the accelerometer shows stepped between two dwells.
    TiltStepped {
        /// By how much, thousandths of gravity.
        change: f64,
        /// After which time, s.
        after: f64,
    },
    /// Dwells at the beginning or the end do not fit the others.
    EndAstray {
        /// How many.
        dwells: usize,
        /// After which time the others end or these begin, s.
        after: f64,
    },
    /// The gyro's rate follows the stage late.
    GyroLags {
        /// By how much, s.
        seconds: f64,
    },
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
    /// All dwells scatter alike, as white noise does, but not as the noise that was stated.
    NoiseNotAsStated {
        /// Their noise power over the stated one.
        ratio: f64,
    },
    /// More dwells were disturbed than may be left out.
    Disturbed {
        /// How many were disturbed.
        disturbed: usize,
        /// Of how many.
        positions: usize,
    },
    /// More turns of a platform were disturbed than may be left out.
    TurnsDisturbed {
        /// How many were disturbed.
        disturbed: u32,
        /// Of how many.
        turns: u32,
    },
    /// Turns of a platform at the beginning or the end of a stretch do not fit the others.
    TurnsAstray {
        /// How many.
        turns: u32,
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
    /// The platform did not turn round often enough in one sense.
    TurnsTooFew {
        /// Which.
        sense: Sense,
        /// Whole even turns in it that count.
        turns: u32,
    },
    /// The platform turned in one sense faster than in the other.
    SpeedsUnequal {
        /// Speed clockwise, °/s.
        clockwise: f64,
        /// Speed counter-clockwise, °/s.
        counter: f64,
    },
    /// The platform does not turn as it is told.
    PlatformStopped {
        /// Speed that it was told, °/s, clockwise positive.
        wanted: f64,
    },
    /// The encoder moved against the platform.
    EncoderSlipped {
        /// By how much, °.
        angle: f64,
    },
    /// The sensitive axis stands too far from the platform's plane.
    Misaligned {
        /// How far, °.
        angle: f64,
        /// The greatest accepted, °.
        allowed: f64,
    },
    /// Nothing is known of how the gyro feels the platform's own rate.
    CouplingUnknown,
    /// What both senses show differs by more than a flat sensor lets them.
    SensesDisagree {
        /// Half of the difference, in σ.
        sigmas: f64,
    },
    /// What two speeds show of a sensor's lag and g-sensitivity does not go together, or not with the uneven turn.
    SpeedsDisagree {
        /// By how much, in σ.
        sigmas: f64,
    },
    /// The tilt that the accelerometer shows changed between the senses or speeds.
    TiltChanged {
        /// By how much, thousandths of gravity.
        change: f64,
    },
    /// The Earth rate's direction drifts from turn to turn.
    DirectionDrifts {
        /// By how much, in σ.
        sigmas: f64,
    },
    /// The sensor lags so far that north cannot be told from south.
    PhaseAmbiguous {
        /// Its phase, °.
        phase: f64,
    },
    /// The integrated g-sensitivity is too large a part of what turns.
    MolecularTooGreat {
        /// That part.
        ratio: f64,
    },
    /// The vehicle stood nowhere.
    NoStop,
    /// The vehicle stood once only, which this method cannot use.
    OneStop {
        /// From when, s.
        from: f64,
        /// To when, s.
        to: f64,
    },
    /// A stop is too short.
    StopTooShort {
        /// Which, from one.
        stop: usize,
        /// Its length, s.
        seconds: f64,
        /// The least, s.
        least: f64,
    },
    /// Between the first stop and the last the Earth turned too little.
    DriveTooShort {
        /// The time between their middles, s.
        seconds: f64,
        /// The least, s.
        least: f64,
    },
    /// The vehicle moved where it was said to stand.
    VehicleMoves {
        /// At which stop, from one.
        stop: usize,
        /// How far its mean rate was from the Earth's, °/h.
        rate: f64,
        /// How far its mean force was from gravity, m/s².
        force: f64,
    },
    /// The vehicle drove on before the alignment was over.
    MovedDuringAlignment,
    /// Gyros and accelerometers disagree about how a body sways.
    AxesDisagree {
        /// How much more the forces change when they are turned by what the gyros show, in power.
        ratio: f64,
    },
    /// Samples were missing, and with them a part of the rotation.
    RotationMissing {
        /// After which time, s.
        at: f64,
        /// For how long, s.
        seconds: f64,
    },
    /// Samples come at another pace than was told.
    PeriodContradicted {
        /// The period that was told, ms.
        told: f64,
        /// That of their times, ms.
        found: f64,
    },
    /// A gyro stood at the limit of its range, and a part of the rotation is lost.
    RotationClipped {
        /// At which time, s.
        at: f64,
    },
    /// Most of the time at rest was disturbed.
    RestDisturbed {
        /// Means that were left out.
        disturbed: u32,
        /// Of how many.
        of: u32,
    },
    /// At most stops the gyros showed another rotation than the Earth's.
    EarthNotFelt {
        /// At how many.
        stops: u32,
        /// Of how many.
        of: u32,
    },
    /// By the forces on the way, half of the drives or more do not end at rest.
    DrivesDisagree {
        /// How many.
        drives: u32,
        /// Of how many.
        of: u32,
    },
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
    Self::AzimuthUnobservable =>
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
    Self::HeadingStepped { angle, after } =>
        "the heading steps by {}° after {} s: the encoder slipped, or the base was turned",
        Rounded::<2>(angle), Rounded::<1>(after);
    Self::TiltStepped { change, after } =>
        "the tilt steps by {} mg after {} s: the encoder slipped, or the platform was moved",
        Rounded::<2>(change), Rounded::<1>(after);
    Self::EndAstray { dwells, after } =>
        "{} dwell(s) at the beginning or the end do not fit the others: after {} s the encoder slipped, the base was turned, or the gyro settled",
        dwells, Rounded::<1>(after);
    Self::GyroLags { seconds } =>
        "the gyro follows the stage {} s late: check its filter, and the times of its column",
        Rounded::<2>(seconds);
    Self::AccelerometerImplausible { ratio } =>
        "the accelerometer feels {} of gravity: check its axes, signs and units",
        Rounded::<3>(ratio);
    Self::AccelerometerAstray { scatter } =>
        "the accelerometer strays by {} mg from any tilt: check which way the encoder counts, the axes, its noise, and \
         whether it warms up",
        Rounded::<1>(scatter);
    Self::EarthRateMismatch { ratio, sigma } =>
        "Earth rate found is {} ± {} of the expected: check latitude and gyro scale",
        Rounded::<3>(ratio), Rounded::<3>(sigma);
    Self::NoiseNotAsStated { ratio } =>
        "all dwells scatter alike, with {} times the stated noise power: check N, and the unit of the rates",
        Rounded::<1>(ratio);
    Self::Disturbed { disturbed, positions } =>
        "{} of {} dwells were disturbed: keep the platform still", disturbed, positions;
    Self::TurnsDisturbed { disturbed, turns } =>
        "{} of {} turns were disturbed: keep the base still, let the sensor settle", disturbed, turns;
    Self::TurnsAstray { turns } =>
        "{} turn(s) at the beginning or the end of a stretch do not fit the others: the encoder slipped, the base was turned, or the gyro settles late",
        turns;
    Self::StageNotThere { target, actual } =>
        "the stage was sent to {}° but stands at {}°", Rounded::<3>(target), Rounded::<3>(actual);
    Self::TimeExhausted => "the time allowed ran out";
    Self::StepsUneven =>
        "this criterion needs equal steps that are a multiple of 10″, none left out";
    Self::NothingAccepted => "no azimuth of the table lies within the bound";
    Self::EverythingAccepted =>
        "every azimuth of the table lies within the bound: it cannot tell";
    Self::TurnsTooFew { sense, turns } =>
        "{} whole even turn(s) {}: two are needed in either sense", turns, sense;
    Self::SpeedsUnequal { clockwise, counter } =>
        "the platform turned by {} °/s clockwise, by {} °/s counter-clockwise: both must be equal",
        Rounded::<3>(clockwise), Rounded::<3>(counter);
    Self::PlatformStopped { wanted } =>
        "the platform does not turn, or not evenly, by {} °/s as it is told", Rounded::<2>(wanted);
    Self::EncoderSlipped { angle } =>
        "the encoder moved by {}° against the platform", Rounded::<2>(angle);
    Self::Misaligned { angle, allowed } =>
        "the sensitive axis stands {}° from the platform's plane, more than {}°: align the sensor mechanically",
        Rounded::<2>(angle), Rounded::<1>(allowed);
    Self::CouplingUnknown =>
        "nobody knows how the sensor feels the platform's own rate: turn it unevenly first";
    Self::SensesDisagree { sigmas } =>
        "clockwise and counter-clockwise disagree by {} σ: this sensor is not flat, or lags",
        Rounded::<1>(sigmas);
    Self::SpeedsDisagree { sigmas } =>
        "the two speeds disagree by {} σ about the sensor's lag and g-sensitivity: the base was turned, or the \
         lag is not that of one pole",
        Rounded::<1>(sigmas);
    Self::TiltChanged { change } =>
        "the tilt changed by {} mg between senses or speeds: the base moved, or the encoder slipped",
        Rounded::<2>(change);
    Self::DirectionDrifts { sigmas } =>
        "the Earth rate's direction drifts from turn to turn by {} σ: the encoder slips, or the base turns",
        Rounded::<1>(sigmas);
    Self::PhaseAmbiguous { phase } =>
        "the sensor lags by {}°: north cannot be told from south", Rounded::<0>(phase);
    Self::MolecularTooGreat { ratio } =>
        "g-sensitivity makes {} of what turns with the platform: level it, or turn faster",
        Rounded::<2>(ratio);
    Self::NoStop => "the vehicle stood nowhere: stop it, engine off, for a minute";
    Self::OneStop { from, to } =>
        "the vehicle stood once only, from {} to {} s: drive and stop again, or align it as one that stands",
        Rounded::<1>(from), Rounded::<1>(to);
    Self::StopTooShort { stop, seconds, least } =>
        "stop {} has {} s of rest: {} are needed", stop, Rounded::<1>(seconds), Rounded::<0>(least);
    Self::DriveTooShort { seconds, least } =>
        "{} s between the stops are too few for the Earth to turn: {} are needed",
        Rounded::<1>(seconds), Rounded::<0>(least);
    Self::VehicleMoves { stop, rate, force } =>
        "the vehicle moves at stop {}: its rate is {} °/h from the Earth's, its force {} m/s² from gravity",
        stop, Rounded::<2>(rate), Rounded::<3>(force);
    Self::MovedDuringAlignment => "the vehicle drove on before it was aligned";
    Self::AxesDisagree { ratio } =>
        "turned by what the gyros show, the forces change {} times more: check axes and signs of both",
        Rounded::<1>(ratio);
    Self::RotationMissing { at, seconds } =>
        "samples are missing after {} s, for {} s: what the vehicle turned meanwhile is lost",
        Rounded::<3>(at), Rounded::<3>(seconds);
    Self::PeriodContradicted { told, found } =>
        "samples come every {} ms, not every {} ms as was told: correct the sample rate or the times",
        Rounded::<3>(found), Rounded::<3>(told);
    Self::RotationClipped { at } =>
        "a gyro stood at the limit of its range at {} s: what the vehicle turned beyond is lost",
        Rounded::<3>(at);
    Self::RestDisturbed { disturbed, of } =>
        "{} of {} means at rest were disturbed: keep the vehicle still", disturbed, of;
    Self::EarthNotFelt { stops, of } =>
        "at {} of {} stops the gyros turn otherwise than the Earth: check latitude, axes, signs and scale",
        stops, of;
    Self::DrivesDisagree { drives, of } =>
        "{} of {} drives do not end at rest by their forces: check accelerometers, gyros and displacement",
        drives, of;
    Self::Device { device, trouble } => "{}: {}", device, trouble;
}

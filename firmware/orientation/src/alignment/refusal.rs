//! Reasons for which an alignment ends without a result, with the sentences that are printed for
//! them. A refusal carries the figures that decided it, so that the operator can see how far it
//! missed and which remedy helps: level the platform, turn a longer arc, keep still, or check a
//! sensor.

use super::budget::Source;
use super::rotating::turn::Sense;
use crate::device::{Device, Trouble};
use crate::noise::fit::FitError;
use crate::words::Rounded;

/// Reason for which no azimuth is given. Angles are in degrees and times in seconds, ready to
/// print.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Refusal {
    /// The latitude is within 5° of a pole: the horizontal Earth rate is below 9 % of the whole.
    LatitudeTooHigh {
        /// The latitude, °.
        latitude: f64,
    },
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
    /// The standard deviation of the azimuth is greater than the required one.
    BudgetNotMet {
        /// Standard deviation that was reached, 1σ, °.
        sigma: f64,
        /// Greatest standard deviation that is accepted, 1σ, °.
        required: f64,
        /// Largest contribution to the error budget.
        source: Source,
    },
    /// The required standard deviation cannot be reached in the time allowed.
    OutOfReach {
        /// Least standard deviation that can be reached, 1σ, °.
        sigma: f64,
        /// Standard deviation that was required, 1σ, °.
        required: f64,
        /// Time allowed for the alignment, s.
        seconds: f64,
    },
    /// The survey (the recording at rest before the alignment) does not determine the gyro's noise.
    NoiseUnknown(FitError),
    /// No sequence of dwells and rotations fits into the time allowed.
    NoSchedule {
        /// Time allowed for the alignment, s.
        seconds: f64,
    },
    /// The platform is inclined more than the method allows.
    TiltTooGreat {
        /// Tilt of the platform that was measured, °.
        tilt: f64,
        /// Greatest tilt that the configuration allows, °.
        allowed: f64,
    },
    /// The uncertainty of the tilt alone exceeds the accepted standard deviation of the azimuth.
    TiltTooUncertain {
        /// Contribution of the tilt's uncertainty to the azimuth, 1σ, °.
        sigma: f64,
        /// Greatest standard deviation of the azimuth that is accepted, 1σ, °.
        required: f64,
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
    /// The gyro drifts, and these positions do not separate the drift from the Earth rate.
    TrendNotSeparable,
    /// The heading of the platform stepped between two dwells.
    HeadingStepped {
        /// Size of the heading step, °.
        angle: f64,
        /// Time at which the heading stepped, s after the first dwell began.
        after: f64,
    },
    /// The tilt measured by the accelerometer stepped between two dwells.
    TiltStepped {
        /// Size of the tilt step, mg.
        change: f64,
        /// Time at which the tilt stepped, s after the first dwell began.
        after: f64,
    },
    /// Dwells at the beginning or at the end are inconsistent with the others.
    EndDisagrees {
        /// Number of inconsistent dwells.
        dwells: usize,
        /// Time that separates the inconsistent dwells from the others, s.
        after: f64,
    },
    /// The measured rate lags behind the stage angle.
    GyroLags {
        /// Lag of the rate, s.
        seconds: f64,
    },
    /// The accelerometer's readings do not turn with the stage angle that the encoder shows.
    AccelerometerDisagrees {
        /// RMS of the readings that no constant tilt explains, mg.
        scatter: f64,
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
    /// More turns of the rotating platform were disturbed than may be excluded.
    TurnsDisturbed {
        /// Number of disturbed turns.
        disturbed: u32,
        /// Number of all turns.
        turns: u32,
    },
    /// Turns of the platform at the beginning or end of a stretch are inconsistent with the others.
    TurnsDisagree {
        /// Number of inconsistent turns.
        turns: u32,
    },
    /// The stage came to rest away from its commanded angle.
    StageNotThere {
        /// Commanded stage angle, °.
        target: f64,
        /// Stage angle at which it came to rest, °.
        actual: f64,
    },
    /// The time allowed for the whole session ran out.
    TimeExhausted,
    /// The criteria of Sokolov 2019 need equal steps that are a multiple of 10″.
    StepsUneven,
    /// No azimuth of the reference table (etalon) meets the given bound.
    NothingAccepted,
    /// Every azimuth of the reference table (etalon) meets the given bound.
    EverythingAccepted,
    /// The platform completed too few whole turns in one sense of rotation.
    TurnsTooFew {
        /// Sense of rotation that lacks turns.
        sense: Sense,
        /// Whole, undisturbed turns at constant rate in that sense.
        turns: u32,
    },
    /// The platform turned faster in one sense than in the other.
    SpeedsUnequal {
        /// Speed of clockwise rotation, °/s.
        clockwise: f64,
        /// Speed of counter-clockwise rotation, °/s.
        counter: f64,
    },
    /// The platform does not turn at the commanded rate.
    PlatformStopped {
        /// Commanded rate, °/s, clockwise positive.
        wanted: f64,
    },
    /// The encoder angle moved relative to the platform.
    EncoderSlipped {
        /// Angle by which the encoder slipped, °.
        angle: f64,
    },
    /// The gyro's sensitive axis is too far from the plane of rotation (axis misalignment).
    Misaligned {
        /// Misalignment found, °.
        angle: f64,
        /// Greatest misalignment accepted, °.
        allowed: f64,
    },
    /// The axis misalignment is unknown: neither configured, nor measured by rate-modulated turns.
    MisalignmentUnknown,
    /// The phasors of both senses of rotation differ by more than a sensor of flat response allows.
    SensesDisagree {
        /// Half of the difference, in standard deviations.
        sigmas: f64,
    },
    /// The lag and g-sensitivity inferred from two speeds contradict each other, or contradict the
    /// lag found from the rate-modulated turns (MET 2018).
    SpeedsDisagree {
        /// Size of the contradiction, in standard deviations.
        sigmas: f64,
    },
    /// The tilt measured by the accelerometer changed between senses of rotation or between speeds.
    TiltChanged {
        /// Change of the tilt, mg.
        change: f64,
    },
    /// The direction of the Earth-rate phasor drifts from turn to turn.
    DirectionDrifts {
        /// Size of the drift, in standard deviations.
        sigmas: f64,
    },
    /// The phase lag of the sensor is so large that an azimuth and its opposite cannot be
    /// distinguished.
    PhaseAmbiguous {
        /// Phase lag of the sensor, °.
        phase: f64,
    },
    /// The integrated g-sensitivity of a molecular-electronic sensor is too large against the Earth
    /// rate (MET 2018, ρ = |G|/(w Ω cos φ)).
    MolecularTooGreat {
        /// Ratio of the integrated g-sensitivity to the rotating signal.
        ratio: f64,
    },
    /// No stop of the vehicle was detected.
    NoStop,
    /// A single stop was detected; the azimuth needs two stops (Szymanowski 2003).
    OneStop {
        /// Beginning of the stop, s.
        from: f64,
        /// End of the stop, s.
        to: f64,
    },
    /// A stop of the vehicle is too short.
    StopTooShort {
        /// Number of the stop, counted from one.
        stop: usize,
        /// Length of the stop, s.
        seconds: f64,
        /// Least length required, s.
        least: f64,
    },
    /// The Earth turned too little between the first and the last stop to show the azimuth.
    DriveTooShort {
        /// Time between the middles of these stops, s.
        seconds: f64,
        /// Least time required, s.
        least: f64,
    },
    /// The vehicle moved during an interval that was configured as a stop.
    VehicleMoves {
        /// Number of the stop, counted from one.
        stop: usize,
        /// Deviation of the mean rate from the Earth's, °/h.
        rate: f64,
        /// Deviation of the mean specific force from gravity, m/s².
        force: f64,
    },
    /// The vehicle drove on before the alignment was complete.
    MovedDuringAlignment,
    /// Gyros and accelerometers disagree on the sway of the body: an axis or a sign is wrong.
    AxesDisagree {
        /// Power of the force changes after rotation by the gyros' angles over their power before
        /// it; below 1 where the axes agree.
        ratio: f64,
    },
    /// Samples are missing, and the rotation during the gap is unknown.
    RotationMissing {
        /// Time at which the gap begins, s.
        at: f64,
        /// Length of the gap, s.
        seconds: f64,
    },
    /// The time stamps contradict the configured sample period.
    PeriodContradicted {
        /// Configured sample period, ms.
        stated: f64,
        /// Sample period found from the time stamps, ms.
        found: f64,
    },
    /// A gyro reached the limit of its range, and the rotation beyond it is unknown.
    RotationClipped {
        /// Time at which the gyro was saturated, s.
        at: f64,
    },
    /// Most of the time at rest was disturbed.
    RestDisturbed {
        /// Number of short means that were excluded.
        disturbed: u32,
        /// Number of all short means.
        of: u32,
    },
    /// At most stops the gyros measured another rotation than the Earth's.
    EarthNotFelt {
        /// Number of stops with another rotation.
        stops: u32,
        /// Number of all stops.
        of: u32,
    },
    /// Velocity integrated from the forces does not return to zero at the end of half of the drives
    /// or more.
    DrivesDisagree {
        /// Number of drives that do not end at rest.
        drives: u32,
        /// Number of all drives.
        of: u32,
    },
    /// A device of the board failed permanently.
    Device {
        /// Device that failed.
        device: Device,
        /// Failure of that device.
        trouble: Trouble,
    },
}

impl core::error::Error for Refusal {}

crate::words! { Refusal:
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
        "the positions do not show the azimuth: turn the stage over a longer arc";
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
        "the rate drifts, and these positions do not separate it from the Earth rate: turn a full circle";
    Self::HeadingStepped { angle, after } =>
        "the heading steps by {}° after {} s: the encoder slipped, or the base was turned",
        Rounded::<2>(angle), Rounded::<1>(after);
    Self::TiltStepped { change, after } =>
        "the tilt steps by {} mg after {} s: the encoder slipped, or the platform was moved",
        Rounded::<2>(change), Rounded::<1>(after);
    Self::EndDisagrees { dwells, after } =>
        "{} dwell(s) at the beginning or the end do not fit the others: after {} s the encoder slipped, the base was turned, or the gyro settled",
        dwells, Rounded::<1>(after);
    Self::GyroLags { seconds } =>
        "the gyro follows the stage {} s late: check its filter, and the times of its column",
        Rounded::<2>(seconds);
    Self::AccelerometerImplausible { ratio } =>
        "the accelerometer feels {} of gravity: check its axes, signs and units",
        Rounded::<3>(ratio);
    Self::AccelerometerDisagrees { scatter } =>
        "the accelerometer is off by {} mg from any tilt: check which way the encoder counts, the axes, its noise, and \
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
    Self::SwayUnmeasured =>
        "the dwells were disturbed, and the coarse IMU is missing that would measure the base's sway: check its wiring";
    Self::TurnsDisturbed { disturbed, turns } =>
        "{} of {} turns were disturbed: keep the base still, let the sensor settle", disturbed, turns;
    Self::TurnsDisagree { turns } =>
        "{} turn(s) at the beginning or the end of a stretch do not fit the others: the encoder slipped, the base was turned, or the gyro settles late",
        turns;
    Self::StageNotThere { target, actual } =>
        "the stage was sent to {}° but stands at {}°", Rounded::<3>(target), Rounded::<3>(actual);
    Self::TimeExhausted => "the time allowed ran out";
    Self::StepsUneven =>
        "this criterion needs equal steps that are a multiple of 10″, none left out";
    Self::NothingAccepted => "no azimuth of the table lies within the bound";
    Self::EverythingAccepted =>
        "every azimuth of the table lies within the bound: it excludes none";
    Self::TurnsTooFew { sense, turns } =>
        "{} whole even turn(s) {}: two are needed in either sense", turns, sense;
    Self::SpeedsUnequal { clockwise, counter } =>
        "the platform turned by {} °/s clockwise, by {} °/s counter-clockwise: both must be equal",
        Rounded::<3>(clockwise), Rounded::<3>(counter);
    Self::PlatformStopped { wanted } =>
        "the platform does not turn, or not evenly, by {} °/s as stated", Rounded::<2>(wanted);
    Self::EncoderSlipped { angle } =>
        "the encoder moved by {}° against the platform", Rounded::<2>(angle);
    Self::Misaligned { angle, allowed } =>
        "the sensitive axis stands {}° from the platform's plane, more than {}°: align the sensor mechanically",
        Rounded::<2>(angle), Rounded::<1>(allowed);
    Self::MisalignmentUnknown =>
        "the axis misalignment of the sensor is not known: modulate the platform's rate first";
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
        "the sensor lags by {}°: north looks like south", Rounded::<0>(phase);
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
    Self::PeriodContradicted { stated, found } =>
        "samples come every {} ms, not every {} ms as stated: correct the sample rate or the times",
        Rounded::<3>(found), Rounded::<3>(stated);
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

//! Refusals of an alignment by continuous rotation, with the sentences that are printed for them.

use super::turn::Sense;
use crate::units::{Degrees, DegreesPerSecond, MilliG};
use crate::words::Rounded;

/// Reason for which an alignment by continuous rotation gives no azimuth, beside those that several methods have.
/// Quantities are in the units of its sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
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
    /// The platform completed too few whole turns in one sense of rotation.
    TurnsTooFew {
        /// Sense of rotation that lacks turns.
        sense: Sense,
        /// Whole, undisturbed turns at constant rate in that sense.
        turns: u32,
    },
    /// The platform turned faster in one sense than in the other.
    SpeedsUnequal {
        /// Speed of clockwise rotation.
        clockwise: DegreesPerSecond,
        /// Speed of counter-clockwise rotation.
        counter: DegreesPerSecond,
    },
    /// The platform does not turn at the commanded rate.
    PlatformStopped {
        /// Commanded rate, clockwise positive.
        wanted: DegreesPerSecond,
    },
    /// The encoder angle moved relative to the platform.
    EncoderSlipped {
        /// Angle by which the encoder slipped.
        angle: Degrees,
    },
    /// The gyro's sensitive axis is too far from the plane of rotation (axis misalignment).
    Misaligned {
        /// Misalignment found.
        angle: Degrees,
        /// Greatest misalignment accepted.
        allowed: Degrees,
    },
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
        /// Change of the tilt.
        change: MilliG,
    },
    /// The direction of the Earth-rate phasor drifts from turn to turn.
    DirectionDrifts {
        /// Size of the drift, in standard deviations.
        sigmas: f64,
    },
    /// The phase lag of the sensor is so large that an azimuth and its opposite cannot be
    /// distinguished.
    PhaseAmbiguous {
        /// Phase lag of the sensor.
        phase: Degrees,
    },
    /// The integrated g-sensitivity of a molecular-electronic sensor is too large against the Earth
    /// rate (MET 2018, ρ = |G|/(w Ω cos φ)).
    MolecularTooGreat {
        /// Ratio of the integrated g-sensitivity to the rotating signal.
        ratio: f64,
    },
}

crate::words! { Refusal:
    reason @ Self::TurnsDisturbed { disturbed, turns } =>
        "{} of {} turns were disturbed{}", disturbed, turns,
        reason.remedy();
    Self::TurnsDisagree { turns } =>
        "{} turn(s) at the beginning or the end of a stretch do not fit the others: the encoder slipped, the base was turned, or the gyro settles late",
        turns;
    Self::TurnsTooFew { sense, turns } =>
        "{} whole even turn(s) {}: two are needed in either sense", turns, sense;
    Self::SpeedsUnequal { clockwise, counter } =>
        "the platform turned by {} °/s clockwise, by {} °/s counter-clockwise: both must be equal",
        Rounded::<3>(clockwise.0), Rounded::<3>(counter.0);
    Self::PlatformStopped { wanted } =>
        "the platform does not turn, or not evenly, by {} °/s as stated", Rounded::<2>(wanted.0);
    Self::EncoderSlipped { angle } =>
        "the encoder moved by {}° against the platform", Rounded::<2>(angle.0);
    Self::Misaligned { angle, allowed } =>
        "the sensitive axis stands {}° from the platform's plane, more than {}°: align the sensor mechanically",
        Rounded::<2>(angle.0), Rounded::<1>(allowed.0);
    Self::SensesDisagree { sigmas } =>
        "clockwise and counter-clockwise disagree by {} σ: this sensor is not flat, or lags",
        Rounded::<1>(sigmas);
    Self::SpeedsDisagree { sigmas } =>
        "the two speeds disagree by {} σ about the sensor's lag and g-sensitivity: the base was turned, or the \
         lag is not that of one pole",
        Rounded::<1>(sigmas);
    Self::TiltChanged { change } =>
        "the tilt changed by {} mg between senses or speeds: the base moved, or the encoder slipped",
        Rounded::<2>(change.0);
    Self::DirectionDrifts { sigmas } =>
        "the Earth rate's direction drifts from turn to turn by {} σ: the encoder slips, or the base turns",
        Rounded::<1>(sigmas);
    Self::PhaseAmbiguous { phase } =>
        "the sensor lags by {}°: north looks like south", Rounded::<0>(phase.0);
    Self::MolecularTooGreat { ratio } =>
        "g-sensitivity makes {} of what turns with the platform: level it, or turn faster",
        Rounded::<2>(ratio);
}

impl Refusal {
    /// Usual remedy, with which the sentence ends; empty where it names none.
    pub(crate) const fn remedy(&self) -> &'static str {
        match self {
            Self::TurnsDisturbed { .. } => ": keep the base still, let the sensor settle",
            _ => "",
        }
    }
}

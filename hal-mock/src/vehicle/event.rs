//! Doors and passengers that shake a vehicle, and falls.

use super::Pose;
use super::smooth::Smooth;

/// Something that happens to the vehicle, standing or not.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A door falls shut: body and force ring and die away.
    Slam {
        /// When the door falls shut, s from the start.
        at_s: f64,
        /// Frequency of the ringing, Hz, > 0.
        frequency_hz: f64,
        /// Time constant of the ringing, s, > 0.
        decay_s: f64,
        /// Amplitude of azimuth, pitch and roll, °, before it dies away.
        angles_deg: [f64; 3],
        /// Amplitude of the specific force forward, right, down, m/s², before it dies away.
        force_m_s2: [f64; 3],
    },
    /// A person gets in or out: the vehicle takes another level for good.
    Boarding {
        /// When the vehicle begins to sink, s from the start.
        at_s: f64,
        /// How long it takes, s.
        seconds: f64,
        /// Change of pitch, °.
        pitch_deg: f64,
        /// Change of roll, °.
        roll_deg: f64,
    },
    /// The vehicle falls: nothing is felt but what its slope leaves.
    Fall {
        /// When the fall begins, s from the start.
        at_s: f64,
        /// How long it takes, s.
        seconds: f64,
    },
}

impl Event {
    /// What a fall does to the force, m/s²: of a body that is nearly level.
    const WEIGHTLESS: [f64; 3] = [0.0, 0.0, 9.806_65];

    /// A car door: 8 Hz for some tenths of a second, a hundredth of a degree, a tenth of a m/s².
    pub const fn door_slam(at_s: f64) -> Self {
        Self::Slam {
            at_s,
            frequency_hz: 8.0,
            decay_s: 0.12,
            angles_deg: [0.004, 0.008, 0.02],
            force_m_s2: [0.1, 0.3, 0.15],
        }
    }

    /// A person gets in on the right within 2 s.
    pub const fn person_boards(at_s: f64) -> Self {
        Self::Boarding { at_s, seconds: 2.0, pitch_deg: -0.02, roll_deg: 0.06 }
    }

    /// Adds what it does at a time in s.
    pub(super) fn add(&self, pose: &mut Pose, time_s: f64) {
        match *self {
            Self::Slam { at_s, frequency_hz, decay_s, angles_deg, force_m_s2 } => {
                let ringing = Smooth::bounce(frequency_hz, decay_s, time_s - at_s);
                if ringing == Smooth::default() {
                    return;
                }
                pose.turn(angles_deg.map(|angle| ringing.times(angle.to_radians())));
                for (sum, force) in pose.force_m_s2.iter_mut().zip(force_m_s2) {
                    *sum += force * ringing.value;
                }
            }
            Self::Boarding { at_s, seconds, pitch_deg, roll_deg } => {
                let sunk = Smooth::blend(0.0, 1.0, seconds, time_s - at_s);
                let [pitch, roll] =
                    [pitch_deg, roll_deg].map(|angle| sunk.times(angle.to_radians()));
                pose.turn([Smooth::default(), pitch, roll]);
            }
            Self::Fall { at_s, seconds } => {
                if (at_s..at_s + seconds).contains(&time_s) {
                    pose.force_m_s2 =
                        [0, 1, 2].map(|axis: usize| pose.force_m_s2[axis] + Self::WEIGHTLESS[axis]);
                }
            }
        }
    }
}

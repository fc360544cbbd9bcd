//! What a vehicle does one after the other: it stands, or it drives.

use super::Pose;
use super::smooth::Smooth;
use crate::plant::sway::SwayConfiguration;

/// Longest time in which the speed changes, s: a driver with a sensitive load.
const SPEEDING_S: f64 = 12.0;

/// Longest time in which sway, weaving and hills come and go, s.
const FADING_S: f64 = 5.0;

/// Rocking of a suspension after the brakes let go: Hz, and its time constant, s.
const SUSPENSION: (f64, f64) = (1.3, 0.8);

/// Time in which a vehicle at rest takes another level, s.
const LEVELLING_S: f64 = 2.0;

/// Vibration along forward, right, down, Hz: orders of an engine.
const ENGINE_HZ: [f64; 3] = [17.0, 23.0, 31.0];

/// The vehicle stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stop {
    /// Duration, s.
    pub seconds: f64,
    /// Pitch of the ground, °, nose up positive.
    pub pitch_deg: f64,
    /// Roll of the ground, °, right side down positive.
    pub roll_deg: f64,
    /// Sway on the wheels.
    pub sway: SwayConfiguration,
    /// How far pitch and roll rock after the arrival, °: 1.3 Hz, dying away within seconds.
    pub settling_deg: [f64; 2],
}

/// The vehicle drives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Duration, s.
    pub seconds: f64,
    /// Change of heading from its beginning to its end, °, to the right positive.
    pub heading_change_deg: f64,
    /// Time that this turn takes, s, in the middle of the drive; zero for the whole drive.
    pub turn_s: f64,
    /// Speed between speeding up and slowing down, m/s.
    pub speed_m_s: f64,
    /// Bends of the road: amplitude of the heading, °.
    pub winding_deg: f64,
    /// Period of the bends, s, > 0 where there are any.
    pub winding_s: f64,
    /// Hills: amplitude of the slope, °.
    pub hills_deg: f64,
    /// Period of the slopes, s, > 0 where there are any.
    pub hills_s: f64,
    /// How the body moves on its wheels.
    pub weaving: SwayConfiguration,
    /// Amplitude of the engine's vibration along each axis, m/s².
    pub vibration_m_s2: f64,
}

/// A part of a vehicle's day. A drive that follows a drive goes on without a halt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg {
    /// The vehicle stands.
    Stop(Stop),
    /// The vehicle drives.
    Drive(Drive),
}

impl Leg {
    /// Duration, s.
    #[must_use]
    pub const fn seconds(&self) -> f64 {
        match self {
            Self::Stop(stop) => stop.seconds,
            Self::Drive(drive) => drive.seconds,
        }
    }

    /// By how much the leg changes the heading, rad, to the right positive.
    pub(super) fn heading_change_rad(&self) -> f64 {
        match self {
            Self::Stop(_) => 0.0,
            Self::Drive(drive) => drive.heading_change_deg.to_radians(),
        }
    }

    /// Speed at which it is left where it does not end at rest, m/s.
    fn speed_m_s(&self) -> f64 {
        match self {
            Self::Stop(_) => 0.0,
            Self::Drive(drive) => drive.speed_m_s,
        }
    }

    /// Pitch and roll of the ground at its end, rad: a drive ends where the next stop stands.
    fn ground_rad(&self, next: Option<&Self>) -> [f64; 2] {
        match (self, next) {
            (Self::Stop(stop), _) | (Self::Drive(_), Some(Self::Stop(stop))) => {
                [stop.pitch_deg, stop.roll_deg].map(f64::to_radians)
            }
            (Self::Drive(_), _) => [0.0; 2],
        }
    }
}

/// A leg between its neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbours<'a> {
    pub(super) before: Option<&'a Leg>,
    pub(super) leg: &'a Leg,
    pub(super) after: Option<&'a Leg>,
}

impl Neighbours<'_> {
    /// The motion `elapsed_s` seconds into the leg, which began with the heading `heading_rad`; `time_s`
    /// counts from the start of the day.
    pub(super) fn pose(&self, heading_rad: f64, elapsed_s: f64, time_s: f64) -> Pose {
        let mut pose = Pose::default();
        match self.leg {
            Leg::Stop(stop) => self.stand(stop, &mut pose, elapsed_s, time_s),
            Leg::Drive(drive) => self.drive(drive, &mut pose, elapsed_s, time_s),
        }
        pose.heading.value += heading_rad;
        pose.azimuth = pose.azimuth + pose.heading;
        pose
    }

    /// Sets the pose of a vehicle at rest.
    fn stand(&self, stop: &Stop, pose: &mut Pose, elapsed_s: f64, time_s: f64) {
        [pose.pitch, pose.roll] = self.ground(LEVELLING_S, elapsed_s);
        pose.sway(&stop.sway, self.presence(elapsed_s), time_s);
        if self.before.is_some() {
            let (frequency_hz, decay_s) = SUSPENSION;
            let rocking = Smooth::bounce(frequency_hz, decay_s, elapsed_s);
            let [pitch, roll] = stop.settling_deg.map(f64::to_radians);
            pose.pitch = pose.pitch + rocking.times(pitch);
            pose.roll = pose.roll + rocking.times(roll);
        }
    }

    /// Sets the pose of a vehicle on its way.
    fn drive(&self, drive: &Drive, pose: &mut Pose, elapsed_s: f64, time_s: f64) {
        let presence = self.presence(elapsed_s);
        pose.speed = self.speed(drive, elapsed_s);
        pose.heading = turn(drive, elapsed_s) + bends(drive, elapsed_s) * presence;
        let hills = drive.hills_deg.to_radians();
        pose.slope = Smooth::wave(hills, 1.0 / drive.hills_s, 0.0, elapsed_s) * presence;
        [pose.pitch, pose.roll] = self.ground(drive.seconds, elapsed_s);
        pose.pitch = pose.pitch + pose.slope;
        pose.sway(&drive.weaving, presence, time_s);
        let vibration = drive.vibration_m_s2 * presence.value;
        pose.force_m_s2 = ENGINE_HZ.map(|hertz| Smooth::wave(vibration, hertz, 0.0, time_s).value);
    }

    /// Speed along the road, m/s.
    fn speed(&self, drive: &Drive, elapsed_s: f64) -> Smooth {
        let (own, seconds) = (drive.speed_m_s, libm::fmin(SPEEDING_S, drive.seconds / 3.0));
        let from = self.before.map_or(0.0, Leg::speed_m_s);
        let gained = Smooth::blend(from, own, seconds, elapsed_s);
        if matches!(self.after, Some(Leg::Drive(_))) {
            return gained;
        }
        gained + Smooth::blend(0.0, -own, seconds, elapsed_s - (drive.seconds - seconds))
    }

    /// Pitch and roll of the ground, rad, which the vehicle reaches `seconds` after the beginning of the
    /// leg.
    fn ground(&self, seconds: f64, elapsed_s: f64) -> [Smooth; 2] {
        let to = self.leg.ground_rad(self.after);
        let from = match (self.before, self.leg) {
            (Some(before), leg) => before.ground_rad(Some(leg)),
            (None, Leg::Stop(_)) => to,
            (None, Leg::Drive(_)) => [0.0; 2],
        };
        [0, 1].map(|axis| Smooth::blend(from[axis], to[axis], seconds, elapsed_s))
    }

    /// How much of what belongs to this leg alone is there, 0 to 1: all of it at the beginning and at
    /// the end of the day.
    fn presence(&self, elapsed_s: f64) -> Smooth {
        let seconds = self.leg.seconds();
        let fading_s = libm::fmin(FADING_S, seconds / 3.0);
        let whole = Smooth { value: 1.0, rate: 0.0 };
        let coming = self.before.map_or(whole, |_| Smooth::blend(0.0, 1.0, fading_s, elapsed_s));
        let end = |_: &Leg| Smooth::blend(1.0, 0.0, fading_s, elapsed_s - (seconds - fading_s));
        coming * self.after.map_or(whole, end)
    }
}

/// The turn in the middle of a drive, rad.
fn turn(drive: &Drive, elapsed_s: f64) -> Smooth {
    let seconds = if drive.turn_s > 0.0 { drive.turn_s } else { drive.seconds };
    let begun_s = 0.5 * (drive.seconds - seconds);
    Smooth::blend(0.0, drive.heading_change_deg.to_radians(), seconds, elapsed_s - begun_s)
}

/// The bends of the road, rad.
fn bends(drive: &Drive, elapsed_s: f64) -> Smooth {
    Smooth::wave(drive.winding_deg.to_radians(), 1.0 / drive.winding_s, 0.0, elapsed_s)
}

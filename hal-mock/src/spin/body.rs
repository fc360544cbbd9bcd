//! The body in flight: how it turns, and what is felt on it.

use super::SpinConfiguration;
use super::profile::Profile;
use super::trajectory::{Flight, Forces};

/// What ideal sensors on the body would show.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Felt {
    /// Rates about body x, y and z, rad/s.
    pub(super) rate_rad_s: [f64; 3],
    /// Specific force at the accelerometers along y and z, m/s².
    pub(super) force_m_s2: [f64; 2],
}

impl Felt {
    /// Sum of these motions and `part` of others.
    fn plus(&self, part: f64, other: &Self) -> Self {
        Self {
            rate_rad_s: [0, 1, 2].map(|i: usize| self.rate_rad_s[i] + part * other.rate_rad_s[i]),
            force_m_s2: [0, 1].map(|i: usize| self.force_m_s2[i] + part * other.force_m_s2[i]),
        }
    }
}

/// The body at work.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body<'a> {
    /// What acts on the body.
    pub(super) forces: Forces<'a>,
    /// Rate of the roll over the time, rad/s.
    pub(super) spin: Profile<'a>,
    /// Roll at the start, rad.
    first_roll_rad: f64,
    /// Distances of the accelerometers along y and z from the axis, m.
    radius_m: [f64; 2],
    /// Where the body is, as of the latest time.
    pub(super) flight: Flight,
    /// The latest time, s.
    pub(super) time_s: f64,
}

/// Places and weights by which Gauss and Legendre integrate over [−½, ½], exact to the fifth power: over
/// a sample in which the body turns by 5° to 10⁻¹¹.
const GAUSS: [(f64, f64); 3] = {
    /// √(3/5)/2.
    const PLACE: f64 = 0.387_298_334_620_741_7;
    [(-PLACE, 5.0 / 18.0), (0.0, 8.0 / 18.0), (PLACE, 5.0 / 18.0)]
};

impl<'a> Body<'a> {
    /// A body at the start of its flight.
    pub(super) fn new(configuration: &SpinConfiguration<'a>) -> Self {
        let c = configuration;
        let flight = Flight {
            speed_m_s: c.speed_m_s,
            pitch_rad: c.pitch_deg.to_radians(),
            course_rad: c.course_deg.to_radians(),
            position_m: [0.0; 3],
        };
        let (spin, first_roll_rad) = (c.spin_rad_s, c.roll_rad);
        let radius_m = c.radius_m;
        Self { forces: c.forces, spin, first_roll_rad, radius_m, flight, time_s: 0.0 }
    }

    /// Flies on to a time in s; not back.
    pub(super) fn advance(&mut self, time_s: f64) {
        if time_s > self.time_s {
            self.flight = self.flight.flown(&self.forces, self.time_s, time_s);
            self.time_s = time_s;
        }
    }

    /// Roll at a time in s, rad, whole turns counted.
    pub(super) fn roll_rad(&self, time_s: f64) -> f64 {
        self.first_roll_rad + self.spin.integral(time_s)
    }

    /// What is felt at a time in s near the latest one: pitch and course change little meanwhile.
    pub(super) fn felt(&self, time_s: f64) -> Felt {
        let change = self.flight.derivative(&self.forces, time_s);
        let (sine, cosine) = libm::sincos(self.flight.pitch_rad);
        let (across, up) = libm::sincos(self.roll_rad(time_s));
        let Forces { lift_m_s2, side_m_s2, .. } = &self.forces;
        let (lift, side) = (lift_m_s2.value(time_s), side_m_s2.value(time_s));
        let about_x = self.spin.value(time_s) - change.course_rad * sine;
        // The rates of a level body: about the right wing, and about up.
        let (pitching, turning) = (change.pitch_rad, -change.course_rad * cosine);
        let [radius_y, radius_z] = self.radius_m;
        let square = about_x * about_x;
        Felt {
            rate_rad_s: [
                about_x,
                up * turning + across * pitching,
                up * pitching - across * turning,
            ],
            force_m_s2: [
                up * lift + across * side - radius_y * square,
                up * side - across * lift - radius_z * square,
            ],
        }
    }

    /// Means of what is felt between two times in s near the latest one.
    pub(super) fn means(&self, from_s: f64, to_s: f64) -> Felt {
        let (middle_s, span_s) = (0.5 * (from_s + to_s), to_s - from_s);
        let at = |place: f64| self.felt(middle_s + place * span_s);
        let sum = |sum: Felt, (place, weight): &(f64, f64)| sum.plus(*weight, &at(*place));
        GAUSS.iter().fold(Felt::default(), sum)
    }
}

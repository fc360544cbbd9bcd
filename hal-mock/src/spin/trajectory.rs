//! The flight of the body: the equations of M. Nekrasova and V. Uspenskiy (2017), section 5.
//!
//! ```text
//!  V̇ = −(k/m) V − g sin θ      ẋ = V cos θ cos ψ   north
//!  θ̇ = (q − g cos θ)/V          ẏ = V sin θ         up
//!  ψ̇ = s/(V cos θ)              ż = V cos θ sin ψ   east
//! ```
//!
//! Where the paper is unclear: it sets the transverse overload `n_y` to zero, which leaves no lift and
//! with it nothing that rotates in the accelerometers, and turns what there is of it with the body (as
//! cos γ and sin γ), while its equations (2) and (3) need a lift that stays upright. Here the lift q does:
//! it lies in the vertical plane through the velocity, across it, and a force s, zero unless stated, lies
//! to the right of that plane. The paper's roll is −Ωt; here it has any profile, right-handed about x.
//! The Earth neither turns nor is round.

use super::profile::Profile;

/// Longest step of the integration, s: of order four, it is exact to 10⁻¹⁰ for any flight of minutes.
const STEP_S: f64 = 1e-3;

/// What acts on the body beside gravity, over the time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces<'a> {
    /// Gravity, m/s².
    pub gravity_m_s2: f64,
    /// k/m, what the air takes of the speed, 1/s.
    pub drag_per_s: f64,
    /// The lift q per mass, m/s²: across the velocity, upwards, in the vertical plane.
    pub lift_m_s2: Profile<'a>,
    /// A force per mass to the right of that plane, m/s².
    pub side_m_s2: Profile<'a>,
}

/// Where the body is, and where it goes; its long axis lies along the velocity.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flight {
    /// Speed V, m/s, > 0.
    pub speed_m_s: f64,
    /// Pitch θ, rad, up positive, within ±π/2.
    pub pitch_rad: f64,
    /// Course ψ, rad, clockwise from north.
    pub course_rad: f64,
    /// Position from the start, m: north, up, east.
    pub position_m: [f64; 3],
}

impl Flight {
    /// How fast everything in it changes at a time in s.
    pub fn derivative(&self, forces: &Forces, time_s: f64) -> Self {
        let Self { speed_m_s: speed, pitch_rad, course_rad, .. } = *self;
        let [(sine, cosine), (east, north)] = [pitch_rad, course_rad].map(libm::sincos);
        let (lift, side) = (forces.lift_m_s2.value(time_s), forces.side_m_s2.value(time_s));
        let gravity = forces.gravity_m_s2;
        Self {
            speed_m_s: -forces.drag_per_s * speed - gravity * sine,
            pitch_rad: (lift - gravity * cosine) / speed,
            course_rad: side / (speed * cosine),
            position_m: [speed * cosine * north, speed * sine, speed * cosine * east],
        }
    }

    /// This flight after `seconds` at a derivative.
    fn after(&self, seconds: f64, derivative: &Self) -> Self {
        let [from, change] = [&self.position_m, &derivative.position_m];
        Self {
            speed_m_s: self.speed_m_s + seconds * derivative.speed_m_s,
            pitch_rad: self.pitch_rad + seconds * derivative.pitch_rad,
            course_rad: self.course_rad + seconds * derivative.course_rad,
            position_m: [0, 1, 2].map(|axis: usize| from[axis] + seconds * change[axis]),
        }
    }

    /// Flies on from a time to a later one, s, by the classical method of Runge and Kutta.
    pub fn flown(mut self, forces: &Forces, from_s: f64, to_s: f64) -> Self {
        let steps = libm::ceil((to_s - from_s) / STEP_S);
        let step_s = (to_s - from_s) / steps;
        for index in 0..steps as u64 {
            self = self.step(forces, from_s + index as f64 * step_s, step_s);
        }
        self
    }

    /// One step of `step_s` from a time in s.
    fn step(&self, forces: &Forces, time_s: f64, step_s: f64) -> Self {
        let half_s = 0.5 * step_s;
        let first = self.derivative(forces, time_s);
        let second = self.after(half_s, &first).derivative(forces, time_s + half_s);
        let third = self.after(half_s, &second).derivative(forces, time_s + half_s);
        let fourth = self.after(step_s, &third).derivative(forces, time_s + step_s);
        let parts = [(6.0, first), (3.0, second), (3.0, third), (6.0, fourth)];
        parts.iter().fold(*self, |flight, (part, slope)| flight.after(step_s / part, slope))
    }
}

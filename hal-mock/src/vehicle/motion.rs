//! The vehicle on the rotating ellipsoid: what gyros and accelerometers fixed to it feel, integrated.
//!
//! Angular rate: that of the body over the ground, Earth rate and transport rate. Specific force: what
//! speeds up and steers, Coriolis force, gravity, and what a sensor off the axes of the
//! sway feels. Position follows from the same velocity, so that up-vectors, transport rate and
//! displacement agree. All by full rotation matrices (P. D. Groves, "Principles of GNSS, Inertial, and
//! Multisensor Integrated Navigation Systems", 2nd ed., §5.4: the equations, here run backwards).
//!
//! Height does not enter gravity or radii: 100 m of it change a transport rate by 2·10⁻⁵ of itself.

use super::leg::Leg;
use super::place::{Place, Position};
use super::route::Route;
use super::{Event, Pose};
use crate::earth::{Attitude, InertialInput, Matrix, apply_transposed, cross};

/// Longest panel of the quadrature, s: a tenth of a period of 10 Hz.
const PANEL_S: f64 = 0.01;

/// Longest panel that takes two points, s: where three add nothing to f64's digits but a third of the
/// work of an emulated board.
const SHORT_PANEL_S: f64 = 0.005;

/// Nodes in [0, 1] and weights of Gauss and Legendre's quadrature of two points: exact to t³.
const TWO: [(f64, f64); 2] = [(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)];

/// Nodes in [0, 1] and weights of Gauss and Legendre's quadrature of three points: exact to t⁵.
const THREE: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How the vehicle moves at one moment, and what sensors fixed to it feel of that.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Felt {
    /// The pose that it belongs to.
    pose: Pose,
    /// Inertial angular rate about forward, right, down, rad/s.
    rate_rad_s: [f64; 3],
    /// Specific force along forward, right, down, m/s².
    force_m_s2: [f64; 3],
    /// Rates of latitude and longitude.
    travel_rad_s: [f64; 2],
}

/// Integrals since the start: what an ideal strapdown unit has summed up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Integrals {
    /// Integral of the inertial angular rate about forward, right, down, rad.
    pub turned_rad: [f64; 3],
    /// Integral of the specific force along forward, right, down, m/s.
    pub pushed_m_s: [f64; 3],
}

impl Integrals {
    /// Mean rate and force over the `seconds` since the integrals were `before`; zero seconds have no
    /// mean, and give zero.
    pub(super) fn means(&self, before: &Self, seconds: f64) -> InertialInput {
        let mean = |to: [f64; 3], from: [f64; 3]| {
            [0, 1, 2].map(|axis: usize| (to[axis] - from[axis]) / libm::fmax(seconds, 1e-9))
        };
        InertialInput {
            rate_rad_s: mean(self.turned_rad, before.turned_rad),
            force_m_s2: mean(self.pushed_m_s, before.pushed_m_s),
        }
    }
}

/// A moving vehicle.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
pub struct Motion<'a> {
    /// What the vehicle does.
    route: Route<'a>,
    /// From the point of sway to the sensors, m, forward, right, down.
    lever_m: [f64; 3],
    /// The latest moment, s from the start.
    pub time_s: f64,
    /// Position at the start.
    start: Position,
    /// Position at the latest moment.
    pub position: Position,
    /// What an ideal strapdown unit has summed up.
    pub integrals: Integrals,
    /// Earth in the middle of the latest panel: a vehicle goes less than a metre in one.
    place: Place,
    /// What was felt at the latest node.
    felt: Felt,
    /// Angular rate at the latest moment, rad/s; kept for a lever only.
    rate_rad_s: [f64; 3],
}

impl<'a> Motion<'a> {
    /// A vehicle at the beginning of its legs: latitude and azimuth in rad, and where the sensors are
    /// from the point about which it sways, m forward, right, down.
    pub fn new(
        legs: &'a [Leg],
        events: &'a [Event],
        latitude_rad: f64,
        azimuth_rad: f64,
        lever_m: [f64; 3],
    ) -> Self {
        let start = Position { latitude_rad, longitude_rad: 0.0 };
        let (mut route, place) = (Route::new(legs, events, azimuth_rad), Place::at(latitude_rad));
        let felt = felt_at(route.pose(0.0), &place, lever_m);
        Self {
            route,
            lever_m,
            time_s: 0.0,
            start,
            position: start,
            integrals: Integrals::default(),
            place,
            felt,
            rate_rad_s: felt.rate_rad_s,
        }
    }

    /// Moves on to a time in s from the start; an earlier one changes nothing.
    pub fn advance(&mut self, time_s: f64) {
        let (from_s, seconds) = (self.time_s, time_s - self.time_s);
        let panels = libm::ceil(seconds / PANEL_S - 1e-6);
        for panel in 1..=panels as u32 {
            // The last panel ends at the time asked for, whatever was rounded.
            let left = panels - f64::from(panel);
            let end_s = from_s + seconds / panels * f64::from(panel);
            self.panel(if left == 0.0 { time_s } else { end_s });
        }
    }

    /// North and east from the start, m.
    pub(crate) fn displacement_m(&self) -> [f64; 2] {
        self.position.displacement_m(&self.start)
    }

    /// Attitude at the latest moment; the azimuth is not wrapped.
    pub fn attitude(&self) -> Attitude {
        { self.route }.pose(self.time_s).attitude()
    }

    /// Velocity north, east, down at the latest moment, m/s.
    pub(crate) fn velocity_m_s(&self) -> [f64; 3] {
        { self.route }.pose(self.time_s).way()[0]
    }

    /// One panel of the quadrature.
    fn panel(&mut self, until_s: f64) {
        let (from_s, seconds) = (self.time_s, until_s - self.time_s);
        self.look_around(0.5 * seconds);
        let nodes: &[(f64, f64)] = if seconds > SHORT_PANEL_S { &THREE } else { &TWO };
        for (node, weight) in nodes {
            let (felt, part_s) = (self.felt(from_s + node * seconds), weight * seconds);
            add(&mut self.integrals.turned_rad, felt.rate_rad_s, part_s);
            add(&mut self.integrals.pushed_m_s, felt.force_m_s2, part_s);
            self.position.travel(felt.travel_rad_s, part_s);
        }
        self.time_s = until_s;
        self.swing();
    }

    /// Takes Earth for what it is where the vehicle will be `seconds` later.
    fn look_around(&mut self, seconds: f64) {
        let mut there = self.position;
        there.travel(self.felt.travel_rad_s, seconds);
        if there.latitude_rad != self.place.latitude_rad {
            self.place = Place::at(there.latitude_rad);
        }
    }

    /// What is felt at a time in s; while nothing moves it is what it was.
    fn felt(&mut self, time_s: f64) -> Felt {
        let pose = self.route.pose(time_s);
        if pose != self.felt.pose || !pose.stands() {
            self.felt = felt_at(pose, &self.place, self.lever_m);
        }
        self.felt
    }

    /// Adds the integral of ω̇ × r: (change of ω) × r, exactly.
    fn swing(&mut self) {
        if self.lever_m == [0.0; 3] {
            return;
        }
        let rate_rad_s = self.felt(self.time_s).rate_rad_s;
        let change = [0, 1, 2].map(|axis| rate_rad_s[axis] - self.rate_rad_s[axis]);
        add(&mut self.integrals.pushed_m_s, cross(change, self.lever_m), 1.0);
        self.rate_rad_s = rate_rad_s;
    }
}

/// What is felt at a place, less the part of a lever that changes with ω̇.
fn felt_at(pose: Pose, place: &Place, lever_m: [f64; 3]) -> Felt {
    let [velocity_m_s, acceleration_m_s2] = pose.way();
    let to_navigation = pose.attitude().body_to_navigation();
    let transport = place.transport_rad_s(velocity_m_s);
    let level = sum(place.earth_rad_s, transport);
    let over_ground = turning_rad_s(&pose, &to_navigation);
    let rate_rad_s = apply_transposed(&to_navigation, sum(level, over_ground));
    let coriolis = cross(sum(level, place.earth_rad_s), velocity_m_s);
    let [north, east, down] = sum(acceleration_m_s2, coriolis);
    let force = apply_transposed(&to_navigation, [north, east, down - place.gravity_m_s2]);
    let swung = cross(rate_rad_s, cross(rate_rad_s, lever_m));
    Felt {
        pose,
        rate_rad_s,
        force_m_s2: sum(sum(force, pose.force_m_s2), swung),
        travel_rad_s: place.travel_rad_s(velocity_m_s),
    }
}

/// Rate of the body over the ground, north, east, down, rad/s: the azimuth turns about down, the pitch
/// about the level axis to the right, the roll about forward.
fn turning_rad_s(pose: &Pose, to_navigation: &Matrix) -> [f64; 3] {
    let forward = [0, 1, 2].map(|row: usize| to_navigation[row][0]);
    let level = libm::sqrt(forward[0] * forward[0] + forward[1] * forward[1]);
    let pitch = pose.pitch.rate / level;
    let mut turning = [-forward[1] * pitch, forward[0] * pitch, pose.azimuth.rate];
    add(&mut turning, forward, pose.roll.rate);
    turning
}

/// The sum of two vectors.
fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Adds `times` a vector to a total.
fn add(total: &mut [f64; 3], vector: [f64; 3], times: f64) {
    for (total, part) in total.iter_mut().zip(vector) {
        *total += part * times;
    }
}

//! The vehicle on the rotating ellipsoid: what gyros and accelerometers fixed to it feel, integrated.
//!
//! Angular rate: that of the body over the ground, Earth rate and transport rate. Specific force: what
//! speeds up and steers, Coriolis force, gravity, and what a sensor off the axes of the
//! sway feels. Position follows from the same velocity, so that up-vectors, transport rate and
//! displacement agree. All by full rotation matrices (P. D. Groves, "Principles of GNSS, Inertial, and
//! Multisensor Integrated Navigation Systems", 2nd ed., §5.4: the equations, here run backwards).
//!
//! Height does not enter gravity or radii: 100 m of it change a transport rate by 2·10⁻⁵ of itself.

use super::leg::{Leg, Neighbours};
use super::sensors::Means;
use super::{Event, Pose};
use crate::earth::{
    Attitude, apply_transposed, curvature_radii_m, earth_rate_rad_s, normal_gravity_m_s2,
};

/// Longest panel of the quadrature, s: a tenth of a period of 10 Hz.
const PANEL_S: f64 = 0.01;

/// Nodes in [0, 1] and weights of Gauss and Legendre's quadrature of three points: exact to t⁵.
const NODES: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Where the vehicle is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Position {
    /// Geodetic latitude, rad.
    pub latitude_rad: f64,
    /// Longitude from the start, rad, east positive.
    pub longitude_rad: f64,
}

impl Position {
    /// North and east from another position, m: differences of coordinates times the radii of
    /// curvature at the mean latitude, as two position fixes give them.
    #[must_use]
    pub fn displacement_m(&self, from: &Self) -> [f64; 2] {
        let mean_rad = 0.5 * (self.latitude_rad + from.latitude_rad);
        let [meridian_m, transverse_m] = curvature_radii_m(mean_rad);
        let east_rad = (self.longitude_rad - from.longitude_rad) * libm::cos(mean_rad);
        [(self.latitude_rad - from.latitude_rad) * meridian_m, east_rad * transverse_m]
    }
}

/// A vehicle's way through its legs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Route<'a> {
    legs: &'a [Leg],
    events: &'a [Event],
    /// Which leg, when it began, s, and the heading it began with, rad.
    index: usize,
    since_s: f64,
    heading_rad: f64,
}

impl Route<'_> {
    /// The motion at a time in s; ask in rising order. After the last leg the vehicle stays.
    fn pose(&mut self, time_s: f64) -> Pose {
        while let Some(leg) = self.legs.get(self.index)
            && self.index + 1 < self.legs.len()
            && time_s >= self.since_s + leg.seconds()
        {
            self.since_s += leg.seconds();
            self.heading_rad += leg.heading_change_rad();
            self.index += 1;
        }
        let mut pose = self.on_leg(time_s);
        for event in self.events {
            event.add(&mut pose, time_s);
        }
        pose
    }

    fn on_leg(&self, time_s: f64) -> Pose {
        let leg_at = |index: usize| self.legs.get(index);
        let before = self.index.checked_sub(1).and_then(leg_at);
        let Some(leg) = leg_at(self.index) else { return Pose::facing(self.heading_rad) };
        let neighbours = Neighbours { before, leg, after: leg_at(self.index + 1) };
        neighbours.pose(self.heading_rad, time_s - self.since_s, time_s)
    }
}

/// What sensors fixed to the vehicle feel at one moment.
#[derive(Clone, Copy, Debug, Default)]
struct Felt {
    rate_rad_s: [f64; 3],
    force_m_s2: [f64; 3],
    /// Over the ground, north, east, down.
    velocity_m_s: [f64; 3],
}

/// Integrals since the start: what an ideal strapdown unit has summed up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Integrals {
    /// Of the inertial angular rate about forward, right, down, rad.
    pub turned_rad: [f64; 3],
    /// Of the specific force along forward, right, down, m/s.
    pub pushed_m_s: [f64; 3],
}

impl Integrals {
    /// Mean rate and force since these were those, so many seconds ago; zero seconds have no mean, and
    /// give zero.
    pub(super) fn means(&self, before: &Self, seconds: f64) -> Means {
        let mean = |to: [f64; 3], from: [f64; 3]| {
            [0, 1, 2].map(|axis: usize| (to[axis] - from[axis]) / libm::fmax(seconds, 1e-9))
        };
        Means {
            rate_rad_s: mean(self.turned_rad, before.turned_rad),
            force_m_s2: mean(self.pushed_m_s, before.pushed_m_s),
        }
    }
}

/// A moving vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion<'a> {
    route: Route<'a>,
    lever_m: [f64; 3],
    time_s: f64,
    start: Position,
    position: Position,
    integrals: Integrals,
    /// Angular rate at the latest moment, rad/s; kept for a lever only.
    rate_rad_s: [f64; 3],
}

impl<'a> Motion<'a> {
    /// A vehicle at the beginning of its legs: latitude and azimuth in rad, and where the sensors are
    /// from the point about which it sways, m forward, right, down.
    #[must_use]
    pub fn new(
        legs: &'a [Leg],
        events: &'a [Event],
        latitude_rad: f64,
        azimuth_rad: f64,
        lever_m: [f64; 3],
    ) -> Self {
        let start = Position { latitude_rad, longitude_rad: 0.0 };
        let route = Route { legs, events, index: 0, since_s: 0.0, heading_rad: azimuth_rad };
        let mut motion = Self {
            route,
            lever_m,
            time_s: 0.0,
            start,
            position: start,
            integrals: Integrals::default(),
            rate_rad_s: [0.0; 3],
        };
        motion.rate_rad_s = motion.felt(0.0).rate_rad_s;
        motion
    }

    /// Moves on to a time in s from the start; an earlier one changes nothing.
    pub fn advance(&mut self, time_s: f64) {
        let (from_s, seconds) = (self.time_s, time_s - self.time_s);
        let panels = libm::ceil(seconds / PANEL_S - 1e-6);
        for panel in 1..=panels as u32 {
            // The last panel ends at the time asked for, whatever was rounded.
            let left = panels - f64::from(panel);
            self.panel(if left == 0.0 {
                time_s
            } else {
                from_s + seconds / panels * f64::from(panel)
            });
        }
    }

    /// Time of the latest moment, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Integrals up to the latest moment.
    #[must_use]
    pub fn integrals(&self) -> &Integrals {
        &self.integrals
    }

    /// Where it is.
    #[must_use]
    pub fn position(&self) -> &Position {
        &self.position
    }

    /// North and east from the start, m.
    #[must_use]
    pub fn displacement_m(&self) -> [f64; 2] {
        self.position.displacement_m(&self.start)
    }

    /// Attitude at the latest moment; the azimuth is not wrapped.
    #[must_use]
    pub fn attitude(&self) -> Attitude {
        { self.route }.pose(self.time_s).base().lean
    }

    /// Velocity north, east, down at the latest moment, m/s.
    #[must_use]
    pub fn velocity_m_s(&self) -> [f64; 3] {
        { self.route }.pose(self.time_s).velocity_m_s()
    }

    /// One panel of the quadrature.
    fn panel(&mut self, until_s: f64) {
        let (from_s, from, seconds) = (self.time_s, self.position, until_s - self.time_s);
        let mut to = from;
        for (node, weight) in NODES {
            let felt = self.felt_from(&from, node * seconds, from_s + node * seconds);
            let part_s = weight * seconds;
            add(&mut self.integrals.turned_rad, felt.rate_rad_s, part_s);
            add(&mut self.integrals.pushed_m_s, felt.force_m_s2, part_s);
            to = moved(&to, &from, felt.velocity_m_s, part_s);
        }
        (self.position, self.time_s) = (to, until_s);
        self.swing();
    }

    /// What is felt at a time in s, so many seconds after the vehicle was at `from`.
    fn felt_from(&mut self, from: &Position, after_s: f64, time_s: f64) -> Felt {
        let pose = self.route.pose(time_s);
        let here = moved(from, from, pose.velocity_m_s(), after_s);
        felt_at(&pose, here.latitude_rad, self.lever_m)
    }

    fn felt(&mut self, time_s: f64) -> Felt {
        let here = self.position;
        self.felt_from(&here, 0.0, time_s)
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

/// A position moved by a velocity for some seconds, with the radii at another.
fn moved(
    position: &Position,
    radii_at: &Position,
    velocity_m_s: [f64; 3],
    seconds: f64,
) -> Position {
    let [meridian_m, transverse_m] = curvature_radii_m(radii_at.latitude_rad);
    let [north, east, _] = velocity_m_s;
    let parallel_m = transverse_m * libm::cos(radii_at.latitude_rad);
    Position {
        latitude_rad: position.latitude_rad + north / meridian_m * seconds,
        longitude_rad: position.longitude_rad + east / parallel_m * seconds,
    }
}

/// Rate and force at a latitude in rad, less the part of a lever that changes with ω̇.
fn felt_at(pose: &Pose, latitude_rad: f64, lever_m: [f64; 3]) -> Felt {
    let velocity_m_s = pose.velocity_m_s();
    let base = pose.base();
    let to_navigation = base.lean.body_to_navigation();
    let earth = earth_rate_rad_s(latitude_rad);
    let transport = transport_rad_s(latitude_rad, velocity_m_s);
    let ground = apply_transposed(&to_navigation, sum(earth, transport));
    let rate_rad_s = sum(base.body_rad_s(&base.lean), ground);
    let force = free_force(pose, latitude_rad, sum(sum(earth, earth), transport));
    let held = sum(apply_transposed(&to_navigation, force), pose.force_m_s2);
    let swung = cross(rate_rad_s, cross(rate_rad_s, lever_m));
    Felt { rate_rad_s, force_m_s2: sum(held, swung), velocity_m_s }
}

/// Specific force north, east, down, m/s², where the frame turns at `coriolis_rad_s`: twice Earth's
/// rate and the transport rate.
fn free_force(pose: &Pose, latitude_rad: f64, coriolis_rad_s: [f64; 3]) -> [f64; 3] {
    let [north, east, down] =
        sum(pose.acceleration_m_s2(), cross(coriolis_rad_s, pose.velocity_m_s()));
    [north, east, down - normal_gravity_m_s2(latitude_rad)]
}

/// Rate at which the local level turns under a moving vehicle, north, east, down, rad/s.
fn transport_rad_s(latitude_rad: f64, [north, east, _]: [f64; 3]) -> [f64; 3] {
    let [meridian_m, transverse_m] = curvature_radii_m(latitude_rad);
    let about_north = east / transverse_m;
    [about_north, -north / meridian_m, -about_north * libm::tan(latitude_rad)]
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn add(total: &mut [f64; 3], vector: [f64; 3], times: f64) {
    for (total, part) in total.iter_mut().zip(vector) {
        *total += part * times;
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

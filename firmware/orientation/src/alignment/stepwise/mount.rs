//! Mounts of the precise gyro: the single-axis stage, and the two-frame mount (Burov, Fig. 2) with
//! its pointing for two frame angles, and frame angles for a wanted pointing.
//!
//! ```text
//!  base ─▶ outer frame, about body x ─▶ inner frame, across it ─▶ sensitive axis, perpendicular
//!            right side down: +           forward from down: +      to the inner frame's axis
//! ```
//!
//! With both angles zero the inner frame's axis lies along body y and the sensitive axis points
//! down: the station for heading hold (storage of azimuth). For gyrocompassing the axis lies in the
//! base plane at one of four headings. The outer frame stands at zero where the axis lies along
//! body x, so every way between two stations is straight in both angles, within their limits, and
//! no frame turns further than the stations demand.
//!
//! **g-sensitivity.** κ belongs to the gyro's case: `k_s` multiplies the specific force along the
//! sensitive axis, `k_o` that along the inner frame's axis. That axis is horizontal at 0 and 180° but
//! vertical at 90° (up) and 270° (down): unlike on a stage, `k_o` then meets all of gravity, and turns
//! the azimuth as an Earth rate along body y would. The third part, across both, does so along body x.

use super::tilt::Tilt;
use crate::earth::Latitude;
use crate::math::rotation::{IDENTITY, dot};
use crate::signal::Dwell;
use crate::units::{DEGREE, Radians, wrapped};
use crate::words::Rounded;

/// Mechanism that carries the gyro, and the place of its accelerometer. A mount brings its own
/// geometry as functions, so that firmware for one mount contains no code for another.
#[derive(Clone, Copy, Debug)]
pub struct Mount {
    /// Name of the mount, by which mounts are compared.
    pub name: &'static str,
    /// Whether the accelerometer is fixed to the base, so that its biases act as tilt; otherwise it
    /// rides beside the gyro, and they average out over a circle.
    pub is_on_base: bool,
    /// Function for the sensitive axis in a dwell: unit vector in the levelled frame, forward,
    /// right, down.
    pub axis: fn(&Tilt, &Dwell) -> [f64; 3],
    /// Function for the specific force that κ multiplies in a dwell, g.
    pub force: fn(&Tilt, &Dwell) -> [f64; 2],
}

impl Mount {
    /// Single-axis stage: the sensitive axis stays in the stage's plane, and the accelerometer
    /// rides on the stage.
    pub(crate) const STAGE: Self = Self {
        name: "stage",
        is_on_base: false,
        axis: |tilt, dwell| tilt.sensitive_axis(dwell.stage.rad()),
        force: |tilt, dwell| tilt.force(dwell.stage.rad()),
    };

    /// Angle by which a dwell has turned the accelerometer from the base's axes, rad.
    pub(super) fn accelerometer_turn(&self, dwell: &Dwell) -> f64 {
        if self.is_on_base { 0.0 } else { dwell.stage.rad() }
    }
}

impl Default for Mount {
    fn default() -> Self {
        Self::STAGE
    }
}

impl PartialEq for Mount {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Greatest angle of either frame: ±90° (Burov, Fig. 2) and 2° for the corrections of its
/// calibration.
pub const LIMIT: Radians = Radians::from_degrees(92.0);

/// Distance of a heading from its station that counts as arrived. The mount's calibration
/// shifts headings off their nominal values, and each is known exactly.
pub const ARRIVAL: Radians = Radians::from_degrees(1.0);

/// Quarter turn, rad.
const QUARTER: f64 = 90.0 * DEGREE;

/// Angles of both frames, rad, as their encoders show them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameAngles {
    /// Angle of the outer frame about the base's longitudinal axis, positive right side down.
    pub outer: Radians,
    /// Angle of the inner frame, positive where it takes the sensitive axis from down to forward.
    pub inner: Radians,
}

/// Direction of the sensitive axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointing {
    /// Heading θ in the base plane, [0, 2π): clockwise from above, zero along body x.
    pub heading: Radians,
    /// Elevation above the base plane, up positive.
    pub elevation: Radians,
}

/// Orientation to which the mount can be commanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Station {
    /// Sensitive axis along body x: heading 0°.
    Forward,
    /// Sensitive axis along body y: heading 90°.
    Right,
    /// Sensitive axis against body x: heading 180°.
    Backward,
    /// Sensitive axis against body y: heading 270°.
    Left,
    /// Sensitive axis down, perpendicular to the base: heading hold (storage of azimuth).
    Storage,
}

/// Reason for which there are no frame angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MountError {
    /// No station lies at this heading.
    NoStation(Radians),
    /// This calibration does not let the axis reach the station.
    Unreachable(Station),
    /// A frame would turn beyond [`LIMIT`], to this angle.
    BeyondLimit(Radians),
}

crate::words! { Station:
    Self::Forward => "forward";
    Self::Right => "right";
    Self::Backward => "backward";
    Self::Left => "left";
    Self::Storage => "vertical";
}

impl core::error::Error for MountError {}

crate::words! { MountError:
    Self::NoStation(heading) =>
        "the mount has no station at heading {}°", Rounded::<2>(heading.degrees());
    Self::Unreachable(station) =>
        "this calibration lets the gyro's axis not stand {}", station;
    Self::BeyondLimit(angle) =>
        "a frame would turn to {}°, beyond its limit", Rounded::<2>(angle.degrees());
}

/// Calibration of the mount; the default is a perfect one. All angles in rad, right-handed about
/// the named axis (clockwise from above about z), with the frames at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoFrame {
    /// Rotation of the outer axis from body x about body z: positive to the right.
    pub azimuth: Radians,
    /// Rotation of the outer axis from body x about body y: positive where its front is raised.
    pub pitch: Radians,
    /// ε, non-orthogonality of the frames: the inner axis is turned about z from the perpendicular to
    /// the outer one, positive where its right end goes back.
    pub frames: Radians,
    /// δ, non-orthogonality of the gyro: the sensitive axis leans from the perpendicular to the inner
    /// axis towards that axis' right end.
    pub gyro: Radians,
    /// Reading of the outer encoder where the outer frame stands at zero.
    pub outer_zero: Radians,
    /// Reading of the inner encoder where the inner frame stands at zero.
    pub inner_zero: Radians,
}

/// Frame angles with one of the two frames turned by an angle, rad.
type Turning = fn(FrameAngles, f64) -> FrameAngles;

/// Turns the outer frame, about body x.
const OUTER: Turning = |from, turn| FrameAngles { outer: Radians(from.outer.0 + turn), ..from };
/// Turns the inner frame, across the outer one.
const INNER: Turning = |from, turn| FrameAngles { inner: Radians(from.inner.0 + turn), ..from };

impl TwoFrame {
    /// Sensitive axis at these angles: a unit vector forward, right, down. The rotations are exact,
    /// not small-angle ones: `Rz(azimuth) Ry(pitch) Rx(outer) Rz(ε) Ry(inner) Rx(−δ)` takes down to
    /// the axis.
    #[must_use]
    pub fn sensitive_axis(&self, shown: FrameAngles) -> [f64; 3] {
        let leaning = about_x([0.0, 0.0, 1.0], -self.gyro.0);
        let in_outer = about_z(about_y(leaning, shown.inner.0 - self.inner_zero.0), self.frames.0);
        let in_case = about_x(in_outer, shown.outer.0 - self.outer_zero.0);
        about_z(about_y(in_case, self.pitch.0), self.azimuth.0)
    }

    /// Heading and elevation of the sensitive axis at these angles.
    #[must_use]
    pub fn pointing(&self, shown: FrameAngles) -> Pointing {
        let [forward, right, down] = self.sensitive_axis(shown);
        Pointing {
            heading: Radians(wrapped(libm::atan2(right, forward))),
            elevation: Radians(libm::atan2(-down, libm::hypot(forward, right))),
        }
    }

    /// Frame angles at which the axis stands at a station: exactly horizontal or vertical. The
    /// heading is exact to the right and left; along body x the frames cannot change it.
    ///
    /// # Errors
    /// [`MountError`] for a calibration with which a frame cannot take the axis there, or not
    /// within its limits.
    pub fn angles(&self, station: Station) -> Result<FrameAngles, MountError> {
        let [forward, right, down] = IDENTITY;
        let (outer, inner, across) = match station {
            Station::Forward | Station::Backward => {
                let way = if station == Station::Forward { QUARTER } else { -QUARTER };
                let start = self.shown(0.0, way);
                let found = self.perpendicular(start, INNER, down);
                return found.ok_or(MountError::Unreachable(station)).and_then(within_limits);
            }
            Station::Right => (-QUARTER, 0.0, down),
            Station::Left => (QUARTER, 0.0, down),
            Station::Storage => (0.0, 0.0, right),
        };
        let mut angles = self.shown(outer, inner);
        for _ in 0..ROUNDS {
            angles = self
                .perpendicular(angles, INNER, forward)
                .and_then(|angles| self.perpendicular(angles, OUTER, across))
                .ok_or(MountError::Unreachable(station))?;
        }
        within_limits(angles)
    }

    /// Encoder readings at true frame angles.
    fn shown(&self, outer: f64, inner: f64) -> FrameAngles {
        let outer = Radians(outer + self.outer_zero.0);
        let inner = Radians(inner + self.inner_zero.0);
        FrameAngles { outer, inner }
    }

    /// Turns one frame to where the axis is perpendicular to a direction, the nearer of both such
    /// angles; `None` where there is none.
    ///
    /// Over the angle x of a frame any component of the axis is a + b cos x + c sin x, so three
    /// evaluations determine a, b and c.
    fn perpendicular(&self, from: FrameAngles, by: Turning, to: [f64; 3]) -> Option<FrameAngles> {
        let at = |turn: f64| by(from, turn);
        let component = |turn: f64| dot(&self.sensitive_axis(at(turn)), &to);
        let [here, aside, opposite] = [0.0, QUARTER, 2.0 * QUARTER].map(component);
        let mean = 0.5 * (here + opposite);
        let [cosine, sine] = [here - mean, aside - mean];
        let ratio = mean / libm::hypot(cosine, sine);
        if ratio.is_nan() || ratio.abs() > 1.0 {
            return None;
        }
        let (phase, width) = (libm::atan2(sine, cosine), libm::acos(-ratio));
        let [one, other] = [phase + width, phase - width].map(signed);
        Some(at(if one.abs() < other.abs() { one } else { other }))
    }
}

/// Number of rounds in which both frames are set in turn: each multiplies the error by less than
/// the calibration's angles, so four of them reach 10⁻⁹ for angles of a degree.
const ROUNDS: usize = 5;

impl Station {
    /// Station whose heading (rad, any number of turns) is within [`ARRIVAL`].
    ///
    /// # Errors
    /// [`MountError::NoStation`] where no station is so near.
    pub fn at_heading(heading: Radians) -> Result<Self, MountError> {
        const ROUND: [Station; 4] =
            [Station::Forward, Station::Right, Station::Backward, Station::Left];
        let quarters = libm::round(wrapped(heading.0) / QUARTER);
        let is_near = signed(heading.0 - quarters * QUARTER).abs() <= ARRIVAL.0;
        let station = ROUND.get(quarters as usize % ROUND.len()).filter(|_| is_near);
        station.copied().ok_or(MountError::NoStation(heading))
    }
}

/// The two-frame mount, for the setting of an alignment.
pub const TWO_FRAMES: Mount =
    Mount { name: "two frames", is_on_base: true, axis: raised_axis, force: case_force };

/// Sensitive axis of a dwell in the levelled frame, from its heading and its elevation.
fn raised_axis(tilt: &Tilt, dwell: &Dwell) -> [f64; 3] {
    let level = tilt.sensitive_axis(dwell.stage.rad());
    let down = tilt.down();
    let (sine, cosine) = libm::sincos(f64::from(dwell.elevation));
    [0, 1, 2].map(|i| cosine * level[i] - sine * down[i])
}

/// Specific force along the sensitive axis and along the inner frame's axis of a dwell, in g, for a
/// tilt. The mount's non-orthogonality is negligible here.
fn case_force(tilt: &Tilt, dwell: &Dwell) -> [f64; 2] {
    let theta = dwell.stage.rad();
    let (sine, cosine) = libm::sincos(f64::from(dwell.elevation));
    let up = tilt.upward();
    let along = cosine * tilt.force(theta)[0] + sine * up;
    let (east, north) = libm::sincos(theta);
    let inner = if east.abs() < north.abs() { -tilt.imaginary } else { libm::copysign(up, east) };
    [along, inner]
}

/// Azimuth error due to the mount, 1σ, for 1σ of its non-orthogonalities after calibration and
/// of each encoder, both in rad.
///
/// ε changes headings; δ and the encoders' errors raise the axis, and an elevation changes the
/// azimuth by tan φ of itself. The result holds at the azimuths of the greatest effect: σ √(1 +
/// tan² φ), and σ tan φ.
pub fn azimuth_sigma(orthogonality: Radians, encoder: Radians, latitude: Latitude) -> Radians {
    let slope = libm::tan(latitude.rad());
    Radians(libm::hypot(orthogonality.0 * libm::hypot(1.0, slope), encoder.0 * slope))
}

/// Checks that both frames reach the angles.
fn within_limits(angles: FrameAngles) -> Result<FrameAngles, MountError> {
    let beyond = [angles.outer, angles.inner].into_iter().find(|angle| angle.0.abs() > LIMIT.0);
    beyond.map_or(Ok(angles), |angle| Err(MountError::BeyondLimit(angle)))
}

/// Reduces an angle to [−π, π), rad.
fn signed(angle: f64) -> f64 {
    wrapped(angle + 2.0 * QUARTER) - 2.0 * QUARTER
}

/// Vector rotated about x, right-handed.
fn about_x([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(angle);
    [x, cosine * y - sine * z, sine * y + cosine * z]
}

/// Vector rotated about y, right-handed.
fn about_y([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(angle);
    [cosine * x + sine * z, y, cosine * z - sine * x]
}

/// Vector rotated about z, right-handed.
fn about_z([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(angle);
    [cosine * x - sine * y, sine * x + cosine * y, z]
}

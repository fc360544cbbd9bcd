//! Function U(azp): the angle between the vertical that the gyros carried from the first stop and
//! the levelled one at the last, for any azimuth at the start (Szymanowski 2003).
//!
//! The drive is not stored: the rotation measured by the gyros does not depend on the azimuth, so
//! one vector for each of the two stops is all that is kept. A candidate azimuth enters through the
//! start's attitude alone.

use crate::math::brent::{self, Minimum};
use crate::math::quick_root;
use crate::math::rotation::{Matrix, Vector, about_down, transposed, turned};
use crate::math::turn::{high, sine_and_cosine};
use crate::units::{Radians, TURN, wrapped};

/// Chord up to which its angle is taken from two terms of a series: the next term is below 1e-9 of
/// it.
const SHORT: f64 = 0.02;
/// Factor of the components stored as integers.
const STORED: f64 = (1_u64 << 62) as f64;
/// Factor of their products with sines.
const TURNED: f64 = (1_u64 << 60) as f64;
/// Steps of a quarter of the integer angle in a radian.
const QUARTER_STEPS: f64 = (1_u64 << 62) as f64 / TURN;
/// Width of the search about the coarse minimum, rad; U has a single minimum within half a turn.
const HALF_TURN: f64 = 0.5 * TURN;
/// Tolerance of the azimuth in the search, rad: below 1e-8°.
const TOLERANCE: f64 = 1e-10;
/// Greatest number of evaluations in the search.
const EVALUATIONS: u32 = 100;

/// Up-vectors of two stops, from which U is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inclination {
    /// Up vector at the last stop as levelled there, on the first stop's level axes, whose x points
    /// along the horizontal projection of body x.
    levelled: Vector,
    /// Up vector at the last stop as predicted from Earth rotation and displacement, on north,
    /// east, down of the first stop.
    predicted: Vector,
    /// Rotation from those level axes to the body's at the last stop.
    body: Matrix,
    /// Horizontal components of `levelled`, times 2⁶².
    stored: [i64; 2],
    /// Horizontal components of `predicted`, times 2⁶⁰.
    wanted: [i64; 2],
    /// Square of the difference of the vertical components.
    away: f64,
}

impl Inclination {
    /// Inclination from the levelled up vector at the last stop on the first stop's level axes, the
    /// predicted one on its north, east, down (both of length one), and the rotation from those
    /// level axes to the body's at the last stop.
    #[must_use]
    pub fn new(levelled: Vector, predicted: Vector, body: Matrix) -> Self {
        let [x, y, z] = levelled;
        let [north, east, down] = predicted;
        Self {
            levelled,
            predicted,
            body,
            stored: [x, y].map(|part| (part * STORED) as i64),
            wanted: [north, east].map(|part| (part * TURNED) as i64),
            away: (z - down) * (z - down),
        }
    }

    /// Angle U for an azimuth at the first stop, rad: between the carried and the levelled up
    /// vector; its error is 1e-9 relative below 0.02 rad, and 1e-7 rad beyond.
    #[must_use]
    #[inline(never)]
    pub fn angle(&self, azimuth: f64) -> f64 {
        let (sine, cosine) = sine_and_cosine(((azimuth * QUARTER_STEPS) as i64 as u64) << 2);
        let [x, y] = self.stored;
        let [north, east] = self.wanted;
        // Differences are used instead of cosines, so that no digit is lost for small angles.
        let along = (high(cosine, x) - high(sine, y) - north) as f64;
        let across = (high(sine, x) + high(cosine, y) - east) as f64;
        let square = (along * along + across * across) * (1.0 / (TURNED * TURNED));
        angle_of(quick_root(square + self.away))
    }

    /// Value of U in the paper's form: √(ΔΘ² + ΔΦ²) between carried and levelled pitch and roll,
    /// rad (Szymanowski 2003).
    #[must_use]
    pub fn euler(&self, azimuth: f64) -> f64 {
        let carried = turned(&transposed(&about_down(azimuth)), &self.predicted);
        let [carried, levelled] =
            [carried, self.levelled].map(|up| pitch_and_roll(&turned(&self.body, &up)));
        libm::hypot(carried[0].0 - levelled[0].0, apart(carried[1].0, levelled[1].0))
    }

    /// Azimuth at the first stop of the least angle, rad, [0, 2π), in closed form: the horizontal
    /// components of both vectors are parallel.
    #[must_use]
    pub fn closed_form(&self) -> f64 {
        let [x, y, _] = self.levelled;
        let [north, east, _] = self.predicted;
        wrapped(libm::atan2(east, north) - libm::atan2(y, x))
    }

    /// Azimuth of the least U by the paper's way: bounded minimisation of a form of U. The interval
    /// is centred on the best of eight azimuths.
    #[must_use]
    pub fn minimised(&self, form: fn(&Self, f64) -> f64) -> Minimum {
        let eighths = (0..8).map(|eighth| TURN * f64::from(eighth) / 8.0);
        let least = eighths.map(|azimuth| (azimuth, form(self, azimuth)));
        let lesser =
            |least: (f64, f64), next: (f64, f64)| if next.1 < least.1 { next } else { least };
        let (middle, _) = least.fold((0.0, f64::INFINITY), lesser);
        let bounds = [middle - 0.5 * HALF_TURN, middle + 0.5 * HALF_TURN];
        let minimum =
            brent::minimise(bounds, TOLERANCE, EVALUATIONS, |azimuth| form(self, azimuth));
        Minimum { at: wrapped(minimum.at), evaluations: minimum.evaluations + 8, ..minimum }
    }

    /// Sines of the angles by which the up vector turned between the stops, as levelled and as
    /// predicted.
    pub(super) fn turns(&self) -> [f64; 2] {
        [self.levelled, self.predicted].map(|[x, y, _]| libm::hypot(x, y))
    }
}

/// Angle that a chord of the unit sphere spans, rad.
fn angle_of(chord: f64) -> f64 {
    if chord < SHORT {
        // The arc exceeds its chord by 1e-5 of it, so single precision suffices for the difference.
        let (chord32, square) = (chord as f32, chord as f32 * chord as f32);
        return chord + f64::from(chord32 * square * (1.0 / 24.0));
    }
    let half = 0.5 * chord as f32;
    chord + f64::from(2.0 * (libm::asinf(half.min(1.0)) - half))
}

/// Pitch and roll of a body with this up vector on its axes.
pub fn pitch_and_roll(up: &Vector) -> [Radians; 2] {
    let [x, y, z] = *up;
    [Radians(libm::atan2(x, libm::hypot(y, z))), Radians(libm::atan2(-y, -z))]
}

/// Signed angle from one roll to another, rad, the short way.
fn apart(a: f64, b: f64) -> f64 {
    let turns = (a - b) / TURN;
    (turns - libm::round(turns)) * TURN
}

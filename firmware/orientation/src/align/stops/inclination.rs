//! U(azp): how far the vertical that the gyros carried from the first stop is from the levelled one at the
//! last, for any azimuth at the start (Szymanowski 2003, eqs. 9, 10 and 13; equations.md §5).
//!
//! The drive is not stored: what the gyros turned does not depend on the azimuth, so one vector at either
//! stop is all that is kept of it. A candidate enters by the start's attitude alone.

use crate::math::brent::{self, Minimum};
use crate::math::quick_root;
use crate::math::rotation::{Matrix, Vector, about_down, transposed, turned, unit};
use crate::math::turn::{high, sine_and_cosine};
use crate::units::{TURN, wrapped};

/// Chord up to which its angle is taken from a series, whose error is then below 1e-13 of it.
const SHORT: f64 = 0.02;
/// Times which components are stored as integers, and their products with sines come out.
const STORED: f64 = (1_u64 << 62) as f64;
const TURNED: f64 = (1_u64 << 60) as f64;
/// Steps of the stored angle's quarter in a radian.
const QUARTER_STEPS: f64 = (1_u64 << 62) as f64 / TURN;
/// Width of the search about the coarse minimum, rad; U falls only once within half a turn.
const HALF_TURN: f64 = 0.5 * TURN;
/// What the search is to find the azimuth to, rad: below 1e-8°.
const TOLERANCE: f64 = 1e-10;
/// Evaluations that it may take.
const EVALUATIONS: u32 = 100;

/// What two stops leave of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inclination {
    /// Up at the last stop as levelled there, on the level axes of the first stop that point where the
    /// body pointed.
    levelled: Vector,
    /// Up at the last stop as Earth rotation and displacement turned it, on north, east, down of the
    /// first stop.
    predicted: Vector,
    /// From those level axes to the body's at the last stop.
    body: Matrix,
    /// Horizontal parts of the first, times 2⁶², and of the second, times 2⁶⁰.
    stored: [i64; 2],
    wanted: [i64; 2],
    /// Square of the difference of their vertical parts.
    away: f64,
}

impl Inclination {
    /// From up at the last stop on the first stop's level axes, the same as predicted on its north, east,
    /// down, both of length one, and the rotation from those level axes to the body's at the last stop.
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

    /// U for an azimuth at the first stop, rad: the angle between the carried and the levelled up. To 1e-13
    /// of it below 0.02 rad, beyond to 1e-7.
    #[must_use]
    #[inline(never)]
    pub fn angle(&self, azimuth: f64) -> f64 {
        let (sine, cosine) = sine_and_cosine(((azimuth * QUARTER_STEPS) as i64 as u64) << 2);
        let [x, y] = self.stored;
        let [north, east] = self.wanted;
        // Differences, not cosines, so that no digit is lost where the angle is small.
        let along = (high(cosine, x) - high(sine, y) - north) as f64;
        let across = (high(sine, x) + high(cosine, y) - east) as f64;
        let square = (along * along + across * across) * (1.0 / (TURNED * TURNED));
        angle_of(quick_root(square + self.away))
    }

    /// U in the paper's form: √(ΔΘ² + ΔΦ²) between carried and levelled pitch and roll, rad.
    #[must_use]
    pub fn euler(&self, azimuth: f64) -> f64 {
        let carried = turned(&transposed(&about_down(azimuth)), &self.predicted);
        let [carried, levelled] =
            [carried, self.levelled].map(|up| pitch_and_roll(&turned(&self.body, &up)));
        libm::hypot(carried[0] - levelled[0], apart(carried[1], levelled[1]))
    }

    /// Azimuth at the first stop of the least angle, rad, [0, 2π), in closed form: the horizontal parts of
    /// both vectors point the same way.
    #[must_use]
    pub fn closed_form(&self) -> f64 {
        let [x, y, _] = self.levelled;
        let [north, east, _] = self.predicted;
        wrapped(libm::atan2(east, north) - libm::atan2(y, x))
    }

    /// The same by the paper's way: bounded minimisation of a form of U, after the least of eight azimuths
    /// was taken for the middle of the interval.
    #[must_use]
    pub fn minimised(&self, form: fn(&Self, f64) -> f64) -> Minimum {
        let eighths = (0..8).map(|eighth| TURN * f64::from(eighth) / 8.0);
        let least = eighths.map(|azimuth| (azimuth, form(self, azimuth)));
        let (middle, _) =
            least.fold(
                (0.0, f64::INFINITY),
                |least, value| {
                    if value.1 < least.1 { value } else { least }
                },
            );
        let bounds = [middle - 0.5 * HALF_TURN, middle + 0.5 * HALF_TURN];
        let minimum =
            brent::minimise(bounds, TOLERANCE, EVALUATIONS, |azimuth| form(self, azimuth));
        Minimum { at: wrapped(minimum.at), evaluations: minimum.evaluations + 8, ..minimum }
    }

    /// Sines of the angles by which up turned between the stops, as levelled and as predicted.
    #[must_use]
    pub fn turns(&self) -> [f64; 2] {
        [self.levelled, self.predicted].map(|[x, y, _]| libm::hypot(x, y))
    }

    /// The direction in which up turned from the first stop to the last, horizontal, of length one, on the
    /// first stop's level axes.
    #[must_use]
    pub fn direction(&self) -> Vector {
        let [x, y, _] = self.levelled;
        unit(&[x, y, 0.0])
    }
}

/// The angle that a chord of the unit sphere spans, rad.
fn angle_of(chord: f64) -> f64 {
    if chord < SHORT {
        let square = chord * chord;
        return chord + chord * square * (1.0 / 24.0 + square * (3.0 / 640.0));
    }
    let half = 0.5 * chord as f32;
    // What the arc is longer than its chord is small, so single precision will do.
    chord + f64::from(2.0 * (libm::asinf(half.min(1.0)) - half))
}

/// Pitch and roll of a body that feels this as up, rad.
#[must_use]
pub fn pitch_and_roll(up: &Vector) -> [f64; 2] {
    let [x, y, z] = *up;
    [libm::atan2(x, libm::hypot(y, z)), libm::atan2(-y, -z)]
}

/// The angle from one roll to another, rad, the short way.
fn apart(a: f64, b: f64) -> f64 {
    let turns = (a - b) / TURN;
    (turns - libm::round(turns)) * TURN
}

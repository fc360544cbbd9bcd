//! Heading hold: propagation of the azimuth through motion, with its growing standard deviation.
//!
//! The azimuth is `A(t) = A₀ + ∫(ω_down + Ω_v) dt`, in any attitude and with the gyros' biases
//! subtracted (Burov, section 2, storage of azimuth). Its variance is the sum of those of A₀, of
//! noise and biases since then (from the filter of the gyrovertical, or all that is stated of a bias
//! which neither a rest nor an alignment has shown), of the gyro's scale error
//! over the net turn, of a ramp of its bias, of rotation during gaps, and of the level's error, which
//! turns the azimuth of a sloping axis.

use core::f64::consts::PI;

use super::setting::Gyro;
use super::vertical::Vertical;
use crate::alignment::Azimuth;
use crate::earth::Latitude;
use crate::math::quaternion::{Matrix, angles};
use crate::units::{Instant, MetresPerSecond, Radians, TURN, wrapped};

/// Significance, in σ, at which an alignment and the held azimuth contradict each other, and at which an
/// axis is not upright.
const BOUND: f64 = 4.0;

/// Error of a level that is not known any more, 1σ, rad: it says of no axis that it is upright.
const LOST: f32 = 0.1;
/// Square of [`BOUND`].
const SQUARE_OF_BOUND: f32 = (BOUND * BOUND) as f32;

/// Outcome of a new alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Realigned {
    /// There was no azimuth before, and the new one was adopted.
    Taken,
    /// The new azimuth was combined with the held one, weighted by their variances.
    Fused {
        /// Distance between the two, in σ.
        sigmas: f64,
    },
    /// The new azimuth contradicts the held one: one of them is wrong, and the azimuth is
    /// withdrawn.
    Disagrees {
        /// Distance between the two, in σ.
        sigmas: f64,
    },
}

/// Slope of body x at a moment, on which an error ε of the level about the horizontal below body x turns
/// its azimuth by ε·tan P.
///
/// In single precision, and without a function of an angle: it is of errors, and ten times a second.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slope {
    /// Cosine and tangent of the pitch P.
    cosine: f32,
    tangent: f32,
    /// Sine and cosine of the roll.
    roll: [f32; 2],
    /// Variance of the level's error, rad².
    variance: f32,
}

impl Slope {
    /// The present one.
    fn of(vertical: &Vertical) -> Self {
        Self::of_level(&vertical.attitude().rough_matrix(), vertical.sigma())
    }

    /// That of a rotation matrix of the body, whose level has an error, 1σ, rad. Upright, the roll is zero.
    fn of_level([.., [forward, right, down]]: &Matrix, sigma: f32) -> Self {
        let cosine = libm::sqrtf(right * right + down * down);
        let roll = if cosine > 0.0 { [right / cosine, down / cosine] } else { [0.0, 1.0] };
        Self { cosine, tangent: -forward / cosine, roll, variance: sigma * sigma }
    }

    /// Whether body x may be upright, so that it has no azimuth.
    fn is_upright(&self) -> bool {
        self.cosine * self.cosine < SQUARE_OF_BOUND * self.variance.min(LOST * LOST)
    }

    /// Variance of what the level's error turns the azimuth by, rad².
    fn of_azimuth(&self) -> f32 {
        self.variance * self.tangent * self.tangent
    }

    /// Variance of what the level's error turned the azimuth by since an earlier moment, rad². The smaller of both errors is
    /// taken for that of the accelerometers, which both have in common and which stays with the body.
    fn variance_since(&self, before: &Self) -> f64 {
        let [[sine, cosine], [earlier_sine, earlier_cosine]] = [self.roll, before.roll];
        let of_difference = sine * earlier_sine + cosine * earlier_cosine;
        let common = self.variance.min(before.variance) * of_difference;
        let both = self.of_azimuth() + before.of_azimuth();
        (both - 2.0 * common * self.tangent * before.tangent).max(0.0).into()
    }

    /// Ends what it has in common with later ones, and returns the variance that is left of it, rad².
    fn part(&mut self) -> f64 {
        let variance = self.of_azimuth();
        self.tangent = 0.0;
        variance.into()
    }
}

/// An azimuth that is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Heading {
    /// Azimuth of the level frame's x, rad.
    pub(super) frame: f64,
    /// Variance of the azimuth that was handed over, with the error of the turns before the latest restart, rad².
    variance: f64,
    /// Slope since which the level's error counts.
    slope: Slope,
    /// Standard deviations of the gyro's scale factor, and of an unknown ramp of its bias, rad/s².
    scale: f64,
    ramp: f64,
}

impl Heading {
    /// Begins with an azimuth of body x, and restarts the error of the turn.
    pub(super) fn begin(azimuth: Azimuth, gyro: &Gyro, vertical: &mut Vertical) -> Self {
        vertical.begin_course();
        Self {
            frame: wrapped(azimuth.angle.0 - course(vertical)),
            variance: azimuth.sigma.0 * azimuth.sigma.0,
            slope: Slope::of(vertical),
            scale: gyro.scale_sigma,
            ramp: gyro.noise.rate_ramp.0,
        }
    }

    /// Present azimuth of body x; where that may be upright σ is π.
    pub(super) fn azimuth(&self, vertical: &Vertical) -> Azimuth {
        let attitude = vertical.attitude();
        let [course, ..] = angles(attitude.parts());
        self.azimuth_of(&attitude.rough_matrix(), course, vertical)
    }

    /// The same of the vertical's present rotation matrix, and the course of body x on the level frame, rad, which is that
    /// matrix's.
    pub(super) fn azimuth_of(&self, matrix: &Matrix, course: f64, vertical: &Vertical) -> Azimuth {
        let angle = Radians(wrapped(self.frame + course));
        let slope = Slope::of_level(matrix, vertical.sigma());
        let of_level = slope.variance_since(&self.slope);
        let sigma = libm::sqrt(self.variance(vertical) + of_level);
        Azimuth { angle, sigma: Radians(if slope.is_upright() { PI } else { sigma.min(PI) }) }
    }

    /// Standard deviation of the azimuth of the level frame, rad: without what the slope makes of it.
    pub(super) fn sigma(&self, vertical: &Vertical) -> f64 {
        libm::sqrt(self.variance(vertical))
    }

    /// Restarts the error of the turn. That of the level goes on from the slope on which it began.
    pub(super) fn restart(&mut self, gyro: &Gyro, vertical: &mut Vertical) {
        self.variance = self.variance(vertical);
        (self.scale, self.ramp) = (gyro.scale_sigma, gyro.noise.rate_ramp.0);
        vertical.begin_course();
    }

    /// Notes that other accelerometers show the level from now on.
    pub(super) fn exchange_forces(&mut self) {
        self.variance += self.slope.part();
    }

    /// Variance of the azimuth of the level frame, rad².
    fn variance(&self, vertical: &Vertical) -> f64 {
        let motion = &vertical.course;
        let scale = self.scale * f64::from(motion.turned);
        let ramp = self.ramp * f64::from(motion.ramp);
        self.variance + f64::from(vertical.turn_variance()) + scale * scale + ramp * ramp
    }

    /// Combines a new alignment with the held azimuth.
    pub(super) fn realign(
        &mut self,
        azimuth: Azimuth,
        gyro: &Gyro,
        vertical: &mut Vertical,
    ) -> Realigned {
        let kept = self.azimuth(vertical);
        let off = difference(azimuth.angle.0, kept.angle.0);
        let (old, new) = (kept.sigma.0 * kept.sigma.0, azimuth.sigma.0 * azimuth.sigma.0);
        let sigmas = off.abs() / libm::sqrt(old + new);
        if sigmas > BOUND || sigmas.is_nan() {
            return Realigned::Disagrees { sigmas };
        }
        let angle = Radians(kept.angle.0 + off * old / (old + new));
        let sigma = Radians(libm::sqrt(old * new / (old + new)));
        *self = Self::begin(Azimuth { angle, sigma }, gyro, vertical);
        Realigned::Fused { sigmas }
    }
}

/// Course of the body at a moment, from which an azimuth of that moment is carried on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    /// The moment.
    pub(super) at: Instant,
    /// Course of body x on the level frame, rad.
    course: f64,
    /// Variance of the turn, rad², and net turn, rad, up to the moment.
    variance: f32,
    turned: f32,
    /// Standard deviation of the turn since then, rad, until its count was restarted.
    since: f64,
    /// Slope of the moment, and the variance of what other accelerometers' errors did on it, rad².
    slope: Slope,
    parted: f64,
}

impl Mark {
    /// Marks the present course as that of a moment.
    pub(super) fn new(at: Instant, vertical: &Vertical) -> Self {
        let (variance, turned) = (vertical.turn_variance(), vertical.course.turned);
        let slope = Slope::of(vertical);
        Self { at, course: course(vertical), variance, turned, since: 0.0, slope, parted: 0.0 }
    }

    /// Standard deviation of the turn since the moment, rad. Errors of biases and scale factors before and after
    /// a restart of the count are the same ones, so that they add up.
    fn sigma(&self, gyro: &Gyro, vertical: &Vertical) -> f64 {
        let scale = gyro.scale_sigma * f64::from(vertical.course.turned - self.turned);
        let grown = f64::from((vertical.turn_variance() - self.variance).max(0.0));
        self.since + libm::sqrt(grown + scale * scale)
    }

    /// Closes the error of the turn up to now, which this gyro has measured, before its count restarts.
    pub(super) fn close(&mut self, gyro: &Gyro, vertical: &Vertical) {
        self.since = self.sigma(gyro, vertical);
    }

    /// Goes on from the present count.
    pub(super) fn go_on(&mut self, vertical: &Vertical) {
        (self.variance, self.turned) = (vertical.turn_variance(), vertical.course.turned);
    }

    /// Notes that other accelerometers show the level from now on.
    pub(super) fn exchange_forces(&mut self) {
        self.parted += self.slope.part();
    }

    /// Carries an azimuth of the moment on to the present.
    pub(super) fn carry(&self, azimuth: Azimuth, gyro: &Gyro, vertical: &Vertical) -> Azimuth {
        let angle = wrapped(azimuth.angle.0 + course(vertical) - self.course);
        let of_level = Slope::of(vertical).variance_since(&self.slope) + self.parted;
        let of_turn = libm::hypot(self.sigma(gyro, vertical), libm::sqrt(of_level));
        let sigma = libm::hypot(azimuth.sigma.0, of_turn);
        Azimuth { angle: Radians(angle), sigma: Radians(sigma.min(PI)) }
    }
}

/// Rate of the level frame, rad/s, about north, east and down of that frame, whose x has the
/// azimuth `north`: rotation of the Earth and, where the speed north and east is known, m/s,
/// transport rate.
pub(super) fn frame_rate(
    latitude: Latitude,
    north: Option<f64>,
    speed: Option<[MetresPerSecond; 2]>,
) -> [f32; 3] {
    let down = -latitude.vertical_rate().0;
    let Some(frame) = north else { return [0.0, 0.0, down as f32] };
    let [to_north, to_east] = speed.unwrap_or_default();
    let [along, across] = latitude.radii();
    let about_north = latitude.horizontal_rate().0 + to_east.0 / across.0;
    let about_east = -to_north.0 / along.0;
    let about_down = down - to_east.0 / across.0 * libm::tan(latitude.rad());
    let (sine, cosine) = libm::sincos(frame);
    let x = about_north * cosine + about_east * sine;
    let y = about_east * cosine - about_north * sine;
    [x as f32, y as f32, about_down as f32]
}

/// Whether body x may be upright, so that it has no azimuth.
pub(super) fn is_upright(vertical: &Vertical) -> bool {
    Slope::of(vertical).is_upright()
}

/// Course of body x on the level frame, rad.
fn course(vertical: &Vertical) -> f64 {
    let [course, ..] = angles(vertical.attitude().parts());
    course
}

/// Difference of two angles, rad, in [−π, π).
fn difference(a: f64, b: f64) -> f64 {
    wrapped(a - b + 0.5 * TURN) - 0.5 * TURN
}

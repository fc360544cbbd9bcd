//! Heading hold: propagation of the azimuth through motion, with its growing standard deviation.
//!
//! The azimuth is `A(t) = A₀ + ∫(ω_down + Ω_v) dt`, in any attitude and with the gyros' biases
//! subtracted (Burov, section 2, storage of azimuth). Its variance is the sum of those of A₀, of
//! noise and biases since then (from the filter of the gyrovertical), of the gyro's scale error
//! over the net turn, of a ramp of its bias, and of rotation during gaps.

use super::setting::Gyro;
use super::vertical::Vertical;
use crate::alignment::Azimuth;
use crate::earth::Latitude;
use crate::math::quaternion::angles;
use crate::units::{Instant, MetresPerSecond, Radians, TURN, wrapped};

/// Significance, in σ, at which an alignment and the held azimuth contradict each other.
const BOUND: f64 = 4.0;

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

/// An azimuth that is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Heading {
    /// Azimuth of the level frame's x, rad.
    pub(super) frame: f64,
    /// Variance of the azimuth that was handed over, rad².
    variance: f64,
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
            scale: gyro.scale_sigma,
            ramp: gyro.noise.rate_ramp.0,
        }
    }

    /// Present azimuth of body x.
    pub(super) fn azimuth(&self, vertical: &Vertical) -> Azimuth {
        let angle = Radians(wrapped(self.frame + course(vertical)));
        Azimuth { angle, sigma: Radians(libm::sqrt(self.variance(vertical))) }
    }

    /// Begins with the present azimuth.
    pub(super) fn restart(&mut self, gyro: &Gyro, vertical: &mut Vertical) {
        *self = Self::begin(self.azimuth(vertical), gyro, vertical);
    }

    /// Variance of the present azimuth, rad².
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
}

impl Mark {
    /// Marks the present course as that of a moment.
    pub(super) fn new(at: Instant, vertical: &Vertical) -> Self {
        let (variance, turned) = (vertical.turn_variance(), vertical.course.turned);
        Self { at, course: course(vertical), variance, turned, since: 0.0 }
    }

    /// Standard deviation of the turn since the moment, rad. Errors of biases and scale factors before and after
    /// a restart of the count are the same ones, so that they add up.
    fn sigma(&self, gyro: &Gyro, vertical: &Vertical) -> f64 {
        let scale = gyro.scale_sigma * f64::from(vertical.course.turned - self.turned);
        let grown = f64::from((vertical.turn_variance() - self.variance).max(0.0));
        self.since + libm::sqrt(grown + scale * scale)
    }

    /// Notes that the count of the turn's error restarts.
    pub(super) fn restart(&mut self, gyro: &Gyro, vertical: &Vertical) {
        self.since = self.sigma(gyro, vertical);
        (self.variance, self.turned) = (0.0, 0.0);
    }

    /// Carries an azimuth of the moment on to the present.
    pub(super) fn carry(&self, azimuth: Azimuth, gyro: &Gyro, vertical: &Vertical) -> Azimuth {
        let angle = wrapped(azimuth.angle.0 + course(vertical) - self.course);
        let sigma = libm::hypot(azimuth.sigma.0, self.sigma(gyro, vertical));
        Azimuth { angle: Radians(angle), sigma: Radians(sigma) }
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

/// Course of body x on the level frame, rad.
fn course(vertical: &Vertical) -> f64 {
    let [course, ..] = angles(vertical.attitude().parts());
    course
}

/// Difference of two angles, rad, in [−π, π).
fn difference(a: f64, b: f64) -> f64 {
    wrapped(a - b + 0.5 * TURN) - 0.5 * TURN
}

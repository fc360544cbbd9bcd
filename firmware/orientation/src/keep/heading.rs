//! The azimuth through motion: what the gyrovertical turns about the vertical, and how sure that is.
//!
//! `A(t) = A₀ + ∫(ω_down + Ω_v) dt`, in any attitude and less the gyros' biases (Burov, section 2). Its variance
//! is that of A₀; what noise and biases have turned since, which the filter of the gyrovertical carries; the
//! gyro's scale error over the turn that is left; a ramp of its bias; and what gaps hid.

use super::vertical::Vertical;
use super::{Gyro, attitude};
use crate::earth::Latitude;
use crate::units::{TURN, wrapped};

/// Standard deviations by which an alignment and what was kept may differ.
const BOUND: f64 = 4.0;

/// An azimuth with its standard deviation, as it is handed over by an alignment or from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handover {
    /// Azimuth of body x, rad.
    pub azimuth: f64,
    /// Its 1σ, rad.
    pub sigma: f64,
}

/// What became of a new alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Realigned {
    /// There was no azimuth before: it was taken.
    Taken,
    /// It was weighed with what was kept, from which it was so many σ away.
    Fused {
        /// How far.
        sigmas: f64,
    },
    /// It differs from what was kept by so many σ: one of them is wrong, and the azimuth is withdrawn.
    Disagrees {
        /// How far.
        sigmas: f64,
    },
}

/// An azimuth with its standard deviation, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Azimuth {
    /// Of body x from north, clockwise from above, [0, 2π).
    pub angle: f64,
    /// Its 1σ.
    pub sigma: f64,
}

/// An azimuth that is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Heading {
    /// Azimuth of the level frame's x, rad.
    frame: f64,
    /// Variance of what was handed over, rad².
    variance: f64,
    /// 1σ of the scale, and of an unknown ramp of the bias, rad/s².
    scale: f64,
    ramp: f64,
}

impl Heading {
    /// Begins with an azimuth of body x.
    pub(super) fn begin(handover: Handover, gyro: &Gyro, vertical: &mut Vertical) -> Self {
        vertical.begin_course();
        Self {
            frame: wrapped(handover.azimuth - course(vertical)),
            variance: handover.sigma * handover.sigma,
            scale: gyro.scale_sigma,
            ramp: gyro.noise.rate_ramp,
        }
    }

    /// The azimuth of body x now.
    pub(super) fn azimuth(&self, vertical: &Vertical) -> Azimuth {
        let angle = wrapped(self.frame + course(vertical));
        Azimuth { angle, sigma: libm::sqrt(self.variance(vertical)) }
    }

    /// Azimuth of the level frame's x, rad.
    pub(super) fn frame(&self) -> f64 {
        self.frame
    }

    fn variance(&self, vertical: &Vertical) -> f64 {
        let motion = vertical.course();
        let scale = self.scale * f64::from(motion.turned);
        let ramp = self.ramp * f64::from(motion.ramp);
        self.variance + f64::from(vertical.turn_variance()) + scale * scale + ramp * ramp
    }

    /// Weighs a new alignment with what is kept.
    pub(super) fn realign(
        &mut self,
        handover: Handover,
        gyro: &Gyro,
        vertical: &mut Vertical,
    ) -> Realigned {
        let kept = self.azimuth(vertical);
        let off = difference(handover.azimuth, kept.angle);
        let (old, new) = (kept.sigma * kept.sigma, handover.sigma * handover.sigma);
        let sigmas = off.abs() / libm::sqrt(old + new);
        if sigmas > BOUND || sigmas.is_nan() {
            return Realigned::Disagrees { sigmas };
        }
        let azimuth = kept.angle + off * old / (old + new);
        let sigma = libm::sqrt(old * new / (old + new));
        *self = Self::begin(Handover { azimuth, sigma }, gyro, vertical);
        Realigned::Fused { sigmas }
    }
}

/// How the level frame turns, rad/s, on north, east and down, its x pointing so far from north: with the Earth
/// and, where the speed north and east is known, m/s, with the way over it.
pub(super) fn frame_rate(
    latitude: Latitude,
    north: Option<f64>,
    speed: Option<[f64; 2]>,
) -> [f32; 3] {
    let down = -latitude.vertical_rate();
    let Some(frame) = north else { return [0.0, 0.0, down as f32] };
    let [to_north, to_east] = speed.unwrap_or_default();
    let [along, across] = latitude.radii();
    let about_north = latitude.horizontal_rate() + to_east / across;
    let about_east = -to_north / along;
    let about_down = down - to_east / across * libm::tan(latitude.rad());
    let (sine, cosine) = libm::sincos(frame);
    let x = about_north * cosine + about_east * sine;
    let y = about_east * cosine - about_north * sine;
    [x as f32, y as f32, about_down as f32]
}

/// Course of body x on the level frame, rad.
fn course(vertical: &Vertical) -> f64 {
    let [course, ..] = attitude::angles(vertical.attitude().parts());
    course
}

/// The difference of two angles, rad, in [−π, π).
fn difference(a: f64, b: f64) -> f64 {
    wrapped(a - b + 0.5 * TURN) - 0.5 * TURN
}

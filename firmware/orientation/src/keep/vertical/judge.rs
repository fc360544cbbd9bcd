//! Looks at what happened: ten times a second at the forces, twice a second for a rest.

use super::filter::Filter;
use super::rest::{Means, WINDOW};
use super::stretch::Stretch;
use super::sums::{Rested, Window};
use super::{GRAVITY, Trust, Vector, Vertical};
use crate::keep::attitude::{self, Attitude};
use crate::math::rotation::{difference, scaled, sum, turned};

/// Time from one step of the filter to the next, s.
pub(super) const STRETCH: f32 = 0.1;
/// Time over which the first forces are averaged to begin with, s.
const START: f32 = 0.2;
/// 1σ of the tilt with which it begins, rad, and of that on the way: nobody says that the body stands.
const START_TILT: f32 = 0.05;
const MOVING_TILT: f32 = 0.2;
/// Tilt, 1σ, of a standing body by its mean force over a window, rad: wind and engine.
const STANDING_TILT: f32 = 3e-4;
/// How far wind and engine turn a body that stands, 1σ, rad: 4″.
const SHAKING: f32 = 2e-5;
/// Longest stretch of a rest whose mean rates are taken together, s.
const LONGEST_REST: f32 = 64.0;
/// Part of gravity below which a force is a free fall.
const FREE: f32 = 0.3;
/// Tilt, 1σ, at which the level counts as lost, rad.
const LOST: f32 = 0.1;
/// Acceleration, RMS, at which gravity is hardly told from it, m/s².
const COASTING: f32 = 1.0;

impl Vertical {
    /// Lets the filter look at what happened.
    #[inline(never)]
    pub(super) fn step(&mut self) {
        if self.trust == Trust::Starting || self.is_lost {
            return self.start();
        }
        let mut stretch = core::mem::take(&mut self.stretch);
        stretch.is_rest = self.rest.is_at_rest();
        self.filter.step(&stretch, &self.expected);
        self.judge(&stretch);
        if self.window.seconds >= WINDOW {
            self.look();
        }
        self.correct();
        self.attitude.normalise();
    }

    /// Takes the first forces for gravity, and those after all of the level was lost.
    fn start(&mut self) {
        self.stretch = Stretch::default();
        if self.window.forced < START {
            return;
        }
        let force = scaled(&self.window.impulse, 1.0 / self.window.forced);
        self.window = Window::default();
        let [course, ..] = attitude::angles(self.attitude.parts());
        self.attitude = Attitude::levelled(&force, course);
        self.matrix = self.attitude.matrix();
        let is_first = self.trust == Trust::Starting;
        self.filter.relevel(if is_first { START_TILT } else { MOVING_TILT });
        self.is_lost = false;
        self.trust = Trust::Level;
    }

    /// Says what of the level can be trusted.
    fn judge(&mut self, stretch: &Stretch) {
        let is_forced = stretch.forced > 0.5 * stretch.seconds;
        self.trust = if self.filter.tilt_sigma() > LOST {
            Trust::RotationLost
        } else if !is_forced {
            Trust::NoForce
        } else if stretch.force() < FREE * GRAVITY {
            Trust::FreeFall
        } else if self.filter.force() > COASTING {
            Trust::Coasting
        } else {
            Trust::Level
        };
    }

    /// Looks whether the body stands; if so, its rates are the biases and its force is gravity.
    fn look(&mut self) {
        let window = core::mem::take(&mut self.window);
        let per_second = 1.0 / window.seconds;
        let rate = scaled(&window.turned, per_second);
        let force = (window.forced > 0.0).then(|| scaled(&window.impulse, 1.0 / window.forced));
        let variances = self.filter.bias_variances();
        let means = Means { rate, force };
        if !self.rest.push(means, self.bias, variances, self.expected.walk) {
            self.course.drive(&window);
            self.learn_biases();
            self.rested.due = 0.0;
            return;
        }
        self.course.stand(window.seconds);
        self.stand(&window, force);
        // The body did not turn: what the gyro made of it is undone.
        self.attitude.correct(&[0.0, 0.0, -window.about]);
    }

    fn stand(&mut self, window: &Window, force: Option<Vector>) {
        self.filter.stand();
        self.rested.seconds += window.seconds;
        self.rested.turned = sum(&self.rested.turned, &window.turned);
        if self.rested.seconds >= self.rested.due {
            self.rested.due = (2.0 * self.rested.seconds).min(LONGEST_REST);
            self.learn_biases();
        }
        if let Some(force) = force {
            let [north, east, down] = turned(&self.matrix, &force);
            let variance = STANDING_TILT * STANDING_TILT;
            self.filter.measure(0, east / down, variance);
            self.filter.measure(1, -north / down, variance);
        }
    }

    /// The mean rates of a rest are the biases.
    pub(super) fn learn_biases(&mut self) {
        let Rested { seconds, turned, .. } = self.rested;
        if seconds <= 0.0 {
            return;
        }
        (self.rested.seconds, self.rested.turned) = (0.0, [0.0; 3]);
        let off = difference(&scaled(&turned, 1.0 / seconds), &self.bias);
        for (axis, off) in off.into_iter().enumerate() {
            let variance = self.rest_variance(axis, seconds);
            self.filter.measure(Filter::bias(axis), off, variance);
        }
        if !self.knows_north {
            self.doubt_level_biases();
        }
    }

    /// Variance of a mean rate over so many seconds of a rest, (rad/s)².
    pub(super) fn rest_variance(&self, axis: usize, seconds: f32) -> f32 {
        let shaking = SHAKING / seconds;
        self.expected.walk[axis] / seconds + 2.0 * shaking * shaking
    }

    /// As long as nobody knows where north is, what rests show of a bias has the Earth's level rate in it, and at
    /// another heading another part of it.
    fn doubt_level_biases(&mut self) {
        for (axis, cosine) in self.matrix[2].into_iter().enumerate() {
            self.filter.limit_bias(axis, self.unknown * (1.0 - cosine * cosine));
        }
    }

    /// Puts attitude and biases right.
    pub(super) fn correct(&mut self) {
        let [rotation, bias] = self.filter.take();
        self.attitude.correct(&rotation);
        self.matrix = self.attitude.matrix();
        self.bias = bounded(&sum(&self.bias, &bias), &self.greatest);
    }
}

/// The vector with each component within its bound.
fn bounded(vector: &Vector, bounds: &Vector) -> Vector {
    core::array::from_fn(|axis| vector[axis].max(-bounds[axis]).min(bounds[axis]))
}

//! Looks at what happened: ten times a second at the forces, twice a second for a rest.

use super::filter::Filter;
use super::rest::{Known, Means, WINDOW};
use super::stretch::Stretch;
use super::sums::{Rested, Window};
use super::{GRAVITY, Trust, Vector, Vertical};
use crate::keep::attitude::{self, Attitude};
use crate::math::rotation::{difference, dot, scaled, sum, turned};

/// Time from one step of the filter to the next, s.
pub(super) const STRETCH: f32 = 0.1;
/// Time over which the first forces are averaged to begin with, s.
const START: f32 = 0.2;
/// 1σ of the tilt with which it begins, rad, and of that on the way: nobody says that the body stands.
const START_TILT: f32 = 0.05;
const MOVING_TILT: f32 = 0.4;
/// Tilt, 1σ, of a standing body by its mean force over a window, rad: wind and engine.
const STANDING_TILT: f32 = 3e-4;
/// How far wind turns a body that stands, its engine off, 1σ, rad: 2″.
const SHAKING: f32 = 1e-5;
/// Longest stretch of a rest whose mean rates are taken together, s.
const LONGEST_REST: f32 = 64.0;
/// Part of gravity below which a force is a free fall.
const FREE: f32 = 0.3;
/// Tilt, 1σ, at which the level counts as lost, rad.
const LOST: f32 = 0.1;
/// Acceleration, RMS, at which gravity is hardly told from it, m/s².
const COASTING: f32 = 1.0;

/// How far gravity may be from the standard, m/s²: 9.78 on the equator, 9.83 at the poles.
const GRAVITY_CHANGE: f32 = 0.03;
/// Standard deviations of the level by which a force at rest may be beside gravity.
const SIGMAS: f32 = 4.0;
/// Part of gravity by which a force points down where the level stands on its head, and for how long, s: a body that
/// is pushed down so hard falls 29 m meanwhile.
const UPSIDE_DOWN: f32 = 0.5;
const HEADLONG: f32 = 2.0;
/// Part of gravity by which the first forces may differ from it.
const BEGINNING: f32 = 0.5;

impl Vertical {
    /// Lets the filter look at what happened.
    #[inline(never)]
    pub(super) fn step(&mut self) {
        if self.trust == Trust::Starting || self.is_lost {
            return self.start();
        }
        let mut stretch = core::mem::take(&mut self.stretch);
        stretch.is_rest = self.rest.is_at_rest();
        stretch.hidden = if self.knows_north { 0.0 } else { 2.0 * self.unknown };
        self.filter.step(&stretch, &self.expected);
        self.judge(&stretch);
        self.check_head(&stretch);
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
        // A body that falls or is thrown shows no level.
        if (libm::sqrtf(dot(&force, &force)) - GRAVITY).abs() > BEGINNING * GRAVITY {
            return;
        }
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
        let known = Known {
            biases: self.bias,
            variances: self.filter.bias_variances(),
            walk: self.expected.walk,
        };
        let is_gravity = force.is_some_and(|force| self.is_gravity(&force));
        let was_rest = self.is_at_rest();
        if !self.rest.push(Means { rate, force, is_gravity }, &known) {
            return self.move_on(&window, was_rest);
        }
        if let Some(force) = force.filter(|_| !was_rest && !is_gravity) {
            self.lose_level(&turned(&self.matrix, &force));
        }
        self.course.stand(window.seconds);
        self.stand(&window, force);
        // The body did not turn: what the gyro made of it is undone.
        self.attitude.correct(&[0.0, 0.0, -window.about]);
    }

    /// The body goes, or goes on. As long as nobody knows where north is, the biases hold what the Earth turned it by at
    /// rest, which is another rate as soon as it turns.
    fn move_on(&mut self, window: &Window, was_rest: bool) {
        self.course.drive(window);
        self.learn_biases();
        self.rested.due = 0.0;
        if was_rest && !self.knows_north {
            self.doubt_biases();
        }
    }

    pub(super) fn doubt_biases(&mut self) {
        for axis in 0..3 {
            self.filter.doubt(Filter::bias(axis), 2.0 * self.unknown);
        }
    }

    /// Whether a mean force is gravity as the attitude has it, as far as that can be told.
    fn is_gravity(&self, force: &Vector) -> bool {
        let off = sum(force, &scaled(&self.matrix[2], GRAVITY));
        let bound = SIGMAS * GRAVITY * self.sigma() + GRAVITY_CHANGE;
        dot(&off, &off) <= bound * bound
    }

    /// The level is not where it was believed to be, but where this force on it says.
    fn lose_level(&mut self, force: &Vector) {
        let [about_north, about_east] = tilt(force);
        let square = about_north * about_north + about_east * about_east;
        self.filter.doubt(0, square);
        self.filter.doubt(1, square);
    }

    /// Looks whether the level stands on its head: no vehicle is pushed down for so long.
    fn check_head(&mut self, stretch: &Stretch) {
        let is_wrong = stretch.impulse[2] > UPSIDE_DOWN * GRAVITY * stretch.seconds;
        self.headlong = if is_wrong { self.headlong + stretch.seconds } else { 0.0 };
        if self.headlong > HEADLONG {
            self.headlong = 0.0;
            self.lose_level(&stretch.impulse);
            self.take_for_gravity(&stretch.impulse);
            self.filter.doubt(0, START_TILT * START_TILT);
            self.filter.doubt(1, START_TILT * START_TILT);
        }
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
            self.take_for_gravity(&turned(&self.matrix, &force));
        }
    }

    /// A force on the level frame is gravity.
    fn take_for_gravity(&mut self, force: &Vector) {
        for (place, off) in tilt(force).into_iter().enumerate() {
            self.filter.measure(place, off, STANDING_TILT * STANDING_TILT);
        }
    }

    /// The mean rates of a rest are the biases.
    pub(super) fn learn_biases(&mut self) {
        let Rested { seconds, turned, .. } = self.rested;
        if seconds <= 0.0 {
            return;
        }
        (self.rested.seconds, self.rested.turned) = (0.0, [0.0; 3]);
        self.rest.learnt();
        let off = difference(&scaled(&turned, 1.0 / seconds), &self.bias);
        for (axis, off) in off.into_iter().enumerate() {
            let variance = self.rest_variance(axis, seconds);
            self.filter.measure(Filter::bias(axis), off, variance);
        }
    }

    /// Variance of a mean rate over so many seconds of a rest, (rad/s)².
    pub(super) fn rest_variance(&self, axis: usize, seconds: f32) -> f32 {
        let shaking = SHAKING / seconds;
        self.expected.walk[axis] / seconds + 2.0 * shaking * shaking
    }

    /// Puts attitude and biases right.
    pub(super) fn correct(&mut self) {
        let [rotation, bias] = self.filter.take();
        self.attitude.correct(&rotation);
        self.matrix = self.attitude.matrix();
        self.bias = bounded(&sum(&self.bias, &bias), &self.greatest);
    }
}

/// By how much a force on the level frame shows that it is turned, about north and east, rad: up to half a turn.
fn tilt([north, east, down]: &Vector) -> [f32; 2] {
    let across = libm::sqrtf(north * north + east * east);
    let angle = libm::atan2f(across, -down);
    let part = if across > 0.0 { angle / across } else { 0.0 };
    [-part * east, part * north]
}

/// The vector with each component within its bound.
fn bounded(vector: &Vector, bounds: &Vector) -> Vector {
    core::array::from_fn(|axis| vector[axis].max(-bounds[axis]).min(bounds[axis]))
}

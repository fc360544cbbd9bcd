//! A base that sways from power-on: its gyros' biases, which no rest shows, from the mean rates while an alignment ran.
//!
//! A base that stands with a bias of its vertical gyro and one that circles at a constant speed look alike to gyros and
//! accelerometers. An alignment on a standing base that has found north tells them apart: its base stood. The mean rates over
//! that time are the biases, within the sway over the time. They are averaged in parts, each as long as all before: a part
//! with another mean rate than before begins the average anew, since the base was turned.

use super::Vertical;
use super::filter::{BIAS, TURN};
use super::sums::{Turned, Window};
use crate::math::quaternion::Matrix;
use crate::math::rotation::{difference, dot};

/// Angle by which a base sways that is aligned, 1σ, rad: half a degree.
const SWAY: f32 = 1e-2;
/// Least time in which sway is averaged, s.
const LEAST: f32 = 20.0;
/// Significance, in σ, at which two mean rates are different ones.
const BOUND: f32 = 3.0;

impl Turned {
    /// Whether the mean rates of a shorter time are others than these.
    fn is_other(&self, than: &Self) -> bool {
        let least = self.seconds.min(than.seconds);
        let bound = BOUND * 2.0 * SWAY / least;
        difference(&self.rates(), &than.rates()).iter().any(|beside| beside.abs() > bound)
    }
}

/// Mean rates since the start, or since the base was last turned.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SwayAverage {
    /// All parts that are over.
    before: Turned,
    /// The part in progress.
    part: Turned,
}

impl SwayAverage {
    /// Adds a window.
    pub(super) fn push(&mut self, window: &Window) {
        self.part.add(window.seconds, &window.turned);
        if self.part.seconds >= self.before.seconds {
            self.close();
        }
    }

    /// Ends the part in progress, where it is long enough for a mean.
    fn close(&mut self) {
        if self.part.seconds < LEAST {
            return;
        }
        let part = core::mem::take(&mut self.part);
        if self.before.seconds > 0.0 && self.before.is_other(&part) {
            self.before = Turned::default();
        }
        self.before.add(part.seconds, &part.angles);
    }
}

impl Vertical {
    /// Learns biases and level of a base that has never rested, but stood as an alignment has shown. What the filter made of
    /// them is dropped, and the turn that its error of the vertical gyro's bias has made is taken back.
    pub(crate) fn learn_from_sway(&mut self) {
        self.sway.close();
        let mean = core::mem::take(&mut self.sway).before;
        if !self.has_unlearnt_bias() || mean.seconds < LEAST {
            return;
        }
        self.finish();
        self.break_off();
        let biases = mean.rates();
        let variances = core::array::from_fn(|axis| self.sway_variance(axis, mean.seconds));
        let since = self.course.moved;
        let about = since * dot(&self.matrix[2], &difference(&biases, &self.bias));
        self.attitude.correct(&[0.0, 0.0, -about]);
        self.course.turned -= about;
        self.filter.inflate(TURN, since * since * dot(&self.matrix[2], &variances));
        for (axis, variance) in variances.into_iter().enumerate() {
            self.filter.reset(BIAS + axis, variance);
            self.filter.reset_axis(axis, self.expected.scale[axis]);
        }
        (self.bias, self.axes) = (biases, Matrix::default());
        self.matrix = self.attitude.rough_matrix();
        if let Some(force) = self.rest.latest_force() {
            self.level_by(&force, SWAY);
        }
        self.course.stood = mean.seconds;
    }

    /// Variance of a mean rate over `seconds` of sway as a bias, (rad/s)². The Earth rate that it may contain is level.
    fn sway_variance(&self, axis: usize, seconds: f32) -> f32 {
        let drift = self.expected.drift[axis] * seconds;
        let level = 1.0 - self.matrix[2][axis] * self.matrix[2][axis];
        self.mean_variance(axis, seconds, SWAY) + drift + 2.0 * level * self.hidden()
    }

    /// Whether neither a rest nor an alignment has shown the gyros' biases.
    pub(crate) fn has_unlearnt_bias(&self) -> bool {
        self.course.stood <= 0.0
    }

    /// Variance of what the vertical gyro's bias turns the azimuth by since its error counts, rad², where no rest has shown
    /// it: only what is stated of it counts then, and the filter's estimate, whose σ is too small since its level errs
    /// with it, is an error as a whole.
    pub(super) fn unlearnt_variance(&self) -> f32 {
        let turned = if self.has_unlearnt_bias() { self.course.moved } else { 0.0 };
        let [.., bias] = self.bias;
        (self.priors[2] + bias * bias) * turned * turned
    }
}

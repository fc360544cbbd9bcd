//! Gyrovertical filter: a Kalman filter of seventeen states that corrects tilt, biases and axes by
//! gravity, ten times a second.
//!
//! The states are errors: of the attitude about north, east and down; of the three gyros' biases on
//! the body's axes; of their scale factors and the directions of their axes, nine numbers; and of
//! the velocity, north and east, that the forces integrate to. A body does not travel far for long,
//! so its velocity is about zero, within what it lately showed (zero-velocity pseudo-measurement):
//! that alone separates gravity from acceleration ([`super::motion`]). A lasting velocity fades
//! from the state, because it carries no information on the tilt.
//!
//! Errors of scale and axes accumulate as long as a body turns one way, and cancel when it turns
//! back: they are not noise, but states that gravity shows. They are estimated for the level only.
//! Gravity does not observe the heading, and axis errors that motion makes it estimate wrongly
//! would remain in the heading for good.

use super::floor::{Floor, Verdict};
use super::motion::{FADING, LEAST_SPEED, Motion};
use super::stretch::Stretch;
use crate::attitude::setting::Setting;
use crate::math::quaternion::Vector;
use crate::math::rotation::dot;

/// Number of states.
const STATES: usize = 17;
/// Index of the rotation about the vertical.
pub(crate) const TURN: usize = 2;
/// Index of the first bias.
pub(crate) const BIAS: usize = 3;
/// Index of the first scale and axis error: the excess of each gyro per rotation about each axis,
/// row by row.
const AXES: usize = 6;
/// Index of the first velocity.
const VELOCITY: usize = 15;
/// Noise density of the forces, m/s²/√Hz: 100 µg/√Hz.
const FORCE_NOISE: f32 = 1e-3;
/// Error of the accelerometers that changes as the body turns, m/s²: 1 % of gravity, by scale and
/// axes.
const FORCE_SCALE: f32 = 0.1;

/// Part of a gyro's configured error of scale and axes that is constant and can be estimated; the
/// rest changes with rate, acceleration and temperature.
const CONSTANT_PART: f32 = 0.4;
/// Correlation time of an error of scale and axes, s.
const RENEWAL: f32 = 1000.0;
/// Time for which a body turns one way before it turns back, s: variable errors of scale and axes
/// accumulate until then.
const SWING: f32 = 0.5;
/// Relative rounding error of a variance.
const ROUNDING: f32 = 1e-6;
/// Time in which a quickly turning body shows the full Earth rate on every axis, s.
const TURNING: f32 = 30.0;
/// Duration of a bend, s.
const BEND: f32 = 10.0;
/// Variance of an unknown angle, rad²: a turn squared. A larger value would only cost digits.
const ANY_ANGLE: f32 = 40.0;
/// Time in which a bias that the floor shows gets a variance larger by a factor of e, s.
const WIDENING: f32 = 4.0;
/// Averaging time of the balance between growth and reduction of the level's variance, s.
const WATCH: f32 = 5.0;

/// States that a stretch changes: tilt, rotation and velocity.
const CARRIED: [usize; 5] = [0, 1, TURN, VELOCITY, VELOCITY + 1];

/// A vector of all states.
type States = [f32; STATES];

/// Expected errors of the gyros, as variances.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Expected {
    /// Squared angle random walk, rad²/s.
    pub walk: [f32; 3],
    /// Squared drift of a bias, (rad/s)²/s.
    pub drift: [f32; 3],
    /// Squared error of scale and axes.
    pub scale: [f32; 3],
}

impl Expected {
    /// Expected errors of the gyros of a setting, as variances.
    pub(super) fn of(setting: &Setting) -> Self {
        let squared = |part: f32| part * part;
        Self {
            walk: setting.gyros.map(|gyro| squared(gyro.noise.angle_random_walk.0 as f32)),
            drift: setting.gyros.map(|gyro| gyro.drift() as f32),
            scale: setting.gyros.map(|gyro| squared(gyro.scale_sigma as f32)),
        }
    }
}

/// Corrections that the filter found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Correction {
    /// Rotation of the attitude about north, east and down, rad.
    pub(super) rotation: [f32; 3],
    /// Change of the biases, rad/s.
    pub(super) bias: [f32; 3],
    /// Change of scale factors and axes, one row for each gyro.
    pub(super) axes: [[f32; 3]; 3],
}

/// Recent change of the level's variance, rad²/s.
#[derive(Clone, Copy, Debug, Default)]
struct Balance {
    /// Growth by the gyros' errors.
    grown: f32,
    /// Reduction by gravity.
    gained: f32,
}

/// State of the filter.
#[derive(Clone, Debug, Default)]
pub(crate) struct Filter {
    /// Covariance of the states.
    covariance: [States; STATES],
    /// Velocity north and east that the forces integrate to, m/s.
    velocity: [f32; 2],
    /// Statistics of the motion.
    pub(super) motion: Motion,
    /// Low-passed force, as a check of the vertical.
    floor: Floor,
    /// Balance of the level's variance.
    balance: Balance,
    /// Corrections that have not been applied yet.
    correction: States,
}

impl Filter {
    /// Filter with these 1σ of the gyros' biases, rad/s, before the level is set.
    pub(crate) fn new(biases: [f32; 3], expected: &Expected) -> Self {
        let mut filter = Self::default();
        for (axis, bias) in biases.into_iter().enumerate() {
            filter.reset(BIAS + axis, bias * bias);
            filter.reset_axis(axis, expected.scale[axis]);
        }
        filter.reset(0, ANY_ANGLE);
        filter.reset(1, ANY_ANGLE);
        filter.stand();
        filter
    }

    /// First half of the propagation over a stretch: coupling of the tilt to the gyros' excess, by
    /// bias, and by scale and axis for every rate.
    pub(crate) fn carry(&mut self, stretch: &Stretch) {
        let rates = stretch.rates();
        let (tilts, others) = self.covariance.split_at_mut(BIAS);
        let [north, east, down] = &stretch.attitude;
        for axis in 0..3 {
            let mut excess = others[axis];
            for (rate, place) in rates.iter().zip(axes(axis)) {
                subtract(&mut excess, -rate, &others[place - BIAS]);
            }
            subtract(&mut tilts[0], north[axis], &excess);
            subtract(&mut tilts[1], east[axis], &excess);
            if !stretch.is_rest {
                subtract(&mut tilts[TURN], down[axis], &others[axis]);
            }
        }
    }

    /// Second half of the propagation: the velocity, the symmetric part, and the process noise.
    pub(crate) fn spread(&mut self, stretch: &Stretch, expected: &Expected) {
        let kept = 1.0 - stretch.seconds / FADING;
        for (velocity, impulse) in self.velocity.iter_mut().zip(stretch.impulse) {
            *velocity = *velocity * kept + impulse;
        }
        let [.., down] = stretch.impulse;
        let (tilts, others) = self.covariance.split_at_mut(BIAS);
        let velocities = &mut others[VELOCITY - BIAS..];
        for (velocity, (tilt, force)) in velocities.iter_mut().zip([(1, down), (0, -down)]) {
            for part in velocity.iter_mut() {
                *part *= kept;
            }
            subtract(velocity, -force, &tilts[tilt]);
        }
        let before = self.level_variance();
        self.even_out(stretch, kept);
        self.add_noise(stretch, expected);
        let grown = (self.level_variance() - before) / stretch.seconds;
        let part = (stretch.seconds / WATCH).min(1.0);
        self.balance.grown += part * (grown.max(0.0) - self.balance.grown);
        self.balance.gained -= part * self.balance.gained;
    }

    /// Propagates tilt and velocity with each other, whose rows alone were propagated before, and
    /// copies the rows to the columns.
    fn even_out(&mut self, stretch: &Stretch, kept: f32) {
        let rates = stretch.rates();
        let [about_north, about_east, about_down] = &stretch.attitude;
        let [.., down] = stretch.impulse;
        for row in CARRIED {
            let row = &mut self.covariance[row];
            let [x, y, z, a, b, c, d, e, f, g, h, i] = row[BIAS..VELOCITY] else { return };
            let excess = [
                x + dot(&rates, &[a, b, c]),
                y + dot(&rates, &[d, e, f]),
                z + dot(&rates, &[g, h, i]),
            ];
            row[0] -= dot(about_north, &excess);
            row[1] -= dot(about_east, &excess);
            if !stretch.is_rest {
                row[TURN] -= dot(about_down, &[x, y, z]);
            }
            row[VELOCITY] = kept * row[VELOCITY] + down * row[1];
            row[VELOCITY + 1] = kept * row[VELOCITY + 1] - down * row[0];
        }
        for row in CARRIED {
            let carried = self.covariance[row];
            for (other, value) in self.covariance.iter_mut().zip(&carried) {
                other[row] = *value;
            }
        }
    }

    /// Adds the process noise of a stretch.
    fn add_noise(&mut self, stretch: &Stretch, expected: &Expected) {
        self.add_turn_noise(stretch, expected);
        let square = stretch.rate_squares.iter().sum::<f32>();
        self.add_drift(stretch, expected, square);
        // A body that keeps its attitude shows a constant error: that is a tilt, not noise.
        let turned = (square / stretch.seconds * SWING * SWING).min(1.0);
        let scale_noise = FORCE_SCALE * FORCE_SCALE * SWING * turned;
        for place in [VELOCITY, VELOCITY + 1] {
            self.covariance[place][place] +=
                (FORCE_NOISE * FORCE_NOISE + scale_noise) * stretch.seconds;
        }
    }

    /// Process noise of the attitude: the gyros' random walk, and variable errors of scale and
    /// axes.
    fn add_turn_noise(&mut self, stretch: &Stretch, expected: &Expected) {
        let scale = SWING * self.floor.strain();
        let variances: [f32; 3] = core::array::from_fn(|axis| {
            let swung = scale * expected.scale[axis] * stretch.rate_squares[axis];
            expected.walk[axis] * stretch.seconds + swung
        });
        let [about_north, about_east, _] =
            stretch.attitude.map(|row| weighed(&row, &variances, stretch));
        // The scale error of the down gyro over a turn is accounted for in heading hold.
        let [x, y, _] = variances;
        let own = expected.walk[2] * stretch.seconds;
        let about_down = weighed(&stretch.attitude[2], &[x, y, own], stretch);
        let about_down = if stretch.is_rest { 0.0 } else { about_down + self.slanted(stretch) };
        for (place, more) in [about_north, about_east, about_down].into_iter().enumerate() {
            self.covariance[place][place] += more;
        }
    }

    /// Process noise of biases and axes, for a body whose squared rates integrate to `square`,
    /// rad²/s.
    fn add_drift(&mut self, stretch: &Stretch, expected: &Expected, square: f32) {
        // A body that quickly turns to and fro leaves only the mean of it.
        let turned = (BEND * square).min(stretch.seconds / TURNING);
        for axis in 0..3 {
            let more = expected.drift[axis] * stretch.seconds + stretch.hidden * turned;
            self.covariance[BIAS + axis][BIAS + axis] += more;
            let renewed = lasting(expected.scale[axis]) * (stretch.seconds / RENEWAL);
            for place in axes(axis) {
                self.covariance[place][place] += renewed;
            }
        }
    }

    /// Effect of a wrong level on a turn: half its square is missing from the turn, with one sign
    /// for the duration of a bend.
    fn slanted(&self, stretch: &Stretch) -> f32 {
        let square = self.covariance[0][0].max(self.covariance[1][1]);
        0.25 * square * square * BEND * stretch.rate_squares.iter().sum::<f32>()
    }

    /// Observes the motion, and compares the floor's vertical; returns the mean force on the level
    /// frame, m/s², where the filter's vertical is wrong beyond repair.
    pub(crate) fn watch(&mut self, stretch: &Stretch) -> Option<Vector> {
        let size = stretch.force();
        self.motion.watch(stretch, size, &self.floor.mean);
        self.floor.watch(stretch, size);
        let tilt = 0.5 * self.level_variance();
        let Verdict { more, is_biased } = self.floor.compare(tilt, &self.motion, stretch.seconds);
        self.inflate_level(more);
        if is_biased {
            for place in BIAS..AXES {
                self.covariance[place][place] *= 1.0 + stretch.seconds / WIDENING;
            }
        }
        if self.motion.is_tumbled() { self.floor.take_level() } else { None }
    }

    /// Zero-velocity pseudo-measurement for the velocity north (0) or east (1), over `seconds`.
    pub(crate) fn stay(&mut self, axis: usize, seconds: f32) {
        let before = self.level_variance();
        let density = self.motion.density(0.5 * before);
        self.measure(VELOCITY + axis, -self.velocity[axis], density / seconds);
        self.balance.gained += (before - self.level_variance()) / WATCH;
    }

    /// Updates the filter with a measurement of one state: its deviation, and the variance of that.
    pub(crate) fn measure(&mut self, place: usize, off: f32, variance: f32) {
        let column: States = core::array::from_fn(|row| self.covariance[row][place]);
        let whole = column[place] + variance;
        if whole <= 0.0 {
            return;
        }
        let part = 1.0 / whole;
        let off = (off - self.correction[place]) * part;
        subtract(&mut self.correction, -off, &column);
        for (row, covariance) in self.covariance.iter_mut().enumerate() {
            let before = covariance[row];
            subtract(covariance, column[row] * part, &column);
            // Rounding must not leave a negative variance of a state that is learnt almost
            // completely at once.
            covariance[row] = covariance[row].max(ROUNDING * before);
        }
        // The remaining variance of the measured state is a difference of nearly equal numbers, so
        // it is written as a product.
        let left = variance * part;
        for (row, before) in column.iter().enumerate() {
            self.covariance[row][place] = before * left;
            self.covariance[place][row] = before * left;
        }
    }

    /// Begins a rest: the velocity is zero.
    pub(crate) fn stand(&mut self) {
        self.velocity = [0.0; 2];
        self.motion.stand();
        self.floor.stand();
        for place in VELOCITY..STATES {
            self.reset(place, LEAST_SPEED * LEAST_SPEED);
        }
    }

    /// Takes the corrections, which count as applied from now on.
    pub(super) fn take(&mut self) -> Correction {
        let [a, b, c, x, y, z, axes @ .., north, east] = core::mem::take(&mut self.correction);
        self.velocity[0] += north;
        self.velocity[1] += east;
        let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = axes;
        Correction {
            rotation: [a, b, c],
            bias: [x, y, z],
            axes: [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]],
        }
    }

    /// Resets a gyro's scale and axis errors to the configured variance.
    pub(crate) fn reset_axis(&mut self, axis: usize, scale: f32) {
        for place in axes(axis) {
            self.reset(place, lasting(scale));
        }
    }

    /// Resets a state to this variance, and removes its correlations.
    pub(crate) fn reset(&mut self, place: usize, variance: f32) {
        for other in 0..STATES {
            self.covariance[place][other] = 0.0;
            self.covariance[other][place] = 0.0;
        }
        self.covariance[place][place] = variance;
        self.correction[place] = 0.0;
    }

    /// Reports that the level was set anew, with this 1σ, rad.
    pub(crate) fn relevel(&mut self, sigma: f32) {
        for place in 0..TURN {
            self.reset(place, sigma * sigma);
        }
        self.begin_balance();
        self.stand();
    }

    /// Restarts the balance, as if gravity had compensated all growth until now.
    pub(crate) fn begin_balance(&mut self) {
        self.balance.gained = self.balance.grown;
    }

    /// Inflates the variance of a state; that of an angle only up to a whole turn.
    pub(crate) fn inflate(&mut self, place: usize, variance: f32) {
        let own = &mut self.covariance[place][place];
        let room = if place <= TURN { (ANY_ANGLE - *own).max(0.0) } else { variance };
        *own += variance.min(room);
    }

    /// Inflates the variance of both tilts, rad².
    pub(crate) fn inflate_level(&mut self, variance: f32) {
        self.inflate(0, variance);
        self.inflate(1, variance);
    }

    /// Variance of a state including corrections that have not been applied yet.
    pub(crate) fn variance(&self, place: usize) -> f32 {
        let correction = self.correction[place];
        self.covariance[place][place].max(0.0) + correction * correction
    }

    /// Sum of the variances of both tilts, rad².
    fn level_variance(&self) -> f32 {
        self.covariance[0][0] + self.covariance[1][1]
    }

    /// Standard deviation of the greater tilt, 1σ, rad.
    pub(crate) fn tilt_sigma(&self) -> f32 {
        libm::sqrtf(self.variance(0).max(self.variance(1)))
    }

    /// Variances of the biases, (rad/s)².
    pub(crate) fn bias_variances(&self) -> [f32; 3] {
        core::array::from_fn(|axis| self.covariance[BIAS + axis][BIAS + axis].max(0.0))
    }

    /// Part of the growth of the level's variance that gravity lately compensated; one where there
    /// was no growth.
    pub(crate) fn share_of_gravity(&self) -> f32 {
        let Balance { grown, gained } = self.balance;
        if grown > 0.0 { gained / grown } else { 1.0 }
    }
}

/// Indices of scale factor and axis errors of a gyro.
fn axes(axis: usize) -> core::ops::Range<usize> {
    AXES + 3 * axis..AXES + 3 * axis + 3
}

/// Variance of the constant part of an error of scale and axes, from the whole.
fn lasting(scale: f32) -> f32 {
    CONSTANT_PART * CONSTANT_PART * scale
}

/// Variance about an axis of the level frame, from variances about the body's axes.
fn weighed(row: &[f32; 3], variances: &[f32; 3], stretch: &Stretch) -> f32 {
    let part = 1.0 / (stretch.seconds * stretch.seconds);
    let [x, y, z] = row.map(|cosine| cosine * cosine * part);
    x * variances[0] + y * variances[1] + z * variances[2]
}

/// Subtracts a multiple of another row from a row, four numbers at a time, because a loop costs as
/// much as its body.
#[inline(never)]
fn subtract(row: &mut States, factor: f32, other: &States) {
    let (fours, rest) = row.as_chunks_mut::<4>();
    let (other_fours, other_rest) = other.as_chunks::<4>();
    for ([a, b, c, d], [e, f, g, h]) in fours.iter_mut().zip(other_fours) {
        *a -= factor * e;
        *b -= factor * f;
        *c -= factor * g;
        *d -= factor * h;
    }
    for (part, other) in rest.iter_mut().zip(other_rest) {
        *part -= factor * other;
    }
}

//! What gravity tells of tilt, biases and axes: a Kalman filter of seventeen states, ten times a second.
//!
//! The states are errors: of the attitude about north, east and down; of the three gyros' biases on the body's
//! axes; of their scale factors and the directions of their axes, nine numbers; and of the velocity, north and east, that
//! the forces add up to. A body goes nowhere for long, so its velocity is about zero, to within what it lately showed:
//! that is all that tells gravity from acceleration ([`super::motion`]). A lasting velocity fades from the state, for it
//! says nothing of the tilt.
//!
//! Errors of scale and axes add up as long as a body turns one way, and come back when it turns back: they are no noise,
//! but a state that gravity shows. They are learnt for the level only. Gravity knows nothing of the heading, and what
//! motion makes it say wrongly of the axes would be carried there for good.

use super::Vector;
use super::floor::{Floor, Verdict};
use super::motion::{FADING, LEAST_SPEED, Motion};
use super::stretch::Stretch;
use crate::math::rotation::dot;

/// Number of states.
const STATES: usize = 17;
/// Where the turn about the vertical stands.
pub const TURN: usize = 2;
/// Where the biases begin.
const BIAS: usize = 3;
/// Where scale factors and axes begin: by how much of the turn about each axis each gyro shows too much, row by row.
const AXES: usize = 6;
/// Where the velocity begins.
const VELOCITY: usize = 15;
/// Noise of the forces, m/s²/√Hz: 100 µg.
const FORCE_NOISE: f32 = 1e-3;
/// Error of the accelerometers that changes as the body turns, m/s²: 1 % of gravity, by scale and axes.
const FORCE_SCALE: f32 = 0.1;

/// Part of a gyro's stated error of scale and axes that is the same all the time and can be learnt; the rest changes
/// with rate, acceleration and temperature.
const CONSTANT_PART: f32 = 0.4;
/// Time over which an error of scale and axes is renewed, s.
const RENEWAL: f32 = 1000.0;
/// For how long a body turns one way before it turns back, s: what changes of scale and axes adds up until then.
const SWING: f32 = 0.5;
/// Part of a variance that rounding may make of it.
const ROUNDING: f32 = 1e-6;
/// Time in which a body that turns quickly shows all of the Earth's rate on every axis, s.
const TURNING: f32 = 30.0;
/// For how long a bend lasts, s.
const BEND: f32 = 10.0;
/// Variance of an angle of which nothing is known, rad²: a turn's square. More would only cost digits.
const ANY_ANGLE: f32 = 40.0;
/// Time in which a bias that the floor shows becomes less certain by a factor of e in its variance, s.
const WIDENING: f32 = 4.0;
/// Time over which it is watched what gravity takes from the level's variance and what the gyros add, s.
const WATCH: f32 = 5.0;

/// The states that a stretch changes: tilt, turn and velocity.
const CARRIED: [usize; 5] = [0, 1, TURN, VELOCITY, VELOCITY + 1];

/// A vector of all states.
type States = [f32; STATES];

/// What of the gyros is to be expected, 1σ.
#[derive(Clone, Copy, Debug, Default)]
pub struct Expected {
    /// Angle random walk, squared, rad²/s.
    pub walk: [f32; 3],
    /// What a bias drifts, squared, (rad/s)²/s.
    pub drift: [f32; 3],
    /// Scale and axes, squared.
    pub scale: [f32; 3],
}

/// What is to be put right.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Correction {
    /// Of the attitude, about north, east and down, rad.
    pub(super) rotation: [f32; 3],
    /// Of the biases, rad/s.
    pub(super) bias: [f32; 3],
    /// Of scale factors and axes, a row a gyro.
    pub(super) axes: [[f32; 3]; 3],
}

/// What happened to the level's variance lately, rad²/s.
#[derive(Clone, Copy, Debug, Default)]
struct Balance {
    /// What the gyros' errors added.
    grown: f32,
    /// What gravity took.
    gained: f32,
}

/// The filter at work.
#[derive(Clone, Debug)]
pub struct Filter {
    covariance: [States; STATES],
    velocity: [f32; 2],
    motion: Motion,
    floor: Floor,
    balance: Balance,
    /// Corrections that are still to be taken.
    correction: States,
}

/// Setting up, and a step.
impl Filter {
    /// With these 1σ of the gyros' biases, rad/s; the level is not taken yet.
    #[must_use]
    pub fn new(biases: [f32; 3], expected: &Expected) -> Self {
        let mut filter = Self {
            covariance: [[0.0; STATES]; STATES],
            velocity: [0.0; 2],
            motion: Motion::default(),
            floor: Floor::default(),
            balance: Balance::default(),
            correction: [0.0; STATES],
        };
        for (axis, bias) in biases.into_iter().enumerate() {
            filter.forget_bias(axis, bias * bias);
            filter.forget_axis(axis, expected.scale[axis]);
        }
        filter.reset(0, ANY_ANGLE);
        filter.reset(1, ANY_ANGLE);
        filter.stand();
        filter
    }

    /// What the stretch adds to the errors, first half: how the tilt goes along with what each gyro shows too much, by
    /// its bias, and by its scale and axis of every rate.
    pub fn carry(&mut self, stretch: &Stretch) {
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

    /// The second half: how the velocity goes along, all of it as the other way round, and what is new.
    pub fn spread(&mut self, stretch: &Stretch, expected: &Expected) {
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

    /// Carries the errors of tilt and velocity with each other, whose rows alone are carried yet, and makes the columns
    /// like the rows.
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

    /// What the stretch adds that is new.
    fn add_noise(&mut self, stretch: &Stretch, expected: &Expected) {
        self.add_turn_noise(stretch, expected);
        let square = stretch.rate_squares.iter().sum::<f32>();
        self.add_drift(stretch, expected, square);
        // A body that keeps its attitude shows the same error all the time: a tilt, not noise.
        let turned = (square / stretch.seconds * SWING * SWING).min(1.0);
        let strayed = FORCE_SCALE * FORCE_SCALE * SWING * turned;
        for place in [VELOCITY, VELOCITY + 1] {
            self.covariance[place][place] +=
                (FORCE_NOISE * FORCE_NOISE + strayed) * stretch.seconds;
        }
    }

    /// Of the attitude: the gyros' random walk, and what changes of their scale and axes.
    fn add_turn_noise(&mut self, stretch: &Stretch, expected: &Expected) {
        let scale = SWING * self.floor.strain();
        let strays: [f32; 3] = core::array::from_fn(|axis| {
            let swung = scale * expected.scale[axis] * stretch.rate_squares[axis];
            expected.walk[axis] * stretch.seconds + swung
        });
        let [about_north, about_east, _] =
            stretch.attitude.map(|row| weighed(&row, &strays, stretch));
        // What the gyro of the down axis makes of the turn by its scale, who keeps the turn accounts for.
        let [x, y, _] = strays;
        let own = expected.walk[2] * stretch.seconds;
        let about_down = weighed(&stretch.attitude[2], &[x, y, own], stretch);
        let about_down = if stretch.is_rest { 0.0 } else { about_down + self.slanted(stretch) };
        for (place, more) in [about_north, about_east, about_down].into_iter().enumerate() {
            self.covariance[place][place] += more;
        }
    }

    /// Of biases and axes, of a body whose squared rates add up to this, rad²/s.
    fn add_drift(&mut self, stretch: &Stretch, expected: &Expected, square: f32) {
        // A body that turns to and fro quickly leaves of it only its mean.
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

    /// What a wrong level makes of a turn: half its square is missing of it, the same way round for as long as a bend
    /// lasts.
    fn slanted(&self, stretch: &Stretch) -> f32 {
        let square = self.covariance[0][0].max(self.covariance[1][1]);
        0.25 * square * square * BEND * stretch.rate_squares.iter().sum::<f32>()
    }

    /// Looks how the body moves, and where the floor has its vertical: the mean force on the level frame, m/s², where the
    /// filter's has nothing to do with it.
    pub fn watch(&mut self, stretch: &Stretch) -> Option<Vector> {
        let size = stretch.force();
        self.motion.watch(stretch, size, &self.floor.mean());
        self.floor.watch(stretch, size);
        let tilt = 0.5 * self.level_variance();
        let Verdict { more, is_biased } = self.floor.compare(tilt, &self.motion, stretch.seconds);
        self.doubt_level(more);
        if is_biased {
            for place in BIAS..AXES {
                self.covariance[place][place] *= 1.0 + stretch.seconds / WIDENING;
            }
        }
        if self.motion.is_tumbled() { self.floor.take_level() } else { None }
    }

    /// The body stays where it is, nearly: what its velocity north (0) or east (1) says, over so many seconds.
    pub fn stay(&mut self, axis: usize, seconds: f32) {
        let before = self.level_variance();
        let density = self.motion.density(0.5 * before);
        self.measure(VELOCITY + axis, -self.velocity[axis], density / seconds);
        self.balance.gained += (before - self.level_variance()) / WATCH;
    }

    /// Takes a measurement of one state: by how much it is off, and that number's variance.
    pub fn measure(&mut self, place: usize, off: f32, variance: f32) {
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
            // Of what is learnt at once almost to the end, rounding must not leave less than nothing.
            covariance[row] = covariance[row].max(ROUNDING * before);
        }
        // What is left of the measured state is a difference of nearly equal numbers: written as a product.
        let left = variance * part;
        for (row, before) in column.iter().enumerate() {
            self.covariance[row][place] = before * left;
            self.covariance[place][row] = before * left;
        }
    }
}

/// What becomes of the states from outside.
impl Filter {
    /// The body stands: whatever velocity it had is over.
    pub fn stand(&mut self) {
        self.velocity = [0.0; 2];
        self.motion.stand();
        self.floor.stand();
        for place in VELOCITY..STATES {
            self.reset(place, LEAST_SPEED * LEAST_SPEED);
        }
    }

    /// What is to be put right, which is known from now on.
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

    /// Counts the error of the turn about the vertical from now on.
    pub fn begin_turn(&mut self) {
        self.reset(TURN, 0.0);
    }

    /// Forgets a bias but for this variance, (rad/s)².
    pub fn forget_bias(&mut self, axis: usize, variance: f32) {
        self.reset(BIAS + axis, variance);
    }

    /// Forgets a gyro's scale and axis but for what is stated of them, squared.
    pub fn forget_axis(&mut self, axis: usize, scale: f32) {
        for place in axes(axis) {
            self.reset(place, lasting(scale));
        }
    }

    /// Forgets all of a state but for its variance.
    fn reset(&mut self, place: usize, variance: f32) {
        for other in 0..STATES {
            self.covariance[place][other] = 0.0;
            self.covariance[other][place] = 0.0;
        }
        self.covariance[place][place] = variance;
        self.correction[place] = 0.0;
    }

    /// The level was taken anew, with this 1σ, rad.
    pub fn relevel(&mut self, sigma: f32) {
        for place in 0..TURN {
            self.reset(place, sigma * sigma);
        }
        self.begin_balance();
        self.stand();
    }

    /// The body may be moving, at a speed that is not known yet.
    pub fn expect_motion(&mut self) {
        self.motion.expect_motion();
    }

    /// Watches from now on what gravity takes of what the gyros add, as if it had taken all until now.
    pub fn begin_balance(&mut self) {
        self.balance.gained = self.balance.grown;
    }

    /// Makes a state less certain by a variance; an angle until it may be any.
    pub fn inflate(&mut self, place: usize, variance: f32) {
        let own = &mut self.covariance[place][place];
        let room = if place <= TURN { (ANY_ANGLE - *own).max(0.0) } else { variance };
        *own += variance.min(room);
    }

    /// Makes both tilts less certain by a variance, rad².
    pub fn doubt_level(&mut self, variance: f32) {
        self.inflate(0, variance);
        self.inflate(1, variance);
    }
}

/// What is asked of it.
impl Filter {
    /// Variance of the turn about the vertical, rad².
    #[must_use]
    pub fn turn_variance(&self) -> f32 {
        self.variance(TURN)
    }

    /// Variance of a state as it stands: what is still to be put right counts as an error.
    fn variance(&self, place: usize) -> f32 {
        let correction = self.correction[place];
        self.covariance[place][place].max(0.0) + correction * correction
    }

    /// Variances of both tilts together, rad².
    fn level_variance(&self) -> f32 {
        self.covariance[0][0] + self.covariance[1][1]
    }

    /// 1σ of the greater tilt, rad.
    #[must_use]
    pub fn tilt_sigma(&self) -> f32 {
        libm::sqrtf(self.variance(0).max(self.variance(1)))
    }

    /// Variances of the biases, (rad/s)².
    #[must_use]
    pub fn bias_variances(&self) -> [f32; 3] {
        core::array::from_fn(|axis| self.covariance[BIAS + axis][BIAS + axis].max(0.0))
    }

    /// Whether the body is tumbled about, or was lately turned as no vehicle on wheels is.
    #[must_use]
    pub fn is_tumbled(&self) -> bool {
        self.motion.is_tumbled()
    }

    /// Where the bias of an axis stands among the states.
    #[must_use]
    pub fn bias(axis: usize) -> usize {
        BIAS + axis
    }

    /// What part gravity lately took of what the gyros' errors added to the level's variance; one where they added
    /// nothing.
    #[must_use]
    pub fn share_of_gravity(&self) -> f32 {
        let Balance { grown, gained } = self.balance;
        if grown > 0.0 { gained / grown } else { 1.0 }
    }
}

/// Where scale factor and axis of a gyro stand among the states.
fn axes(axis: usize) -> core::ops::Range<usize> {
    AXES + 3 * axis..AXES + 3 * axis + 3
}

/// Variance of what lasts of an error of scale and axes, from the whole.
fn lasting(scale: f32) -> f32 {
    CONSTANT_PART * CONSTANT_PART * scale
}

/// What strays about the body's axes, squared, as it adds up about an axis of the level frame.
fn weighed(row: &[f32; 3], strays: &[f32; 3], stretch: &Stretch) -> f32 {
    let part = 1.0 / (stretch.seconds * stretch.seconds);
    let [x, y, z] = row.map(|cosine| cosine * cosine * part);
    x * strays[0] + y * strays[1] + z * strays[2]
}

/// Takes a multiple of another row from a row: four numbers at a time, for a loop costs as much as what it does.
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

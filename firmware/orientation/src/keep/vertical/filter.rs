//! What gravity tells of tilt and biases: a Kalman filter of eight states, ten times a second.
//!
//! The states are errors: of the attitude about north, east and down, of the three gyros' biases on
//! the body's axes, and of the velocity, north and east, that the forces add up to. A body goes
//! nowhere for long, so its velocity is about zero, to within what it lately showed: that is all that tells
//! gravity from acceleration. How fast the body moves and how quickly that changes are watched, so that a
//! hand that shakes and a vehicle that takes a bend each get the trust they deserve. A lasting velocity
//! fades from the state, for it says nothing of the tilt.

use super::stretch::Stretch;
use crate::math::rotation::turned;

/// Number of states.
const STATES: usize = 8;
/// Where the turn about the vertical stands.
pub const TURN: usize = 2;
/// Where the biases begin.
const BIAS: usize = 3;
/// Where the velocity begins.
const VELOCITY: usize = 6;
/// Time after which a velocity has faded, s: longer than hands and wheels take to come back.
const FADING: f32 = 10.0;
/// Time over which velocities are averaged to see the slow ones, s.
const SLOW: f32 = 3.0;
/// Time over which motion is watched, s.
const WATCH: f32 = 5.0;
/// Least speed that is allowed for, m/s, and least acceleration, m/s²: those of a body that stands.
const LEAST_SPEED: f32 = 0.03;
const LEAST_FORCE: f32 = 0.03;
/// Noise of the forces, m/s²/√Hz: 100 µg.
const FORCE_NOISE: f32 = 1e-3;
/// Error of the accelerometers that changes as the body turns, m/s²: 1 % of gravity, by scale and axes.
const FORCE_SCALE: f32 = 0.1;

/// For how long a body turns one way before it turns back, s: errors of scale and axes add up until then.
const SWING: f32 = 0.5;
/// Part of a variance that rounding may make of it.
const ROUNDING: f32 = 1e-6;
/// Time in which a body that turns quickly shows all of the Earth's rate on every axis, s.
const TURNING: f32 = 30.0;
/// For how long a bend lasts, s.
const BEND: f32 = 10.0;
/// Variance of an angle of which nothing is known, rad²: a turn's square. More would only cost digits.
const ANY_ANGLE: f32 = 40.0;

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

/// The filter at work.
#[derive(Clone, Debug)]
pub struct Filter {
    covariance: [States; STATES],
    velocity: [f32; 2],
    /// What the forces alone add up to, fading, m/s, and its mean over [`SLOW`].
    shown: [f32; 2],
    slow: [f32; 2],
    /// Mean squares of the velocity, m²/s², and of the horizontal force, m²/s⁴, lately.
    speed: f32,
    force: f32,
    /// Corrections that are still to be taken.
    correction: States,
}

impl Filter {
    /// With these 1σ of the gyros' biases, rad/s; the level is not taken yet.
    #[must_use]
    pub fn new(biases: [f32; 3]) -> Self {
        let mut covariance = [[0.0; STATES]; STATES];
        let speed = LEAST_SPEED * LEAST_SPEED;
        let [x, y, z] = biases;
        let start = [0.0, 0.0, 0.0, x, y, z, LEAST_SPEED, LEAST_SPEED];
        for (place, sigma) in start.into_iter().enumerate() {
            covariance[place][place] = sigma * sigma;
        }
        let force = LEAST_FORCE * LEAST_FORCE;
        Self {
            covariance,
            velocity: [0.0; 2],
            slow: [0.0; 2],
            shown: [0.0; 2],
            speed,
            force,
            correction: [0.0; STATES],
        }
    }

    /// What the stretch adds to the errors, and what the forces say of them.
    pub fn step(&mut self, stretch: &Stretch, expected: &Expected) {
        self.predict(stretch, expected);
        if stretch.forced > 0.0 {
            self.watch(stretch);
            self.stay(stretch.seconds);
        }
    }

    fn predict(&mut self, stretch: &Stretch, expected: &Expected) {
        let kept = 1.0 - stretch.seconds / FADING;
        for (velocity, impulse) in self.velocity.iter_mut().zip(stretch.impulse) {
            *velocity = *velocity * kept + impulse;
        }
        self.carry(stretch, kept);
        let strays: [f32; 3] = core::array::from_fn(|axis| {
            let swung = SWING * expected.scale[axis] * stretch.rate_squares[axis];
            expected.walk[axis] * stretch.seconds + swung
        });
        let [about_north, about_east, _] =
            stretch.attitude.map(|row| weighed(&row, &strays, stretch));
        // What the gyro of the down axis makes of the turn by its scale, who keeps the turn accounts for.
        let [x, y, _] = strays;
        let own = expected.walk[2] * stretch.seconds;
        let about_down = weighed(&stretch.attitude[2], &[x, y, own], stretch);
        let about_down = if stretch.is_rest { 0.0 } else { about_down + self.slanted(stretch) };
        // A body that keeps its attitude shows the same error all the time: a tilt, not noise.
        let rate = stretch.rate_squares.iter().sum::<f32>() / stretch.seconds;
        let strayed = FORCE_SCALE * FORCE_SCALE * SWING * (rate * SWING * SWING).min(1.0);
        let moved = (FORCE_NOISE * FORCE_NOISE + strayed) * stretch.seconds;
        // A body that turns to and fro quickly leaves of it only its mean.
        let turned = BEND * stretch.rate_squares.iter().sum::<f32>();
        let turned = turned.min(stretch.seconds / TURNING);
        let [x, y, z] =
            expected.drift.map(|drift| drift * stretch.seconds + stretch.hidden * turned);
        let more = [about_north, about_east, about_down, x, y, z, moved, moved];
        for (place, more) in more.into_iter().enumerate() {
            self.covariance[place][place] += more;
        }
    }

    /// What a wrong level makes of a turn: half its square is missing of it, the same way round for as long as a bend
    /// lasts.
    fn slanted(&self, stretch: &Stretch) -> f32 {
        let square = self.covariance[0][0].max(self.covariance[1][1]);
        0.25 * square * square * BEND * stretch.rate_squares.iter().sum::<f32>()
    }

    /// Carries the covariance on: tilt changes by the biases, velocity by the tilt.
    fn carry(&mut self, stretch: &Stretch, kept: f32) {
        for _ in 0..2 {
            for row in &mut self.covariance {
                *row = carried(row, stretch, kept);
            }
            self.transpose();
        }
        self.even_out();
    }

    fn transpose(&mut self) {
        for row in 1..STATES {
            for column in 0..row {
                let other = self.covariance[column][row];
                self.covariance[column][row] = self.covariance[row][column];
                self.covariance[row][column] = other;
            }
        }
    }

    /// Makes both halves the same again: no measurement ever shrinks what rounding makes them differ by.
    fn even_out(&mut self) {
        for row in 1..STATES {
            for column in 0..row {
                let mean = 0.5 * (self.covariance[column][row] + self.covariance[row][column]);
                self.covariance[column][row] = mean;
                self.covariance[row][column] = mean;
            }
        }
    }

    /// Watches how fast it moves. Velocities that come and go within a second hide no tilt, so the slow ones
    /// count.
    fn watch(&mut self, stretch: &Stretch) {
        let (part, kept) = (stretch.seconds / SLOW, 1.0 - stretch.seconds / FADING);
        for axis in 0..2 {
            self.shown[axis] = self.shown[axis] * kept + stretch.impulse[axis];
            self.slow[axis] += part * (self.shown[axis] - self.slow[axis]);
        }
        let [north, east] = self.slow;
        let [force_north, force_east, _] = stretch.impulse.map(|part| part / stretch.forced);
        let part = stretch.seconds / WATCH;
        let speed = 0.5 * (north * north + east * east);
        let force = 0.5 * (force_north * force_north + force_east * force_east);
        self.speed += part * (speed - self.speed);
        self.force += part * (force - self.force);
    }

    /// The body stays where it is, nearly.
    fn stay(&mut self, seconds: f32) {
        let [north, east] = self.slow;
        let now = north * north + east * east;
        let speed = self.speed.max(now).max(LEAST_SPEED * LEAST_SPEED);
        // As white noise of the density that slow velocities have.
        let variance = speed * 2.0 * SLOW / seconds;
        let [north, east] = self.velocity;
        self.measure(VELOCITY, -north, variance);
        self.measure(VELOCITY + 1, -east, variance);
    }

    /// Takes a measurement of one state: by how much it is off, and that number's variance.
    pub fn measure(&mut self, place: usize, off: f32, variance: f32) {
        let column: States = core::array::from_fn(|row| self.covariance[row][place]);
        let whole = column[place] + variance;
        if whole <= 0.0 {
            return;
        }
        let off = off - self.correction[place];
        for row in 0..STATES {
            let gain = column[row] / whole;
            self.correction[row] += gain * off;
            let before = self.covariance[row][row];
            for (part, other) in self.covariance[row].iter_mut().zip(column) {
                *part -= gain * other;
            }
            // Of what is learnt at once almost to the end, rounding must not leave less than nothing.
            let least = ROUNDING * before;
            self.covariance[row][row] = self.covariance[row][row].max(least);
        }
        // What is left of the measured state is a difference of nearly equal numbers: written as a product.
        for (row, before) in column.into_iter().enumerate() {
            let left = before * (variance / whole);
            self.covariance[row][place] = left;
            self.covariance[place][row] = left;
        }
    }

    /// The body stands: whatever velocity it had is over.
    pub fn stand(&mut self) {
        self.velocity = [0.0; 2];
        self.slow = [0.0; 2];
        self.shown = [0.0; 2];
        for place in VELOCITY..STATES {
            self.clear(place);
            self.covariance[place][place] = LEAST_SPEED * LEAST_SPEED;
        }
    }

    /// How far the attitude, about north, east and down, rad, and the biases, rad/s, are to be put right.
    pub fn take(&mut self) -> [[f32; 3]; 2] {
        let [a, b, c, x, y, z, north, east] = core::mem::take(&mut self.correction);
        self.velocity[0] += north;
        self.velocity[1] += east;
        [[a, b, c], [x, y, z]]
    }

    /// Counts the error of the turn about the vertical from now on.
    pub fn begin_turn(&mut self) {
        self.clear(TURN);
    }

    /// Forgets a bias but for this variance, (rad/s)².
    pub fn forget_bias(&mut self, axis: usize, variance: f32) {
        self.clear(BIAS + axis);
        self.covariance[BIAS + axis][BIAS + axis] = variance;
    }

    /// Forgets all of a state.
    fn clear(&mut self, place: usize) {
        for other in 0..STATES {
            self.covariance[place][other] = 0.0;
            self.covariance[other][place] = 0.0;
        }
        self.correction[place] = 0.0;
    }

    /// Variance of the turn about the vertical, rad².
    #[must_use]
    pub fn turn_variance(&self) -> f32 {
        self.covariance[TURN][TURN].max(0.0)
    }

    /// The level was taken anew, with this 1σ, rad.
    pub fn relevel(&mut self, sigma: f32) {
        for place in 0..TURN {
            self.clear(place);
            self.covariance[place][place] = sigma * sigma;
        }
        self.stand();
    }

    /// Makes a state less certain by a variance; an angle until it may be any.
    pub fn doubt(&mut self, place: usize, variance: f32) {
        let own = &mut self.covariance[place][place];
        let room = if place <= TURN { (ANY_ANGLE - *own).max(0.0) } else { variance };
        *own += variance.min(room);
    }

    /// 1σ of the greater tilt, rad.
    #[must_use]
    pub fn tilt_sigma(&self) -> f32 {
        libm::sqrtf(self.covariance[0][0].max(self.covariance[1][1]).max(0.0))
    }

    /// Variances of the biases, (rad/s)².
    #[must_use]
    pub fn bias_variances(&self) -> [f32; 3] {
        core::array::from_fn(|axis| self.covariance[BIAS + axis][BIAS + axis].max(0.0))
    }

    /// Where the bias of an axis stands among the states.
    #[must_use]
    pub fn bias(axis: usize) -> usize {
        BIAS + axis
    }

    /// RMS of the horizontal acceleration lately, m/s².
    #[must_use]
    pub fn force(&self) -> f32 {
        libm::sqrtf(self.force)
    }
}

/// What strays about the body's axes, squared, as it adds up about an axis of the level frame.
fn weighed(row: &[f32; 3], strays: &[f32; 3], stretch: &Stretch) -> f32 {
    let part = 1.0 / (stretch.seconds * stretch.seconds);
    let [x, y, z] = row.map(|cosine| cosine * cosine * part);
    x * strays[0] + y * strays[1] + z * strays[2]
}

/// A row of the covariance after a stretch.
fn carried(row: &States, stretch: &Stretch, kept: f32) -> States {
    let [a, b, c, x, y, z, north, east] = *row;
    let [by_north, by_east, by_down] = turned(&stretch.attitude, &[x, y, z]);
    let (new_a, new_b) = (a - by_north, b - by_east);
    let new_c = if stretch.is_rest { c } else { c - by_down };
    let down = stretch.impulse[2];
    // Half of what the biases turn comes to count within the stretch.
    let north = kept * north + 0.5 * down * (b + new_b);
    let east = kept * east - 0.5 * down * (a + new_a);
    [new_a, new_b, new_c, x, y, z, north, east]
}

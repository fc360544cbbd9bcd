//! The analytic gyrovertical: attitude from three gyros and three accelerometers, Earth rate compensated.
//!
//! ```text
//!  angle increments ─▶ sum, coning ─50 Hz─▶ attitude (integers) ─▶ pitch, roll, turn about the vertical
//!  forces ───────────▶ mean ─turned level─▶ velocity ─10 Hz─▶ filter ─tilt, biases─▲
//!                                      └─2 Hz─▶ rest? ─rates are biases, force is gravity─▲
//! ```
//!
//! Source: Burov, section 2 (two coarse gyros and two accelerometers as an analytic gyrovertical); how
//! gravity is told from acceleration is the filter's (compare D. Laidig and T. Seel, VQF, Information
//! Fusion 2023, which filters the forces in an inertial frame for the same reason).

mod course;
mod filter;
mod floor;
mod gap;
mod judge;
mod motion;
mod rest;
mod stretch;
mod sums;

pub use self::course::Course;
pub use self::filter::Expected;
use self::filter::Filter;
use self::judge::{Findings, STRETCH, Task};
use self::rest::ZeroVelocityDetector;
use self::stretch::Stretch;
use self::sums::{Before, Rested, Sums, Window};
use super::Setting;
use super::attitude::{Attitude, Matrix};
use crate::math::rotation::{difference, dot, scaled, sum, transposed, turned};
use crate::signal::InertialSample;
use crate::signal::increment::Increment;
use crate::units::{Instant, SpecificForce};

/// A vector in single precision.
type Vector = [f32; 3];

/// Time from one attitude to the next, µs: 50 Hz.
const TICK: u64 = 20_000;
/// Standard gravity, m/s².
const GRAVITY: f32 = 9.806_65;
/// Part of its period by which a sample may come late.
const LATE: f32 = 0.5;
/// Force that no accelerometer for a vehicle or a hand shows, µm/s²: 100 g; what is beyond is clipped or no force at all.
const GREATEST_FORCE: u32 = 980_665_000;
/// Time over which the rate lately fades, s.
const GAP_WATCH: f32 = 1.0;

/// Whether the level can be trusted, and what keeps it from that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// The first forces have not come.
    #[default]
    Starting,
    /// Nothing is the matter.
    Level,
    /// The body moves so that gravity takes less than a quarter of what the gyros' errors add: they alone carry the level.
    Coasting,
    /// The body falls freely.
    FreeFall,
    /// There are no forces, or they stand at their limit.
    NoForce,
    /// A part of the rotation was lost, and the level with it.
    RotationLost,
}

/// The gyrovertical at work.
#[derive(Clone, Debug)]
pub struct Vertical {
    expected: Expected,
    /// Variances of the biases when the gyros are switched on, and of what the Earth's rate adds to them as long as
    /// nobody knows where north is, (rad/s)².
    priors: Vector,
    unknown: f32,
    /// Whether a bias showed to be beyond what was stated.
    is_bias_beyond_stated: bool,
    /// 1σ of the accelerometers' biases, as a tilt, rad.
    force_tilt: f32,
    /// Sample period, s.
    period: f32,
    /// How the level frame turns, rad/s: with the Earth, and on the way over it.
    frame: Vector,
    increment: Increment,
    force: Sums,
    attitude: Attitude,
    matrix: Matrix,
    bias: Vector,
    /// Of the turn about each axis, what each gyro shows too much: its scale and the direction of its axis.
    axes: Matrix,
    filter: Filter,
    stretch: Stretch,
    /// The stretch that is being worked on, what of that is to be done next, and how many parts a sample.
    block: Stretch,
    task: Task,
    pace: u32,
    findings: Findings,
    window: Window,
    rest: ZeroVelocityDetector,
    rested: Rested,
    before: Before,
    course: Course,
    /// When the latest attitude was taken.
    since: Instant,
    trust: Trust,
    /// Whether nothing of the level is left.
    is_lost: bool,
    knows_north: bool,
}

impl Vertical {
    /// Begins with these gyros at this place.
    #[must_use]
    pub fn new(setting: &Setting) -> Self {
        // As long as nobody knows where north is, a level axis may show the Earth's rate beside its bias.
        let unknown = 0.5 * setting.latitude.horizontal_rate() * setting.latitude.horizontal_rate();
        let sigmas = setting
            .gyros
            .map(|gyro| libm::sqrt(gyro.bias_sigma * gyro.bias_sigma + unknown) as f32);
        let expected = setting.expected();
        let period = setting.sample_seconds as f32;
        Self {
            priors: setting.gyros.map(|gyro| (gyro.bias_sigma * gyro.bias_sigma) as f32),
            unknown: unknown as f32,
            is_bias_beyond_stated: false,
            force_tilt: setting.force_bias_sigma as f32 / GRAVITY,
            period,
            frame: [0.0, 0.0, -(setting.latitude.vertical_rate() as f32)],
            increment: Increment::default(),
            force: Sums::default(),
            attitude: Attitude::default(),
            matrix: Attitude::default().matrix(),
            bias: [0.0; 3],
            axes: [[0.0; 3]; 3],
            filter: Filter::new(sigmas, &expected),
            expected,
            stretch: Stretch::default(),
            block: Stretch::default(),
            task: Task::Nothing,
            pace: Self::pace(period),
            findings: Findings::default(),
            window: Window::default(),
            rest: ZeroVelocityDetector::default(),
            rested: Rested::default(),
            before: Before::default(),
            course: Course::default(),
            since: Instant::default(),
            trust: Trust::Starting,
            is_lost: false,
            knows_north: false,
        }
    }

    /// Takes a sample; whether it made a new attitude, or lost one.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) -> bool {
        let elapsed = self.elapsed(sample.time);
        if elapsed > (1.0 + LATE) * self.period {
            self.bridge(elapsed, sample);
        }
        let [x, y, z] = sample.turned;
        let is_lost = x.is_saturated() || y.is_saturated() || z.is_saturated();
        if is_lost {
            self.clip(sample.time);
        } else {
            self.increment.push(sample.turned);
            self.before.turned = sample.turned;
            self.before.clipped = 0.0;
        }
        let is_felt = |force: &[SpecificForce; 3]| {
            force.iter().all(|part| part.0.unsigned_abs() < GREATEST_FORCE)
        };
        if let Some(force) = sample.force.filter(is_felt) {
            self.force.push(force);
        }
        let is_due = sample.time.0.saturating_sub(self.since.0) >= TICK;
        if is_due || self.increment.is_large() {
            self.tick(sample.time);
        }
        // A sample that makes an attitude does enough already, if there are others.
        for _ in u32::from(is_due)..self.pace {
            self.work();
        }
        is_due || is_lost
    }

    /// Time since the sample before, s.
    #[inline]
    fn elapsed(&mut self, now: Instant) -> f32 {
        if let Some(before) = self.before.time.replace(now) {
            if now < before {
                // A clock that was set back: what was measured since the latest attitude counts from now.
                self.since = now;
            }
            return seconds_between(before, now);
        }
        self.since = Instant(now.0.saturating_sub((self.period * 1e6) as u64));
        self.period
    }

    /// Takes the attitude.
    #[inline(never)]
    fn tick(&mut self, now: Instant) {
        let seconds = seconds_between(self.since, now);
        self.since = now;
        let rotation = self.increment.take_rough();
        if seconds > 0.0 {
            self.advance(&rotation, seconds);
        }
        self.before.lately *= 1.0 - (seconds / GAP_WATCH).min(1.0);
        let rate = libm::sqrtf(dot(&rotation, &rotation)) / seconds.max(self.period);
        self.before.lately = self.before.lately.max(rate);
    }

    /// The body turned by what the gyros show, rad, in that time, s.
    fn advance(&mut self, rotation: &Vector, seconds: f32) {
        let frame = turned(&transposed(&self.matrix), &scaled(&self.frame, seconds));
        let shown = difference(rotation, &frame);
        let rotation = self.rotation(&difference(&shown, &scaled(&self.bias, seconds)));
        self.attitude.turn(&rotation);
        let after = self.attitude.matrix();
        let middle: Matrix = core::array::from_fn(|row| {
            core::array::from_fn(|column| 0.5 * (self.matrix[row][column] + after[row][column]))
        });
        self.matrix = after;
        self.window.turn(&shown, seconds);
        self.window.about += dot(&middle[2], &rotation);
        self.stretch.turn(&middle, &rotation, seconds);
        if let Some(force) = self.force.take() {
            self.window.impulse = sum(&self.window.impulse, &scaled(&force, seconds));
            self.window.forced += seconds;
            self.stretch.push(&turned(&middle, &force), seconds);
        }
        if self.stretch.seconds >= STRETCH {
            self.step();
        }
    }

    /// What the body turned, from what the gyros show of it without their biases: what is known of their axes is put
    /// right in the level, and not in the heading.
    fn rotation(&self, shown: &Vector) -> Vector {
        let [.., down] = &self.matrix;
        let off = turned(&self.axes, shown);
        let level = difference(&off, &scaled(down, dot(down, &off)));
        difference(shown, &level)
    }
}

/// What is asked of it.
impl Vertical {
    /// From body axes to the level frame, on a course that is zero for a body that was level when it began; at the
    /// latest sample.
    #[must_use]
    pub fn attitude(&self) -> Attitude {
        let mut increment = self.increment;
        let seconds = self.time().0.saturating_sub(self.since.0) as f32 * 1e-6;
        let frame = turned(&transposed(&self.matrix), &self.frame);
        let drift = scaled(&sum(&frame, &self.bias), seconds);
        let mut attitude = self.attitude;
        attitude.turn(&difference(&increment.take_rough(), &drift));
        attitude
    }

    /// 1σ of pitch and of roll, rad.
    #[must_use]
    pub fn sigma(&self) -> f32 {
        let tilt = self.filter.tilt_sigma();
        libm::sqrtf(tilt * tilt + self.force_tilt * self.force_tilt)
    }

    /// Biases of the gyros, rad/s.
    #[must_use]
    pub fn biases(&self) -> Vector {
        self.bias
    }

    /// Their 1σ, rad/s.
    #[must_use]
    pub fn bias_sigmas(&self) -> Vector {
        self.filter.bias_variances().map(libm::sqrtf)
    }

    /// Whether a gyro's bias showed to be beyond what was stated, so that nothing stated of them is believed.
    #[must_use]
    pub fn is_bias_beyond_stated(&self) -> bool {
        self.is_bias_beyond_stated
    }

    /// Whether the level can be trusted.
    #[must_use]
    pub fn trust(&self) -> Trust {
        self.trust
    }

    /// Whether the body stands.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.rest.is_at_rest()
    }

    /// When the latest sample ended.
    #[must_use]
    pub fn time(&self) -> Instant {
        self.before.time.unwrap_or_default()
    }

    /// What the body did since [`Vertical::begin_course`].
    #[must_use]
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// Variance of what it turned about the vertical since then, rad²: noise and biases, and what gaps hid.
    #[must_use]
    pub fn turn_variance(&self) -> f32 {
        self.filter.turn_variance()
    }

    /// Mean rates about the body's axes at rest, rad/s, the Earth's included; none where it does not stand.
    #[must_use]
    pub fn rest_rates(&self) -> Option<[f64; 3]> {
        let frame = turned(&transposed(&self.matrix), &self.frame);
        self.is_at_rest().then(|| sum(&self.bias, &frame).map(f64::from))
    }

    /// From now on another gyro shows the axis down: nothing is known of its bias.
    pub fn exchange_down(&mut self, setting: &Setting) {
        self.finish();
        self.expected = setting.expected();
        let [.., down] = &setting.gyros;
        let sigma = down.bias_sigma as f32;
        self.priors[2] = sigma * sigma;
        self.bias[2] = 0.0;
        self.axes[2] = [0.0; 3];
        self.filter.forget_bias(2, sigma * sigma);
        self.filter.forget_axis(2, self.expected.scale[2]);
        self.rested = Rested::default();
        self.rest.exchange(2, self.expected.walk[2]);
        self.window = Window::default();
    }

    /// From now on the level frame turns so, rad/s.
    pub fn turn_frame(&mut self, rate: Vector) {
        self.frame = rate;
    }

    /// The same, and north is known for the first time, or again: biases held the Earth's level rate until now.
    pub fn find_north(&mut self, rate: Vector) {
        self.learn_biases();
        let more = turned(&transposed(&self.matrix), &difference(&rate, &self.frame));
        self.frame = rate;
        self.knows_north = true;
        self.window = Window::default();
        if !self.is_at_rest() {
            return;
        }
        // What was learnt of the sum holds for the bias, of which more was known beforehand.
        self.bias = difference(&self.bias, &more);
        for (axis, bias) in self.bias.into_iter().enumerate() {
            self.filter.measure(Filter::bias(axis), -bias, self.priors[axis]);
        }
        self.correct();
    }

    /// North is not known any more: biases may hold the Earth's rate from now on.
    pub fn lose_north(&mut self, rate: Vector) {
        self.frame = rate;
        self.knows_north = false;
        self.doubt_biases();
    }

    /// Counts from now on.
    pub fn begin_course(&mut self) {
        self.learn_biases();
        self.filter.begin_turn();
        self.course = Course { stood: self.course.stood, ..Course::default() };
    }
}

/// Time from one moment to the next, s, an hour at most; none where it runs backwards.
#[inline]
fn seconds_between(before: Instant, now: Instant) -> f32 {
    now.0.saturating_sub(before.0).min(u64::from(u32::MAX)) as u32 as f32 * 1e-6
}

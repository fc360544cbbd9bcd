//! Analytic gyrovertical: attitude from three gyros and three accelerometers, with the Earth rate
//! compensated.
//!
//! ```text
//!  angle increments ─▶ sum, coning ─50 Hz─▶ attitude (integers) ─▶ pitch, roll, turn about the vertical
//!  forces ───────────▶ mean ─turned level─▶ velocity ─10 Hz─▶ filter ─tilt, biases─▲
//!                                      └─2 Hz─▶ rest? ─rates are biases, force is gravity─▲
//! ```
//!
//! Sources: Burov, section 2 (two coarse gyros and two accelerometers as an analytic gyrovertical);
//! for separating gravity from acceleration compare D. Laidig and T. Seel, VQF, Information Fusion
//! 2023, which filters the forces in an inertial frame for the same reason.

mod course;
mod filter;
mod floor;
mod gap;
mod judge;
mod motion;
mod rest;
mod stretch;
mod sums;
mod sway;

use self::course::Course;
use self::filter::{BIAS, Expected, Filter, TURN};
use self::judge::{Findings, STRETCH, Task};
use self::motion::GRAVITY;
use self::rest::ZeroVelocityDetector;
use self::stretch::Stretch;
use self::sums::{Before, Rested, Seen, Sums, Window};
use self::sway::SwayAverage;
use super::setting::Setting;
use crate::math::quaternion::{Attitude, Matrix, Vector};
use crate::math::rotation::{difference, dot, length, scaled, sum, transposed, turned};
use crate::signal::InertialSample;
use crate::signal::increment::Increment;
use crate::units::{Instant, RadiansPerSecond, SpecificForce};

/// Least cosine of the pitch at which a rate of turn is stated: body x is within 84° of the horizontal.
const LEAST_COSINE: f32 = 0.1;
/// Time between attitude updates, µs: 50 Hz.
const TICK: u64 = 20_000;
/// Greatest delay of a sample, in sample periods.
const LATE: f32 = 0.5;
/// Greatest plausible force of an accelerometer on a vehicle or in a hand, µm/s²: 100 g; beyond it
/// the reading is clipped or faulty.
const GREATEST_FORCE: u32 = 980_665_000;
/// Decay time of the recent rate, s.
const GAP_WATCH: f32 = 1.0;

/// Reliability of the level, and the cause that limits it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// No forces have been received yet.
    #[default]
    Starting,
    /// The level is corrected by gravity.
    Level,
    /// Gravity compensates less than a quarter of the growth by the gyros' errors, which alone
    /// carry the level.
    Coasting,
    /// The body is in free fall.
    FreeFall,
    /// There are no forces, or they are saturated.
    NoForce,
    /// Rotation was lost, and the level with it.
    RotationLost,
}

/// State of the gyrovertical.
#[derive(Clone, Debug, Default)]
pub(super) struct Vertical {
    /// Expected errors of the gyros.
    expected: Expected,
    /// Variances of the switch-on biases, (rad/s)², and variance of the Earth rate that they may
    /// contain while north is unknown.
    priors: Vector,
    unknown: f32,
    /// Whether a gyro's bias exceeded its configured 1σ by far, so that the configuration was
    /// inflated.
    pub(super) is_bias_beyond_stated: bool,
    /// Standard deviation of the accelerometers' biases, as a tilt, 1σ, rad.
    force_tilt: f32,
    /// Sample period, s.
    period: f32,
    /// Rate of the level frame, rad/s: Earth rate and transport rate.
    pub(super) frame: Vector,
    /// Rotation since the latest attitude update.
    increment: Increment,
    /// Forces since the latest attitude update.
    force: Sums,
    /// Attitude from body axes to the level frame.
    attitude: Attitude,
    /// Attitude as a matrix.
    matrix: Matrix,
    /// Estimated biases, rad/s.
    pub(super) bias: Vector,
    /// Excess of each gyro per rotation about each axis: scale factor and axis errors.
    axes: Matrix,
    /// Filter of tilt, biases and axes.
    filter: Filter,
    /// Stretch in progress.
    stretch: Stretch,
    /// Stretch that is being processed, its next task, and the number of tasks for each sample.
    block: Stretch,
    task: Task,
    tasks_per_sample: u32,
    /// Measurements of a rest for the filter.
    findings: Findings,
    /// Window of rest detection in progress.
    window: Window,
    /// Rest detection.
    rest: ZeroVelocityDetector,
    /// Part of the present rest that was not used yet.
    rested: Rested,
    /// Mean rates of a base that never rests.
    sway: SwayAverage,
    /// Values of the previous sample.
    before: Before,
    /// What is shown to those who steer by it.
    seen: Seen,
    /// Motion since the heading was handed over.
    pub(super) course: Course,
    /// Time of the latest attitude update.
    since: Instant,
    /// Reliability of the level.
    pub(super) trust: Trust,
    /// Whether the level is lost completely.
    is_lost: bool,
    /// Whether north is known, so that biases and Earth rate are separated.
    knows_north: bool,
}

impl Vertical {
    /// Begins with these gyros at this site.
    pub(crate) fn new(setting: &Setting) -> Self {
        // While north is unknown, a level axis may contain the Earth rate in addition to its bias.
        let rate = setting.latitude.horizontal_rate().0;
        let unknown = 0.5 * rate * rate;
        let priors = setting.gyros.map(|gyro| gyro.bias_sigma.0 * gyro.bias_sigma.0);
        let sigmas = priors.map(|prior| libm::sqrt(prior + unknown) as f32);
        let expected = Expected::of(setting);
        let period = setting.sample_seconds.0 as f32;
        Self {
            priors: priors.map(|prior| prior as f32),
            unknown: unknown as f32,
            force_tilt: force_tilt(setting),
            period,
            frame: [0.0, 0.0, -(setting.latitude.vertical_rate().0 as f32)],
            matrix: Attitude::default().rough_matrix(),
            filter: Filter::new(sigmas, &expected),
            expected,
            tasks_per_sample: Self::tasks_per_sample(period),
            ..Self::default()
        }
    }

    /// Takes a sample; returns whether it updated the attitude, or lost rotation.
    #[inline]
    pub(crate) fn push(&mut self, sample: &InertialSample) -> bool {
        let elapsed = self.elapsed(sample.time);
        if elapsed > (1.0 + LATE) * self.period {
            self.bridge(elapsed, sample);
        }
        let [x, y, z] = sample.turned;
        let is_lost = x.is_saturated() || y.is_saturated() || z.is_saturated();
        if is_lost {
            self.clip(sample);
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
        // A sample that updates the attitude does no further task, if there are others.
        for _ in u32::from(is_due)..self.tasks_per_sample {
            self.work();
        }
        is_due || is_lost
    }

    /// Time since the previous sample, s.
    #[inline]
    fn elapsed(&mut self, now: Instant) -> f32 {
        if let Some(before) = self.before.time.replace(now) {
            if now < before {
                // The clock was set back: increments since the latest attitude update count from
                // now.
                self.since = now;
            }
            return seconds_between(before, now);
        }
        self.since = Instant(now.0.saturating_sub((self.period * 1e6) as u64));
        self.period
    }

    /// Updates the attitude.
    #[inline(never)]
    fn tick(&mut self, now: Instant) {
        let seconds = seconds_between(self.since, now);
        self.since = now;
        let rotation = self.increment.take();
        if seconds > 0.0 {
            self.seen.turned.add(seconds, &rotation);
            self.advance(&rotation, seconds);
        }
        self.before.lately *= 1.0 - (seconds / GAP_WATCH).min(1.0);
        let own = difference(&rotation, &scaled(&self.bias, seconds));
        let rate = length(&own) / seconds.max(self.period);
        self.before.lately = self.before.lately.max(rate);
    }

    /// Rotates the body by the gyros' rotation, rad, in a time, s.
    fn advance(&mut self, rotation: &Vector, seconds: f32) {
        let frame = turned(&transposed(&self.matrix), &scaled(&self.frame, seconds));
        let shown = difference(rotation, &frame);
        let rotation = self.rotation(&difference(&shown, &scaled(&self.bias, seconds)));
        self.attitude.turn(&rotation);
        let after = self.attitude.rough_matrix();
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

    /// Rotation of the body from the gyros' rotation without biases: the estimated axis errors are
    /// corrected in the level, but not in the heading.
    fn rotation(&self, shown: &Vector) -> Vector {
        let [.., down] = &self.matrix;
        let off = turned(&self.axes, shown);
        let level = difference(&off, &scaled(down, dot(down, &off)));
        difference(shown, &level)
    }

    /// Attitude from body axes to the level frame at the latest sample; the course is zero for a
    /// body that was level at the start.
    pub(crate) fn attitude(&self) -> Attitude {
        let mut increment = self.increment;
        let seconds = self.time().0.saturating_sub(self.since.0) as f32 * 1e-6;
        let frame = turned(&transposed(&self.matrix), &self.frame);
        let drift = scaled(&sum(&frame, &self.bias), seconds);
        let mut attitude = self.attitude;
        attitude.turn(&difference(&increment.take(), &drift));
        attitude
    }

    /// Standard deviation of pitch and of roll, 1σ, rad.
    pub(crate) fn sigma(&self) -> f32 {
        let tilt = self.filter.tilt_sigma();
        libm::sqrtf(tilt * tilt + self.force_tilt * self.force_tilt)
    }

    /// Standard deviations of the biases, 1σ, rad/s.
    pub(crate) fn bias_sigmas(&self) -> Vector {
        self.filter.bias_variances().map(libm::sqrtf)
    }

    /// Whether the body is at rest.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.rest.is_at_rest
    }

    /// End of the latest sample.
    pub(crate) fn time(&self) -> Instant {
        self.before.time.unwrap_or_default()
    }

    /// Variance of the rotation about the vertical since its error counts, rad²: noise and biases, and
    /// rotation during gaps.
    pub(crate) fn turn_variance(&self) -> f32 {
        self.filter.variance(TURN) + self.unlearnt_variance()
    }

    /// Mean rates of the body about its axes since they were taken last, rad/s, less the biases; [`None`] where nothing was
    /// measured, or a gyro was at the limit of its range.
    pub(crate) fn take_rates(&mut self) -> Option<Vector> {
        let Seen { turned, is_clipped } = core::mem::take(&mut self.seen);
        let is_known = turned.seconds > 0.0 && !is_clipped;
        is_known.then(|| difference(&turned.rates(), &self.bias))
    }

    /// Rate of the azimuth of body x, rad/s, at these rates of the body about its axes; [`None`] where body x is upright.
    /// It is (q sin φ + r cos φ) / cos θ less that of the level frame about down.
    pub(crate) fn turn_rate(&self, [_, about_right, about_down]: &Vector) -> Option<f32> {
        let [.., [_, right, down]] = self.matrix;
        let square = right * right + down * down;
        let turn = || (right * about_right + down * about_down) / square - self.frame[2];
        (square > LEAST_COSINE * LEAST_COSINE).then(turn)
    }

    /// Mean rates about the body's axes at rest, including the Earth rate; `None` in motion.
    pub(crate) fn rest_rates(&self) -> Option<[RadiansPerSecond; 3]> {
        let frame = turned(&transposed(&self.matrix), &self.frame);
        self.is_at_rest().then(|| rates(sum(&self.bias, &frame)))
    }

    /// Replaces the gyro of the down axis by another one, whose bias is unknown.
    pub(crate) fn exchange_down(&mut self, setting: &Setting) {
        // What was turned since the latest attitude update has the former gyro's bias.
        self.tick(self.time());
        self.finish();
        self.expected = Expected::of(setting);
        let [.., down] = &setting.gyros;
        let sigma = down.bias_sigma.0 as f32;
        self.priors[2] = sigma * sigma;
        self.bias[2] = 0.0;
        self.axes[2] = [0.0; 3];
        self.filter.reset(BIAS + 2, sigma * sigma);
        self.filter.reset_axis(2, self.expected.scale[2]);
        (self.rested, self.sway) = (Rested::default(), SwayAverage::default());
        self.break_off();
        self.rest.exchange(2, self.expected.walk[2]);
    }

    /// Replaces the accelerometers by others: the level is wrong by the biases of the former ones.
    pub(crate) fn exchange_forces(&mut self, setting: &Setting) {
        self.finish();
        self.filter.inflate_level(self.force_tilt * self.force_tilt);
        self.force_tilt = force_tilt(setting);
        self.force = Sums::default();
        self.break_off();
        self.rest.exchange_forces();
    }

    /// Sets the rate of the level frame, rad/s, and reports that north is known for the first time,
    /// or again: until now the biases contained the level Earth rate.
    pub(crate) fn find_north(&mut self, rate: Vector) {
        self.learn_biases();
        let more = turned(&transposed(&self.matrix), &difference(&rate, &self.frame));
        self.frame = rate;
        self.knows_north = true;
        self.break_off();
        if !self.is_at_rest() {
            return;
        }
        // The estimate of the sum now holds for the bias, which has a tighter prior.
        self.bias = difference(&self.bias, &more);
        for (axis, bias) in self.bias.into_iter().enumerate() {
            self.filter.measure(BIAS + axis, -bias, self.priors[axis]);
        }
        self.correct();
    }

    /// Sets the rate of the level frame, rad/s, and reports that north is unknown: biases may
    /// contain the Earth rate from now on.
    pub(crate) fn lose_north(&mut self, rate: Vector) {
        self.frame = rate;
        self.knows_north = false;
        self.inflate_biases();
    }

    /// Breaks off the window in progress, of which rest detection is not to know. What the body turned in it counts.
    fn break_off(&mut self) {
        let window = core::mem::take(&mut self.window);
        if self.is_at_rest() {
            self.course.turned += window.about;
        } else {
            self.course.drive(&window);
        }
    }

    /// Restarts the motion statistics and the error of the rotation about the vertical.
    pub(crate) fn begin_course(&mut self) {
        self.learn_biases();
        self.filter.reset(TURN, 0.0);
        self.course = Course { stood: self.course.stood, ..Course::default() };
    }
}

/// Time from one moment to the next, s, at most an hour; zero where it runs backwards.
#[inline]
fn seconds_between(before: Instant, now: Instant) -> f32 {
    now.0.saturating_sub(before.0).min(u64::from(u32::MAX)) as u32 as f32 * 1e-6
}

/// Standard deviation of the accelerometers' biases as a tilt, 1σ, rad.
fn force_tilt(setting: &Setting) -> f32 {
    setting.force_bias_sigma.0 as f32 / GRAVITY
}

/// Rates in double precision.
pub(super) fn rates([x, y, z]: Vector) -> [RadiansPerSecond; 3] {
    [x, y, z].map(|rate| RadiansPerSecond(rate.into()))
}

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

mod filter;
mod rest;

pub use self::filter::Expected;
use self::filter::{Filter, Stretch, TURN};
use self::rest::{Known, Means, RestWatch, WINDOW};
use super::Setting;
use super::attitude::{Attitude, Matrix};
use crate::math::rotation::{difference, dot, scaled, sum, transposed, turned};
use crate::signal::InertialSample;
use crate::signal::increment::{Increment, STEP};
use crate::units::{AngleIncrement, Instant, SpecificForce};

/// A vector in single precision.
type Vector = [f32; 3];

/// Time from one attitude to the next, µs: 50 Hz.
const TICK: u64 = 20_000;
/// Time from one step of the filter to the next, s.
const STRETCH: f32 = 0.1;
/// Time over which the first forces are averaged to begin with, s.
const START: f32 = 0.2;
/// 1σ of the tilt with which it begins, rad: nobody says that the body stands.
const START_TILT: f32 = 0.05;
/// Tilt, 1σ, of a standing body by its mean force over a window, rad: wind and engine.
const STANDING_TILT: f32 = 3e-4;
/// How far wind and engine turn a body that stands, 1σ, rad: 4″.
const SHAKING: f32 = 2e-5;
/// Longest stretch of a rest whose mean rates are taken together, s.
const LONGEST_REST: f32 = 64.0;
/// Part of gravity below which a force is a free fall.
const FREE: f32 = 0.3;
/// Standard gravity, m/s².
const GRAVITY: f32 = 9.806_65;
/// How far gravity may be from that, m/s²: 9.78 on the equator, 9.83 at the poles.
const GRAVITY_CHANGE: f32 = 0.03;
/// Standard deviations of the level by which a force at rest may be beside gravity.
const SIGMAS: f32 = 4.0;
/// Part of gravity by which a force points down where the level stands on its head, and for how long, s: a body that
/// is pushed down so hard falls 29 m meanwhile.
const UPSIDE_DOWN: f32 = 0.5;
const HEADLONG: f32 = 2.0;
/// Part of gravity by which the first forces may differ from it.
const BEGINNING: f32 = 0.5;
/// Part of its period by which a sample may come late.
const LATE: f32 = 0.5;
/// Greatest bias that is believed, in 1σ of what was stated.
const GREATEST_BIAS: f32 = 5.0;
/// Part of the rate lately that a rate within a gap may be beside the mean of its ends.
const GAP_PART: f32 = 0.3;
/// Time over which the rate lately fades, s.
const GAP_WATCH: f32 = 1.0;
/// Least rate that may be hidden behind a gyro's limit, rad/s.
const LEAST_CLIPPED: f32 = 1.0;
/// Tilt, 1σ, at which the level counts as lost, rad.
const LOST: f32 = 0.1;
/// For how long a rest is remembered, s.
const MEMORY: f32 = 600.0;
/// Acceleration, RMS, at which gravity is hardly told from it, m/s².
const COASTING: f32 = 1.0;

/// Whether the level can be trusted, and what keeps it from that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// The first forces have not come.
    #[default]
    Starting,
    /// Nothing is the matter.
    Level,
    /// The body moves so that gravity can hardly be told from acceleration.
    Coasting,
    /// The body falls freely.
    FreeFall,
    /// There are no forces, or they stand at their limit.
    NoForce,
    /// A part of the rotation was lost, and the level with it.
    RotationLost,
}

/// What the body did since its heading was handed over.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// Turned about the vertical, rad, whole turns included.
    pub turned: f32,
    /// For how long it has moved since it stood last, s.
    pub moved: f32,
    /// For how long it stood then, s, ten minutes at most.
    pub stood: f32,
    /// What a bias that grows by 1 rad/s² has turned unseen, rad.
    pub ramp: f32,
}

/// The gyrovertical at work.
#[derive(Clone, Debug)]
pub struct Vertical {
    expected: Expected,
    /// Variances of the biases when the gyros are switched on, and of what the Earth's rate adds to them as long as
    /// nobody knows where north is, (rad/s)².
    priors: Vector,
    unknown: f32,
    /// Greatest biases that are believed, rad/s.
    greatest: Vector,
    /// 1σ of the accelerometers' biases, as a tilt, rad.
    force_tilt: f32,
    /// Sample period, s.
    period: f32,
    /// How the level frame turns, rad/s: with the Earth, and on the way over it.
    frame: Vector,
    is_north_known: bool,
    increment: Increment,
    force: Sums,
    attitude: Attitude,
    matrix: Matrix,
    bias: Vector,
    filter: Filter,
    stretch: Stretch,
    window: Window,
    rest: RestWatch,
    rested: Rested,
    before: Before,
    course: Course,
    /// When the latest attitude was taken.
    since: Instant,
    trust: Trust,
    /// For how long there was no force, s.
    unforced: f32,
    /// For how long the force has pointed down, s.
    headlong: f32,
}

/// Forces since the latest attitude.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// µm/s².
    sums: [i32; 3],
    count: u32,
}

/// What a window of the rest watch sums.
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    seconds: f32,
    /// What the body turned against the Earth, about its axes, with its biases, rad.
    turned: Vector,
    /// Turned about the vertical, rad.
    about: f32,
    /// Integral of the force on the body's axes, m/s.
    impulse: Vector,
    forced: f32,
}

/// What of a rest the biases have not been told yet: of every part the mean rate counts, each as long as all
/// before, for what shakes the body turns it to and fro.
#[derive(Clone, Copy, Debug, Default)]
struct Rested {
    seconds: f32,
    /// Length of this part, s.
    due: f32,
    turned: Vector,
}

/// The sample before.
#[derive(Clone, Copy, Debug, Default)]
struct Before {
    time: Option<Instant>,
    turned: [AngleIncrement; 3],
    /// Rate lately, rad/s.
    lately: f32,
    /// What may have been lost since a gyro clips, rad.
    clipped: f32,
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
        Self {
            priors: setting.gyros.map(|gyro| (gyro.bias_sigma * gyro.bias_sigma) as f32),
            unknown: unknown as f32,
            expected: setting.expected(),
            greatest: scaled(&sigmas, GREATEST_BIAS),
            force_tilt: setting.force_bias_sigma as f32 / GRAVITY,
            period: setting.sample_seconds as f32,
            frame: [0.0, 0.0, -(setting.latitude.vertical_rate() as f32)],
            is_north_known: false,
            increment: Increment::default(),
            force: Sums::default(),
            attitude: Attitude::default(),
            matrix: Attitude::default().matrix(),
            bias: [0.0; 3],
            filter: Filter::new(START_TILT, sigmas),
            stretch: Stretch::default(),
            window: Window::default(),
            rest: RestWatch::default(),
            rested: Rested::default(),
            before: Before::default(),
            course: Course::default(),
            since: Instant::default(),
            trust: Trust::Starting,
            unforced: 0.0,
            headlong: 0.0,
        }
    }

    /// Takes a sample; whether it made a new attitude.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) -> bool {
        let elapsed = self.elapsed(sample.time);
        if elapsed > (1.0 + LATE) * self.period {
            self.bridge(elapsed, sample);
        }
        let [x, y, z] = sample.turned;
        if x.is_saturated() || y.is_saturated() || z.is_saturated() {
            self.clip(sample.time);
        } else {
            self.increment.push(sample.turned);
            self.before.turned = sample.turned;
            self.before.clipped = 0.0;
        }
        if let Some(force) =
            sample.force.filter(|force| !force.iter().any(|part| part.is_saturated()))
        {
            self.force.push(force);
        }
        let is_due = sample.time.0.saturating_sub(self.since.0) >= TICK;
        if is_due || self.increment.is_large() {
            self.tick(sample.time);
        }
        is_due
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

    /// Samples are missing: the rate between is taken for the mean of those at either end.
    #[inline(never)]
    fn bridge(&mut self, elapsed: f32, sample: &InertialSample) {
        let missing = elapsed - self.period;
        let end = Instant(sample.time.0.saturating_sub((self.period * 1e6) as u64));
        self.tick(Instant(end.0.saturating_sub((missing * 1e6) as u64)));
        let rate =
            |turned: &[AngleIncrement; 3]| turned.map(|part| part.0 as f32 * STEP / self.period);
        let (before, after) = (rate(&self.before.turned), rate(&sample.turned));
        let mean = scaled(&sum(&before, &after), 0.5);
        let jump = difference(&after, &before);
        let lost = 0.5 * libm::sqrtf(dot(&jump, &jump)) + GAP_PART * self.before.lately;
        self.advance(&scaled(&mean, missing), missing);
        self.since = end;
        self.lose(lost * missing);
    }

    /// A gyro stood at the limit of its range: what it turned beyond is not known.
    #[inline(never)]
    fn clip(&mut self, now: Instant) {
        self.tick(now);
        // What is lost of one clip goes one way: it adds up, not its squares.
        let before = self.before.clipped;
        self.before.clipped += self.before.lately.max(LEAST_CLIPPED) * self.period;
        self.lose_square(self.before.clipped * self.before.clipped - before * before);
    }

    /// A rotation of this size, rad, may have been lost.
    fn lose(&mut self, angle: f32) {
        self.lose_square(angle * angle);
    }

    fn lose_square(&mut self, variance: f32) {
        self.filter.doubt(0, variance);
        self.filter.doubt(1, variance);
        self.filter.doubt(TURN, variance);
        self.rest.disturb();
        self.rested = Rested::default();
        self.window = Window::default();
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
        let rotation = difference(&shown, &scaled(&self.bias, seconds));
        self.attitude.turn(&rotation);
        let after = self.attitude.matrix();
        let middle: Matrix = core::array::from_fn(|row| {
            core::array::from_fn(|column| 0.5 * (self.matrix[row][column] + after[row][column]))
        });
        self.matrix = after;
        self.window.seconds += seconds;
        self.window.turned = sum(&self.window.turned, &shown);
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

    /// Lets the filter look at what happened.
    #[inline(never)]
    fn step(&mut self) {
        if self.trust == Trust::Starting {
            return self.start();
        }
        let mut stretch = core::mem::take(&mut self.stretch);
        stretch.is_rest = self.rest.is_at_rest();
        self.filter.step(&stretch, &self.expected);
        self.judge(&stretch);
        self.check_head(&stretch);
        if self.window.seconds >= WINDOW {
            self.look();
        }
        self.correct();
        self.attitude.normalise();
    }

    /// Takes the first forces for gravity.
    fn start(&mut self) {
        if self.window.forced < START {
            self.stretch = Stretch::default();
            return;
        }
        let force = scaled(&self.window.impulse, 1.0 / self.window.forced);
        self.stretch = Stretch::default();
        self.window = Window::default();
        // A body that falls or is thrown shows no level.
        if (libm::sqrtf(dot(&force, &force)) - GRAVITY).abs() > BEGINNING * GRAVITY {
            return;
        }
        self.attitude = Attitude::levelled(&force);
        self.matrix = self.attitude.matrix();
        self.trust = Trust::Level;
    }

    /// Says what of the level can be trusted.
    fn judge(&mut self, stretch: &Stretch) {
        let is_forced = stretch.forced > 0.5 * stretch.seconds;
        self.unforced = if is_forced { 0.0 } else { self.unforced + stretch.seconds };
        let force = self.filter.force();
        self.trust = if self.filter.tilt_sigma() > LOST {
            Trust::RotationLost
        } else if !is_forced {
            Trust::NoForce
        } else if stretch.force() < FREE * GRAVITY {
            Trust::FreeFall
        } else if force > COASTING {
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
            self.course.drive(&window);
            self.learn_biases();
            self.rested.due = 0.0;
            if was_rest {
                self.leave();
            }
            return;
        }
        if let Some(force) = force.filter(|_| !was_rest && !is_gravity) {
            self.lose_level(&force);
        }
        self.course.stand(window.seconds);
        self.stand(&window, force);
        // The body did not turn: what the gyro made of it is undone.
        self.attitude.correct(&[0.0, 0.0, -window.about]);
    }

    /// Whether a mean force is gravity as the attitude has it, as far as that can be told.
    fn is_gravity(&self, force: &Vector) -> bool {
        let [.., down] = &self.matrix;
        let off = sum(force, &scaled(down, GRAVITY));
        let bound = SIGMAS * GRAVITY * self.sigma() + GRAVITY_CHANGE;
        dot(&off, &off) <= bound * bound
    }

    /// The level is not where it was believed to be, but where this force says.
    fn lose_level(&mut self, force: &Vector) {
        let [about_north, about_east] = tilt(&turned(&self.matrix, force));
        let square = about_north * about_north + about_east * about_east;
        self.filter.doubt(0, square);
        self.filter.doubt(1, square);
    }

    /// The body goes. As long as nobody knows where north is, the biases hold what the Earth turned it by at rest,
    /// which is another rate as soon as it turns.
    fn leave(&mut self) {
        if !self.is_north_known {
            self.doubt_biases();
        }
    }

    fn doubt_biases(&mut self) {
        for axis in 0..3 {
            self.filter.doubt(Filter::bias(axis), 2.0 * self.unknown);
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
        let variance = STANDING_TILT * STANDING_TILT;
        for (place, off) in tilt(force).into_iter().enumerate() {
            self.filter.measure(place, off, variance);
        }
    }

    /// Looks whether the level stands on its head: no vehicle is pushed down for so long.
    fn check_head(&mut self, stretch: &Stretch) {
        let [.., down] = stretch.impulse;
        let is_wrong = down > UPSIDE_DOWN * GRAVITY * stretch.seconds;
        self.headlong = if is_wrong { self.headlong + stretch.seconds } else { 0.0 };
        if self.headlong > HEADLONG {
            self.headlong = 0.0;
            let force = turned(&transposed(&self.matrix), &stretch.impulse);
            self.lose_level(&force);
            self.take_for_gravity(&stretch.impulse);
            self.filter.doubt(0, START_TILT * START_TILT);
            self.filter.doubt(1, START_TILT * START_TILT);
        }
    }

    /// The mean rates of a rest are the biases.
    fn learn_biases(&mut self) {
        let Rested { seconds, turned, .. } = self.rested;
        if seconds <= 0.0 {
            return;
        }
        (self.rested.seconds, self.rested.turned) = (0.0, [0.0; 3]);
        self.rest.learnt();
        let off = difference(&scaled(&turned, 1.0 / seconds), &self.bias);
        let shaking = SHAKING / seconds;
        for (axis, off) in off.into_iter().enumerate() {
            let variance = self.expected.walk[axis] / seconds + 2.0 * shaking * shaking;
            self.filter.measure(Filter::bias(axis), off, variance);
        }
    }

    /// Puts attitude and biases right.
    fn correct(&mut self) {
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

/// Time from one moment to the next, s, an hour at most; none where it runs backwards.
#[inline]
fn seconds_between(before: Instant, now: Instant) -> f32 {
    now.0.saturating_sub(before.0).min(u64::from(u32::MAX)) as u32 as f32 * 1e-6
}

/// The vector with each component within its bound.
fn bounded(vector: &Vector, bounds: &Vector) -> Vector {
    core::array::from_fn(|axis| vector[axis].max(-bounds[axis]).min(bounds[axis]))
}

/// What is asked of it.
impl Vertical {
    /// From body axes to the level frame, whose x was in the body's vertical plane when it began; at the
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
        self.expected = setting.expected();
        let [.., down] = &setting.gyros;
        let sigma = down.bias_sigma as f32;
        self.priors[2] = sigma * sigma;
        self.greatest[2] = GREATEST_BIAS * sigma;
        self.bias[2] = 0.0;
        self.filter.forget_bias(2, sigma * sigma);
        self.rested = Rested::default();
        self.rest.disturb();
        self.window = Window::default();
    }

    /// From now on the level frame turns so, rad/s.
    pub fn turn_frame(&mut self, rate: Vector) {
        self.frame = rate;
    }

    /// The same, and nobody knows any more where north is: biases may hold the Earth's rate from now on.
    pub fn lose_north(&mut self, rate: Vector) {
        self.frame = rate;
        self.is_north_known = false;
        self.doubt_biases();
    }

    /// The same, and north is known for the first time: biases held the Earth's rate until now.
    pub fn find_north(&mut self, rate: Vector) {
        self.learn_biases();
        self.correct();
        let more = turned(&transposed(&self.matrix), &difference(&rate, &self.frame));
        self.frame = rate;
        self.is_north_known = true;
        self.window = Window::default();
        if self.is_at_rest() {
            // What was learnt of the sum holds for the bias, of which more was known beforehand.
            self.bias = difference(&self.bias, &more);
            for (axis, bias) in self.bias.into_iter().enumerate() {
                self.filter.measure(Filter::bias(axis), -bias, self.priors[axis]);
            }
            self.correct();
        } else {
            for axis in 0..3 {
                self.filter.doubt(Filter::bias(axis), self.unknown);
            }
        }
    }

    /// Counts from now on.
    pub fn begin_course(&mut self) {
        self.learn_biases();
        self.correct();
        self.filter.begin_turn();
        self.course = Course { stood: self.course.stood, ..Course::default() };
    }
}

impl Course {
    fn drive(&mut self, window: &Window) {
        self.turned += window.about;
        self.moved += window.seconds;
        self.ramp += window.seconds * (self.moved + 0.5 * self.stood);
    }

    fn stand(&mut self, seconds: f32) {
        if self.moved > 0.0 {
            (self.moved, self.stood) = (0.0, 0.0);
        }
        self.stood = (self.stood + seconds).min(MEMORY);
    }
}

impl Sums {
    #[inline]
    fn push(&mut self, [x, y, z]: [SpecificForce; 3]) {
        // Sixteenths of a µm/s² would not fit; whole ones of ±2147 m/s² do not add up either: halves of
        // what is summed are far below every noise.
        self.sums[0] = self.sums[0].saturating_add(x.0 >> SHIFT);
        self.sums[1] = self.sums[1].saturating_add(y.0 >> SHIFT);
        self.sums[2] = self.sums[2].saturating_add(z.0 >> SHIFT);
        self.count += 1;
    }

    /// The mean, m/s², which begins again.
    fn take(&mut self) -> Option<Vector> {
        let Self { sums, count } = core::mem::take(self);
        let part = 1e-6 * (1 << SHIFT) as f32 / count as f32;
        (count > 0).then(|| [sums[0] as f32 * part, sums[1] as f32 * part, sums[2] as f32 * part])
    }
}

/// Bits by which forces are rounded before they are summed, so that 128 of them fit at full range: 64 µm/s².
const SHIFT: u32 = 6;

impl Stretch {
    fn turn(&mut self, attitude: &Matrix, rotation: &Vector, seconds: f32) {
        for (sums, row) in self.attitude.iter_mut().zip(attitude) {
            *sums = sum(sums, &scaled(row, seconds));
        }
        let [x, y, z] = *rotation;
        let squares = scaled(&[x * x, y * y, z * z], 1.0 / seconds);
        self.rate_squares = sum(&self.rate_squares, &squares);
        self.seconds += seconds;
    }

    /// A force on the level frame.
    fn push(&mut self, force: &Vector, seconds: f32) {
        self.impulse = sum(&self.impulse, &scaled(force, seconds));
        self.forced += seconds;
    }

    /// The mean force's size, m/s².
    fn force(&self) -> f32 {
        libm::sqrtf(dot(&self.impulse, &self.impulse)) / self.forced
    }
}

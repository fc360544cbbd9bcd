//! Looks at what happened: ten times a second at the forces, twice a second for a rest.

use super::filter::{Correction, Filter, TURN};
use super::rest::{Found, Known, Means, WINDOW};
use super::stretch::Stretch;
use super::sums::{Rested, Window};
use super::{GRAVITY, Trust, Vector, Vertical};
use crate::math::rotation::{difference, dot, scaled, sum, turned};

/// Time from one step of the filter to the next, s.
pub(super) const STRETCH: f32 = 0.1;
/// Time over which the first forces are averaged to begin with, s.
const START: f32 = 0.2;
/// 1σ of the tilt with which it begins, rad, and of that on the way: nobody says that the body stands.
const START_TILT: f32 = 0.05;
const MOVING_TILT: f32 = 0.4;
/// Rate, rad/s, and force beside gravity, m/s², below which the body may stand as it begins: an engine's and the wind's.
const CALM_RATE: f32 = 0.2;
const CALM_FORCE: f32 = 0.5;
/// Tilt, 1σ, of a standing body by its mean force over a window, rad: wind and engine.
const STANDING_TILT: f32 = 3e-4;
/// How far wind turns a body that stands, its engine off, 1σ, rad: 2″.
const SHAKING: f32 = 1e-5;
/// Longest stretch of a rest whose mean rates are taken together, s.
const LONGEST_REST: f32 = 64.0;
/// Part of gravity below which a force is a free fall.
const FREE: f32 = 0.3;
/// Tilt, 1σ, beyond which a steady force is rather gravity than an acceleration, rad: 0.2 m/s².
const UNSURE: f32 = 0.02;
/// Tilt, 1σ, at which the level counts as lost, rad.
const LOST: f32 = 0.1;
/// Part that gravity takes of what the gyros' errors add to the level's variance, below which they carry it alone.
const COASTING: f32 = 0.25;
/// Bias, in 1σ of what was stated, beyond which that is not believed.
const GREATEST_BIAS: f32 = 5.0;
/// Standard deviations of what is known of it by which it must be beyond that.
const SURE: f32 = 3.0;
/// Greatest factor by which what was stated is widened at once, and the variance of a bias that is stated to be
/// nothing, (rad/s)²: 0.002 °/h.
const WIDEST: f32 = 100.0;
const LEAST_PRIOR: f32 = 1e-16;

/// How far gravity may be from the standard, m/s²: 9.78 on the equator, 9.83 at the poles.
const GRAVITY_CHANGE: f32 = 0.03;
/// Standard deviations of the level by which a force at rest may be beside gravity.
const SIGMAS: f32 = 5.0;
/// Part of gravity by which the first forces may differ from it.
const BEGINNING: f32 = 0.5;

/// What is to be done for a stretch: a part with each sample, so that none takes long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Task {
    /// All is done.
    #[default]
    Nothing,
    /// The filter's errors are carried on: rows, then columns.
    Carry,
    Spread,
    /// The velocity north (0) and east (1) is about zero.
    Stay(usize),
    /// What can be trusted, and whether the body stands.
    Judge,
    /// The mean rate of a rest is the bias of an axis.
    Learn(usize),
    /// The mean force of a rest is gravity, about north (0) and east (1).
    Level(usize),
    /// What was found is put right.
    Correct,
}

/// Greatest number of tasks of a stretch, with as many more as the samples leave that make an attitude and do none.
const TASKS: f32 = 24.0;

/// What a look at a rest found, to be told to the filter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Findings {
    /// By how much the biases are off, rad/s, and the variances of that.
    biases: Option<[Vector; 2]>,
    /// By how much the level is off, rad.
    level: Option<[f32; 2]>,
    /// Whether the biases are to be doubted then: what they hold of the Earth's rate is another as the body turns.
    is_doubted: bool,
}

impl Vertical {
    /// How many parts of a stretch's work fall to a sample.
    pub(super) fn pace(period: f32) -> u32 {
        (TASKS * period / STRETCH) as u32 + 1
    }

    /// A stretch is over: what is left of the one before is done, and its own work begins.
    #[inline(never)]
    pub(super) fn step(&mut self) {
        self.finish();
        let stretch = core::mem::take(&mut self.stretch);
        if self.trust == Trust::Starting || self.is_lost {
            return self.start();
        }
        let hidden = 2.0 * self.hidden();
        self.block = Stretch { is_rest: self.rest.is_at_rest(), hidden, ..stretch };
        self.task = Task::Carry;
    }

    /// Does all that is left to be done.
    pub(super) fn finish(&mut self) {
        while self.task != Task::Nothing {
            self.work();
        }
    }

    /// Does a part of what is to be done.
    #[inline(never)]
    pub(super) fn work(&mut self) {
        self.task = match self.task {
            Task::Nothing => Task::Nothing,
            Task::Carry => {
                self.filter.carry(&self.block);
                Task::Spread
            }
            Task::Spread => {
                self.filter.spread(&self.block, &self.expected);
                if self.block.forced > 0.0 { Task::Stay(0) } else { Task::Judge }
            }
            Task::Stay(axis) => self.stay(axis),
            Task::Judge => {
                self.judge();
                if self.window.seconds >= WINDOW {
                    self.look();
                }
                self.after_look()
            }
            Task::Learn(axis) => self.learn(axis),
            Task::Level(place) => self.level(place),
            Task::Correct => {
                self.correct();
                self.attitude.normalise();
                Task::Nothing
            }
        }
    }

    /// The body stays where it is, nearly; its motion is watched before that counts.
    fn stay(&mut self, axis: usize) -> Task {
        if axis == 0
            && let Some(force) = self.filter.watch(&self.block)
        {
            self.take_level(&force);
        }
        self.filter.stay(axis, self.block.seconds);
        if axis == 0 { Task::Stay(1) } else { Task::Judge }
    }

    /// What comes after a look.
    fn after_look(&self) -> Task {
        match self.findings {
            Findings { biases: Some(_), .. } => Task::Learn(0),
            Findings { level: Some(_), .. } => Task::Level(0),
            _ => Task::Correct,
        }
    }

    /// The mean rates of a rest are the biases.
    fn learn(&mut self, axis: usize) -> Task {
        if let Some([off, variance]) = self.findings.biases {
            self.filter.measure(Filter::bias(axis), off[axis], variance[axis]);
        }
        if axis < 2 {
            return Task::Learn(axis + 1);
        }
        self.findings.biases = None;
        if core::mem::take(&mut self.findings.is_doubted) {
            self.doubt_biases();
        }
        self.after_look()
    }

    /// The mean force of a rest is gravity.
    fn level(&mut self, place: usize) -> Task {
        if let Some(off) = self.findings.level {
            self.filter.measure(place, off[place], STANDING_TILT * STANDING_TILT);
        }
        if place == 0 {
            return Task::Level(1);
        }
        self.findings.level = None;
        Task::Correct
    }

    /// Takes the first forces for gravity, and those after all of the level was lost.
    fn start(&mut self) {
        if self.window.forced < START {
            return;
        }
        let Some(force) = self.window.force() else { return };
        let rate = self.window.rate();
        self.window = Window::default();
        // A body that falls or is thrown shows no level.
        let beside = (libm::sqrtf(dot(&force, &force)) - GRAVITY).abs();
        if beside > BEGINNING * GRAVITY {
            return;
        }
        let is_calm = beside < CALM_FORCE && dot(&rate, &rate) < CALM_RATE * CALM_RATE;
        let [about_north, about_east] = tilt(&turned(&self.matrix, &force));
        self.attitude.correct(&[about_north, about_east, 0.0]);
        self.matrix = self.attitude.matrix();
        let is_first = self.trust == Trust::Starting;
        self.filter.relevel(if is_first && is_calm { START_TILT } else { MOVING_TILT });
        if !is_calm {
            self.filter.expect_motion();
        }
        self.is_lost = false;
        self.trust = Trust::Level;
    }

    /// Says what of the level can be trusted.
    fn judge(&mut self) {
        let block = &self.block;
        let is_forced = block.forced > 0.5 * block.seconds;
        let is_free = is_forced && block.force() < FREE * GRAVITY;
        if !is_forced || is_free {
            // What gravity could not take meanwhile says nothing of whether it can afterwards.
            self.filter.begin_balance();
        }
        self.trust = if self.filter.tilt_sigma() > LOST {
            Trust::RotationLost
        } else if !is_forced {
            Trust::NoForce
        } else if is_free {
            Trust::FreeFall
        } else if !block.is_rest && self.filter.share_of_gravity() < COASTING {
            Trust::Coasting
        } else {
            Trust::Level
        };
    }

    /// Looks whether the body stands; if so, its rates are the biases and its force is gravity.
    fn look(&mut self) {
        let window = core::mem::take(&mut self.window);
        let force = window.force();
        let means = Means {
            rate: window.rate(),
            force,
            walk: window.walk().unwrap_or(self.expected.walk),
            acceleration: force.and_then(|force| self.acceleration(&force)),
        };
        let was_rest = self.is_at_rest();
        match self.rest.push(means, &self.known()) {
            Found::Rest => self.stand(&window, was_rest),
            Found::Motion => self.move_on(&window, was_rest),
            Found::StrangeBias => {
                self.move_on(&window, was_rest);
                // Even rates were taken for a turn until now.
                let turned = dot(&self.matrix[2], &self.rest.turned_evenly());
                self.filter.inflate(TURN, turned * turned);
                self.widen_biases(&difference(&means.rate, &self.bias), &means.rate);
            }
        }
    }

    /// What is known of the gyros.
    fn known(&self) -> Known {
        Known {
            biases: self.bias,
            variances: self.filter.bias_variances(),
            stated: self.stated(),
            walk: self.expected.walk,
        }
    }

    /// Variance of what the Earth's rate may hide in a bias, (rad/s)².
    fn hidden(&self) -> f32 {
        if self.knows_north { 0.0 } else { self.unknown }
    }

    /// Variances of the biases as they were stated, with what the Earth's rate may hide in them, (rad/s)².
    fn stated(&self) -> Vector {
        let hidden = self.hidden();
        self.priors.map(|prior| (prior + hidden).max(LEAST_PRIOR))
    }

    /// The body goes, or goes on. As long as nobody knows where north is, the biases hold what the Earth turned it by at
    /// rest, which is another rate as soon as it turns.
    fn move_on(&mut self, window: &Window, was_rest: bool) {
        self.course.drive(window);
        self.findings.biases = self.rested_biases();
        self.rested.due = 0.0;
        if was_rest && !self.knows_north {
            match self.findings.biases {
                Some(_) => self.findings.is_doubted = true,
                None => self.doubt_biases(),
            }
        }
    }

    pub(super) fn doubt_biases(&mut self) {
        for axis in 0..3 {
            self.filter.inflate(Filter::bias(axis), 2.0 * self.unknown);
        }
    }

    /// The biases are off by so much, rad/s, for they are found to be these: what is known of them is forgotten. Where one
    /// is beyond what was stated, that is believed of none of the gyros any more, for they are of one kind.
    fn widen_biases(&mut self, off: &Vector, found: &Vector) {
        let stated = self.stated();
        let ratio = |biases: &Vector| {
            let squares = (0..3).map(|axis| biases[axis] * biases[axis] / stated[axis]);
            squares.fold(1.0, f32::max).min(WIDEST * WIDEST)
        };
        for (axis, variance) in scaled(&stated, ratio(off)).into_iter().enumerate() {
            self.filter.inflate(Filter::bias(axis), variance);
        }
        self.rest.count_anew();
        let beyond = ratio(found);
        if beyond > GREATEST_BIAS * GREATEST_BIAS {
            self.priors = scaled(&stated, beyond);
            self.is_bias_beyond_stated = true;
        }
    }

    /// Whether a mean force is gravity as the attitude has it, as far as that can be told.
    fn is_gravity(&self, force: &Vector) -> bool {
        let off = sum(force, &scaled(&self.matrix[2], GRAVITY));
        let bound = SIGMAS * GRAVITY * self.sigma() + GRAVITY_CHANGE;
        dot(&off, &off) <= bound * bound
    }

    /// The acceleration that a steady force may show, m/s²: where it is beside gravity as the attitude has it, and either
    /// holds the body up as gravity would, as in a steady acceleration on a level road, or is not of gravity's size.
    fn acceleration(&self, force: &Vector) -> Option<f32> {
        // A body that is turned over does not speed up steadily for as long as a rest takes to be seen; and against a
        // level that is not sure of itself no force is an acceleration.
        if self.filter.is_tumbled() || self.sigma() > UNSURE {
            return None;
        }
        let tolerance = SIGMAS * GRAVITY * self.force_tilt + GRAVITY_CHANGE;
        let size = libm::sqrtf(dot(force, force));
        let support = -dot(&self.matrix[2], force);
        let across = libm::sqrtf((size * size - support * support).max(0.0));
        let holds_up = (support - GRAVITY).abs() <= tolerance + SIGMAS * self.sigma() * across;
        let other = (size - GRAVITY).abs();
        let is_possible = !self.is_gravity(force) && (holds_up || other > tolerance);
        is_possible.then(|| across.max(other))
    }

    /// The level is not where it was believed to be, but where this force on it says.
    fn lose_level(&mut self, force: &Vector) {
        let [about_north, about_east] = tilt(force);
        let square = about_north * about_north + about_east * about_east;
        self.filter.doubt_level(square);
    }

    /// Takes the level from this force on it, for it stood where no vertical is.
    fn take_level(&mut self, force: &Vector) {
        self.lose_level(force);
        for (place, off) in tilt(force).into_iter().enumerate() {
            self.filter.measure(place, off, STANDING_TILT * STANDING_TILT);
            self.filter.inflate(place, MOVING_TILT * MOVING_TILT);
        }
    }

    /// The body stands: its rates are the biases, and its force is gravity.
    fn stand(&mut self, window: &Window, was_rest: bool) {
        self.filter.stand();
        self.course.stand(window.seconds);
        self.rested.seconds += window.seconds;
        self.rested.turned = sum(&self.rested.turned, &window.turned);
        if self.rested.seconds >= self.rested.due {
            self.rested.due = (2.0 * self.rested.seconds).min(LONGEST_REST);
            self.findings.biases = self.rested_biases();
        }
        if let Some(force) = window.force() {
            let is_beside = !was_rest && !self.is_gravity(&force);
            let force = turned(&self.matrix, &force);
            if is_beside {
                self.lose_level(&force);
            }
            self.findings.level = Some(tilt(&force));
        }
        // The body did not turn: what the gyro made of it is undone.
        self.attitude.correct(&[0.0, 0.0, -window.about]);
    }

    /// What the rest says of the biases that it has not said yet.
    fn rested_biases(&mut self) -> Option<[Vector; 2]> {
        let Rested { seconds, turned, .. } = self.rested;
        if seconds <= 0.0 {
            return None;
        }
        (self.rested.seconds, self.rested.turned) = (0.0, [0.0; 3]);
        self.rest.count_anew();
        let off = difference(&scaled(&turned, 1.0 / seconds), &self.bias);
        Some([off, core::array::from_fn(|axis| self.rest_variance(axis, seconds))])
    }

    /// Tells the filter at once what the rest says of the biases.
    pub(super) fn learn_biases(&mut self) {
        self.finish();
        self.findings.biases = self.rested_biases();
        if self.findings.biases.is_some() {
            self.task = Task::Learn(0);
            self.finish();
        }
    }

    /// Variance of a mean rate over so many seconds of a rest, (rad/s)².
    pub(super) fn rest_variance(&self, axis: usize, seconds: f32) -> f32 {
        let shaking = SHAKING / seconds;
        self.expected.walk[axis] / seconds + 2.0 * shaking * shaking
    }

    /// Puts attitude, biases and axes right.
    pub(super) fn correct(&mut self) {
        let Correction { rotation, bias, axes } = self.filter.take();
        self.attitude.correct(&rotation);
        self.matrix = self.attitude.matrix();
        self.bias = sum(&self.bias, &bias);
        for (row, more) in self.axes.iter_mut().zip(axes) {
            *row = sum(row, &more);
        }
        let stated = self.stated();
        let known = self.filter.bias_variances();
        let most =
            |axis: usize| GREATEST_BIAS * GREATEST_BIAS * stated[axis] + SURE * SURE * known[axis];
        let bias = self.bias;
        if (0..3).any(|axis| bias[axis] * bias[axis] > most(axis)) {
            self.widen_biases(&bias, &bias);
        }
    }
}

/// By how much a force on the level frame shows that it is turned, about north and east, rad: up to half a turn, which is
/// about north.
fn tilt([north, east, down]: &Vector) -> [f32; 2] {
    let across = libm::sqrtf(north * north + east * east);
    let angle = libm::atan2f(across, -down);
    if across > 0.0 { [-angle * east / across, angle * north / across] } else { [angle, 0.0] }
}

//! Supervision of the gyrovertical: the forces ten times a second, rest detection twice a second.

use super::filter::{BIAS, Correction, TURN};
use super::motion::GRAVITY;
use super::rest::{Found, Known, Means, WINDOW};
use super::stretch::Stretch;
use super::sums::Window;
use super::{Trust, Vertical};
use crate::math::quaternion::Vector;
use crate::math::rotation::{difference, dot, length, scaled, sum, turned};

/// Time between two steps of the filter, s.
pub(super) const STRETCH: f32 = 0.1;
/// Averaging time of the first forces, s.
const START: f32 = 0.2;
/// Initial 1σ of the tilt at rest, rad.
const START_TILT: f32 = 0.05;
/// Initial 1σ of the tilt on the way, rad: rest is not assumed.
const MOVING_TILT: f32 = 0.4;
/// Rate, rad/s, below which the body may be at rest at the start: engine and wind.
const CALM_RATE: f32 = 0.2;
/// Deviation of the force from gravity, m/s², below which the body may be at rest at the start.
const CALM_FORCE: f32 = 0.5;
/// Standard deviation of the tilt of a body at rest from the mean force of a window, 1σ, rad: wind
/// and engine.
const STANDING_TILT: f32 = 3e-4;
/// Rotation of a body at rest by wind, engine off, 1σ, rad: 2″.
const SHAKING: f32 = 1e-5;
/// Longest part of a rest whose mean rates are averaged together, s.
const LONGEST_REST: f32 = 64.0;
/// Part of gravity below which a force counts as free fall.
const FREE: f32 = 0.3;
/// Standard deviation of the tilt beyond which a steady force is rather gravity than an
/// acceleration, 1σ, rad: 0.2 m/s².
const UNSURE: f32 = 0.02;
/// Standard deviation of the tilt at which the level counts as lost, 1σ, rad.
const LOST: f32 = 0.1;
/// Part of the growth of the level's variance that gravity compensates, below which the gyros alone
/// carry the level.
const COASTING: f32 = 0.25;
/// Bias, in configured 1σ, beyond which the configuration is not trusted.
const GREATEST_BIAS: f32 = 5.0;
/// Significance, in σ of the bias, by which it must exceed that.
const SURE: f32 = 3.0;
/// Greatest factor by which a configured 1σ is inflated at once.
const WIDEST: f32 = 100.0;
/// Variance of a bias that is configured as zero, (rad/s)²: 0.002 °/h.
const LEAST_PRIOR: f32 = 1e-16;

/// Deviation of gravity from the standard value, m/s²: 9.78 at the equator, 9.83 at the poles.
const GRAVITY_CHANGE: f32 = 0.03;
/// Significance, in σ of the level, at which a force at rest deviates from gravity.
const SIGMAS: f32 = 5.0;
/// Relative deviation of the first forces from gravity up to which they set the level.
const BEGINNING: f32 = 0.5;

/// Work for a stretch, done in parts with each sample, so that no sample takes long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Task {
    /// No work is left.
    #[default]
    Nothing,
    /// Propagate the filter's rows.
    Carry,
    /// Propagate the filter's columns and add the process noise.
    Spread,
    /// Apply the zero-velocity pseudo-measurement north (0) or east (1).
    Stay(usize),
    /// Determine the reliability, and detect rest.
    Judge,
    /// Update the bias of an axis with the mean rate of a rest.
    Learn(usize),
    /// Update the tilt about north (0) or east (1) with the mean force of a rest.
    Level(usize),
    /// Apply the corrections.
    Correct,
}

/// Greatest number of tasks of a stretch, doubled for the samples that update the attitude and do
/// no task.
const TASKS: f32 = 24.0;

/// Measurements of a rest for the filter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Findings {
    /// Deviation of the biases, rad/s, and its variance.
    biases: Option<[Vector; 2]>,
    /// Deviation of the level, rad.
    level: Option<[f32; 2]>,
    /// Whether the biases are to be inflated afterwards: the part of the Earth rate in them changes
    /// as the body turns.
    is_inflated: bool,
}

impl Vertical {
    /// Number of tasks for each sample.
    pub(super) fn tasks_per_sample(period: f32) -> u32 {
        (TASKS * period / STRETCH) as u32 + 1
    }

    /// Ends a stretch: finishes the work of the previous one, and begins its own.
    #[inline(never)]
    pub(super) fn step(&mut self) {
        self.finish();
        let stretch = core::mem::take(&mut self.stretch);
        if self.trust == Trust::Starting || self.is_lost {
            return self.start();
        }
        let hidden = 2.0 * self.hidden();
        self.block = Stretch { is_rest: self.rest.is_at_rest, hidden, ..stretch };
        self.task = Task::Carry;
    }

    /// Does all remaining work.
    pub(super) fn finish(&mut self) {
        while self.task != Task::Nothing {
            self.work();
        }
    }

    /// Does one task.
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

    /// Zero-velocity pseudo-measurement; the motion is observed before it is applied.
    fn stay(&mut self, axis: usize) -> Task {
        if axis == 0
            && let Some(force) = self.filter.watch(&self.block)
        {
            self.take_level(&force);
        }
        self.filter.stay(axis, self.block.seconds);
        if axis == 0 { Task::Stay(1) } else { Task::Judge }
    }

    /// Task after rest detection.
    fn after_look(&self) -> Task {
        match self.findings {
            Findings { biases: Some(_), .. } => Task::Learn(0),
            Findings { level: Some(_), .. } => Task::Level(0),
            _ => Task::Correct,
        }
    }

    /// Updates a bias with the mean rates of a rest.
    fn learn(&mut self, axis: usize) -> Task {
        if let Some([off, variance]) = self.findings.biases {
            self.filter.measure(BIAS + axis, off[axis], variance[axis]);
        }
        if axis < 2 {
            return Task::Learn(axis + 1);
        }
        self.findings.biases = None;
        if core::mem::take(&mut self.findings.is_inflated) {
            self.inflate_biases();
        }
        self.after_look()
    }

    /// Updates a tilt with the mean force of a rest.
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

    /// Sets the level by the first forces, also after it was lost.
    fn start(&mut self) {
        if self.window.forced < START {
            return;
        }
        let Some(force) = self.window.force() else { return };
        let rate = self.window.rate();
        self.break_off();
        // A falling or thrown body shows no level.
        let beside = (length(&force) - GRAVITY).abs();
        if beside > BEGINNING * GRAVITY {
            return;
        }
        let is_calm = beside < CALM_FORCE && dot(&rate, &rate) < CALM_RATE * CALM_RATE;
        let is_first = self.trust == Trust::Starting;
        self.level_by(&force, if is_first && is_calm { START_TILT } else { MOVING_TILT });
        if !is_calm {
            self.filter.motion.expect_motion();
        }
        self.is_lost = false;
        self.trust = Trust::Level;
    }

    /// Levels the body by this force on its axes, which shows the tilt with this 1σ, rad.
    pub(super) fn level_by(&mut self, force: &Vector, sigma: f32) {
        let [about_north, about_east] = tilt(&turned(&self.matrix, force));
        self.attitude.correct(&[about_north, about_east, 0.0]);
        self.matrix = self.attitude.rough_matrix();
        self.filter.relevel(sigma);
    }

    /// Determines the reliability of the level.
    fn judge(&mut self) {
        let block = &self.block;
        let is_forced = block.forced > 0.5 * block.seconds;
        let is_free = is_forced && block.force() < FREE * GRAVITY;
        if !is_forced || is_free {
            // Growth that gravity could not compensate meanwhile is no measure of what follows.
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

    /// Tests for rest; at rest the rates are the biases and the force is gravity.
    fn look(&mut self) {
        let window = core::mem::take(&mut self.window);
        let force = window.force();
        let means = Means {
            rate: window.rate(),
            force,
            walk: window.walk().unwrap_or(self.expected.walk),
            acceleration: force.and_then(|force| self.acceleration(&force)),
        };
        if self.has_unlearnt_bias() {
            self.sway.push(&window);
        }
        let was_rest = self.is_at_rest();
        match self.rest.push(means, &self.known()) {
            Found::Rest => self.stand(&window, was_rest),
            Found::Motion => self.move_on(&window, was_rest),
            Found::StrangeBias => {
                self.move_on(&window, was_rest);
                // Constant rates were taken for a rotation until now.
                let turned = dot(&self.matrix[2], &self.rest.steady.turned);
                self.filter.inflate(TURN, turned * turned);
                self.widen_biases(&difference(&means.rate, &self.bias), &means.rate);
            }
        }
    }

    /// Prior knowledge of the gyros for the detector.
    fn known(&self) -> Known {
        Known {
            biases: self.bias,
            variances: self.filter.bias_variances(),
            stated: self.stated(),
            walk: self.expected.walk,
        }
    }

    /// Variance of the Earth rate that a bias may contain, (rad/s)².
    pub(super) fn hidden(&self) -> f32 {
        if self.knows_north { 0.0 } else { self.unknown }
    }

    /// Configured variances of the biases, including the Earth rate that they may contain,
    /// (rad/s)².
    fn stated(&self) -> Vector {
        let hidden = self.hidden();
        self.priors.map(|prior| (prior + hidden).max(LEAST_PRIOR))
    }

    /// Begins or continues motion. While north is unknown, the biases contain the Earth rate at
    /// rest, which is another as soon as the body turns.
    fn move_on(&mut self, window: &Window, was_rest: bool) {
        self.course.drive(window);
        self.findings.biases = self.rested_biases();
        self.rested.due = 0.0;
        if was_rest && !self.knows_north {
            match self.findings.biases {
                Some(_) => self.findings.is_inflated = true,
                None => self.inflate_biases(),
            }
        }
    }

    /// Inflates the biases by the Earth rate that they may contain.
    pub(super) fn inflate_biases(&mut self) {
        for axis in 0..3 {
            self.filter.inflate(BIAS + axis, 2.0 * self.unknown);
        }
    }

    /// Inflates biases that deviate by `off`, rad/s, and were found to be `found`. Where one
    /// exceeds its configured 1σ by far, the configuration is inflated for all gyros, because they
    /// are of one kind.
    fn widen_biases(&mut self, off: &Vector, found: &Vector) {
        let stated = self.stated();
        let ratio = |biases: &Vector| {
            let squares = (0..3).map(|axis| biases[axis] * biases[axis] / stated[axis]);
            squares.fold(1.0, f32::max).min(WIDEST * WIDEST)
        };
        for (axis, variance) in scaled(&stated, ratio(off)).into_iter().enumerate() {
            self.filter.inflate(BIAS + axis, variance);
        }
        self.rest.count_anew();
        let beyond = ratio(found);
        if beyond > GREATEST_BIAS * GREATEST_BIAS {
            self.priors = scaled(&stated, beyond);
            self.is_bias_beyond_stated = true;
        }
    }

    /// Whether a mean force is gravity for the present attitude, within its uncertainty.
    fn is_gravity(&self, force: &Vector) -> bool {
        let off = sum(force, &scaled(&self.matrix[2], GRAVITY));
        let bound = SIGMAS * GRAVITY * self.sigma() + GRAVITY_CHANGE;
        dot(&off, &off) <= bound * bound
    }

    /// Acceleration that a steady force may show, m/s²: where it deviates from gravity for the
    /// present attitude, and either supports the body as gravity would, as in steady acceleration
    /// on a level road, or is not of gravity's magnitude.
    fn acceleration(&self, force: &Vector) -> Option<f32> {
        // A body that is turned over does not accelerate steadily for as long as rest detection
        // takes; and against an uncertain level no force counts as an acceleration.
        if self.filter.motion.is_tumbled() || self.sigma() > UNSURE {
            return None;
        }
        let tolerance = SIGMAS * GRAVITY * self.force_tilt + GRAVITY_CHANGE;
        let size = length(force);
        let support = -dot(&self.matrix[2], force);
        let across = libm::sqrtf((size * size - support * support).max(0.0));
        let holds_up = (support - GRAVITY).abs() <= tolerance + SIGMAS * self.sigma() * across;
        let other = (size - GRAVITY).abs();
        let is_possible = !self.is_gravity(force) && (holds_up || other > tolerance);
        is_possible.then(|| across.max(other))
    }

    /// Inflates the level by its deviation from the one that this force on it shows.
    fn lose_level(&mut self, force: &Vector) {
        let [about_north, about_east] = tilt(force);
        let square = about_north * about_north + about_east * about_east;
        self.filter.inflate_level(square);
    }

    /// Sets the level by this force on it, because the filter's vertical was invalid.
    fn take_level(&mut self, force: &Vector) {
        self.lose_level(force);
        for (place, off) in tilt(force).into_iter().enumerate() {
            self.filter.measure(place, off, STANDING_TILT * STANDING_TILT);
            self.filter.inflate(place, MOVING_TILT * MOVING_TILT);
        }
    }

    /// Processes a rest: the rates are the biases, and the force is gravity.
    fn stand(&mut self, window: &Window, was_rest: bool) {
        self.filter.stand();
        self.course.stand(window.seconds);
        self.rested.part.add(window.seconds, &window.turned);
        if self.rested.part.seconds >= self.rested.due {
            self.rested.due = (2.0 * self.rested.part.seconds).min(LONGEST_REST);
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
        // The body did not turn, so the rotation from the gyro is undone. That of the first window is in the variances
        // until then, and what the rest shows of the biases undoes it.
        if was_rest {
            self.attitude.correct(&[0.0, 0.0, -window.about]);
        }
    }

    /// Measurement of the biases by the part of the rest that was not used yet.
    fn rested_biases(&mut self) -> Option<[Vector; 2]> {
        let part = core::mem::take(&mut self.rested.part);
        if part.seconds <= 0.0 {
            return None;
        }
        self.rest.count_anew();
        let off = difference(&part.rates(), &self.bias);
        let variance = |axis| self.mean_variance(axis, part.seconds, SHAKING);
        Some([off, core::array::from_fn(variance)])
    }

    /// Updates the filter at once with the biases of the rest.
    pub(super) fn learn_biases(&mut self) {
        self.finish();
        self.findings.biases = self.rested_biases();
        if self.findings.biases.is_some() {
            self.task = Task::Learn(0);
            self.finish();
        }
    }

    /// Variance of a mean rate over `seconds` in which the body swings to and fro by an angle, 1σ, rad; (rad/s)².
    pub(super) fn mean_variance(&self, axis: usize, seconds: f32, angle: f32) -> f32 {
        let swung = angle / seconds;
        self.expected.walk[axis] / seconds + 2.0 * swung * swung
    }

    /// Applies the corrections to attitude, biases and axes.
    pub(super) fn correct(&mut self) {
        let Correction { rotation, bias, axes } = self.filter.take();
        self.attitude.correct(&rotation);
        self.matrix = self.attitude.rough_matrix();
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

/// Tilt of the level frame that a force on it shows, about north and east, rad; up to half a turn,
/// which is taken about north.
fn tilt([north, east, down]: &Vector) -> [f32; 2] {
    let across = libm::sqrtf(north * north + east * east);
    let angle = libm::atan2f(across, -down);
    if across > 0.0 { [-angle * east / across, angle * north / across] } else { [angle, 0.0] }
}

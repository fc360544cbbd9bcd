//! Whitening filter: turns dwell means with coloured noise into rows of unit white noise, in fixed
//! memory.
//!
//! The noise of successive dwell means is white (N), plus a random walk (K), plus flicker (B) as a
//! sum of Gauss–Markov processes, one for each factor of four in correlation time. A Kalman filter
//! of these states alone predicts what each dwell mean has in common with its predecessors. The
//! filter is linear, so applied to every column of a regression and to its left side it gives
//! innovations that are independent with variance one: ordinary least squares on them is
//! generalised least squares on the dwells. Each process is averaged exactly over a dwell; for K
//! its variance is K²(a + T/3), a being the dwell's start and T its length. Of the angle error that
//! sway compensation leaves, a dwell sees the change over its time, divided by it.

use super::model::GyroNoise;
use crate::math::Scalar;
use crate::signal::SwayNoise;

/// Number of Gauss–Markov processes that make up flicker noise.
const FLICKER_STATES: usize = 7;
/// Number of rate processes: flicker and the random walk.
const RATES: usize = FLICKER_STATES + 1;
/// Number of all states: the rate processes, and the angle error of sway compensation, which comes
/// last and is usually absent.
const STATES: usize = RATES + 1;
/// Ratio of successive correlation times; the sum follows 1/f within ±2 % at this spacing.
const SPACING: f64 = 4.0;
/// Natural logarithm of [`SPACING`].
const LOG_SPACING: f64 = 1.386_294_361_119_890_6;

/// One noise process: a Gauss–Markov process, or a random walk (infinite correlation time).
#[derive(Clone, Copy, Debug, Default)]
struct Process {
    /// Correlation time, s; infinite for the random walk.
    correlation: f64,
    /// Density of the driving noise, (rad/s)²/s.
    drive: f64,
}

/// Transition of one process over an interval: its end value and its mean over the interval.
#[derive(Clone, Copy, Debug, Default)]
struct Step<T> {
    /// End value for a unit start value.
    end: T,
    /// Mean for a unit start value.
    mean: T,
    /// Variance that the interval adds to the end value.
    end_variance: T,
    /// Covariance that the interval adds between end value and mean.
    cross: T,
    /// Variance that the interval adds to the mean.
    mean_variance: T,
}

impl Process {
    /// Transition over an interval, for e₁ = 1 − e⁻ˣ with x the interval over the correlation time.
    fn step<T: Scalar>(&self, seconds: f64, e1: f64) -> Step<T> {
        let x = seconds / self.correlation;
        let power = self.drive * seconds;
        Step::of(if x < 1e-3 {
            // Short intervals take the limits of a random walk, with the first-order decay, because
            // the closed forms cancel.
            [
                1.0 - e1,
                1.0 - 0.5 * x,
                power * (1.0 - x),
                0.5 * power * (1.0 - x),
                power / 3.0 * (1.0 - 0.75 * x),
            ]
        } else {
            let (per_x, e2) = (1.0 / x, doubled(e1));
            let power = power * per_x;
            [
                1.0 - e1,
                e1 * per_x,
                0.5 * power * e2,
                0.5 * power * e1 * e1 * per_x,
                power * (x - 2.0 * e1 + 0.5 * e2) * per_x * per_x,
            ]
        })
    }
}

impl<T: Scalar> Step<T> {
    /// Step of these numbers, in the order of its fields.
    fn of(numbers: [f64; 5]) -> Self {
        let [end, mean, end_variance, cross, mean_variance] = numbers.map(T::of);
        Self { end, mean, end_variance, cross, mean_variance }
    }
}

/// Transition of the angle error of sway compensation over an interval, as a rate: the parts of a
/// [`Step`] in their order.
#[inline(never)]
fn sway_step(sway: &SwayNoise, seconds: f64) -> [f64; 5] {
    let e1 = -libm::expm1(-seconds / sway.correlation.0);
    let (rate, added) = (1.0 / seconds, sway.angle_variance * doubled(e1));
    let cross = added * rate;
    [1.0 - e1, -e1 * rate, added, cross, cross * rate]
}

/// Value 1 − e⁻²ˣ from 1 − e⁻ˣ, without cancellation.
fn doubled(e1: f64) -> f64 {
    e1 * (2.0 - e1)
}

/// Model of the filter: the processes, and the parts outside them.
#[derive(Clone, Copy, Debug)]
struct Model {
    /// Flicker processes from fast to slow, then the random walk.
    processes: [Process; RATES],
    /// White density of the flicker faster than the processes, (rad/s)²·s.
    fast: f64,
    /// Noise that sway compensation leaves; zero without compensation.
    sway: SwayNoise,
}

/// Transitions of all processes over the latest interval, kept because dwells mostly have equal
/// length.
#[derive(Clone, Copy, Debug)]
struct Steps<T> {
    /// Length of the interval, s; NaN before the first.
    seconds: f64,
    /// Variance that the flicker faster than all processes adds to a mean, (rad/s)².
    fast: f64,
    /// Transition of each process.
    of: [Step<T>; STATES],
}

impl<T: Scalar> Steps<T> {
    /// No transitions yet.
    fn none() -> Self {
        Self { seconds: f64::NAN, fast: 0.0, of: [Step::default(); STATES] }
    }

    /// Transitions over `seconds`, computed anew where the length changed.
    fn over(&mut self, model: &Model, seconds: f64) -> &[Step<T>; STATES] {
        if self.seconds != seconds {
            self.seconds = seconds;
            self.renew(model);
        }
        &self.of
    }

    /// Computes the transitions. Correlation times are in the ratio of [`SPACING`], so one
    /// exponential serves them all.
    #[inline(never)]
    fn renew(&mut self, model: &Model) {
        let (processes, seconds) = (&model.processes, self.seconds);
        self.fast = model.fast / seconds;
        self.of[FLICKER_STATES] = processes[FLICKER_STATES].step(seconds, 0.0);
        let slowest = processes[FLICKER_STATES - 1].correlation;
        let mut e1 = -libm::expm1(-seconds / slowest);
        for index in (0..FLICKER_STATES).rev() {
            self.of[index] = processes[index].step(seconds, e1);
            e1 = doubled(doubled(e1));
        }
        if model.sway.angle_variance > 0.0 {
            self.of[RATES] = Step::of(sway_step(&model.sway, seconds));
        }
    }
}

/// State of the Kalman filter: an estimate for every column, with one covariance for all.
#[derive(Clone, Debug)]
struct Belief<const COLUMNS: usize, T> {
    /// Number of states that are in use.
    active: usize,
    /// Covariance of the states, lower triangle.
    covariance: [[T; STATES]; STATES],
    /// Estimates of the states, one for each column.
    state: [[T; COLUMNS]; STATES],
}

impl<const COLUMNS: usize, T: Scalar> Belief<COLUMNS, T> {
    /// Propagates the states over an interval.
    fn advance(&mut self, steps: &[Step<T>; STATES]) {
        for (i, step) in steps.iter().enumerate().take(self.active) {
            for value in &mut self.state[i] {
                *value *= step.end;
            }
            for (shared, other) in self.covariance[i].iter_mut().zip(steps).take(i + 1) {
                *shared *= step.end * other.end;
            }
            self.covariance[i][i] += step.end_variance;
        }
    }

    /// Subtracts from a row the predicted mean: what remains is the innovation.
    fn innovation(&self, steps: &[Step<T>; STATES], row: &mut [T; COLUMNS]) {
        for (step, state) in steps.iter().zip(&self.state).take(self.active) {
            for (value, state) in row.iter_mut().zip(state) {
                *value -= step.mean * *state;
            }
        }
    }

    /// Updates the states with an innovation of this variance and covariance with the states.
    fn learn(&mut self, cross: &[T; STATES], variance: T, innovation: &[T; COLUMNS]) {
        for i in 0..self.active {
            let gain = cross[i] / variance;
            for (state, innovation) in self.state[i].iter_mut().zip(innovation) {
                *state += gain * *innovation;
            }
            for (shared, other) in self.covariance[i].iter_mut().zip(cross).take(i + 1) {
                *shared -= gain * *other;
            }
        }
    }

    /// Covariance of the states at an interval's end with its mean, and the variance of the mean.
    fn mean_covariance(&self, steps: &[Step<T>; STATES], white: T) -> ([T; STATES], T) {
        let mut variance = white;
        let mut cross = [T::default(); STATES];
        for i in 0..self.active {
            let mut shared = T::default();
            for (covariance, step) in self.covariance[i].iter().zip(steps).take(i + 1) {
                shared += *covariance * step.mean;
            }
            for (row, step) in self.covariance.iter().zip(steps).take(self.active).skip(i + 1) {
                shared += row[i] * step.mean;
            }
            cross[i] = steps[i].cross;
            cross[i] += steps[i].end * shared;
            variance += steps[i].mean * shared;
            variance += steps[i].mean_variance;
        }
        (cross, variance)
    }
}

/// The whitening filter; `COLUMNS` counts the regression's columns and its left side.
#[must_use]
#[derive(Clone, Debug)]
pub struct Whitener<const COLUMNS: usize, T = f64> {
    /// Processes and their parameters.
    model: Model,
    /// Estimated states.
    belief: Belief<COLUMNS, T>,
    /// End of the latest dwell, s.
    end: Option<f64>,
    /// Whether there is coloured noise; otherwise rows are only scaled.
    coloured: bool,
    /// Transitions over the latest interval between dwells.
    gap: Steps<T>,
    /// Transitions over the latest dwell.
    dwell: Steps<T>,
}

impl<const COLUMNS: usize, T: Scalar> Whitener<COLUMNS, T> {
    /// Filter for a gyro whose shortest dwell lasts `shortest` seconds.
    ///
    /// Flicker is modelled between correlation times of a third of that dwell and 4096/3 of it; the
    /// low cut-off is therefore 1/(2π·1365·`shortest`) Hz. Slower flicker is a constant to the
    /// regression, which has a column for it. Faster flicker averages like white noise: processes
    /// of variance s² and correlation time τ leave 2s²τ/T, summed over τ/4, τ/16, …
    pub fn new(noise: &GyroNoise, shortest: f64) -> Self {
        let zero = T::default();
        let mut belief = Belief {
            active: RATES,
            covariance: [[zero; STATES]; STATES],
            state: [[zero; COLUMNS]; STATES],
        };
        let flicker = noise.bias_instability.0 * noise.bias_instability.0 / core::f64::consts::PI;
        let (variance, mut correlation) = (flicker * LOG_SPACING, shortest / 3.0);
        let fast = 2.0 * variance * correlation / (SPACING - 1.0);
        let mut processes = [Process::default(); RATES];
        for (index, process) in processes.iter_mut().enumerate().take(FLICKER_STATES) {
            *process = Process { correlation, drive: 2.0 * variance / correlation };
            belief.covariance[index][index] = T::of(variance);
            correlation *= SPACING;
        }
        processes[FLICKER_STATES] = Process {
            correlation: f64::INFINITY,
            drive: noise.rate_random_walk.0 * noise.rate_random_walk.0,
        };
        let model = Model { processes, fast, sway: SwayNoise::NONE };
        let coloured = noise.is_coloured();
        Self { model, belief, end: None, coloured, gap: Steps::none(), dwell: Steps::none() }
    }

    /// The filter with the noise that sway compensation leaves.
    pub fn with_sway(mut self, sway: &SwayNoise) -> Self {
        if sway.angle_variance > 0.0 {
            self.model.sway = *sway;
            self.belief.active = STATES;
            self.belief.covariance[RATES][RATES] = T::of(sway.angle_variance);
            self.coloured = true;
        }
        self
    }

    /// Whitens the row of a dwell mean over [`start`, `end`] (s) in place; `white` is the variance
    /// that is independent of other dwells, (rad/s)². Dwells must come in the order of time.
    pub fn whiten(&mut self, start: f64, end: f64, white: f64, row: &mut [T; COLUMNS]) {
        if !self.coloured {
            scale(row, T::of(white));
            return;
        }
        let gap = self.end.replace(end).map_or(0.0, |previous| start - previous);
        if gap > 0.0 {
            self.belief.advance(self.gap.over(&self.model, gap));
        }
        self.observe(end - start, white, row);
    }

    /// Predicts the dwell's mean, replaces the row by its normalised innovation, and updates the
    /// states.
    fn observe(&mut self, seconds: f64, white: f64, row: &mut [T; COLUMNS]) {
        let Self { model, belief, dwell, .. } = self;
        dwell.over(model, seconds);
        let Steps { fast, of: steps, .. } = dwell;
        let (cross, variance) = belief.mean_covariance(steps, T::of(white + *fast));
        belief.innovation(steps, row);
        belief.advance(steps);
        belief.learn(&cross, variance, row);
        scale(row, variance);
    }
}

/// Divides a row by the standard deviation of its noise.
fn scale<const COLUMNS: usize, T: Scalar>(row: &mut [T; COLUMNS], variance: T) {
    let weight = T::of(1.0) / variance.root();
    for value in row {
        *value *= weight;
    }
}

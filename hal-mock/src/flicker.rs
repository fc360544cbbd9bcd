//! Flicker noise (bias instability) as a sum of Gauss–Markov processes.
//!
//! A process of variance v and corner a (rad/s) has the one-sided spectrum 4va/(a² + ω²). Corners in
//! geometric progression of ratio ρ with equal v = B²·ln ρ/π add up to B²/(π f) between the first and
//! the last, where the sum is a half (the integral of a sech over ln a). With ρ ≤ 4 its ripple is
//! 2·sech(π²/ln ρ) ≤ 0.33 %. Inside the cut-offs the Allan deviation is flat: √(2 ln 2/π)·B = 0.664 B.

use crate::noise::Generator;

/// Most processes: with a corner ratio of 4 they span nine and a half decades.
const MAXIMUM: usize = 16;

/// Largest ratio of neighbouring corners.
const RATIO: f64 = 4.0;

/// Longest time a process is held between its updates, as a part of its correlation time.
const HOLD: f64 = 1.0 / 16.0;

/// One Gauss–Markov process with its exact discretisation: x ← keep·x + kick·w.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Process {
    /// Where the process stands, in the unit of the noise.
    value: f64,
    /// What is left of it after one step, 1.
    keep: f64,
    /// Deviation of what a step adds, in the unit of the noise.
    kick: f64,
}

impl Process {
    /// A process of deviation `sigma` that is updated after each `step` of its correlation time, in
    /// its stationary state.
    fn new(sigma: f64, step: f64, noise: &mut Generator) -> Self {
        let kick = sigma * libm::sqrt(-libm::expm1(-2.0 * step));
        Self { value: sigma * noise.gaussian(), keep: libm::exp(-step), kick }
    }

    /// Moves on by one hold; returns by how much the value has changed.
    fn update(&mut self, noise: &mut Generator) -> f64 {
        let before = self.value;
        self.value = self.keep * before + self.kick * noise.gaussian();
        self.value - before
    }
}

/// How seldom a process of corner `corner` in rad/s is updated that is sampled every `interval_s`: once
/// in 2ᵖ samples, of which this is the power p.
fn hold(corner: f64, interval_s: f64) -> u8 {
    let mut power = 0;
    while 2.0 * (1_u64 << power) as f64 * corner * interval_s <= HOLD && power < 40 {
        power += 1;
    }
    power
}

/// Flicker noise of one-sided spectrum S(f) = B²/(π f) between two cut-offs.
#[derive(Clone, Debug, PartialEq)]
pub struct Flicker {
    /// Fastest first, so that an update can stop at the first that is held.
    processes: [Process; MAXIMUM],
    /// For each process the number of zero bits in which the counter of samples ends when it is updated.
    holds: [u8; MAXIMUM],
    /// How many of the processes there are.
    count: usize,
    /// Sum of all of them.
    sum: f64,
    /// Samples that were taken.
    samples: u64,
    /// Where the steps are drawn from.
    noise: Generator,
}

impl Flicker {
    /// Flicker of bias instability `b` (any unit; samples come in the same), cut-offs `low_hz` <
    /// `high_hz` where the power falls to a half, sampled at `rate_hz`.
    ///
    /// Zero `b` or an empty band gives no noise. A band of more than 4¹⁶ keeps its upper part. A
    /// cut-off above `rate_hz`/2 folds power back, as sampling does.
    #[must_use]
    pub fn new(b: f64, low_hz: f64, high_hz: f64, rate_hz: f64, mut noise: Generator) -> Self {
        let (count, ratio) = if b > 0.0 { spacing(low_hz, high_hz) } else { (0, 1.0) };
        let sigma = b * libm::sqrt(libm::log(ratio) / core::f64::consts::PI);
        let mut corner = core::f64::consts::TAU * high_hz / libm::sqrt(ratio);
        let (mut processes, mut holds) = ([Process::default(); MAXIMUM], [0; MAXIMUM]);
        for (process, power) in processes.iter_mut().zip(&mut holds).take(count) {
            *power = hold(corner, 1.0 / rate_hz);
            let step = (1_u64 << *power) as f64 * corner * (1.0 / rate_hz);
            *process = Process::new(sigma, step, &mut noise);
            corner /= ratio;
        }
        let sum = processes.iter().map(|process| process.value).sum();
        Self { processes, holds, count, sum, samples: 0, noise }
    }

    /// The next sample, in the unit of `b`.
    ///
    /// Slow processes are held for up to 1/16 of their correlation time; the stairs this leaves change
    /// the spectrum of the sum by less than 0.8 % anywhere in the band (from the closed form of held
    /// processes at 100 Hz and 2 kHz).
    #[inline]
    pub fn sample(&mut self) -> f64 {
        let zeros = self.samples.trailing_zeros();
        for (process, power) in self.processes.iter_mut().zip(&self.holds).take(self.count) {
            if zeros < u32::from(*power) {
                break;
            }
            self.sum += process.update(&mut self.noise);
        }
        self.samples = self.samples.wrapping_add(1);
        self.sum
    }
}

/// Number of processes and the ratio of their corners for a band; (0, 1) when it is empty.
fn spacing(low_hz: f64, high_hz: f64) -> (usize, f64) {
    if !(low_hz > 0.0 && high_hz > low_hz) {
        return (0, 1.0);
    }
    let span = libm::log(high_hz / low_hz);
    let count = libm::ceil(span / libm::log(RATIO)) as usize;
    if count > MAXIMUM {
        return (MAXIMUM, RATIO);
    }
    (count, libm::exp(span / count as f64))
}

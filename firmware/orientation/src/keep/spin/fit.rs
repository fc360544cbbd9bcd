//! The lift's phase in the forces of about one turn: least squares over every sample.
//!
//! `s = a_y − j a_z = c₀ + c₁τ + (Q₀ + Q₁τ) e^{jγ̂}`, γ̂ being the angle that is believed and τ the place in the turn
//! from −1 to 1. What the accelerometers feel of the spin itself, −ρω², and its slow change are c; the lift and
//! its change, Q. The phase of Q₀ is by how much γ̂ is behind at the middle. What goes round otherwise is taken out
//! ([`super::harmonics`]), in turns with the rest.

use super::Accelerometer;
use super::complex::Complex;
use super::harmonics::{Harmonics, PARTS, Ripple};
use super::phase_accumulator::sine_and_cosine;
use crate::units::{Angle, SpinForce};

/// One step of a force, m/s².
const STEP: f32 = 1e-5;
/// Least samples of a fit: twice its eight real unknowns.
const LEAST: u32 = 16;
/// Complex unknowns of a fit.
const UNKNOWNS: f32 = 4.0 + PARTS as f32;
/// How often the rest is fitted after what goes round otherwise, over one turn: each leaves two fifths, and of four turns
/// a fortieth.
const PASSES: u32 = 8;
/// By what that raises the variance of the lift of one turn.
const CROWDED: f32 = 0.3;
/// Part of what goes round otherwise that one turn does not tell from the lift.
const HIDDEN: f32 = 0.25;
/// How much of the turning part must be its own: samples that do not go round cannot tell it from a force.
const GOING_ROUND: f32 = 0.01;
/// Part of the forces' power that sums in single precision may make of what is left of it.
const PRECISION: f32 = 2e-7;
/// What the rounding of the forces leaves at least, (m/s²)².
const ROUNDING: f32 = STEP * STEP / 6.0;

/// Sums over the samples of a turn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Force that is taken off first: the turn's first one.
    base: [i32; 2],
    /// Half the samples that the turn is expected to have, and one over it.
    half: f32,
    scale: f32,
    /// Samples, those without force included.
    samples: u32,
    count: u32,
    place: f32,
    place_square: f32,
    turning: [Complex; 3],
    force: [Complex; 2],
    turned_force: [Complex; 2],
    /// Of either force, the base taken off.
    power: [f32; 2],
    harmonics: Harmonics,
}

/// What a turn shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// The lift at the middle, by γ̂, m/s².
    pub(super) lift: Complex,
    /// By how much it changes from the middle to either end, m/s².
    pub(super) change: f32,
    /// Variance of what is left of a sample, both forces together, (m/s²)².
    pub(super) noise: f32,
    /// By which that counts in either part of the lift.
    pub(super) share: f32,
    /// What goes round otherwise, m/s².
    pub(super) ripple: Ripple,
    /// Samples, and turns.
    pub(super) count: f32,
    pub(super) turns: u32,
}

impl Fit {
    /// What goes round otherwise may hide of the lift, m/s²: of one turn a quarter, of more the less.
    pub(super) fn crowded(&self) -> f32 {
        let turns = self.turns as f32;
        HIDDEN * self.ripple.size() / (turns * turns)
    }
}

impl Sums {
    /// For a turn of about so many samples.
    pub(super) fn of(samples: f32) -> Self {
        let half = 0.5 * samples;
        Self { half, scale: 1.0 / half, ..Self::default() }
    }

    /// Samples of it.
    pub(super) fn samples(&self) -> u32 {
        self.samples
    }

    /// What part of them comes after the middle, where the fit tells the phase.
    pub(super) fn part_after_middle(&self) -> f32 {
        let samples = self.samples as f32;
        (samples - 1.0 - self.half) / samples
    }

    /// Those that had a force.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// Passes over samples that are missing: they have no force.
    pub(super) fn pass(&mut self, samples: u32) {
        self.samples = self.samples.saturating_add(samples);
    }

    /// Adds a sample. Written out: this is the sample's whole cost.
    #[inline]
    pub(super) fn push(&mut self, angle: Angle, force: Option<[SpinForce; 2]>) {
        let place = (self.samples as f32 - self.half) * self.scale;
        self.samples = self.samples.saturating_add(1);
        let Some([y, z]) = force.filter(|[y, z]| !y.is_saturated() && !z.is_saturated()) else {
            return;
        };
        if self.count == 0 {
            self.base = [y.0, z.0];
        }
        self.count += 1;
        let [sine, cosine] = sine_and_cosine(angle);
        let real = y.0.wrapping_sub(self.base[0]) as f32 * STEP;
        let imaginary = self.base[1].wrapping_sub(z.0) as f32 * STEP;
        // s e^{−jγ̂}
        let turned_real = real * cosine + imaginary * sine;
        let turned_imaginary = imaginary * cosine - real * sine;
        let (placed_cosine, placed_sine) = (place * cosine, place * sine);
        self.place += place;
        self.place_square += place * place;
        self.turning[0].real += cosine;
        self.turning[0].imaginary += sine;
        self.turning[1].real += placed_cosine;
        self.turning[1].imaginary += placed_sine;
        self.turning[2].real += place * placed_cosine;
        self.turning[2].imaginary += place * placed_sine;
        self.force[0].real += real;
        self.force[0].imaginary += imaginary;
        self.force[1].real += place * real;
        self.force[1].imaginary += place * imaginary;
        self.turned_force[0].real += turned_real;
        self.turned_force[0].imaginary += turned_imaginary;
        self.turned_force[1].real += place * turned_real;
        self.turned_force[1].imaginary += place * turned_imaginary;
        self.power[0] += real * real;
        self.power[1] += imaginary * imaginary;
        self.harmonics.push(place, [cosine, sine], [real, imaginary]);
    }

    /// The accelerometers that showed one value all the time.
    pub(super) fn stuck(&self) -> Option<Accelerometer> {
        match self.power.map(|power| power > 0.0) {
            [false, false] => Some(Accelerometer::Both),
            [false, true] => Some(Accelerometer::Y),
            [true, false] => Some(Accelerometer::Z),
            [true, true] => None,
        }
    }

    /// What the samples of so many turns show; none where they are too few, or do not go round.
    pub(super) fn fit(&self, turns: u32) -> Option<Fit> {
        let normal = Normal::of(self)?;
        let count = self.count as f32;
        let even = [count, self.place];
        let first = [self.turning[0], self.turning[1]];
        let mut ripple = Ripple::default();
        let mut solved = normal.solve(self.force, self.turned_force);
        for _ in 0..PASSES / turns {
            self.harmonics.approach(&mut ripple, even, first, &solved.model);
            let [force, placed, turned, turned_placed] =
                self.harmonics.shares(&ripple, even, first);
            solved = normal.solve(
                [self.force[0] - force, self.force[1] - placed],
                [self.turned_force[0] - turned, self.turned_force[1] - turned_placed],
            );
        }
        let explained = solved.explained + self.harmonics.explained(&ripple, count);
        let power = self.power[0] + self.power[1];
        let least = ROUNDING + PRECISION * power / count;
        let noise = ((power - explained) / (count - UNKNOWNS)).max(least);
        let [_, _, lift, change] = solved.model;
        let change = libm::sqrtf(change.power());
        let share = normal.share() * (1.0 + CROWDED / (turns * turns) as f32);
        Some(Fit { lift, change, noise, share, ripple, count, turns })
    }
}

/// The normal equations of what is steady and of the lift.
struct Normal {
    /// A⁻¹ of the steady part, its upper triangle.
    inverse: [f32; 3],
    /// The turning part's columns B, and A⁻¹B.
    turning: [Complex; 3],
    first: [Complex; 2],
    second: [Complex; 2],
    /// What is left to the turning part: A − B*A⁻¹B, Hermitian, and its determinant.
    m11: f32,
    m12: Complex,
    m22: f32,
    whole: f32,
}

/// A solution.
struct Solved {
    /// Steady force, its change, lift, its change.
    model: [Complex; 4],
    /// Power that it explains.
    explained: f32,
}

impl Normal {
    /// Of sums; none where the samples are too few, or do not go round.
    fn of(sums: &Sums) -> Option<Self> {
        if sums.count < LEAST {
            return None;
        }
        let count = sums.count as f32;
        let determinant = count * sums.place_square - sums.place * sums.place;
        let inverse =
            [sums.place_square / determinant, -sums.place / determinant, count / determinant];
        let turning = sums.turning;
        let [e0, e1, e2] = turning;
        let first = steady(&inverse, e0, e1);
        let second = steady(&inverse, e1, e2);
        let m11 = count - both(e0, e1, &first).real;
        let m12 = Complex { real: sums.place, imaginary: 0.0 } - both(e0, e1, &second);
        let m22 = sums.place_square - both(e1, e2, &second).real;
        let whole = m11 * m22 - m12.power();
        let goes_round = whole >= GOING_ROUND * m11 * m22 && m11 > 0.0;
        goes_round.then_some(Self { inverse, turning, first, second, m11, m12, m22, whole })
    }

    /// Of the force's sums, and of those turned back.
    fn solve(&self, force: [Complex; 2], turned: [Complex; 2]) -> Solved {
        let [e0, e1, e2] = self.turning;
        let own = steady(&self.inverse, force[0], force[1]);
        let r1 = turned[0] - both(e0, e1, &own);
        let r2 = turned[1] - both(e1, e2, &own);
        let lift = (r1.scaled(self.m22) - self.m12.times(r2)).scaled(1.0 / self.whole);
        let change = (r2.scaled(self.m11) - self.m12.against(r1)).scaled(1.0 / self.whole);
        let explained = both(own[0], own[1], &force).real + both(lift, change, &[r1, r2]).real;
        let [steady, its_change] = [0, 1]
            .map(|i: usize| own[i] - self.first[i].times(lift) - self.second[i].times(change));
        Solved { model: [steady, its_change, lift, change], explained }
    }

    /// By which a sample's noise counts in either part of the lift.
    fn share(&self) -> f32 {
        0.5 * self.m22 / self.whole
    }
}

/// A⁻¹ times a column, A⁻¹ by its upper triangle.
fn steady(inverse: &[f32; 3], one: Complex, other: Complex) -> [Complex; 2] {
    let [a, b, c] = *inverse;
    [one.scaled(a) + other.scaled(b), one.scaled(b) + other.scaled(c)]
}

/// The conjugates of two numbers times those of a column, summed.
fn both(one: Complex, other: Complex, column: &[Complex; 2]) -> Complex {
    one.against(column[0]) + other.against(column[1])
}

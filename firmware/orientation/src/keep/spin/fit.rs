//! The lift's phase in the forces of about one turn: least squares over every sample.
//!
//! `s = a_y − j a_z = c₀ + c₁τ + (Q₀ + Q₁τ) e^{jγ̂}`, γ̂ being the angle that is believed and τ the place in the turn
//! from −1 to 1. What the accelerometers feel of the spin itself, −ρω², and its slow change are c; the lift and
//! its change, Q. The phase of Q₀ is by how much γ̂ is behind at the middle.

use core::ops::{Add, Sub};

use super::wheel::sine_and_cosine;
use crate::units::{Angle, SpinForce};

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Complex {
    pub(super) real: f32,
    pub(super) imaginary: f32,
}

impl Complex {
    /// The conjugate of this, times another.
    fn against(self, other: Self) -> Self {
        Self {
            real: self.real * other.real + self.imaginary * other.imaginary,
            imaginary: self.real * other.imaginary - self.imaginary * other.real,
        }
    }

    fn times(self, other: Self) -> Self {
        Self { real: self.real, imaginary: -self.imaginary }.against(other)
    }

    fn scaled(self, factor: f32) -> Self {
        Self { real: factor * self.real, imaginary: factor * self.imaginary }
    }

    /// Its square.
    pub(super) fn power(self) -> f32 {
        self.real * self.real + self.imaginary * self.imaginary
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { real: self.real + other.real, imaginary: self.imaginary + other.imaginary }
    }
}

impl Sub for Complex {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other.scaled(-1.0)
    }
}

/// One step of a force, m/s².
const STEP: f32 = 1e-5;
/// Least samples of a fit: twice its eight real unknowns.
const LEAST: u32 = 16;
/// Complex unknowns of a fit.
const UNKNOWNS: f32 = 4.0;
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
    power: f32,
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
        self.power += real * real + imaginary * imaginary;
    }

    /// What the samples show; none where they are too few, or do not go round.
    pub(super) fn fit(&self) -> Option<Fit> {
        if self.count < LEAST {
            return None;
        }
        let count = self.count as f32;
        let determinant = count * self.place_square - self.place * self.place;
        let inverse =
            [self.place_square / determinant, -self.place / determinant, count / determinant];
        let [e0, e1, e2] = self.turning;
        // A⁻¹B and A⁻¹r of the steady part, by columns.
        let first = steady(&inverse, e0, e1);
        let second = steady(&inverse, e1, e2);
        let own = steady(&inverse, self.force[0], self.force[1]);
        // What is left to the turning part: A − B*A⁻¹B, Hermitian, and r − B*A⁻¹r.
        let m11 = count - both(e0, e1, &first).real;
        let m12 = Complex { real: self.place, imaginary: 0.0 } - both(e0, e1, &second);
        let m22 = self.place_square - both(e1, e2, &second).real;
        let r1 = self.turned_force[0] - both(e0, e1, &own);
        let r2 = self.turned_force[1] - both(e1, e2, &own);
        let whole = m11 * m22 - m12.power();
        if whole < GOING_ROUND * m11 * m22 || m11 <= 0.0 {
            return None;
        }
        let lift = (r1.scaled(m22) - m12.times(r2)).scaled(1.0 / whole);
        let change = (r2.scaled(m11) - m12.against(r1)).scaled(1.0 / whole);
        let explained = both(own[0], own[1], &self.force).real + both(lift, change, &[r1, r2]).real;
        let least = ROUNDING + PRECISION * self.power / count;
        let noise = ((self.power - explained) / (count - UNKNOWNS)).max(least);
        let change = libm::sqrtf(change.power());
        Some(Fit { lift, change, noise, share: 0.5 * m22 / whole })
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

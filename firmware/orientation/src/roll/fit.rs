//! Phase of the lift in the transverse forces of about one turn: least squares over every sample.
//!
//! The model is `s = a_y − j a_z = c₀ + c₁τ + (Q₀ + Q₁τ) e^{jγ̂}`, with γ̂ the estimated angle and
//! τ the place in the turn from −1 to 1. The constant c contains the centripetal force −ρω² and its
//! slow change; Q is the lift and its change. The phase of Q₀ is the lag of γ̂ at the middle.
//! Further harmonics are removed ([`super::harmonics`]), alternating with this fit.

use super::harmonics::{Complex, Harmonics, PARTS, Ripple};
use super::phase_accumulator::sine_and_cosine;
use super::state::Accelerometer;
use crate::units::{Angle, SpinForce};

/// Size of a force step, m/s².
const STEP: f32 = 1e-5;
/// Least number of samples of a fit: twice its eight real unknowns.
const LEAST: u32 = 16;
/// Number of complex unknowns of a fit.
const UNKNOWNS: f32 = 4.0 + PARTS as f32;
/// Number of alternations between this fit and the harmonics, over one turn: each leaves two fifths
/// of the error, and over four turns a fortieth.
const PASSES: u32 = 8;
/// Relative increase of the variance of one turn's lift by the harmonics.
const CROWDED: f32 = 0.3;
/// Part of the harmonics that one turn does not separate from the lift.
const HIDDEN: f32 = 0.25;
/// Least part of the rotating columns that is independent of the others: samples over a small part
/// of a turn cannot separate lift from constant force.
const GOING_ROUND: f32 = 0.01;
/// Relative error of the residual power due to sums in single precision.
const PRECISION: f32 = 2e-7;
/// Least residual variance, due to rounding of the forces, (m/s²)².
const ROUNDING: f32 = STEP * STEP / 6.0;

/// Sums over the samples of a turn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Force that is subtracted from all: the first one of the turn.
    base: [i32; 2],
    /// Half the expected number of samples of the turn, and its reciprocal.
    half: f32,
    scale: f32,
    /// Number of samples, including those without force.
    pub(super) samples: u32,
    /// Number of samples with a force.
    pub(super) count: u32,
    /// Sum of the places.
    place: f32,
    /// Sum of the squared places.
    place_square: f32,
    /// Sums of e^{jγ̂} times place to the powers 0, 1 and 2.
    turning: [Complex; 3],
    /// Sums of the force times place to the powers 0 and 1.
    force: [Complex; 2],
    /// Sums of the force rotated back, times place to the powers 0 and 1.
    turned_force: [Complex; 2],
    /// Sums of the squares of each force, after subtraction of the base.
    power: [f32; 2],
    /// Sums for the harmonics.
    harmonics: Harmonics,
}

/// Result of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// Lift at the middle, relative to γ̂, m/s².
    pub(super) lift: Complex,
    /// Magnitude of the lift's change from the middle to either end, m/s².
    pub(super) change: f32,
    /// Residual variance of a sample, both forces together, (m/s²)².
    pub(super) noise: f32,
    /// Factor from that variance to the variance of either part of the lift.
    pub(super) share: f32,
    /// Amplitudes of the harmonics, m/s².
    pub(super) ripple: Ripple,
    /// Number of samples, and number of turns.
    pub(super) count: f32,
    pub(super) turns: u32,
}

impl Fit {
    /// Possible error of the lift due to harmonics, m/s²: a quarter of them for one turn, less for
    /// more turns.
    pub(super) fn crowded(&self) -> f32 {
        let turns = self.turns as f32;
        HIDDEN * self.ripple.size() / (turns * turns)
    }
}

impl Sums {
    /// Empty sums for a turn of about this many samples.
    pub(super) fn of(samples: f32) -> Self {
        let half = 0.5 * samples;
        Self { half, scale: 1.0 / half, ..Self::default() }
    }

    /// Part of the samples after the middle, where the fit gives the phase.
    pub(super) fn part_after_middle(&self) -> f32 {
        let samples = self.samples as f32;
        (samples - 1.0 - self.half) / samples
    }

    /// Skips missing samples, which have no force.
    pub(super) fn pass(&mut self, samples: u32) {
        self.samples = self.samples.saturating_add(samples);
    }

    /// Adds a sample.
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
        let (turning, force) = (Complex::new(cosine, sine), Complex::new(real, imaginary));
        let placed = turning.scaled(place);
        // Force rotated back, s e^{−jγ̂}.
        let turned = turning.against(force);
        self.place += place;
        self.place_square += place * place;
        self.turning[0] += turning;
        self.turning[1] += placed;
        self.turning[2] += placed.scaled(place);
        self.force[0] += force;
        self.force[1] += force.scaled(place);
        self.turned_force[0] += turned;
        self.turned_force[1] += turned.scaled(place);
        self.power[0] += real * real;
        self.power[1] += imaginary * imaginary;
        self.harmonics.push(place, turning, force);
    }

    /// Accelerometers whose reading never changed.
    pub(super) fn stuck(&self) -> Option<Accelerometer> {
        match self.power.map(|power| power > 0.0) {
            [false, false] => Some(Accelerometer::Both),
            [false, true] => Some(Accelerometer::Y),
            [true, false] => Some(Accelerometer::Z),
            [true, true] => None,
        }
    }

    /// Fits the samples of this many turns; `None` with too few samples, or where they do not cover
    /// a turn.
    pub(super) fn fit(&self, turns: u32) -> Option<Fit> {
        let normal = Normal::of(self)?;
        let count = self.count as f32;
        let first = [self.turning[0], self.turning[1]];
        let round = self.harmonics.round([count, self.place], first);
        let mut ripple = Ripple::default();
        let mut solved = normal.solve(self.force, self.turned_force);
        for _ in 0..PASSES / turns {
            self.harmonics.approach(&mut ripple, &round, &solved.model);
            let [force, placed, turned, turned_placed] = round.shares(&ripple);
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

/// Normal equations of the constant part and of the lift.
struct Normal {
    /// Inverse A⁻¹ for the constant part, upper triangle.
    inverse: [f32; 3],
    /// Columns B of the rotating part, and A⁻¹B.
    turning: [Complex; 3],
    first: [Complex; 2],
    second: [Complex; 2],
    /// Reduced matrix A − B*A⁻¹B of the rotating part, Hermitian, and its determinant.
    m11: f32,
    m12: Complex,
    m22: f32,
    whole: f32,
}

/// Solution of the normal equations.
struct Solved {
    /// Constant force, its change, lift, its change.
    model: [Complex; 4],
    /// Power that the model explains, (m/s²)² times samples.
    explained: f32,
}

impl Normal {
    /// Normal equations from sums; `None` with too few samples, or where they do not cover a turn.
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
        let m11 = count - both(e0, e1, &first).re;
        let m12 = Complex::new(sums.place, 0.0) - both(e0, e1, &second);
        let m22 = sums.place_square - both(e1, e2, &second).re;
        let whole = m11 * m22 - m12.power();
        let goes_round = whole >= GOING_ROUND * m11 * m22 && m11 > 0.0;
        goes_round.then_some(Self { inverse, turning, first, second, m11, m12, m22, whole })
    }

    /// Solution for the sums of the force, and of the force rotated back.
    fn solve(&self, force: [Complex; 2], turned: [Complex; 2]) -> Solved {
        let [e0, e1, e2] = self.turning;
        let own = steady(&self.inverse, force[0], force[1]);
        let r1 = turned[0] - both(e0, e1, &own);
        let r2 = turned[1] - both(e1, e2, &own);
        let lift = (r1.scaled(self.m22) - self.m12 * r2).scaled(1.0 / self.whole);
        let change = (r2.scaled(self.m11) - self.m12.against(r1)).scaled(1.0 / self.whole);
        let explained = both(own[0], own[1], &force).re + both(lift, change, &[r1, r2]).re;
        let [steady, its_change] =
            [0, 1].map(|i: usize| own[i] - self.first[i] * lift - self.second[i] * change);
        Solved { model: [steady, its_change, lift, change], explained }
    }

    /// Factor from a sample's noise variance to the variance of either part of the lift.
    fn share(&self) -> f32 {
        0.5 * self.m22 / self.whole
    }
}

/// Product of A⁻¹, given by its upper triangle, with a column.
fn steady(inverse: &[f32; 3], one: Complex, other: Complex) -> [Complex; 2] {
    let [a, b, c] = *inverse;
    [one.scaled(a) + other.scaled(b), one.scaled(b) + other.scaled(c)]
}

/// Sum of the products of two conjugated numbers with those of a column.
fn both(one: Complex, other: Complex, column: &[Complex; 2]) -> Complex {
    one.against(column[0]) + other.against(column[1])
}

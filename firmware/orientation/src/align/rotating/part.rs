//! What a turn accumulator gathers: the eighth of a turn in progress, its forces, an uneven stretch, a break.

use super::coupling::Coupling;
use crate::align::regression::Regression;
use crate::math::Complex;
use crate::noise::model::GyroNoise;
use crate::signal::phasor::{Block, COLUMNS, COSINE, ONE, Products, Reference, SINE, Sums};
use crate::units::Angle;

/// Steps of an [`Angle`] in an eighth of a turn.
pub(super) const EIGHTH: i64 = 1 << 29;
/// Range of the platform's rate within an eighth, over its mean, that still counts as even.
const EVEN: f32 = 0.04;
/// What the mean rates of a turn's eighths may differ by.
const ALIKE: f32 = 0.02;
/// Change of the platform's rate from block to block, over its speed, that nobody commands: the platform
/// took another speed there, or something touched it.
const JUMP: f32 = 0.02;
/// The sums of an uneven stretch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uneven {
    /// Products of all signals.
    pub sums: Sums,
    /// Its length, s.
    pub seconds: f64,
    /// Angle turned through, rad, clockwise positive.
    pub turned: f64,
    /// Half the width of the modulation's line over its frequency, where it was commanded.
    pub width: f64,
}

impl Uneven {
    /// The coupling that it shows, if it was uneven enough.
    #[must_use]
    pub fn coupling(&self, noise: &GyroNoise) -> Option<Coupling> {
        Coupling::of(&self.sums, self.seconds, self.turned, self.width, noise)
    }
}

/// A break of even turns: what the platform has turned in it, steps of an [`Angle`], and for how long, s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Broken {
    pub(super) turned: i64,
    pub(super) seconds: f32,
}

impl Broken {
    /// What it turned beyond a speed in rad/s, rad.
    pub(super) fn slip(&self, speed: f32) -> f64 {
        self.turned as f64 * Angle::STEP - f64::from(speed) * f64::from(self.seconds)
    }
}

/// The part of a turn that is being gathered.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Part {
    pub(super) products: Products,
    pub(super) forces: Forces,
    pub(super) turned: i64,
    /// How far beyond its eighth the one before went, steps of an [`Angle`].
    pub(super) ahead: i64,
    pub(super) seconds: f32,
    pub(super) least: f32,
    pub(super) greatest: f32,
    pub(super) last: f32,
    pub(super) rows: u32,
}

impl Part {
    pub(super) fn push(&mut self, block: &Block, quickening: f32, reference: &Reference) {
        let turning = block.turning;
        if self.rows == 0 {
            (self.least, self.greatest) = (turning, turning);
        }
        self.least = self.least.min(turning);
        self.greatest = self.greatest.max(turning);
        self.last = turning;
        self.products.push(block, quickening, reference);
        self.turned += block.turned;
        self.seconds += block.seconds;
        self.rows += 1;
    }

    /// Whether a rate of the platform does not go on from the last block.
    pub(super) fn jumps_to(&self, turning: f32) -> bool {
        self.rows > 0 && is_jump(self.last, turning)
    }

    /// How far it has come, steps of an [`Angle`].
    pub(super) fn reached(&self) -> i64 {
        self.turned.abs() + self.ahead
    }

    /// Mean rate of the platform, rad/s.
    pub(super) fn speed(&self) -> f32 {
        self.turned as f32 * (Angle::STEP as f32) / self.seconds
    }

    pub(super) fn is_even(&self) -> bool {
        let range = self.greatest - self.least;
        !self.products.is_astray && range <= EVEN * self.speed().abs()
    }

    /// Whether the platform turned as fast as `speed`, rad/s.
    pub(super) fn is_alike(&self, speed: f32) -> bool {
        (self.speed() - speed).abs() <= ALIKE * speed.abs()
    }
}

/// What the eighths of a turn show of an encoder's error twice a turn: how long they took, and how far they went,
/// each with the angle at which they lie.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ellipse {
    seconds: [f32; 2],
    turned: [f32; 2],
    sum: f32,
}

impl Ellipse {
    /// Part of an error twice a turn that its eighths show in a sum over them: eight times √2 over two.
    const SHOWN: f64 = 4.0 * core::f64::consts::SQRT_2;

    pub(super) fn push(&mut self, part: &Part) {
        let [c, s] = part.products.phasor();
        let power = (c * c + s * s).max(f32::MIN_POSITIVE);
        let twice = [(c * c - s * s) / power, -2.0 * c * s / power];
        let turned = part.turned as f32 * (Angle::STEP as f32);
        for ((seconds, turns), part_of) in self.seconds.iter_mut().zip(&mut self.turned).zip(twice)
        {
            *seconds += part.seconds * part_of;
            *turns += turned * part_of;
        }
        self.sum += turned;
    }

    /// The error as ε e^{jψ}, rad, of a platform that turned evenly for so many seconds.
    pub(super) fn error(&self, seconds: f64) -> Complex {
        let speed = f64::from(self.sum) / seconds;
        let [re, im] =
            [0, 1].map(|part| speed * f64::from(self.seconds[part]) - f64::from(self.turned[part]));
        Complex::new(re, im).scaled(-libm::copysign(1.0, speed) / Self::SHOWN)
    }
}

/// Whether a rate of the platform does not go on from the one before.
pub(super) fn is_jump(before: f32, after: f32) -> bool {
    (after - before).abs() > JUMP * after.abs().max(before.abs())
}

/// Axes of the accelerometer in the platform's plane: along the sensitive axis, and 90° clockwise of it.
pub(super) const AXES: usize = 2;

/// Products of cosine and sine with the forces in the platform's plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Forces {
    /// 1·c, 1·s, c·c, c·s, s·s in 2⁻¹⁶.
    phasors: [i64; 5],
    /// Each force in µm/s² with 1, c, s.
    with_force: [[i64; 3]; AXES],
    count: u32,
}

/// What a step of cosine or sine in [`Forces`] is worth.
const FORCE_STEP: f64 = 1.0 / 65_536.0;

impl Forces {
    #[inline]
    pub(super) fn push(&mut self, phasor: [i32; 2], forces: [i32; AXES]) {
        let [c, s] = phasor.map(|value| i64::from(value >> 14));
        for (sum, term) in self.phasors.iter_mut().zip([c, s, c * c, c * s, s * s]) {
            *sum += term;
        }
        for (sums, force) in self.with_force.iter_mut().zip(forces.map(i64::from)) {
            for (sum, term) in sums.iter_mut().zip([force, force * c, force * s]) {
                *sum += term;
            }
        }
        self.count += 1;
    }

    pub(super) fn add(&mut self, other: &Self) {
        for (sum, term) in self.phasors.iter_mut().zip(other.phasors) {
            *sum += term;
        }
        for (sum, term) in
            self.with_force.iter_mut().flatten().zip(other.with_force.iter().flatten())
        {
            *sum += term;
        }
        self.count += other.count;
    }

    /// The regression of one axis.
    pub(super) fn regression(&self, axis: usize) -> Regression<COLUMNS> {
        let [c, s, cc, cs, ss] = self.phasors.map(|sum| sum as f64);
        let [f, fc, fs] = self.with_force[axis].map(|sum| sum as f64);
        let mut products = [[0.0; COLUMNS]; COLUMNS];
        let mut with_left = [0.0; COLUMNS];
        products[ONE][ONE] = f64::from(self.count);
        products[COSINE][ONE] = c * FORCE_STEP;
        products[SINE][ONE] = s * FORCE_STEP;
        products[COSINE][COSINE] = cc * FORCE_STEP * FORCE_STEP;
        products[SINE][COSINE] = cs * FORCE_STEP * FORCE_STEP;
        products[SINE][SINE] = ss * FORCE_STEP * FORCE_STEP;
        with_left[ONE] = f * 1e-6;
        with_left[COSINE] = fc * FORCE_STEP * 1e-6;
        with_left[SINE] = fs * FORCE_STEP * 1e-6;
        Regression::of_products(products, with_left, self.count as usize)
    }
}

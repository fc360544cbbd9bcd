//! Parts of the turn accumulator: the eighth of a turn in progress, its forces, a rate-modulated
//! stretch, an interruption.

use crate::math::{Complex, Regression};
use crate::signal::phasor::{Block, COLUMNS, COSINE, ONE, Products, SINE, Sums};
use crate::units::Angle;

/// Steps of an [`Angle`] in an eighth of a turn.
pub(super) const EIGHTH: i64 = 1 << 29;
/// Greatest range of the platform's rate within an eighth, over its mean, that counts as constant.
const EVEN: f32 = 0.04;
/// Greatest relative difference between the mean rates of a turn's eighths.
const ALIKE: f32 = 0.02;
/// Change of the platform's rate from block to block, over its speed, that no command produces: the
/// platform changed speed there, or was touched.
const JUMP: f32 = 0.02;
/// Sums of a rate-modulated stretch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Modulated {
    /// Products of all signals.
    pub sums: Sums,
    /// Length of the stretch, s.
    pub seconds: f64,
    /// Angle turned through, rad, clockwise positive.
    pub turned: f64,
    /// Half width of the modulation's spectral line over its frequency, as commanded; zero where it
    /// is unknown.
    pub width: f64,
}

/// Interruption of constant rotation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Broken {
    /// Angle that the platform turned, steps of an [`Angle`].
    pub(super) turned: i64,
    /// Length of the interruption, s.
    pub(super) seconds: f32,
}

impl Broken {
    /// Angle beyond rotation at a speed in rad/s, rad.
    pub(super) fn slip(&self, speed: f32) -> f64 {
        self.turned as f64 * Angle::STEP - f64::from(speed) * f64::from(self.seconds)
    }
}

/// The eighth of a turn in progress.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Part {
    /// Products of all signals.
    pub(super) products: Products,
    /// Products of the forces.
    pub(super) forces: Forces,
    /// Angle turned, steps of an [`Angle`].
    pub(super) turned: i64,
    /// Angle by which the previous eighth went beyond its end, steps of an [`Angle`].
    pub(super) ahead: i64,
    /// Length so far, s.
    pub(super) seconds: f32,
    /// Least rate of the platform, rad/s.
    pub(super) least: f32,
    /// Greatest rate of the platform, rad/s.
    pub(super) greatest: f32,
    /// Rate of the platform in the latest block, rad/s.
    pub(super) last: f32,
    /// Number of blocks.
    pub(super) rows: u32,
}

impl Part {
    /// Adds a block, with the platform's angular acceleration, rad/s².
    pub(super) fn push(&mut self, block: &Block, quickening: f32, reference: &Block) {
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

    /// Whether a rate of the platform jumps from that of the latest block.
    pub(super) fn jumps_to(&self, turning: f32) -> bool {
        self.rows > 0 && is_jump(self.last, turning)
    }

    /// Angle reached, steps of an [`Angle`].
    pub(super) fn reached(&self) -> i64 {
        self.turned.abs() + self.ahead
    }

    /// Mean rate of the platform, rad/s.
    pub(super) fn speed(&self) -> f32 {
        self.turned as f32 * (Angle::STEP as f32) / self.seconds
    }

    /// Whether the platform's rate was constant and the gyro's rate plausible.
    pub(super) fn is_even(&self) -> bool {
        let range = self.greatest - self.least;
        !self.products.is_clamped && range <= EVEN * self.speed().abs()
    }

    /// Whether the platform turned at `speed`, rad/s, within 2 %.
    pub(super) fn is_alike(&self, speed: f32) -> bool {
        (self.speed() - speed).abs() <= ALIKE * speed.abs()
    }
}

/// Sums over the eighths of a turn that show an encoder error twice per turn: their durations and
/// their angles, each as a phasor of twice the angle at which they lie.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ellipse {
    /// Phasor of the durations, s.
    seconds: [f32; 2],
    /// Phasor of the angles, rad.
    turned: [f32; 2],
    /// Sum of the angles, rad.
    sum: f32,
}

impl Ellipse {
    /// Response of the sum over the eighths to an error twice per turn: eight times √2 over two.
    const SHOWN: f64 = 4.0 * core::f64::consts::SQRT_2;

    /// Adds an eighth.
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

    /// Encoder error as ε e^{jψ}, rad, for a platform that turned at constant rate for `seconds`.
    pub(super) fn error(&self, seconds: f64) -> Complex {
        let speed = f64::from(self.sum) / seconds;
        let [re, im] =
            [0, 1].map(|part| speed * f64::from(self.seconds[part]) - f64::from(self.turned[part]));
        Complex::new(re, im).scaled(-libm::copysign(1.0, speed) / Self::SHOWN)
    }
}

/// Whether a rate of the platform jumps from the previous one, by more than 2 %.
pub(super) fn is_jump(before: f32, after: f32) -> bool {
    (after - before).abs() > JUMP * after.abs().max(before.abs())
}

/// Number of accelerometer axes in the platform's plane: along the sensitive axis, and 90°
/// clockwise of it.
pub(super) const AXES: usize = 2;

/// Products of cosine and sine with the forces in the platform's plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Forces {
    /// Sums of 1·c, 1·s, c·c, c·s and s·s, with c and s in steps of 2⁻¹⁶.
    phasors: [i64; 5],
    /// Sums of each force, µm/s², with 1, c and s.
    with_force: [[i64; 3]; AXES],
    /// Number of forces.
    count: u32,
}

/// Size of a step of cosine or sine in [`Forces`].
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

    /// Adds the sums of another part.
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

    /// Regression of one axis's force, m/s², on constant, cosine and sine.
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

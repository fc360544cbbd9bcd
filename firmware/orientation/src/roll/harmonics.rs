//! Harmonics in the transverse forces other than the lift: against the rotation, twice and three
//! times a turn.
//!
//! The model is `s = … + Σ Xₖ e^{jkγ̂}`, k = −1, 2, −2 and 3. Ideal sensors show none of them.
//! Removing them keeps them from biasing the lift's phase and from counting as noise; their meaning
//! for the sensors is in [`super::circle`].

/// Complex numbers in single precision, for the sums of a spinning body.
pub(super) type Complex = crate::math::Complex<f32>;

/// Orders of the harmonics, per turn.
const ORDERS: [i32; PARTS] = [AGAINST, 2, -2, THRICE];
/// Order of the counter-rotating component.
const AGAINST: i32 = -1;
/// Order of the third harmonic.
const THRICE: i32 = 3;
/// Number of harmonics.
pub(super) const PARTS: usize = 4;

/// Amplitudes of the harmonics, m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ripple(pub(super) [Complex; PARTS]);

impl Ripple {
    /// Component that rotates against the gyro, m/s².
    pub(super) fn against(&self) -> Complex {
        self.0[0]
    }

    /// Root of the total power of all harmonics, m/s².
    pub(super) fn size(&self) -> f32 {
        libm::sqrtf(self.0.iter().map(|part| part.power()).sum())
    }

    /// Component that rotates three times a turn, m/s².
    pub(super) fn thrice(&self) -> Complex {
        self.0[3]
    }
}

/// Sums of `e^{jkγ̂}`, and of that times the place, over the samples of an evaluation, k from 0 to 3.
pub(super) struct Round([[Complex; 2]; 4]);

impl Round {
    /// Sums of an order, −3 to 3.
    fn of(&self, order: i32) -> [Complex; 2] {
        let sums = self.0[order.unsigned_abs() as usize];
        if order < 0 { sums.map(Complex::conjugate) } else { sums }
    }

    /// Contribution of the harmonics to the sums of the force, of the force times the place, and of
    /// both rotated back once.
    pub(super) fn shares(&self, ripple: &Ripple) -> [Complex; 4] {
        let mut shares = [Complex::default(); 4];
        for (part, order) in ripple.0.iter().zip(ORDERS) {
            let ([force, placed], [turned, turned_placed]) = (self.of(order), self.of(order - 1));
            for (share, sum) in shares.iter_mut().zip([force, placed, turned, turned_placed]) {
                *share += *part * sum;
            }
        }
        shares
    }
}

/// Sums over the samples of an evaluation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Harmonics {
    /// Sums of `e^{2jγ̂}` and `e^{3jγ̂}`, and of these times the place.
    second: [Complex; 2],
    third: [Complex; 2],
    /// Sums of the force rotated back by each of [`ORDERS`].
    force: [Complex; PARTS],
}

impl Harmonics {
    /// Adds a sample: its place, e^{jγ̂} and force.
    #[inline]
    pub(super) fn push(&mut self, place: f32, first: Complex, force: Complex) {
        let twice = first.im + first.im;
        let second = Complex::new(1.0 - twice * first.im, twice * first.re);
        let third = second * first;
        self.second[0] += second;
        self.second[1] += second.scaled(place);
        self.third[0] += third;
        self.third[1] += third.scaled(place);
        self.force[0] += force * first;
        self.force[1] += second.against(force);
        self.force[2] += second * force;
        self.force[3] += third.against(force);
    }

    /// Sums of the orders 0 to 3, of which the first two are given.
    pub(super) fn round(&self, even: [f32; 2], first: [Complex; 2]) -> Round {
        Round([even.map(|real| Complex::new(real, 0.0)), first, self.second, self.third])
    }

    /// Improves the amplitudes by the residual of the other fit; `model` is that fit: constant, its
    /// change, lift, its change.
    pub(super) fn approach(&self, ripple: &mut Ripple, round: &Round, model: &[Complex; 4]) {
        let [count, _] = round.of(0).map(|sum| sum.re);
        for (place, order) in ORDERS.into_iter().enumerate() {
            let steady = round.of(-order);
            let turning = round.of(1 - order);
            let columns = [steady[0], steady[1], turning[0], turning[1]];
            let shown = columns.iter().zip(model).map(|(column, part)| *column * *part);
            ripple.0[place] = (self.force[place] - shown.sum()).scaled(1.0 / count);
        }
    }

    /// Power of the forces that the harmonics explain in addition to the other fit.
    pub(super) fn explained(&self, ripple: &Ripple, count: f32) -> f32 {
        let parts = ripple.0.iter().zip(&self.force);
        parts.map(|(part, force)| 2.0 * part.against(*force).re - count * part.power()).sum()
    }
}

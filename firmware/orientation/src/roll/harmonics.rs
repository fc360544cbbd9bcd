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

    /// Sums of `e^{jkγ̂}` and of that times the place, k from −3 to 3; `even` and `first` are those
    /// of k = 0 and 1.
    fn round(&self, order: i32, even: [f32; 2], first: [Complex; 2]) -> [Complex; 2] {
        let sums = match order.abs() {
            0 => even.map(|real| Complex::new(real, 0.0)),
            1 => first,
            2 => self.second,
            _ => self.third,
        };
        if order < 0 { sums.map(Complex::conjugate) } else { sums }
    }

    /// Improves the amplitudes by the residual of the other fit; `model` is that fit: constant, its
    /// change, lift, its change.
    pub(super) fn approach(
        &self,
        ripple: &mut Ripple,
        even: [f32; 2],
        first: [Complex; 2],
        model: &[Complex; 4],
    ) {
        let [count, _] = even;
        for (place, order) in ORDERS.into_iter().enumerate() {
            let steady = self.round(-order, even, first);
            let turning = self.round(1 - order, even, first);
            let columns = [steady[0], steady[1], turning[0], turning[1]];
            let shown = columns.iter().zip(model).map(|(column, part)| *column * *part);
            ripple.0[place] = (self.force[place] - shown.sum()).scaled(1.0 / count);
        }
    }

    /// Contribution of the harmonics to the sums of the force, of the force times the place, and of
    /// both rotated back once.
    pub(super) fn shares(
        &self,
        ripple: &Ripple,
        even: [f32; 2],
        first: [Complex; 2],
    ) -> [Complex; 4] {
        let mut shares = [Complex::default(); 4];
        for (part, order) in ripple.0.iter().zip(ORDERS) {
            let [force, placed] = self.round(order, even, first);
            let [turned, turned_placed] = self.round(order - 1, even, first);
            for (share, sum) in shares.iter_mut().zip([force, placed, turned, turned_placed]) {
                *share += *part * sum;
            }
        }
        shares
    }

    /// Power of the forces that the harmonics explain in addition to the other fit.
    pub(super) fn explained(&self, ripple: &Ripple, count: f32) -> f32 {
        let parts = ripple.0.iter().zip(&self.force);
        parts.map(|(part, force)| 2.0 * part.against(*force).re - count * part.power()).sum()
    }
}

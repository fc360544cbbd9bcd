//! Small numerical pieces that several methods share: phasors, rotations, Cholesky factors, chi-square
//! tails, a bounded minimisation.

pub mod brent;
pub mod quaternion;
pub mod reference_table;
pub mod regression;
pub mod rotation;
pub mod turn;

pub(crate) use reference_table::Table;
pub(crate) use regression::{COLUMNS, Column, Regression, Solution};

use core::iter::Sum;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number in the precision that a computation needs: `f64` for results, `f32`, a tenth of the
/// instructions on this core, where a thousandth is enough.
pub trait Scalar:
    Copy
    + Default
    + Into<f64>
    + AddAssign
    + SubAssign
    + MulAssign
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// Converts from `f64`, rounded to nearest.
    fn of(value: f64) -> Self;

    /// Square root.
    #[must_use]
    fn root(self) -> Self;
}

impl Scalar for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn root(self) -> Self {
        libm::sqrt(self)
    }
}

impl Scalar for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }

    fn root(self) -> Self {
        libm::sqrtf(self)
    }
}

/// A complex number: the phasor a of a signal Re{a e^{jθ}} on a turning platform.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex<T = f64> {
    /// Real part: the coefficient of cos θ.
    pub re: T,
    /// Imaginary part: minus the coefficient of sin θ.
    pub im: T,
}

impl Complex {
    /// Phasor of a signal with these coefficients of cosine and sine.
    pub fn of_signal([cosine, sine]: [f32; 2]) -> Self {
        Self::new(f64::from(cosine), -f64::from(sine))
    }

    /// Unit phasor at an angle in rad.
    pub fn unit(angle: f64) -> Self {
        let (sine, cosine) = libm::sincos(angle);
        Self::new(cosine, sine)
    }

    /// Argument, rad, [−π, π].
    #[must_use]
    pub fn angle(self) -> f64 {
        libm::atan2(self.im, self.re)
    }

    /// Magnitude.
    #[must_use]
    pub fn size(self) -> f64 {
        libm::hypot(self.re, self.im)
    }
}

impl<T: Scalar> Complex<T> {
    /// Number with these real and imaginary parts.
    pub const fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// Squared magnitude.
    pub(crate) fn power(self) -> T {
        self.re * self.re + self.im * self.im
    }

    /// Complex conjugate.
    pub(crate) fn conjugate(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Product with a real factor.
    pub fn scaled(self, factor: T) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// Product of the conjugate of this number with another.
    pub(crate) fn against(self, other: Self) -> Self {
        let Self { re, im } = other;
        Self::new(self.re * re + self.im * im, self.re * im - self.im * re)
    }
}

impl<T: Scalar> Add for Complex<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl<T: Scalar> AddAssign for Complex<T> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Scalar> Sub for Complex<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl<T: Scalar> Mul for Complex<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let Self { re, im } = other;
        Self::new(self.re * re - self.im * im, self.re * im + self.im * re)
    }
}

impl Div for Complex {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        (self * other.conjugate()).scaled(1.0 / other.power())
    }
}

impl<T: Scalar> Sum for Complex<T> {
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        numbers.fold(Self::default(), Add::add)
    }
}

/// Square root of a non-negative number, to 1e-14 relative: the hardware finds it in single
/// precision, two Newton steps refine it. It takes a third of the instructions of `libm::sqrt` on a
/// Cortex-M4.
pub(crate) fn quick_root(square: f64) -> f64 {
    let rough = square as f32;
    // Subnormal numbers, zero, and numbers beyond single precision take the library's way.
    if !(f32::MIN_POSITIVE..=f32::MAX).contains(&rough) {
        return libm::sqrt(square);
    }
    let inverse = f64::from(1.0 / libm::sqrtf(rough));
    let root = square * inverse;
    root + 0.5 * inverse * (square - root * root)
}

/// Factors a symmetric positive matrix in place into its lower triangle L, A = L·Lᵀ.
///
/// Only the leading `size` rows are used. Returns `false` where a pivot is not safely positive
/// (below 1e-13 of its diagonal): the columns are dependent.
#[must_use]
pub fn cholesky<const P: usize>(matrix: &mut [[f64; P]; P], size: usize) -> bool {
    for row in 0..size {
        for column in 0..=row {
            let dot: f64 = (0..column).map(|k| matrix[row][k] * matrix[column][k]).sum();
            let rest = matrix[row][column] - dot;
            if row == column {
                if rest.is_nan() || rest <= 1e-13 * matrix[row][row].abs() {
                    return false;
                }
                matrix[row][row] = libm::sqrt(rest);
            } else {
                matrix[row][column] = rest / matrix[column][column];
            }
        }
    }
    true
}

/// Solves L·Lᵀ·x = b in place for a factor from [`cholesky`].
pub fn cholesky_solve<const P: usize>(factor: &[[f64; P]; P], size: usize, b: &mut [f64; P]) {
    for row in 0..size {
        let dot: f64 = (0..row).map(|k| factor[row][k] * b[k]).sum();
        b[row] = (b[row] - dot) / factor[row][row];
    }
    for row in (0..size).rev() {
        let dot: f64 = (row + 1..size).map(|k| factor[k][row] * b[k]).sum();
        b[row] = (b[row] - dot) / factor[row][row];
    }
}

/// Probability that a chi-square variable of `degrees` degrees of freedom, a whole number up to
/// 1000, exceeds `value`.
///
/// The regularised upper incomplete gamma function Q(ν/2, x/2): series below the mean, Lentz's
/// continued fraction above (Abramowitz and Stegun 6.5.29 and 6.5.31); relative error below 1e-10.
#[must_use]
pub fn chi_square_tail(value: f64, degrees: f64) -> f64 {
    let (a, x) = (0.5 * degrees, 0.5 * value);
    if x.is_nan() || x <= 0.0 || a <= 0.0 {
        return 1.0;
    }
    let front = front(a, x);
    if x < a + 1.0 { 1.0 - front * lower_series(a, x) } else { front * upper_fraction(a, x) }
}

/// Factor xᵃ e⁻ˣ / Γ(a) for a whole number of halves a, by the recurrence of Γ: the library's ln Γ
/// would take 2 KB of flash.
fn front(a: f64, x: f64) -> f64 {
    let (mut product, mut factor) =
        if libm::floor(a) < a { (libm::sqrt(x / core::f64::consts::PI), 0.5) } else { (x, 1.0) };
    product *= libm::exp(-x);
    while factor < a {
        product *= x / factor;
        factor += 1.0;
    }
    product
}

/// Series Σ xⁿ / (a (a+1) … (a+n)) of the lower incomplete gamma function.
fn lower_series(a: f64, x: f64) -> f64 {
    let (mut term, mut sum) = (1.0 / a, 1.0 / a);
    for n in 1..500 {
        term *= x / (a + f64::from(n));
        sum += term;
        if term < sum * 1e-15 {
            break;
        }
    }
    sum
}

/// Continued fraction 1/(x+1−a− 1·(1−a)/(x+3−a− …)) of the upper incomplete gamma function, by
/// Lentz's method.
fn upper_fraction(a: f64, x: f64) -> f64 {
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1e300, 1.0 / b);
    let mut fraction = d;
    for n in 1..500 {
        let an = -f64::from(n) * (f64::from(n) - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        fraction *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    fraction
}

/// Sorts a few values by insertion: the library's sort takes 10 KB of flash for each type. Equal
/// values keep their order.
pub fn sort<T>(values: &mut [T], is_less: impl Fn(&T, &T) -> bool) {
    for end in 1..values.len() {
        let mut place = end;
        while place > 0 && is_less(&values[place], &values[place - 1]) {
            values.swap(place, place - 1);
            place -= 1;
        }
    }
}

/// Median of the values, which are reordered; zero for an empty slice. NaN sorts last.
pub fn median(values: &mut [f64]) -> f64 {
    sort(values, |a, b| a.total_cmp(b).is_lt());
    let half = values.len() / 2;
    match values.len() {
        0 => 0.0,
        length if length % 2 == 1 => values[half],
        _ => 0.5 * (values[half - 1] + values[half]),
    }
}

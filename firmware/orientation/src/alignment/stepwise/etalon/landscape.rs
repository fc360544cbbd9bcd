//! A quadratic objective as a continuous function of azimuth, from five sums.
//!
//! Over the stored table cos(A + iΔ) = cos A · pᵢ − sin A · qᵢ up to rounding, so
//! J(A) = Σ(zᵢ − cos A · pᵢ + sin A · qᵢ)² is the squared distance of the measured point from an
//! ellipse in the plane of p and q. That settles how many minima there are and where to look:
//! with the ellipse turned to its principal axes, `J'/2 = X sin ψ − Y cos ψ − h sin ψ cos ψ`, and
//! after reflection to X, Y ≥ 0
//!
//! * the global minimum is the only stationary point of the first quadrant (the measured point's);
//! * the second quadrant has none, the third one maximum;
//! * the fourth has a minimum and a maximum or neither, on either side of tan ψ = −∛(Y/X).

use libm::{atan2, copysign, exp, fabs, log, sincos, sqrt};

use super::exact::Squares;
use super::series::Series;
use crate::math::reference_table::{HALF, ONE, QUARTER, STEP, TURN, Table};

/// Five sums (and the square of z), means removed or differenced, scaled so that the table's
/// integer cosines serve as they are: a soft-float multiplication costs more than a look-up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landscape {
    /// Sums Σp², Σq² and their difference.
    pp: f64,
    qq: f64,
    spread: f64,
    /// Sums 2Σpq, 2Σpz and 2Σqz.
    pq2: f64,
    pz2: f64,
    qz2: f64,
    /// Sum Σz².
    zz: f64,
}

/// Grid indices that separate the stationary points of the objective, as the module describes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// End of the major axis on the measured point's side, ψ = 0 after reflection.
    major: i32,
    /// End of the minor axis on the measured point's side, ψ = π/2.
    minor: i32,
    /// Index between the minimum and the maximum of the fourth quadrant.
    saddle: i32,
}

/// Exact integer sums of the products of (p, q, z).
#[derive(Default)]
struct Sums {
    /// Sums of pp, pq, qq, pz, qz and zz.
    products: [i128; 6],
}

impl Sums {
    /// Adds the products of one position.
    fn add(&mut self, p: i64, q: i64, z: i64) {
        let pairs = [(p, p), (p, q), (q, q), (p, z), (q, z), (z, z)];
        for (sum, (a, b)) in self.products.iter_mut().zip(pairs) {
            *sum += i128::from(a) * i128::from(b);
        }
    }

    /// Mean-removed sums: each times `count`, less the product of the totals.
    fn centred(mut self, count: i128, [p, q, z]: [i64; 3]) -> Self {
        let pairs = [(p, p), (p, q), (q, q), (p, z), (q, z), (z, z)];
        for (sum, (a, b)) in self.products.iter_mut().zip(pairs) {
            *sum = count * *sum - i128::from(a) * i128::from(b);
        }
        self
    }
}

impl Landscape {
    /// Sums `series` over the table; the sums are exact until they are rounded to `f64`.
    pub(super) fn new(table: Table, series: &Series, squares: Squares) -> Self {
        // The scale is a power of two, so the scaling is exact.
        const SCALE: f64 = 1.0 / ONE;
        let sums = match squares {
            Squares::Centred => centred_sums(table, series),
            Squares::Differences => difference_sums(table, series),
        };
        let [pp, pq, qq, pz, qz, zz] = sums.products.map(|sum| sum as f64);
        let [pp, qq] = [pp, qq].map(|sum| sum * (SCALE * SCALE));
        let pq2 = pq * (2.0 * SCALE * SCALE);
        Self { pp, qq, spread: pp - qq, pq2, pz2: pz * (2.0 * SCALE), qz2: qz * (2.0 * SCALE), zz }
    }

    /// Continuous objective at grid index `k`, with cosine and sine from the table.
    pub(super) fn at(&self, table: Table, k: i32) -> f64 {
        let (c, s) = table.phasor(k);
        let cosine = c * self.pp - s * self.pq2 - self.pz2;
        self.zz + c * cosine + s * (s * self.qq + self.qz2)
    }

    /// Slope of the objective per radian, over 2³¹, at grid index `k`.
    pub(super) fn slope(&self, table: Table, k: i32) -> f64 {
        let ((c, s), (c2, s2)) = (table.phasor(k), table.phasor(2 * k));
        (s * self.pz2 + c * self.qz2) * (1.0 / ONE) - s2 * self.spread - c2 * self.pq2
    }

    /// Error bound of [`Self::slope`]: half a unit in each cosine, doubled for the arithmetic.
    pub(super) fn slope_error(&self) -> f64 {
        let linear = (fabs(self.pz2) + fabs(self.qz2)) * (1.0 / ONE);
        linear + fabs(self.spread) + fabs(self.pq2)
    }

    /// Bound on the `f64` rounding of [`Self::at`]: 16 roundings of the largest partial sum.
    pub(super) fn slack(&self) -> f64 {
        let squares = (self.pp + self.qq + fabs(self.pq2)) * (ONE * ONE);
        let linear = (fabs(self.pz2) + fabs(self.qz2)) * ONE;
        (self.zz + squares + linear) * (8.0 * f64::EPSILON)
    }

    /// Bound on the error that table rounding makes in the root of the objective, for `count`
    /// positions.
    ///
    /// The errors are, per cosine, 0.5 for the entry compared and 0.7072 for p and q, twice that
    /// per difference; the root of n Σ(d − mean)² is √n times a norm. Half a unit of cos A and of
    /// sin A on all of p and q is added, which is little on a short arc.
    pub(super) fn rounding(&self, count: f64, squares: Squares) -> f64 {
        const ENTRY: f64 = 1.2073;
        let entries = match squares {
            Squares::Centred => ENTRY * count,
            Squares::Differences => 2.0 * ENTRY * sqrt(count - 1.0),
        };
        entries + 0.5001 * (sqrt(self.pp) + sqrt(self.qq))
    }

    /// Indices that separate the minima and maxima.
    pub(super) fn bounds(&self) -> Bounds {
        let axis = 0.5 * atan2(-self.pq2, self.spread);
        let (sine, cosine) = sincos(axis);
        let x = self.pz2 * cosine - self.qz2 * sine;
        let y = -(self.pz2 * sine + self.qz2 * cosine);
        let axis = libm::round(axis / STEP) as i32;
        Bounds {
            major: if x < 0.0 { axis + HALF } else { axis },
            minor: if y < 0.0 { axis - QUARTER } else { axis + QUARTER },
            saddle: axis + libm::round(atan2(-cube_root(y), cube_root(x)) / STEP) as i32,
        }
    }

    /// Global minimum, then the place of the other one if there is one; to within a step, or
    /// anywhere where the objective is flat.
    pub(super) fn minima(&self, table: Table, bounds: &Bounds) -> [i32; 2] {
        let &Bounds { major, minor, saddle } = bounds;
        [self.turn(table, major, minor, 1.0), self.turn(table, minor + HALF, saddle, 1.0)]
    }

    /// Maxima, to within a step, in the order of [`Self::minima`].
    pub(super) fn maxima(&self, table: Table, bounds: &Bounds) -> [i32; 2] {
        let &Bounds { major, minor, saddle } = bounds;
        [self.turn(table, major + HALF, minor + HALF, -1.0), self.turn(table, saddle, major, -1.0)]
    }

    /// Index on the way from `from` to `to` at which `sign` · J stops falling, by bisection of the
    /// slope.
    fn turn(&self, table: Table, from: i32, to: i32, sign: f64) -> i32 {
        let way = (to - from + HALF).rem_euclid(TURN) - HALF;
        let sign = if way < 0 { -sign } else { sign };
        let (mut near, mut far) = (0, way);
        while (far - near).abs() > 1 {
            let middle = near + (far - near) / 2;
            let falls = self.slope(table, from + middle) * sign < 0.0;
            *(if falls { &mut near } else { &mut far }) = middle;
        }
        (from + near).rem_euclid(TURN)
    }

    /// Azimuth, rad, [0, 2π), of the continuous minimum next to grid index `k`: Newton's method on
    /// the slope, each step at most one grid step.
    pub(super) fn refine(&self, k: i32) -> f64 {
        const ENOUGH: f64 = 1e-10;
        let (pz, qz) = (self.pz2 * (1.0 / ONE), self.qz2 * (1.0 / ONE));
        let mut azimuth = f64::from(k) * STEP;
        for _ in 0..8 {
            let (s, c) = sincos(azimuth);
            let (c2, s2) = (c * c - s * s, 2.0 * s * c);
            let slope = s * pz + c * qz - s2 * self.spread - c2 * self.pq2;
            let curvature = c * pz - s * qz - 2.0 * (c2 * self.spread - s2 * self.pq2);
            if curvature <= 0.0 {
                break;
            }
            let change = (slope / curvature).clamp(-STEP, STEP);
            azimuth -= change;
            if fabs(change) < ENOUGH {
                break;
            }
        }
        crate::units::wrapped(azimuth)
    }
}

/// Cube root to about 10⁻¹³, accurate enough for a grid step; the library's, exact to the last bit,
/// takes 3 KB of flash.
fn cube_root(x: f64) -> f64 {
    copysign(exp(log(fabs(x)) / 3.0), x)
}

/// Mean-removed sums of the series over the table.
fn centred_sums(table: Table, series: &Series) -> Sums {
    let (mut sums, mut totals) = (Sums::default(), [0_i64; 3]);
    let mut index = 0;
    for &z in series.values() {
        let (p, q) = (table.cos(index), table.sin(index));
        sums.add(p, q, z);
        for (total, value) in totals.iter_mut().zip([p, q, z]) {
            *total += value;
        }
        index += series.step();
    }
    sums.centred(series.values().len() as i128, totals)
}

/// Sums of the differences of neighbours over the table.
fn difference_sums(table: Table, series: &Series) -> Sums {
    let mut sums = Sums::default();
    let mut index = 0;
    for pair in series.values().windows(2) {
        let next = index + series.step();
        let p = table.cos(next) - table.cos(index);
        let q = table.sin(next) - table.sin(index);
        sums.add(p, q, pair[1] - pair[0]);
        index = next;
    }
    sums
}

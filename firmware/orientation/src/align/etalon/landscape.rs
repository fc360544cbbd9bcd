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

use libm::{atan2, cbrt, sincos};

use super::exact::Squares;
use super::series::Series;
use super::table::{HALF, ONE, QUARTER, STEP, TURN, Table};

/// The sums, means removed or differenced, in squared table units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landscape {
    pp: f64,
    pq: f64,
    qq: f64,
    pz: f64,
    qz: f64,
    zz: f64,
}

/// The grid indices where the objective turns, to within a step or where it is flat.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    /// The global minimum, then the other one if there is one.
    pub(super) minima: [i32; 2],
    /// The maxima.
    pub(super) maxima: [i32; 2],
}

/// The exact integer sums of products of (p, q, z).
#[derive(Default)]
struct Sums {
    products: [i128; 6],
}

impl Sums {
    fn add(&mut self, p: i64, q: i64, z: i64) {
        let pairs = [(p, p), (p, q), (q, q), (p, z), (q, z), (z, z)];
        for (sum, (a, b)) in self.products.iter_mut().zip(pairs) {
            *sum += i128::from(a) * i128::from(b);
        }
    }

    /// Each sum times `count`, less the product of the totals.
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
        let sums = match squares {
            Squares::Centred => centred_sums(table, series),
            Squares::Differences => difference_sums(table, series),
        };
        let [pp, pq, qq, pz, qz, zz] = sums.products.map(|sum| sum as f64);
        Self { pp, pq, qq, pz, qz, zz }
    }

    /// The objective at grid index `k`, cosine and sine from the table.
    pub(super) fn at(&self, table: Table, k: i32) -> f64 {
        let (c, s) = table.unit(k);
        let cosine = c * self.pp - 2.0 * (s * self.pq + self.pz);
        let sine = s * self.qq + 2.0 * self.qz;
        self.zz + c * cosine + s * sine
    }

    /// Half the objective's slope per radian at grid index `k`.
    pub(super) fn slope(&self, table: Table, k: i32) -> f64 {
        let ((c, s), (c2, s2)) = (table.unit(k), table.unit(2 * k));
        s * self.pz + c * self.qz - 0.5 * s2 * (self.pp - self.qq) - c2 * self.pq
    }

    /// How far [`Self::slope`] may be off: 2⁻³² in each cosine, doubled for the arithmetic.
    pub(super) fn slope_error(&self) -> f64 {
        let size = self.pz.abs() + self.qz.abs() + (self.pp - self.qq).abs() + self.pq.abs();
        size / ONE
    }

    /// A bound on the `f64` rounding of [`Self::at`]: 16 roundings of the largest partial sum.
    pub(super) fn slack(&self) -> f64 {
        let mixed = self.pz.abs() + self.qz.abs() + self.pq.abs();
        (self.zz + self.pp + self.qq + 2.0 * mixed) * (8.0 * f64::EPSILON)
    }

    /// Where the objective turns, by bisection between the bounds the module describes.
    pub(super) fn turns(&self, table: Table) -> Turns {
        let axis = 0.5 * atan2(-2.0 * self.pq, self.pp - self.qq);
        let (sine, cosine) = sincos(axis);
        let x = self.pz * cosine - self.qz * sine;
        let y = -(self.pz * sine + self.qz * cosine);
        let axis = libm::round(axis / STEP) as i32;
        let major = if x < 0.0 { axis + HALF } else { axis };
        let minor = if y < 0.0 { axis - QUARTER } else { axis + QUARTER };
        let saddle = axis + libm::round(atan2(-cbrt(y), cbrt(x)) / STEP) as i32;
        let turn = |from, to, sign| self.turn(table, from, to, sign);
        Turns {
            minima: [turn(major, minor, 1.0), turn(minor + HALF, saddle, 1.0)],
            maxima: [turn(major + HALF, minor + HALF, -1.0), turn(saddle, major, -1.0)],
        }
    }

    /// The index on the way from `from` to `to` at which `sign` · J stops falling.
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

    /// The azimuth in rad, [0, 2π), of the continuous minimum next to grid index `k`: Newton's
    /// method on the slope, each step at most one grid step.
    pub(super) fn refine(&self, k: i32) -> f64 {
        const ENOUGH: f64 = 1e-10;
        let mut azimuth = f64::from(k) * STEP;
        for _ in 0..8 {
            let (s, c) = sincos(azimuth);
            let (c2, s2, spread) = (c * c - s * s, s * c, self.pp - self.qq);
            let slope = s * self.pz + c * self.qz - s2 * spread - c2 * self.pq;
            let curvature = c * self.pz - s * self.qz - c2 * spread + 4.0 * s2 * self.pq;
            if curvature <= 0.0 {
                break;
            }
            let change = (slope / curvature).clamp(-STEP, STEP);
            azimuth -= change;
            if change.abs() < ENOUGH {
                break;
            }
        }
        super::wrap(azimuth)
    }
}

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

/// A bound on the error that table rounding makes in the root of the objective.
///
/// Per cosine: 0.5 for the entry compared, 0.7072 for p and q, 0.7072 for cos A and sin A; twice
/// that per difference. The root of n Σ(d − mean)² is √n times the norm.
pub(super) fn rounding(count: f64, squares: Squares) -> f64 {
    const ENTRY: f64 = 1.9145;
    match squares {
        Squares::Centred => ENTRY * count,
        Squares::Differences => 2.0 * ENTRY * libm::sqrt(count - 1.0),
    }
}

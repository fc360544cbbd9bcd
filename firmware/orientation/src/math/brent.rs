//! Bounded minimisation of a function of one variable (R. P. Brent, Algorithms for Minimization
//! without Derivatives, 1973, chapter 5): the method of `fminbnd`, which Szymanowski 2003 uses.

/// A minimum and the cost of finding it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// Argument of the minimum.
    pub at: f64,
    /// Value of the function at the minimum.
    pub value: f64,
    /// Number of evaluations of the function.
    pub evaluations: u32,
}

/// Fraction of an interval that a golden section takes: (3 − √5)/2.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Relative spacing of `f64`, below which rounding blurs any argument.
const SPACING: f64 = 2.2e-16;

/// State of the search: the bracket and the three best arguments with their values, best first.
struct Search {
    lower: f64,
    upper: f64,
    best: [(f64, f64); 3],
    /// The latest step and the one before it.
    step: f64,
    before: f64,
}

/// Finds a minimum of a function in an interval to within `tolerance`, with at most `limit`
/// evaluations. For a function with a single minimum it is the global one.
pub fn minimise(
    [lower, upper]: [f64; 2],
    tolerance: f64,
    limit: u32,
    mut function: impl FnMut(f64) -> f64,
) -> Minimum {
    let first = lower + GOLDEN * (upper - lower);
    let start = (first, function(first));
    let mut search = Search { lower, upper, best: [start; 3], step: 0.0, before: 0.0 };
    let mut evaluations = 1;
    while evaluations < limit {
        let (at, _) = search.best[0];
        let reach = SPACING * at.abs() + tolerance / 3.0;
        let middle = 0.5 * (search.lower + search.upper);
        if (at - middle).abs() <= 2.0 * reach - 0.5 * (search.upper - search.lower) {
            break;
        }
        let next = search.next(middle, reach);
        search.take(next, function(next));
        evaluations += 1;
    }
    let (at, value) = search.best[0];
    Minimum { at, value, evaluations }
}

impl Search {
    /// Next argument: the parabola's minimum where it can be trusted, else a golden section.
    fn next(&mut self, middle: f64, reach: f64) -> f64 {
        let (at, _) = self.best[0];
        self.step = self.parabola(middle, reach).unwrap_or_else(|| {
            self.before = if at < middle { self.upper - at } else { self.lower - at };
            GOLDEN * self.before
        });
        // The step is never smaller than rounding lets the values differ.
        at + if self.step.abs() >= reach { self.step } else { libm::copysign(reach, self.step) }
    }

    /// Step to the minimum of the parabola through the three best points, if it lies inside the
    /// bracket and is shorter than half of the step before the last; kept a little away from the
    /// ends.
    fn parabola(&mut self, middle: f64, reach: f64) -> Option<f64> {
        let [(x, fx), (w, fw), (v, fv)] = self.best;
        if self.before.abs() <= reach {
            return None;
        }
        let (r, q) = ((x - w) * (fx - fv), (x - v) * (fx - fw));
        let p = (x - v) * q - (x - w) * r;
        let q = 2.0 * (q - r);
        let (p, q) = if q > 0.0 { (-p, q) } else { (p, -q) };
        let before = core::mem::replace(&mut self.before, self.step);
        let is_inside = p > q * (self.lower - x) && p < q * (self.upper - x);
        if !is_inside || p.abs() >= (0.5 * q * before).abs() {
            return None;
        }
        let at = x + p / q;
        let is_near = at - self.lower < 2.0 * reach || self.upper - at < 2.0 * reach;
        Some(if is_near { libm::copysign(reach, middle - x) } else { p / q })
    }

    /// Updates bracket and best points with a new value.
    fn take(&mut self, at: f64, value: f64) {
        let [(x, fx), (w, fw), (v, fv)] = self.best;
        if value <= fx {
            let end = if at >= x { &mut self.lower } else { &mut self.upper };
            *end = x;
            self.best = [(at, value), (x, fx), (w, fw)];
            return;
        }
        let end = if at < x { &mut self.lower } else { &mut self.upper };
        *end = at;
        if value <= fw || w == x {
            self.best = [(x, fx), (at, value), (w, fw)];
        } else if value <= fv || v == x || v == w {
            self.best = [(x, fx), (w, fw), (at, value)];
        }
    }
}

//! Reference costs: the exhaustive search that the fast one replaces, and the regression under
//! every fit.

use core::hint::black_box;

use orientation::alignment::stepwise::etalon;
use orientation::alignment::stepwise::etalon::{Criterion, Series};
use orientation::math::reference_table::TURN;
use orientation::math::reference_table::Table;
use orientation::math::regression::{Column, Regression, Solution};

use crate::report::{Report, figure};
use measure::counter::Counter;

/// Number of dwells of the default schedule.
const DWELLS: u32 = 24;
/// Number of columns of the regression: cosine, sine, constant, time, temperature.
const COLUMNS: usize = 5;

/// Measures an exhaustive search of the circle for a series, whose result the fast search must
/// equal.
pub fn exhaustive(counter: &Counter, report: &mut Report, series: &Series) {
    let (cost, index) = counter.measure(|| least_squares(series));
    let fast = etalon::search(Table::built_in(), series, Criterion::LeastSquares).index;
    report.require("the exhaustive search finds what the fast one finds", index == fast);
    figure("exhaustive search of the circle for 60, least squares", cost.instructions());
}

/// Lowest index with the least sum of squared differences, by trying all 129 600.
#[inline(never)]
fn least_squares(series: &Series) -> i32 {
    let table = Table::built_in();
    let objective = |index: i32| -> u128 {
        let mut angle = index;
        let mut before = table.cos(angle);
        let mut sum = 0_u128;
        for pair in series.values().windows(2) {
            angle += series.step();
            let here = table.cos(angle);
            let off = u128::from(((here - before) - (pair[1] - pair[0])).unsigned_abs());
            sum += off * off;
            before = here;
        }
        sum
    };
    let mut best = (u128::MAX, 0);
    for index in 0..TURN {
        let sum = objective(index);
        if sum < best.0 {
            best = (sum, index);
        }
    }
    best.1
}

/// Measures sums and solution of a regression over the default schedule.
pub fn regression(counter: &Counter, report: &mut Report) {
    let (cost, solution) = counter.measure(|| regress(black_box(DWELLS)));
    let found = solution.is_some_and(|found| (found.coefficients[0] - 1.0).abs() < 1e-9);
    report.require("the regression finds its coefficients", found);
    figure(format_args!("regression of {DWELLS} dwells on {COLUMNS} columns"), cost.instructions());
}

/// Fits cos θ + 2 sin θ exactly.
#[inline(never)]
fn regress(dwells: u32) -> Option<Solution<COLUMNS>> {
    let mut regression = Regression::default();
    for index in 0..dwells {
        let part = f64::from(index) / f64::from(dwells);
        let (sine, cosine) = libm::sincos(part * core::f64::consts::TAU);
        let columns = [cosine, sine, 1.0, part, part * part];
        regression.push(&columns, cosine + 2.0 * sine);
    }
    regression.solve(&[Column::Free; COLUMNS])
}

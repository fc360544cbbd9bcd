//! An accelerometer that warms up: on an arc its biases change as the forces of a stage do that counts the other way.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise;
use orientation::alignment::stepwise::session::Session;
use orientation::math::regression::{Column, Regression};
use orientation::signal::dwell::Dwell;

/// Fewest dwells with forces that say anything of a drift.
const FEWEST: usize = 4;
/// By how much biases change that do, g: an accelerometer for a few cents in the cold.
const MOST: f64 = 0.02;
/// Twice the logarithm of likelihoods by which one explanation is clearly better than another.
const CLEARLY: f64 = 10.0;
/// Part of what any steady tilt leaves of the forces that a drift may leave which explains them.
const LEFT: f64 = 0.1;

/// Tilt phasor, biases, and their change in proportion to the time and its square; two columns of each.
const COLUMNS: usize = 8;

/// A fit of the forces: how many there are, the sum of squares that it leaves, g², and by how much the biases change, g.
struct Found {
    rows: f64,
    left: f64,
    change: f64,
}

/// What is likely where biases that drift explain the forces, and a stage that counts the other way, which gives an
/// azimuth where `is_reversed`, does not clearly explain them better.
pub fn of(session: &Session, refusal: &Refusal, is_reversed: bool) -> Option<String> {
    let is_of_forces = matches!(
        refusal,
        Refusal::AccelerometerDisagrees { .. }
            | Refusal::Stepwise(stepwise::Refusal::TiltStepped { .. })
    );
    let (dwells, gravity) = (session.dwells(), session.setting.site.latitude.gravity());
    let steady = fit(dwells, gravity.0, 1.0, Column::Absent)?;
    let drifting = fit(dwells, gravity.0, 1.0, Column::Free)?;
    let reversed = fit(dwells, gravity.0, -1.0, Column::Absent).filter(|_| is_reversed);
    let is_likely = match reversed {
        Some(reversed) => {
            drifting.explains_more_than(&steady) && !reversed.explains_more_than(&drifting)
        }
        None => is_of_forces && drifting.left < LEFT * LEFT * steady.left,
    };
    if !is_likely || drifting.change > MOST {
        return None;
    }
    let also = if is_reversed {
        ", and so does a column stage_rad that is counted the other way"
    } else {
        ""
    };
    Some(format!(
        "biases of the accelerometer that drift by {:.2} mg, as while it warms up, explain the forces{also}: let it \
         warm up, go round the circle, or come back to the first position",
        drifting.change * 1e3
    ))
}

impl Found {
    /// Whether it explains clearly more than another.
    fn explains_more_than(&self, other: &Self) -> bool {
        self.rows * (other.left / self.left).ln() > CLEARLY
    }
}

/// Fits the forces of a stage that counts by this sign, its biases steady or not.
fn fit(dwells: &[Dwell], gravity: f64, sign: f64, change: Column) -> Option<Found> {
    let forces = || dwells.iter().filter_map(|dwell| Some((dwell, dwell.force?)));
    let (begin, end) = (forces().next()?.0.middle, forces().next_back()?.0.middle);
    if forces().count() < FEWEST || end <= begin {
        return None;
    }
    let mut regression = Regression::<COLUMNS>::default();
    for (dwell, [x, y, _]) in forces() {
        let (sine, cosine) = (sign * dwell.stage.rad()).sin_cos();
        let part = (dwell.middle.0 - begin.0) / (end.0 - begin.0);
        let square = part * part;
        regression.push(&[cosine, -sine, 1.0, 0.0, part, 0.0, square, 0.0], x.0 / gravity);
        regression.push(&[-sine, -cosine, 0.0, 1.0, 0.0, part, 0.0, square], y.0 / gravity);
    }
    let free = Column::Free;
    let model = [free, free, free, free, change, change, change, change];
    let solution = regression.solve(&model)?;
    let [.., x, y, x_square, y_square] = solution.coefficients;
    // They change most at the end, or where the parabola turns.
    let most = |linear: f64, square: f64| {
        let turn = -0.5 * linear / square;
        let between = if (0.0..1.0).contains(&turn) { 0.5 * linear * turn } else { 0.0 };
        (linear + square).abs().max(between.abs())
    };
    Some(Found {
        rows: 2.0 * forces().count() as f64,
        left: solution.chi_square,
        change: most(x, x_square).hypot(most(y, y_square)),
    })
}

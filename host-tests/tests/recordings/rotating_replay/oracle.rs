//! North from a turning platform once more, in plain `f64` on the rows as they are: the equations of
//! `orientation::alignment::rotating` word for word, with nothing of the core's.

use host::recording::RotatingRow;

/// Earth rate, rad/s.
const EARTH: f64 = 7.292_115e-5;

/// A complex number, real part first.
type Complex = [f64; 2];

fn product(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Solves a linear system by elimination with pivoting.
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let size = right.len();
    for column in 0..size {
        let larger =
            |a: &usize, b: &usize| matrix[*a][column].abs().total_cmp(&matrix[*b][column].abs());
        let pivot = (column..size).max_by(larger).unwrap_or(column);
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        let (upper, lower) = matrix.split_at_mut(column + 1);
        let above = &upper[column];
        for (below, row) in lower.iter_mut().enumerate() {
            let factor = row[column] / above[column];
            row.iter_mut().zip(above).for_each(|(own, other)| *own -= factor * other);
            right[column + 1 + below] -= factor * right[column];
        }
    }
    for row in (0..size).rev() {
        let known: f64 = (row + 1..size).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right
}

/// Least squares of a signal on columns, each freed of its mean first: a constant is among them.
pub fn least_squares(columns: &[Vec<f64>], signal: &[f64]) -> Vec<f64> {
    let centred = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| value - mean).collect::<Vec<f64>>()
    };
    let columns: Vec<Vec<f64>> = columns.iter().map(|column| centred(column)).collect();
    let signal = centred(signal);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let products = |a: &Vec<f64>| columns.iter().map(|b| dot(a, b)).collect();
    let matrix = columns.iter().map(products).collect();
    let right = columns.iter().map(|column| dot(column, &signal)).collect();
    solved(matrix, right)
}

fn column(rows: &[RotatingRow], of: impl Fn(&RotatingRow) -> f64) -> Vec<f64> {
    rows.iter().map(of).collect()
}

/// t, cos θ, sin θ.
fn turning(rows: &[RotatingRow]) -> Vec<Vec<f64>> {
    let first = rows[0].time_s;
    vec![
        column(rows, |row| row.time_s - first),
        column(rows, |row| row.stage_rad.cos()),
        column(rows, |row| row.stage_rad.sin()),
    ]
}

/// The sensor's part of the platform's rate, s = −sin α, from a rate-modulated stretch: the fit on
/// 1, t, cos θ, sin θ, θ̇.
pub fn misalignment(modulated: &[RotatingRow]) -> f64 {
    let mut columns = turning(modulated);
    columns.push(column(modulated, |row| row.stage_rate_rad_s));
    least_squares(&columns, &column(modulated, |row| row.rate_rad_s))[3]
}

/// The phasor of a signal.
fn phasor(rows: &[RotatingRow], of: impl Fn(&RotatingRow) -> f64) -> Complex {
    let found = least_squares(&turning(rows), &column(rows, of));
    [found[1], -found[2]]
}

/// What is known beforehand.
pub struct Known {
    /// Latitude, rad.
    pub latitude: f64,
    /// Local gravity, m/s².
    pub gravity: f64,
    /// g-sensitivity `k_s`, `k_o`, rad/s/g.
    pub g_sensitivity: Complex,
}

/// The azimuth, rad, of a flat sensor that turned clockwise, then counter-clockwise; whole turns.
pub fn azimuth(turns: [&[RotatingRow]; 2], misalignment: f64, known: &Known) -> f64 {
    let freed = |row: &RotatingRow| row.rate_rad_s - misalignment * row.stage_rate_rad_s;
    let mean = |[a, b]: [Complex; 2]| [0, 1].map(|part| 0.5 * (a[part] + b[part]));
    let sensor = mean(turns.map(|rows| phasor(rows, freed)));
    let tilt = mean(turns.map(|rows| phasor(rows, |row| row.force_m_s2 / known.gravity)));
    let [along, across] = known.g_sensitivity;
    let turned = product([EARTH * known.latitude.sin() + along, across], tilt);
    let [north, east] = [0, 1].map(|part| sensor[part] - turned[part]);
    east.atan2(north).rem_euclid(std::f64::consts::TAU)
}

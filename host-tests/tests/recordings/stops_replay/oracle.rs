//! The paper's method once more, in double precision throughout and by other means: direction cosine
//! matrices and Rodrigues' formula at every sample, the Earth from geocentric coordinates.

use host::recording::{Header, ImuRow};

type Vector = [f64; 3];
type Matrix = [Vector; 3];

const EARTH_RATE: f64 = 7.292_115e-5;
/// WGS84: semi-major axis, m, and first eccentricity squared.
const AXIS: f64 = 6_378_137.0;
const ECCENTRICITY: f64 = 0.006_694_379_990_14;

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn apply(a: &Matrix, v: &Vector) -> Vector {
    a.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn transposed(a: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn unit(v: &Vector) -> Vector {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// The rotation by a vector: Rodrigues' formula.
fn rotation(v: &Vector) -> Matrix {
    let angle = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z] = *v;
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let square = times(&cross, &cross);
    let (first, second) = if angle < 1e-6 {
        (1.0, 0.5)
    } else {
        (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle))
    };
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            f64::from(u8::from(i == j)) + first * cross[i][j] + second * square[i][j]
        })
    })
}

/// Attitude after each row against that before the first: coning by the term of two samples.
fn attitudes(rows: &[ImuRow], period: f64) -> Vec<Matrix> {
    let mut attitude = rotation(&[0.0; 3]);
    let mut before = [0.0; 3];
    rows.iter()
        .map(|row| {
            let now = row.sample.rates_rad_s.map(|rate| rate * period);
            let [a, b] = [before, now];
            let coning =
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let turned = std::array::from_fn(|axis| now[axis] + coning[axis] / 12.0);
            before = now;
            attitude = times(&attitude, &rotation(&turned));
            attitude
        })
        .collect()
}

/// North, east, down as columns on axes that the Earth turns in.
fn navigation(latitude: f64, longitude: f64) -> Matrix {
    let (sine, cosine) = latitude.sin_cos();
    let (east, zero) = longitude.sin_cos();
    transposed(&[
        [-sine * zero, -sine * east, cosine],
        [-east, zero, 0.0],
        [-cosine * zero, -cosine * east, -sine],
    ])
}

/// The azimuth at the first stop, °, for gyros without bias.
pub fn start_azimuth_deg(header: &Header, rows: &[ImuRow]) -> f64 {
    let latitude = header.latitude_deg.expect("it is stated").to_radians();
    let period = 1.0 / header.rate_hz.expect("it is stated");
    let stops = header.stops_s.as_ref().expect("they are stated");
    let moved = header.displacements_m.as_ref().expect("they are stated");
    let attitudes = attitudes(rows, period);
    // Mean up at a stop on the axes of the body at the start, and the middle of the stop.
    let up = |stop: &[f64; 2]| {
        let inside = |row: &ImuRow| row.time_s > stop[0] + 1e-6 && row.time_s < stop[1] + 1e-6;
        let mut sum = [0.0; 3];
        for (row, attitude) in rows.iter().zip(&attitudes).filter(|(row, _)| inside(row)) {
            let force = apply(attitude, &row.sample.force_m_s2);
            sum = std::array::from_fn(|axis| sum[axis] + force[axis]);
        }
        (unit(&sum), 0.5 * (stop[0] + stop[1]))
    };
    let ends = [0, stops.len() - 1];
    let [first, last] = ends.map(|index| up(&stops[index]));
    let [from, to] = ends.map(|index| moved[index]);
    let square = 1.0 - ECCENTRICITY * latitude.sin().powi(2);
    let north = (to[0] - from[0]) / (AXIS * (1.0 - ECCENTRICITY) / square.powf(1.5));
    let east = (to[1] - from[1]) / (AXIS / square.sqrt() * (latitude + 0.5 * north).cos());
    // Up at the last stop on north, east, down of the first as they stood in its middle.
    let start = navigation(latitude, 0.0);
    let end = navigation(latitude + north, east + EARTH_RATE * (last.1 - first.1));
    let predicted = apply(&transposed(&start), &end.map(|row| -row[2]));
    // Level axes of the first stop that point where the body did in its middle.
    let middle = attitudes[(first.1 / period) as usize - 1];
    let down = first.0.map(|part| -part);
    let nose = middle.map(|row| row[0]);
    let along: f64 = nose.iter().zip(down).map(|(a, b)| a * b).sum();
    let forward = unit(&std::array::from_fn(|axis| nose[axis] - along * down[axis]));
    let right = [
        down[1] * forward[2] - down[2] * forward[1],
        down[2] * forward[0] - down[0] * forward[2],
        down[0] * forward[1] - down[1] * forward[0],
    ];
    let levelled = apply(&[forward, right, down], &last.0);
    let angle = predicted[1].atan2(predicted[0]) - levelled[1].atan2(levelled[0]);
    angle.to_degrees().rem_euclid(360.0)
}

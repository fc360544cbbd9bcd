//! A body that turns and accelerates in closed form, and what its sensors show of it.

use hal_mock::noise::Generator;
use orientation::alignment::Azimuth;
use orientation::attitude::{Gyro, Keeper, Report, Setting};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::signal::InertialSample;
use orientation::units::{
    AngleIncrement, DEGREE, DEGREE_PER_HOUR, Instant, Radians, RadiansPerSecond, Seconds,
    SpecificForce, TURN, wrapped,
};

type Vector = [f64; 3];
type Matrix = [Vector; 3];

/// A body on its way; attitude as course, pitch, roll, rad.
pub struct Body {
    pub setting: Setting,
    pub latitude: f64,
    pub seconds: f64,
    /// Biases of the gyros, rad/s, and of the accelerometers, m/s².
    pub biases: Vector,
    pub force_biases: Vector,
    /// By how much the gyros are noisier than the setting has it.
    pub noise: f64,
    pub attitude: fn(f64) -> Vector,
    /// North, east, down, m/s².
    pub acceleration: fn(f64) -> Vector,
    /// When an azimuth is handed over, s, with 1 mrad.
    pub handed: Option<f64>,
    pub seed: u64,
}

/// A coarse IMU of which the data sheet is right, at 55°, at rest: N 0.4 °/√h, B 10 °/h, K 10 °/h/√h, scale 0.2 %.
pub fn coarse(seconds: f64) -> Body {
    let noise = GyroNoise::from_field_units(0.4, 10.0, 10.0, 0.0);
    let gyro = Gyro { noise, bias_sigma: RadiansPerSecond(0.5 * DEGREE), scale_sigma: 2e-3 };
    Body {
        setting: Setting { gyros: [gyro; 3], ..Setting::coarse(latitude(55.0), Seconds(0.01)) },
        latitude: 55.0,
        seconds,
        biases: [0.4 * DEGREE, -0.3 * DEGREE, 0.2 * DEGREE],
        force_biases: [0.02, -0.01, 0.0],
        noise: 1.0,
        attitude: |_| [0.5, 0.03, -0.02],
        acceleration: |_| [0.0; 3],
        handed: None,
        seed: 1,
    }
}

/// Three fibre-optic gyros: N 0.001 °/√h, B 0.007 °/h, switched on to 0.05 °/h.
pub fn precise(seconds: f64) -> Body {
    let noise = GyroNoise::from_field_units(0.001, 0.007, 0.0, 0.0);
    let gyro = Gyro {
        noise,
        bias_sigma: RadiansPerSecond::from_degrees_per_hour(0.05),
        scale_sigma: 5e-5,
    };
    Body {
        setting: Setting::precise(latitude(55.0), Seconds(0.01), gyro),
        biases: [0.03, -0.05, 0.02].map(|bias| bias * DEGREE_PER_HOUR),
        force_biases: [0.0; 3],
        ..coarse(seconds)
    }
}

/// A vehicle on a straight level road that is shaken at random from 30 s on: sines without a common period, 0.2° together.
pub fn shaken(time: f64) -> Vector {
    let shake = |phase: f64| {
        let sines = [0.53, 0.91, 1.37, 1.73, 2.19, 2.71, 3.29, 3.83];
        let sum =
            sines.map(|rate| (TURN * rate * time + phase * 10.0 * rate).sin()).iter().sum::<f64>();
        0.1 * DEGREE * sum * (time - 30.0).clamp(0.0, 1.0)
    };
    [0.5, 0.02 + shake(1.0), -0.03 + shake(2.0)]
}

fn latitude(degrees: f64) -> Latitude {
    Latitude::from_degrees(degrees).expect("a latitude")
}

/// What was known, and what is true.
pub struct Known {
    pub time: f64,
    /// Angle between the vertical and what was taken for it, rad.
    pub tilt: f64,
    /// Error of the azimuth, rad.
    pub azimuth: Option<f64>,
    pub report: Report,
}

impl Known {
    pub fn in_sigmas(&self) -> f64 {
        self.tilt / self.report.level_sigma.0
    }
}

/// Keeps the attitude of the body; what was known ten times a second. Samples that `spoil` refuses are lost.
pub fn keep(body: &Body, spoil: impl FnMut(f64, &mut InertialSample) -> bool) -> Vec<Known> {
    keep_acting(body, spoil, |_, _| ())
}

/// Keeps the attitude of the body, as [`keep`] does; before each sample `act` has the keeper.
pub fn keep_acting(
    body: &Body,
    mut spoil: impl FnMut(f64, &mut InertialSample) -> bool,
    mut act: impl FnMut(f64, &mut Keeper),
) -> Vec<Known> {
    let mut keeper = Keeper::new(&body.setting);
    let mut sensors = Sensors::new(body);
    let period = body.setting.sample_seconds;
    let mut known = Vec::new();
    let mut is_handed = false;
    for place in 1..=(body.seconds / period.0).round() as u32 {
        let time = f64::from(place) * period.0;
        let mut sample = sensors.sample(time);
        act(time, &mut keeper);
        if spoil(time, &mut sample) {
            keeper.push(&sample);
        }
        if !is_handed && body.handed.is_some_and(|handed| time >= handed) {
            is_handed = true;
            let [azimuth, ..] = (body.attitude)(time).map(wrapped);
            keeper.hand_over(Azimuth { angle: Radians(azimuth), sigma: Radians(1e-3) });
        }
        if place % (0.1 / period.0).round() as u32 == 0 {
            known.push(judged(body, time, keeper.report()));
        }
    }
    known
}

fn judged(body: &Body, time: f64, report: Report) -> Known {
    let angles = (body.attitude)(time);
    let [w, x, y, z] = report.attitude;
    let shown = [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)];
    let [.., down] = matrix(angles);
    let across = length(&cross(&shown, &down));
    let along: f64 = shown.iter().zip(down).map(|(one, other)| one * other).sum();
    let azimuth = report.azimuth.map(|azimuth| {
        let off = azimuth.angle.0 - angles[0];
        off - TURN * (off / TURN).round()
    });
    Known { time, tilt: across.atan2(along), azimuth, report }
}

struct Sensors<'a> {
    body: &'a Body,
    noise: Generator,
    before: Matrix,
    carried: Vector,
}

impl<'a> Sensors<'a> {
    fn new(body: &'a Body) -> Self {
        let before = matrix((body.attitude)(0.0));
        Self { body, noise: Generator::new(body.seed), before, carried: [0.0; 3] }
    }

    fn sample(&mut self, time: f64) -> InertialSample {
        let body = self.body;
        let period = body.setting.sample_seconds;
        let place = latitude(body.latitude);
        let now = matrix((body.attitude)(time));
        let turned = rotation(&times(&transposed(&self.before), &now));
        self.before = now;
        let middle = transposed(&matrix((body.attitude)(time - 0.5 * period.0)));
        let earth = applied(&middle, &[place.horizontal_rate().0, 0.0, -place.vertical_rate().0]);
        let [north, east, down] = (body.acceleration)(time - 0.5 * period.0);
        let force = applied(&middle, &[north, east, down - place.gravity().0]);
        let turned = core::array::from_fn(|axis| {
            let walk = body.setting.gyros[axis].noise.angle_random_walk;
            let walk = body.noise * walk.0 * period.0.sqrt();
            let rate = earth[axis] + body.biases[axis];
            let angle = turned[axis] + rate * period.0 + walk * self.noise.gaussian();
            AngleIncrement::from_rad(angle, &mut self.carried[axis])
        });
        let force = core::array::from_fn(|axis| {
            let noise = 1e-3 / period.0.sqrt() * self.noise.gaussian();
            SpecificForce::from_m_per_s2(force[axis] + body.force_biases[axis] + noise)
        });
        InertialSample { time: Instant::from_seconds(time), turned, force: Some(force) }
    }
}

/// From body axes to north, east, down.
fn matrix([course, pitch, roll]: Vector) -> Matrix {
    let [(a, b), (c, d), (e, f)] = [course.sin_cos(), pitch.sin_cos(), roll.sin_cos()];
    [
        [b * d, b * c * e - a * f, b * c * f + a * e],
        [a * d, a * c * e + b * f, a * c * f - b * e],
        [-c, d * e, d * f],
    ]
}

fn transposed(matrix: &Matrix) -> Matrix {
    core::array::from_fn(|row| core::array::from_fn(|column| matrix[column][row]))
}

fn applied(matrix: &Matrix, vector: &Vector) -> Vector {
    matrix.map(|row| row.iter().zip(vector).map(|(one, other)| one * other).sum())
}

fn times(one: &Matrix, other: &Matrix) -> Matrix {
    let columns = transposed(other);
    one.map(|row| applied(&columns, &row))
}

fn cross([a, b, c]: &Vector, [x, y, z]: &Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn length(vector: &Vector) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// The rotation vector of a matrix, rad.
fn rotation(matrix: &Matrix) -> Vector {
    let twice =
        [matrix[2][1] - matrix[1][2], matrix[0][2] - matrix[2][0], matrix[1][0] - matrix[0][1]];
    let (sine, cosine) = (length(&twice), matrix[0][0] + matrix[1][1] + matrix[2][2] - 1.0);
    let part = if sine < 1e-12 { 0.5 } else { sine.atan2(cosine) / sine };
    twice.map(|axis| axis * part)
}

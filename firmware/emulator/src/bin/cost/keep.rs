//! Cost of attitude and heading: pitch and roll from a coarse IMU, heading from three precise
//! gyros, roll of a spinning body; the mean sample, and the most expensive one.

use core::hint::black_box;

use hal_mock::noise::Generator;
use orientation::alignment::Azimuth;
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::roll as spin;
use orientation::roll::{Signal, Spin};
use orientation::signal::{InertialSample, SpinSample};
use orientation::units::{
    AngleIncrement, DEGREE, DEGREE_PER_HOUR, Instant, Radians, RadiansPerSecond, Seconds,
    SpinForce, TURN,
};

use crate::report::{Report, figure, mean_and_greatest};
use crate::samples::inertial;
use firmware::budget::{
    HEADING_INSTRUCTIONS, SPIN_INSTRUCTIONS, VERTICAL_GREATEST_INSTRUCTIONS, VERTICAL_INSTRUCTIONS,
};
use measure::counter::Counter;

/// Output rate of the coarse IMU, Hz.
const COARSE_HZ: u64 = 416;
/// Sample rate of precise gyros, Hz.
const PRECISE_HZ: u64 = 2000;
/// Time at rest, s.
const REST: u64 = 4;
/// Time of motion, s.
const MOTION: u64 = 8;
/// Sample rate of a spinning body, Hz.
const SPIN_HZ: u64 = 10_000;
/// Spin rate, turns per second.
const TURNS_HZ: f64 = 100.0;
/// Length of the spin, samples.
const SPUN: u64 = 5_000;
/// Lift, m/s².
const LIFT: f64 = 30.0;
/// Centripetal forces on both axes, m/s².
const PULL: [f64; 2] = [-7954.0, -3977.0];
/// Noise of the forces, m/s².
const SPIN_NOISE: f64 = 1.5;
/// Scale error of the gyro of the spinning body, relative.
const SCALE: f64 = 1e-3;
/// Greatest rate about the vertical, rad/s.
const RATE: f64 = 0.6;
/// Frequency of that motion, Hz.
const SWING_HZ: f64 = 0.4;
/// Horizontal acceleration, m/s².
const ACCELERATION: f64 = 1.0;

/// Type of [`Keeper::push`].
type Push = fn(&mut Keeper, &InertialSample);
/// Type of [`Spin::push`].
type PushSpin = fn(&mut Spin, &SpinSample) -> Option<Signal>;

/// Measures all cases.
pub fn report(counter: &Counter, report: &mut Report) {
    let latitude = Latitude::from_degrees(52.0).unwrap_or(Latitude::EQUATOR);
    let coarse = Setting::coarse(latitude, Seconds(1.0 / COARSE_HZ as f64));
    let [mean, worst] = kept(counter, Keeper::new(&coarse), COARSE_HZ, report);
    let name = "gyrovertical on a coarse IMU, a sample at 416 Hz";
    report.budget(name, mean, VERTICAL_INSTRUCTIONS);
    let name = "gyrovertical, the sample that costs most";
    report.budget(name, worst, VERTICAL_GREATEST_INSTRUCTIONS);
    let noise = GyroNoise::from_field_units(0.001, 0.007, 0.0, 0.0);
    let gyro = Gyro { noise, bias_sigma: RadiansPerSecond(DEGREE_PER_HOUR), scale_sigma: 1e-4 };
    let mut keeper =
        Keeper::new(&Setting::precise(latitude, Seconds(1.0 / PRECISE_HZ as f64), gyro));
    keeper.hand_over(Azimuth { angle: Radians(1.0), sigma: Radians::from_degrees(0.1) });
    let [mean, worst] = kept(counter, keeper, PRECISE_HZ, report);
    let name = "heading from three precise gyros, a sample at 2 kHz";
    report.budget(name, mean, HEADING_INSTRUCTIONS);
    figure("the same, the sample that costs most", worst);
    spun(counter, report);
}

/// Mean and greatest number of instructions of a sample, for a body that stands and then moves.
fn kept(counter: &Counter, mut keeper: Keeper, rate: u64, report: &mut Report) -> [u64; 2] {
    let mut noise = Generator::new(3);
    // Through a pointer that is opaque to the optimiser the function is called, not inlined.
    let push = black_box(Keeper::push as Push);
    let mut carried = [0.0; 3];
    let costs = mean_and_greatest((REST + MOTION) * rate, |index| {
        let sample = moving(index, rate, &mut noise, &mut carried);
        counter.measure(|| push(&mut keeper, &sample)).0
    });
    let kept = keeper.report();
    let is_level = libm::hypot(kept.pitch.0, kept.roll.0) < DEGREE;
    report.require("the body is level to a degree", is_level);
    costs
}

/// Sample of a body that stands, then turns to and fro about the vertical and shakes.
fn moving(index: u64, rate: u64, noise: &mut Generator, carried: &mut [f64; 3]) -> InertialSample {
    let seconds = index as f64 / rate as f64;
    let is_moving = index >= REST * rate;
    let swing = if is_moving { libm::sin(TURN * SWING_HZ * seconds) } else { 0.0 };
    let rates = [0.0, 0.0, RATE * swing];
    let force = [ACCELERATION * swing, 0.0, -9.81];
    let rates = rates.map(|rate| rate + 1e-5 * noise.gaussian());
    inertial(index, rate, rates, force.map(|force| force + 1e-3 * noise.gaussian()), carried)
}

/// Measures a spinning body with noise, in phase lock.
fn spun(counter: &Counter, report: &mut Report) {
    let mut noise = Generator::new(4);
    let mut spin = Spin::new(&spin::Setting::new(Seconds(1.0 / SPIN_HZ as f64)));
    let push = black_box(Spin::push as PushSpin);
    let (mut roll, mut carried) = (0.0, 0.0);
    let [mean, worst] = mean_and_greatest(SPUN, |index| {
        roll += TURN * TURNS_HZ / SPIN_HZ as f64;
        let sample = spinning(index, roll, &mut noise, &mut carried);
        counter.measure(|| push(&mut spin, &sample)).0
    });
    let off = spin.roll().rad() - roll;
    report.require("the roll is found to a degree, its turns counted", off.abs() < DEGREE);
    let name = "roll of a spinning body, a sample at 10 kHz";
    report.budget(name, mean, SPIN_INSTRUCTIONS);
    figure("the same, a sample that ends four turns", worst);
}

/// Sample of a spinning body.
fn spinning(index: u64, roll: f64, noise: &mut Generator, carried: &mut f64) -> SpinSample {
    let (sine, cosine) = libm::sincos(roll);
    let step = TURN * TURNS_HZ / SPIN_HZ as f64 * (1.0 + SCALE);
    let force = [PULL[0] + LIFT * cosine, PULL[1] - LIFT * sine];
    SpinSample {
        time: Instant((index + 1) * 1_000_000 / SPIN_HZ),
        turned: [AngleIncrement::from_rad(step, carried), AngleIncrement(0), AngleIncrement(0)],
        force: Some(force.map(|f| SpinForce::from_m_per_s2(f + SPIN_NOISE * noise.gaussian()))),
    }
}

//! Cost of measuring the gyro's noise: the Allan variance of each sample, and one fit.

use core::hint::black_box;

use hal_mock::noise::Generator;
use heapless::Vec;
use orientation::noise::allan::{Allan, MOST_POINTS, Point, variance};
use orientation::noise::fit::{Estimate, FitError, NoiseFit};
use orientation::noise::model::GyroNoise;
use orientation::units::{AngularRate, Seconds};

use crate::report::{Report, mean_and_greatest};
use firmware::budget::{ALLAN_INSTRUCTIONS, NOISE_FIT_INSTRUCTIONS};
use measure::counter::Counter;
use measure::stack::stack_of;

/// Number of samples through the estimator.
const SAMPLES: u64 = 4096;
/// White noise of a sample, rad/s: N = 0.02 °/√h at 10 Hz.
const SIGMA: f64 = 1.8e-5;
/// Sample rate of the fitted records, Hz.
const RATE_HZ: f64 = 2000.0;
/// Number of samples of the longest record that the estimator resolves.
const LONGEST: f64 = 1e8;
/// Number of samples of an hour of rest.
const HOUR: f64 = 3600.0 * RATE_HZ;
/// Noise of the gyro: N in °/√h, B in °/h and K in °/h/√h.
const GYRO: [f64; 3] = [0.02, 0.3, 2.0];

/// Type of [`Allan::push`].
type Push = fn(&mut Allan, AngularRate);

/// Measures a sample, and the fits of an hour and of the full grid.
pub fn report(counter: &Counter, report: &mut Report) {
    report.budget("Allan variance, a sample", sample(counter), ALLAN_INSTRUCTIONS);
    for (name, samples) in [("an hour at 2 kHz", HOUR), ("10^8 samples", LONGEST)] {
        let points = points(samples);
        let (cost, fit) = counter.measure(|| fit(&points));
        let is_found = |fit: NoiseFit| matches!(fit.estimates, [_, Estimate::Found { .. }, ..]);
        report.require("the fit found N", fit.is_ok_and(is_found));
        let title = format_args!("noise fit, {name}");
        report.budget(title, cost.instructions(), NOISE_FIT_INSTRUCTIONS);
    }
}

/// Stack of a fit of the full grid, bytes.
pub fn stack() -> usize {
    let points = points(LONGEST);
    stack_of(|| fit(&points).is_ok()).0
}

/// Fit that is measured, not inlined.
#[inline(never)]
fn fit(points: &[Point]) -> Result<NoiseFit, FitError> {
    NoiseFit::of_points(points, Seconds(1.0 / RATE_HZ))
}

/// Mean number of instructions of a sample, call included.
fn sample(counter: &Counter) -> u64 {
    let mut noise = Generator::new(5);
    let mut allan = Allan::new();
    // Through a pointer that is opaque to the optimiser the function is called, not inlined.
    let push = black_box(Allan::push as Push);
    let [mean, _] = mean_and_greatest(SAMPLES, |_| {
        let rate = AngularRate::from_rad_per_s(SIGMA * noise.gaussian());
        counter.measure(|| push(&mut allan, rate)).0
    });
    mean
}

/// Points as of a record with this many samples: those of the model, with the scatter of white
/// noise.
fn points(samples: f64) -> Vec<Point, MOST_POINTS> {
    let mut noise = Generator::new(6);
    let gyro = GyroNoise::from_field_units(GYRO[0], GYRO[1], GYRO[2], 0.0);
    let levels = (0..24).flat_map(|level| [4.0, 6.0].map(|m| (m, f64::from(1_u32 << level))));
    let grid = [1.0, 2.0, 3.0].map(|m| (m, 1.0)).into_iter().chain(levels);
    let point = |(m, stride): (f64, f64)| {
        let terms = libm::floor(samples / stride) + 1.0 - 2.0 * m;
        let seconds = m * stride / RATE_HZ;
        let scatter = libm::sqrt(m / terms.max(1.0)) * noise.gaussian();
        Point {
            seconds: Seconds(seconds),
            variance: variance(&gyro, seconds) * (1.0 + scatter).max(0.1),
            stride: Seconds(stride / RATE_HZ),
            terms: terms.max(0.0) as u64,
        }
    };
    grid.map(point).filter(|point| point.terms > 0).collect()
}

//! Cost per sample on a continuously rotating platform: its demodulation.

use core::hint::black_box;

use hal_mock::noise::Generator;
use orientation::alignment::rotating::turn_accumulator::{Mode, TurnAccumulator};
use orientation::signal::Sample;
use orientation::units::{Angle, AngularRate, Instant, SpecificForce, TURN};

use crate::report::{Report, figure, mean_and_greatest};
use firmware::budget::TURNING_INSTRUCTIONS;
use measure::counter::Counter;

/// Sample rate, Hz.
const RATE_HZ: f64 = 2000.0;
/// Sample periods in a block of 20 ms.
const PERIODS: u32 = 40;
/// Speed of the platform, turns per second.
const SPEED_HZ: f64 = 0.137;
/// Number of samples: two whole turns and the settling before them.
const SAMPLES: u64 = 30_000;
/// White noise of a sample, rad/s.
const RATE_SIGMA: f64 = 7.3e-7;
/// Horizontal Earth rate at 48°, rad/s.
const EARTH: f64 = 4.9e-5;
/// Interval of the samples that carry a specific force.
const SLOW: u64 = 20;
/// Tilt of the platform and white noise of a specific force, both in m/s².
const FORCE: [f64; 2] = [0.1, 1e-3];

/// Type of [`TurnAccumulator::push`].
type Push = fn(&mut TurnAccumulator, &Sample, Option<f32>) -> bool;

/// Measures the mean sample, and the most expensive one, which ends a turn.
pub fn report(counter: &Counter, report: &mut Report) {
    let mut noise = Generator::new(7);
    let mut turn_accumulator = TurnAccumulator::new(PERIODS, Mode::Even);
    // Through a pointer that is opaque to the optimiser the function is called, not inlined.
    let push = black_box(TurnAccumulator::push as Push);
    let mut turns = 0;
    let [mean, worst] = mean_and_greatest(SAMPLES, |index| {
        let sample = sample(index, &mut noise);
        let (cost, has_turned) = counter.measure(|| push(&mut turn_accumulator, &sample, None));
        turns += u32::from(has_turned);
        cost
    });
    report.require("the platform turned round twice", turns == 2);
    report.budget("demodulation on a turning platform, a sample", mean, TURNING_INSTRUCTIONS);
    figure("the same, a sample that ends a turn", worst);
}

/// Sample of a platform that turns clockwise.
fn sample(index: u64, noise: &mut Generator) -> Sample {
    let seconds = index as f64 / RATE_HZ;
    let angle = SPEED_HZ * TURN * seconds;
    let mut white = |sigma: f64| sigma * noise.gaussian();
    let rate = EARTH * libm::cos(angle) + white(RATE_SIGMA);
    let along = FORCE[0] * libm::cos(angle) + white(FORCE[1]);
    Sample {
        time: Instant(index * 500),
        stage: Angle::from_rad(angle),
        rate: AngularRate::from_rad_per_s(rate),
        force: (index.is_multiple_of(SLOW))
            .then(|| [along, 0.0, -9.81].map(SpecificForce::from_m_per_s2)),
        ..Sample::default()
    }
}

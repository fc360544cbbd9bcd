//! Cost of the work done once per sample.

use core::hint::black_box;

use hal_mock::noise::Generator;
use orientation::filter::{Coefficients, DesignError, Filter};
use orientation::signal::dwell::DwellAverage;
use orientation::signal::{InertialSample, Sample};
use orientation::units::{Angle, AngleIncrement, AngularRate, Instant, SpecificForce, Temperature};

use crate::report::{Report, figure, mean_and_greatest};
use firmware::budget::{FILTER_AND_DWELL_INSTRUCTIONS, FILTER_INSTRUCTIONS};
use measure::counter::Counter;

/// Sections of a filter of order 6.
const SECTIONS: usize = 3;
/// Number of samples through the filter alone.
const FILTERED: u64 = 1000;
/// Number of samples through filter and dwell: one second at [`RATE_HZ`].
const AVERAGED: u64 = 2000;
/// The highest sample rate of the stage path, Hz.
const RATE_HZ: f64 = 2000.0;
/// Cut-off for dwells of 10 s, Hz.
const CUTOFF_HZ: f64 = 2.0;
/// White noise of a sample, rad/s: 0.15 °/h (Sokolov 2019).
const RATE_SIGMA: f64 = 7.3e-7;
/// Interval of the samples that carry a specific force and a temperature.
const SLOW: u64 = 16;
/// Mean specific force, m/s².
const FORCE: [f64; 3] = [0.01, -0.02, -9.81];
/// White noise of a specific force, m/s².
const FORCE_SIGMA: f64 = 1e-3;

/// Type of [`Filter::update`].
type Update = fn(&mut Filter<SECTIONS>, &Coefficients<SECTIONS>, AngularRate) -> AngularRate;
/// Type of [`DwellAverage::push`].
type Push = fn(&mut DwellAverage<SECTIONS>, &Coefficients<SECTIONS>, &Sample);

/// Measures filter, filter with dwell, and the filter's design.
pub fn report(counter: &Counter, report: &mut Report) -> Result<(), DesignError> {
    let (cost, coefficients) = counter.measure(design);
    let coefficients = coefficients?;
    let [filtered, averaged] = [filter(counter, &coefficients), dwell(counter, &coefficients)];
    report.budget("Butterworth of order 6, a sample", filtered, FILTER_INSTRUCTIONS);
    report.budget("filter and dwell, a sample", averaged, FILTER_AND_DWELL_INSTRUCTIONS);
    figure("design of the filter for 2 Hz at 2 kHz", cost.instructions());
    Ok(())
}

/// Design that is measured, not inlined.
#[inline(never)]
fn design() -> Result<Coefficients<SECTIONS>, DesignError> {
    Coefficients::low_pass(black_box(CUTOFF_HZ), black_box(RATE_HZ))
}

/// Mean number of instructions of a sample through the filter, call included.
fn filter(counter: &Counter, coefficients: &Coefficients<SECTIONS>) -> u64 {
    let mut noise = Generator::new(1);
    let mut filter = Filter::at_rest(AngularRate(0));
    // Through a pointer that is opaque to the optimiser the function is called, not inlined.
    let update = black_box(Filter::update as Update);
    let [mean, _] = mean_and_greatest(FILTERED, |_| {
        let rate = AngularRate::from_rad_per_s(RATE_SIGMA * noise.gaussian());
        counter.measure(|| update(&mut filter, coefficients, rate)).0
    });
    mean
}

/// Mean number of instructions of a sample through filter and dwell, call included.
fn dwell(counter: &Counter, coefficients: &Coefficients<SECTIONS>) -> u64 {
    let mut noise = Generator::new(2);
    let mut average = DwellAverage::begin(coefficients, &sample(0, &mut noise));
    let push = black_box(DwellAverage::push as Push);
    let [mean, _] = mean_and_greatest(AVERAGED, |index| {
        let sample = sample(index + 1, &mut noise);
        counter.measure(|| push(&mut average, coefficients, &sample)).0
    });
    mean
}

/// Noisy sample of a standstill.
fn sample(index: u64, noise: &mut Generator) -> Sample {
    let is_slow = index.is_multiple_of(SLOW);
    Sample {
        time: Instant(index * 500),
        stage: Angle(1 << 20),
        rate: AngularRate::from_rad_per_s(RATE_SIGMA * noise.gaussian()),
        force: is_slow.then(|| {
            FORCE.map(|f| SpecificForce::from_m_per_s2(f + FORCE_SIGMA * noise.gaussian()))
        }),
        temperature: is_slow.then_some(Temperature(25_000 + (index & 0x70) as i32)),
        elevation: None,
    }
}

/// Sample number `index` of a body at `rate` samples per second, by its rates of rotation, rad/s, and its
/// specific force, m/s²; `carried` are the remainders of whole steps.
pub fn inertial(
    index: u64,
    rate: u64,
    rates: [f64; 3],
    force: [f64; 3],
    carried: &mut [f64; 3],
) -> InertialSample {
    InertialSample {
        time: Instant((index + 1) * 1_000_000 / rate),
        turned: core::array::from_fn(|axis| {
            AngleIncrement::from_rad(rates[axis] / rate as f64, &mut carried[axis])
        }),
        force: Some(force.map(SpecificForce::from_m_per_s2)),
    }
}

//! The Butterworth low-pass against scipy's vectors, the analogue closed form and `f64` sections
//! written here in another form than the crate's.
//!
//! `data/vectors/butterworth.json` comes from `scipy.signal.butter(output="sos")`.

use orientation::filter::{Coefficients, DesignError, Filter, Section};
use orientation::units::AngularRate;
use proptest::prelude::*;
use serde_json::Value;
use std::f64::consts::PI;

/// Cutoffs as parts of the sample rate, over the whole range of the design.
const RATIOS: [f64; 12] =
    [1e-5, 3e-5, 1e-4, 2.5e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.07, 0.124, 0.2, 0.25];

/// Calls `$check::<SECTIONS>` for orders 2, 4, 6 and 8.
macro_rules! for_all_orders {
    ($check:ident $arguments:tt) => {
        $check::<1> $arguments;
        $check::<2> $arguments;
        $check::<3> $arguments;
        $check::<4> $arguments;
    };
}

/// Calls the check of the given order.
macro_rules! for_order {
    ($order:expr, $check:ident $arguments:tt) => {
        match $order {
            2 => $check::<1> $arguments,
            4 => $check::<2> $arguments,
            6 => $check::<3> $arguments,
            8 => $check::<4> $arguments,
            order => panic!("no test for order {order}"),
        }
    };
}

fn low_pass<const S: usize>(ratio: f64) -> Coefficients<S> {
    Coefficients::low_pass(ratio, 1.0).expect("the ratio is in range")
}

/// (p, 1 − a₂) of the exact design, from the textbook's poles.
fn exact(sections: usize, ratio: f64) -> Vec<(f64, f64)> {
    let g = (PI * ratio).tan();
    let section = |index: usize| {
        let k = 2.0 * (PI * (2 * index + 1) as f64 / (4 * sections) as f64).cos();
        let n = 1.0 + g * k + g * g;
        (4.0 * g * g / n, 2.0 * g * k / n)
    };
    (0..sections).map(section).collect()
}

/// (p, 1 − a₂) as quantised.
fn quantised(sections: &[Section]) -> Vec<(f64, f64)> {
    sections.iter().map(|section| (section.p, 1.0 - section.a2)).collect()
}

/// The delta form d ← a₂d + p(X/4 − y), y ← y + d of each section in `f64`.
struct Reference {
    sections: Vec<(f64, f64)>,
    /// Per section: xₙ₋₁, xₙ₋₂, y, d.
    states: Vec<[f64; 4]>,
}

impl Reference {
    fn at_rest(sections: Vec<(f64, f64)>, x: f64) -> Self {
        let states = vec![[x, x, x, 0.0]; sections.len()];
        Self { sections, states }
    }

    fn update(&mut self, input: f64) -> f64 {
        self.sections.iter().zip(&mut self.states).fold(input, |x, (&(p, loss), state)| {
            let [x1, x2, y, d] = *state;
            let d = d - loss * d + p * (0.25 * (x + 2.0 * x1 + x2) - y);
            *state = [x, x1, y + d, d];
            y + d
        })
    }
}

/// Samples after which a filter is at rest to far below one step of its arithmetic's output.
fn long_enough<const S: usize>(coefficients: &Coefficients<S>) -> u32 {
    4 * coefficients.settling + 64
}

/// Pseudo-random numbers (`xorshift64*`), the same in every run.
struct Noise(u64);

impl Noise {
    /// Uniform in [−0.5, 0.5).
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }

    /// Near Gaussian, unit variance: the sum of twelve uniform numbers.
    fn gaussian(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum()
    }
}

// ---- The response -------------------------------------------------------------------------------

fn vectors() -> Vec<Value> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/vectors/butterworth.json");
    let text = std::fs::read_to_string(path).expect("the vectors are in the repository");
    let root: Value = serde_json::from_str(&text).expect("the vectors are JSON");
    root["filters"].as_array().expect("a list of filters").clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The designed coefficients of a vector's filter.
fn designed<const S: usize>(vector: &Value) -> Coefficients<S> {
    Coefficients::low_pass(number(&vector["fc_hz"]), number(&vector["fs_hz"])).expect("in range")
}

/// Gain in dB at `frequency`, a part of the sample rate.
fn gain_db(sections: &[Section], frequency: f64) -> f64 {
    let (sin, cos) = (2.0 * PI * frequency).sin_cos();
    let (sin2, cos2) = (4.0 * PI * frequency).sin_cos();
    let gain = |section: &Section| {
        let real = 1.0 + section.a1 * cos + section.a2 * cos2;
        let imaginary = section.a1 * sin + section.a2 * sin2;
        section.p * 0.5 * (1.0 + cos) / real.hypot(imaginary)
    };
    20.0 * sections.iter().map(gain).product::<f64>().log10()
}

/// The ideal gain in dB: the analogue Butterworth response at the warped frequency.
fn ideal_db(order: usize, ratio: f64, frequency: f64) -> f64 {
    let warped = (PI * frequency).tan() / (PI * ratio).tan();
    -10.0 * (1.0 + warped.powf(2.0 * f64::from(order as u32))).log10()
}

fn check_sections<const S: usize>(vector: &Value) {
    let by_a2 = |left: &(f64, f64), right: &(f64, f64)| left.1.total_cmp(&right.1);
    let sos = vector["sos"].as_array().expect("sections");
    let mut expected: Vec<_> = sos.iter().map(|row| (number(&row[4]), number(&row[5]))).collect();
    let mut ours: Vec<_> =
        designed::<S>(vector).quantised().iter().map(|section| (section.a1, section.a2)).collect();
    expected.sort_by(by_a2);
    ours.sort_by(by_a2);
    for (ours, expected) in ours.iter().zip(&expected) {
        assert!((ours.0 - expected.0).abs() < 1.4e-9, "a1 {ours:?}, scipy {expected:?}");
        assert!((ours.1 - expected.1).abs() < 4.7e-10, "a2 {ours:?}, scipy {expected:?}");
    }
}

#[test]
fn every_section_has_the_coefficients_of_scipy() {
    let vectors = vectors();
    assert_eq!(vectors.len(), 18);
    for vector in &vectors {
        for_order!(number(&vector["order"]) as u32, check_sections(vector));
    }
}

fn check_listed_gains<const S: usize>(vector: &Value) {
    let sections = designed::<S>(vector).quantised();
    for point in vector["response"].as_array().expect("points") {
        let expected = number(&point["gain_db"]);
        let ours = gain_db(&sections, number(&point["f_hz"]) / number(&vector["fs_hz"]));
        if expected > -60.0 {
            assert!((ours - expected).abs() < 0.01, "{ours} dB, scipy {expected} dB");
        }
    }
}

#[test]
fn the_quantised_response_is_that_of_scipy_within_a_hundredth_of_a_decibel() {
    for vector in &vectors() {
        for_order!(number(&vector["order"]) as u32, check_listed_gains(vector));
    }
}

fn check_ideal_gains<const S: usize>(ratio: f64) {
    let sections = low_pass::<S>(ratio).quantised();
    let mut worst = 0.0_f64;
    for step in 1..400 {
        let frequency = ratio * 0.05 * f64::from(step);
        let expected = ideal_db(2 * S, ratio, frequency);
        if frequency < 0.5 && expected > -60.0 {
            let error = gain_db(&sections, frequency) - expected;
            assert!(error.abs() < 1e-3, "order {}, fc/fs {ratio}: {error} dB", 2 * S);
            worst = worst.max(error.abs());
        }
    }
    println!("order {} fc/fs {ratio}: {worst:.1e} dB", 2 * S);
}

#[test]
fn quantisation_costs_less_than_a_thousandth_of_a_decibel_at_every_cutoff() {
    for step in 0..=600 {
        let ratio = 1e-5 * 25_000_f64.powf(f64::from(step) / 600.0);
        for_all_orders!(check_ideal_gains(ratio));
    }
}

fn check_step<const S: usize>(vector: &Value) {
    const STEP: i32 = 1_500_000_000;
    let coefficients = designed::<S>(vector);
    let mut filter = Filter::at_rest(AngularRate(0));
    let response: Vec<_> =
        (0..=8000).map(|_| filter.update(&coefficients, AngularRate(STEP)).0).collect();
    // "samples": 50 is s(50), the fifty-first output with the step at the input.
    for point in vector["step_after"].as_array().expect("points") {
        let ours = f64::from(response[number(&point["samples"]) as usize]) / f64::from(STEP);
        let expected = number(&point["value"]);
        assert!((ours - expected).abs() < 2e-7, "{point}: {ours}, order {}", 2 * S);
    }
}

#[test]
fn a_large_step_runs_through_the_values_of_scipy() {
    for vector in &vectors() {
        for_order!(number(&vector["order"]) as u32, check_step(vector));
    }
}

/// The gain in dB that the integer filter shows on a sine of `cycles` in `period` samples.
fn measured_db<const S: usize>(ratio: f64, cycles: u32, period: u32) -> f64 {
    const AMPLITUDE: f64 = 2e9;
    let coefficients = low_pass::<S>(ratio);
    let mut filter = Filter::at_rest(AngularRate(0));
    let periods_to_settle = coefficients.settling.div_ceil(period) + 1;
    let (mut cosine, mut sine) = (0.0, 0.0);
    for n in 0..(periods_to_settle + 1) * period {
        let (sin, cos) = (2.0 * PI * f64::from(n * cycles % period) / f64::from(period)).sin_cos();
        let x = AngularRate((AMPLITUDE * sin).round() as i32);
        let y = f64::from(filter.update(&coefficients, x).0);
        if n >= periods_to_settle * period {
            cosine += y * cos;
            sine += y * sin;
        }
    }
    20.0 * (2.0 * cosine.hypot(sine) / f64::from(period) / AMPLITUDE).log10()
}

#[test]
fn driven_sines_come_out_with_the_ideal_gain() {
    for (ratio, period) in [(2.5e-4, 16_000), (0.01, 1000), (0.05, 1000), (0.25, 1000)] {
        for part in [0.25, 0.5, 1.0, 1.5, 1.9] {
            let cycles = (part * ratio * f64::from(period)).round();
            let frequency = cycles / f64::from(period);
            let measured = [
                (2, measured_db::<1>(ratio, cycles as u32, period)),
                (6, measured_db::<3>(ratio, cycles as u32, period)),
                (8, measured_db::<4>(ratio, cycles as u32, period)),
            ];
            for (order, measured) in measured {
                let expected = ideal_db(order, ratio, frequency);
                let error = measured - expected;
                assert!(expected < -60.0 || error.abs() < 0.001, "{error} dB, order {order}");
            }
        }
    }
}

// ---- Rounding and range -------------------------------------------------------------------------

fn check_constants<const S: usize>(ratio: f64) {
    let coefficients = low_pass::<S>(ratio);
    for value in [i32::MIN, i32::MIN + 1, -987_654_321, -1, 0, 1, 2, 72_921, i32::MAX] {
        let value = AngularRate(value);
        let mut resting = Filter::at_rest(value);
        let mut rising = Filter::at_rest(AngularRate(0));
        for _ in 0..long_enough(&coefficients) {
            assert_eq!(resting.update(&coefficients, value), value);
            let _transient = rising.update(&coefficients, value);
        }
        for _ in 0..100 {
            assert_eq!(
                rising.update(&coefficients, value),
                value,
                "fc/fs {ratio}, order {}",
                2 * S
            );
        }
    }
}

#[test]
fn every_constant_comes_out_exact() {
    for ratio in RATIOS.into_iter().filter(|ratio| *ratio >= 1e-4) {
        for_all_orders!(check_constants(ratio));
    }
}

fn check_slow_constant<const S: usize>(value: i32) {
    let coefficients = low_pass::<S>(1e-5);
    let mut filter = Filter::at_rest(AngularRate(0));
    for _ in 0..long_enough(&coefficients) {
        let _transient = filter.update(&coefficients, AngularRate(value));
    }
    assert_eq!(filter.update(&coefficients, AngularRate(value)).0, value);
}

#[test]
fn constants_come_out_exact_even_at_the_lowest_cutoff() {
    for value in [i32::MIN, 1, i32::MAX] {
        for_all_orders!(check_slow_constant(value));
    }
}

/// RMS difference in LSB between the integer filter and `sections` in `f64`, on noise.
fn rounding_rms<const S: usize>(
    coefficients: &Coefficients<S>,
    sections: Vec<(f64, f64)>,
    sigma: f64,
) -> f64 {
    let samples = 60_000.max(5 * coefficients.settling);
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15);
    let mut filter = Filter::at_rest(AngularRate(0));
    let mut reference = Reference::at_rest(sections, 0.0);
    let sum: f64 = (0..samples)
        .map(|_| {
            let x = (sigma * noise.gaussian()).round() as i32;
            let y = filter.update(coefficients, AngularRate(x)).0;
            (f64::from(y) - reference.update(f64::from(x))).powi(2)
        })
        .sum();
    (sum / f64::from(samples)).sqrt()
}

fn check_rounding<const S: usize>(ratio: f64) {
    let coefficients = low_pass::<S>(ratio);
    // Slow filters pass little of white noise; it must still move the output by many LSB.
    let sigma = 2e3 / ratio.sqrt();
    let same = rounding_rms(&coefficients, quantised(&coefficients.quantised()), sigma);
    assert!(same < 0.30, "fc/fs {ratio}, order {}: {same} LSB", 2 * S);
    let ideal = rounding_rms(&coefficients, exact(S, ratio), sigma);
    assert!(ideal < 0.35, "fc/fs {ratio}, order {}: {ideal} LSB from the design", 2 * S);
    println!("order {} fc/fs {ratio}: {same:.4} LSB, from the exact design {ideal:.4}", 2 * S);
}

#[test]
fn rounding_adds_hardly_more_than_that_of_the_output() {
    for ratio in RATIOS {
        for_all_orders!(check_rounding(ratio));
    }
}

fn check_squares<const S: usize>(ratio: f64) {
    let coefficients = low_pass::<S>(ratio);
    let half_period = (0.6 / ratio) as u32 + 1;
    let mut filter = Filter::at_rest(AngularRate(i32::MIN));
    let (mut lowest, mut highest) = (0, 0);
    for n in 0..40 * half_period {
        let x = if (n / half_period).is_multiple_of(2) { i32::MAX } else { i32::MIN };
        let y = filter.update(&coefficients, AngularRate(x)).0;
        lowest = lowest.min(y);
        highest = highest.max(y);
    }
    assert_eq!((lowest, highest), (i32::MIN, i32::MAX), "fc/fs {ratio}, order {}", 2 * S);
    for _ in 0..long_enough(&coefficients) {
        let _transient = filter.update(&coefficients, AngularRate(-12_345));
    }
    assert_eq!(filter.update(&coefficients, AngularRate(-12_345)), AngularRate(-12_345));
}

#[test]
fn full_scale_squares_saturate_and_leave_no_trace() {
    for ratio in [1e-3, 0.01, 0.05, 0.1, 0.2, 0.25] {
        for_all_orders!(check_squares(ratio));
    }
}

/// Impulse responses (output, step 4W of the last section) of the exact design.
///
/// y is the mean of two successive levels, so the level answers xₙ + xₙ₋₁ with the gain p/2, and
/// the section adds f · 4W to it, f = √(p/8).
fn worst_responses(sections: usize, ratio: f64) -> [Vec<f64>; 2] {
    let design = exact(sections, ratio);
    let (earlier, last) = design.split_at(sections - 1);
    let mut chain = Reference::at_rest(earlier.to_vec(), 0.0);
    let mut whole = Reference::at_rest(design.clone(), 0.0);
    let ((p, loss), mut level, mut slope, mut previous) = (last[0], 0.0, 0.0, 0.0);
    (0..(8.0 / ratio) as usize + 50)
        .map(|n| {
            let impulse = f64::from(u8::from(n == 0));
            let x = chain.update(impulse);
            slope += p * (0.5 * (x + previous) - level) - loss * slope;
            level += slope;
            previous = x;
            (whole.update(impulse), slope / (p / 8.0).sqrt())
        })
        .unzip::<_, _, Vec<_>, Vec<_>>()
        .into()
}

fn check_worst_input<const S: usize>(ratio: f64) {
    let coefficients = low_pass::<S>(ratio);
    let responses = worst_responses(S, ratio);
    let norm = responses[1].iter().map(|value| value.abs()).sum::<f64>();
    assert!(norm < 5.8, "order {}, fc/fs {ratio}: {norm}", 2 * S);
    for (response, start) in responses.iter().flat_map(|r| [(r, i32::MIN), (r, i32::MAX)]) {
        let mut filter = Filter::at_rest(AngularRate(start));
        let mut last = 0;
        for value in response.iter().rev() {
            let x = if (*value > 0.0) == (start < 0) { i32::MAX } else { i32::MIN };
            last = filter.update(&coefficients, AngularRate(x)).0;
        }
        let limit = if start < 0 { i32::MAX } else { i32::MIN };
        assert!(*response != responses[0] || last == limit, "the worst input must clip");
        for _ in 0..long_enough(&coefficients) {
            let _transient = filter.update(&coefficients, AngularRate(start));
        }
        assert_eq!(filter.update(&coefficients, AngularRate(start)).0, start);
    }
}

/// Tests are built with overflow checks, so an overflow would end this one.
#[test]
fn the_worst_input_of_full_scale_does_not_overflow() {
    for ratio in [1e-3, 0.01, 0.05, 0.1, 0.15, 0.18, 0.2, 0.22, 0.24, 0.25] {
        for_all_orders!(check_worst_input(ratio));
    }
}

fn check_silence<const S: usize>(ratio: f64, inputs: &[i32], rest: i32) {
    let coefficients = low_pass::<S>(ratio);
    let mut filter = Filter::at_rest(AngularRate(inputs[0]));
    for &x in inputs {
        let _transient = filter.update(&coefficients, AngularRate(x));
    }
    for _ in 0..long_enough(&coefficients) {
        let _transient = filter.update(&coefficients, AngularRate(rest));
    }
    for _ in 0..200 {
        assert_eq!(filter.update(&coefficients, AngularRate(rest)).0, rest);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..Default::default() })]

    #[test]
    fn after_any_excitation_a_constant_is_exact_and_nothing_cycles(
        exponent in -3.0..=0.0_f64,
        inputs in prop::collection::vec(any::<i32>(), 1..300),
        rest in prop_oneof![Just(0), any::<i32>(), -3..=3],
    ) {
        let ratio = 0.25 * 10_f64.powf(exponent);
        for_all_orders!(check_silence(ratio, &inputs, rest));
    }
}

// ---- The step response --------------------------------------------------------------------------

fn check_facts<const S: usize>(ratio: f64) {
    let coefficients = low_pass::<S>(ratio);
    let mut reference = Reference::at_rest(quantised(&coefficients.quantised()), 0.0);
    let rests: Vec<f64> =
        (0..long_enough(&coefficients)).map(|_| 1.0 - reference.update(1.0)).collect();
    let close = |ours: f64, sum: f64, tolerance: f64| (ours - sum).abs() < tolerance * sum;
    let lag: f64 = rests.iter().sum();
    let power: f64 = rests.iter().map(|rest| rest * rest).sum();
    assert!(close(coefficients.lag, lag, 1e-7), "{} {lag}", coefficients.lag);
    assert!(close(coefficients.lag_power, power, 1e-9), "{} {power}", coefficients.lag_power);
    for count in [1, 7, coefficients.settling / 2, coefficients.settling + 5] {
        let responses = rests.iter().take(count as usize).map(|rest| 1.0 - rest);
        let sums = [responses.clone().sum(), responses.map(|s| s * s).sum::<f64>()];
        for (ours, sum) in coefficients.step_sums(count).into_iter().zip(sums) {
            assert!((ours - sum).abs() < 1e-7 * (1.0 + lag + sum), "{count}: {ours} {sum}");
        }
    }
    let last = rests.iter().rposition(|rest| rest.abs() >= 1e-6).expect("the step starts at zero");
    assert_eq!(coefficients.settling as usize, last + 1);
    let ideal: f64 = exact(S, ratio).iter().map(|(p, loss)| loss / p).sum();
    assert!(close(coefficients.lag, ideal, 2e-5), "{} {ideal}", coefficients.lag);
    let periods = f64::from(coefficients.settling) * ratio;
    let slow = [3.143, 5.457, 8.049, 10.706][S - 1];
    assert!(periods < 1.6 * slow, "{periods} periods of the cutoff");
    assert!(ratio > 1e-3 || (periods - slow).abs() < 1e-3, "{periods} periods of the cutoff");
}

#[test]
fn lag_power_and_settling_are_those_of_a_summed_step_response() {
    for ratio in RATIOS {
        for_all_orders!(check_facts(ratio));
    }
}

// ---- What cannot be designed --------------------------------------------------------------------

#[test]
fn impossible_cutoffs_are_refused_with_a_remedy() {
    let refused = |cutoff, rate| Coefficients::<3>::low_pass(cutoff, rate).unwrap_err();
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(refused(bad, 100.0), DesignError::NotPositive);
        assert_eq!(refused(1.0, bad), DesignError::NotPositive);
    }
    assert_eq!(refused(25.001, 100.0), DesignError::CutoffTooHigh);
    assert_eq!(refused(0.000_99, 100.0), DesignError::CutoffTooLow);
    assert!(DesignError::NotPositive.to_string().contains("give both in Hz"));
    assert!(DesignError::CutoffTooHigh.to_string().contains("sample faster"));
    assert!(DesignError::CutoffTooLow.to_string().contains("average samples first"));
    assert!(Coefficients::<3>::low_pass(25.0, 100.0).is_ok());
}

//! Amplitude spectra against scipy's periodogram and closed forms.

use std::f64::consts::TAU;

use host::spectrum::{Line, Window, amplitudes, hann};
use serde::Deserialize;

/// The window of samples that weigh alike: exact over whole periods.
fn rectangular(_: usize, _: usize) -> f64 {
    1.0
}

/// One signal with what `scipy.signal.periodogram` makes of it, as amplitudes.
#[derive(Deserialize)]
struct Vector {
    rate_hz: f64,
    signal: Vec<f64>,
    frequency_hz: Vec<f64>,
    rectangular: Vec<f64>,
    hann: Vec<f64>,
}

fn agree(lines: &[Line], frequencies: &[f64], expected: &[f64]) {
    assert_eq!((lines.len(), lines.len()), (frequencies.len(), expected.len()));
    for ((line, frequency), amplitude) in lines.iter().zip(frequencies).zip(expected) {
        assert!((line.frequency_hz - frequency).abs() < 1e-9, "{line:?} {frequency}");
        assert!((line.amplitude - amplitude).abs() < 1e-9, "{line:?} {amplitude}");
    }
}

#[test]
fn spectra_agree_with_scipy_for_even_odd_and_prime_lengths() {
    let text = include_str!("../../data/vectors/spectrum.json");
    let vectors: Vec<Vector> = serde_json::from_str(text).expect("the vectors parse");
    assert_eq!(vectors.iter().map(|v| v.signal.len()).collect::<Vec<_>>(), [30, 31, 127]);
    for vector in vectors {
        let Vector { rate_hz, signal, frequency_hz, .. } = vector;
        agree(&amplitudes(&signal, rate_hz, rectangular), &frequency_hz, &vector.rectangular);
        agree(&amplitudes(&signal, rate_hz, hann), &frequency_hz, &vector.hann);
    }
}

/// Samples of a sinusoid on a great constant.
fn sinusoid(amplitude: f64, frequency: f64, samples: usize, rate: f64) -> Vec<f64> {
    let at = |index| 700.0 + amplitude * (TAU * frequency * index as f64 / rate + 0.7).cos();
    (0..samples).map(at).collect()
}

#[test]
fn a_sinusoid_on_a_line_shows_its_amplitude_through_either_window() {
    let signal = sinusoid(0.25, 3.0, 500, 50.0);
    let windows: [(&str, Window); 2] = [("rectangular", rectangular), ("Hann's", hann)];
    for (name, window) in windows {
        let lines = amplitudes(&signal, 50.0, window);
        let [line, beyond] = [lines[29], lines[31]];
        assert!((line.frequency_hz - 3.0).abs() < 1e-12, "{line:?}");
        assert!((line.amplitude - 0.25).abs() < 1e-12, "{name}: {line:?}");
        assert!(beyond.amplitude < 1e-12, "{name}: {beyond:?}");
    }
}

#[test]
fn hanns_window_puts_half_of_a_line_on_its_neighbours() {
    let lines = amplitudes(&sinusoid(2.0, 3.0, 500, 50.0), 50.0, hann);
    assert!((lines[28].amplitude - 1.0).abs() < 1e-12 && (lines[30].amplitude - 1.0).abs() < 1e-12);
}

#[test]
fn the_squares_of_the_lines_sum_to_the_variance() {
    let text = include_str!("../../data/vectors/spectrum.json");
    let vectors: Vec<Vector> = serde_json::from_str(text).expect("the vectors parse");
    for Vector { signal, rate_hz, .. } in &vectors[1..] {
        let count = signal.len() as f64;
        let mean = signal.iter().sum::<f64>() / count;
        let variance = signal.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
        let lines = amplitudes(signal, *rate_hz, rectangular);
        // Parseval, for an odd number of samples.
        let sum: f64 = lines.iter().map(|line| 0.5 * line.amplitude * line.amplitude).sum();
        assert!((sum / variance - 1.0).abs() < 1e-12, "{sum} {variance}");
    }
}

#[test]
fn nothing_and_one_sample_have_no_spectrum() {
    assert_eq!(amplitudes(&[], 50.0, hann), []);
    assert_eq!(amplitudes(&[1.0], 50.0, hann), []);
}

//! Amplitude spectra, as the figures of MET 2018 have them: how much of each frequency is in a signal.
//!
//! One-sided and amplitude-correct: a sinusoid of amplitude a on a line of the spectrum shows as a,
//! whatever the window. The mean is taken off first, since a gyro's response to the turn is a
//! thousand times the Earth rate.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// A line of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Frequency of the line, Hz.
    pub frequency_hz: f64,
    /// Amplitude of the sinusoid there, in the signal's unit.
    pub amplitude: f64,
}

/// The weight with which a sample, by its number and that of all, is transformed.
pub type Window = fn(usize, usize) -> f64;

/// Hann's window, periodic: side lobes fall fast, at lines twice as wide as where all samples weigh alike.
#[must_use]
pub fn hann(index: usize, samples: usize) -> f64 {
    0.5 - 0.5 * (TAU * index as f64 / samples as f64).cos()
}

/// The spectrum of evenly spaced samples, from the lowest frequency above zero to half the rate; empty
/// for fewer than two samples.
#[must_use]
pub fn amplitudes(signal: &[f64], rate_hz: f64, window: Window) -> Vec<Line> {
    let samples = signal.len();
    let weights: Vec<f64> = (0..samples).map(|index| window(index, samples)).collect();
    let buffer = transformed(signal, &weights);
    let whole: f64 = weights.iter().sum();
    let line = |index: usize| Line {
        frequency_hz: index as f64 * rate_hz / samples as f64,
        amplitude: sides(index, samples) * buffer[index].norm() / whole,
    };
    (1..=samples / 2).map(line).collect()
}

/// A frequency stands on both sides of the two-sided spectrum, but for half the sample rate.
fn sides(index: usize, samples: usize) -> f64 {
    if 2 * index == samples { 1.0 } else { 2.0 }
}

/// The Fourier transform of a signal without its mean, each sample with its weight.
pub(crate) fn transformed(signal: &[f64], weights: &[f64]) -> Vec<Complex<f64>> {
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    let weighted = signal.iter().zip(weights).map(|(x, weight)| (x - mean) * weight);
    let mut buffer: Vec<Complex<f64>> = weighted.map(Complex::from).collect();
    FftPlanner::new().plan_fft_forward(signal.len()).process(&mut buffer);
    buffer
}

//! The stage filter and the dwell average once more in `f64`, to measure what fixed point costs.
//!
//! Written from the transfer function (direct form II transposed), not from the delta form that the
//! core runs, and with the unrounded design.

use std::f64::consts::PI;

/// One second-order section, gain folded in: b = g(1, 2, 1), a = (1, a₁, a₂).
#[derive(Clone, Copy, Debug)]
struct Section {
    gain: f64,
    a1: f64,
    a2: f64,
}

/// A Butterworth low-pass of order 2·sections, bilinear with prewarping.
#[derive(Clone, Debug)]
pub struct Filter {
    sections: Vec<Section>,
}

impl Filter {
    /// Designs it for a cut-off and a sample rate in Hz.
    pub fn low_pass(order: u32, cutoff_hz: f64, rate_hz: f64) -> Self {
        let k = (PI * cutoff_hz / rate_hz).tan();
        let section = |index: u32| {
            let damping = 2.0 * (PI * f64::from(2 * index + 1) / f64::from(2 * order)).sin();
            let norm = 1.0 / (1.0 + damping * k + k * k);
            Section {
                gain: k * k * norm,
                a1: 2.0 * (k * k - 1.0) * norm,
                a2: (1.0 - damping * k + k * k) * norm,
            }
        };
        Self { sections: (0..order / 2).map(section).collect() }
    }

    /// Filters from rest at `origin`.
    pub fn run(&self, origin: f64, samples: &[f64]) -> Vec<f64> {
        let mut signal: Vec<f64> = samples.iter().map(|x| x - origin).collect();
        for section in &self.sections {
            let (mut s1, mut s2) = (0.0, 0.0);
            for x in &mut signal {
                let input = section.gain * *x;
                let output = input + s1;
                s1 = 2.0 * input - section.a1 * output + s2;
                s2 = input - section.a2 * output;
                *x = output;
            }
        }
        signal.iter().map(|y| y + origin).collect()
    }

    /// The mean of a dwell as the core takes it: filtered from its first sample, freed of the lag.
    pub fn dwell_mean(&self, samples: &[f64]) -> f64 {
        let origin = samples.first().copied().unwrap_or(0.0);
        let filtered = self.run(origin, samples);
        let answered: f64 = self.run(0.0, &vec![1.0; samples.len()]).iter().sum();
        origin + filtered.iter().map(|y| y - origin).sum::<f64>() / answered
    }
}

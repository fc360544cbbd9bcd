//! A sample that stands alone far from its neighbours: found while a record is read, in fixed memory.
//!
//! Each sample is compared with the mean of the one before it and the one after it. Of white noise of σ the difference has a
//! variance of 1.5 σ²; a sample that is off by d alone brings 1.5 d² into the sum of the squares, over three differences, and
//! is taken out of it before σ is told.

/// How many σ a sample must be off to be told: of 10⁹ samples of normal noise none is.
const FAR: f64 = 12.0;
/// How many steps of the numbers it must be off, too: what is rounded coarsely is mostly equal and seldom one step off.
const STEPS: f64 = 4.0;
/// Variance of a difference over that of a sample.
const DIFFERENCE: f64 = 1.5;
/// Differences from which σ is told.
const FEWEST: f64 = 32.0;

/// The sample that is farthest from its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spike {
    /// Its line in the file.
    pub line: u64,
    /// How far it is off the mean of its neighbours, rad/s.
    pub off: f64,
    /// The same in 1σ of the other samples' noise.
    pub sigmas: f64,
}

/// What is kept of the samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spikes {
    /// The two samples before, rad/s, with the line of the later one.
    before: [Option<f64>; 2],
    line: u64,
    squares: f64,
    count: f64,
    /// Line and difference of the greatest.
    greatest: (u64, f64),
}

impl Spikes {
    /// Takes a sample, rad/s.
    pub fn take(&mut self, line: u64, rate: f64) {
        if let [Some(first), Some(middle)] = self.before {
            let off = middle - 0.5 * (first + rate);
            self.squares += off * off;
            self.count += 1.0;
            if off.abs() > self.greatest.1.abs() {
                self.greatest = (self.line, off);
            }
        }
        self.before = [self.before[1], Some(rate)];
        self.line = line;
    }

    /// Samples are missing before the next one.
    pub fn part(&mut self) {
        self.before = [None; 2];
    }

    /// The sample that is farthest off, where that is far beyond noise and rounding in this step, rad/s.
    pub fn found(&self, step: f64) -> Option<Spike> {
        let (line, off) = self.greatest;
        let others = (self.squares - DIFFERENCE * off * off).max(0.0);
        let sigma = (others / (DIFFERENCE * self.count)).sqrt();
        let is_far = off.abs() > (FAR * sigma).max(STEPS * step) && sigma > 0.0;
        (is_far && self.count >= FEWEST).then(|| Spike { line, off, sigmas: off.abs() / sigma })
    }
}

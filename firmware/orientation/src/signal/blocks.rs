//! Block means of one dwell, from which its stationarity is judged.
//!
//! Sixteen sums hold a dwell of any length: when all are full, neighbours merge and the block
//! length doubles, so a dwell ends with eight to sixteen equal blocks. Blocks are formed before the
//! low-pass filter, so that white noise leaves them independent.

use core::num::NonZero;

/// Greatest number of blocks that are kept.
pub(crate) const BLOCKS: usize = 16;

/// Running block sums of the deviations of a rate from the dwell's first sample, nrad/s.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Sums of the full blocks, nrad/s times samples; entries from `full` on are stale.
    sums: [i64; BLOCKS],
    /// Number of full blocks, at most [`BLOCKS`].
    full: usize,
    /// Sum of the block in progress, nrad/s times samples.
    current: i64,
    /// Samples that the block in progress still lacks.
    lacking: u32,
    /// Samples in a block: a power of two.
    length: u32,
}

impl Default for Blocks {
    fn default() -> Self {
        Self { sums: [0; BLOCKS], full: 0, current: 0, lacking: 1, length: 1 }
    }
}

impl Blocks {
    /// Adds one deviation, in nrad/s.
    #[inline]
    pub fn push(&mut self, deviation: i32) {
        self.current += i64::from(deviation);
        self.lacking -= 1;
        if self.lacking == 0 {
            self.close();
        }
    }

    /// Stores the full block. It runs once in a sixteenth to an eighth of the dwell, so it stays
    /// out of the per-sample path.
    #[cold]
    #[inline(never)]
    fn close(&mut self) {
        if self.full == BLOCKS {
            self.merge();
            // The block just filled is now the first half of a block of the doubled length.
            self.lacking = self.length / 2;
            return;
        }
        self.sums[self.full] = self.current;
        self.full += 1;
        self.current = 0;
        self.lacking = self.length;
    }

    /// Merges neighbouring blocks and doubles the block length.
    fn merge(&mut self) {
        for index in 0..BLOCKS / 2 {
            self.sums[index] = self.sums[2 * index] + self.sums[2 * index + 1];
        }
        self.full = BLOCKS / 2;
        self.length *= 2;
    }

    /// Number of deviations added so far.
    pub(crate) fn count(&self) -> u32 {
        (self.full as u32 + 1) * self.length - self.lacking
    }

    /// Statistics of the full blocks, for a sample period in seconds; `None` with fewer than four
    /// blocks. The samples of the incomplete block count as part of the last one.
    #[must_use]
    pub fn statistics(&self, sample_seconds: f64) -> Option<BlockStatistics> {
        let blocks = NonZero::new(self.full as u32).filter(|blocks| blocks.get() >= 4)?;
        let scale = 1e-9 / f64::from(self.length);
        let mut means = self.sums.map(|sum| sum as f64 * scale);
        // Samples after the last full block are merged into it, so that no part of the dwell is
        // left out.
        let tail = self.length - self.lacking;
        let all = self.sums[self.full - 1] + self.current;
        means[self.full - 1] = all as f64 * 1e-9 / f64::from(self.length + tail);
        let seconds = f64::from(self.length) * sample_seconds;
        Some(BlockStatistics::of(&means[..self.full], blocks, seconds))
    }
}

/// Stationarity statistics of a dwell, independent of how noisy the gyro is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockStatistics {
    /// Number of blocks, 4 to 16; never zero, so that `None` takes no room of its own.
    pub blocks: NonZero<u32>,
    /// Length of a block, s.
    pub block_seconds: f64,
    /// Slope of the least-squares line through the block means, rad/s².
    pub slope: f64,
    /// Residual sum of squares about that line, (rad/s)², with `blocks` − 2 degrees of freedom.
    pub scatter: f64,
    /// Largest normalised step, rad/s: over all intervals of blocks, the sum of the residuals in
    /// the interval over its standard deviation for unit block noise (variance one).
    pub largest_step: f64,
    /// Sum of squared differences of neighbouring block means, (rad/s)². Each has twice the
    /// variance of a block and responds little to a slow disturbance.
    pub neighbour_squares: f64,
}

impl BlockStatistics {
    /// Number of blocks as a floating-point number.
    pub(crate) fn count(&self) -> f64 {
        f64::from(self.blocks.get())
    }

    /// The slope's standard deviation for a block standard deviation of one, 1/s.
    pub(crate) fn slope_unit(&self) -> f64 {
        1.0 / (libm::sqrt(spread(self.count())) * self.block_seconds)
    }

    /// Statistics of these block means, rad/s, each over `block_seconds`.
    fn of(means: &[f64], blocks: NonZero<u32>, block_seconds: f64) -> Self {
        let count = means.len() as f64;
        let centre = 0.5 * (count - 1.0);
        let mean = means.iter().sum::<f64>() / count;
        let moment: f64 = means.iter().enumerate().map(|(i, m)| (i as f64 - centre) * m).sum();
        let slope = moment / spread(count);
        let mut rest = [0.0; BLOCKS];
        for (index, value) in means.iter().enumerate() {
            rest[index] = value - mean - slope * (index as f64 - centre);
        }
        Self {
            blocks,
            block_seconds,
            slope: slope / block_seconds,
            scatter: rest.iter().map(|r| r * r).sum(),
            largest_step: largest_step(&rest[..means.len()]),
            neighbour_squares: means.windows(2).map(|w| (w[1] - w[0]) * (w[1] - w[0])).sum(),
        }
    }
}

/// Sum of the squared distances of `count` equidistant points of spacing one from their middle:
/// n(n² − 1)/12.
fn spread(count: f64) -> f64 {
    count * (count * count - 1.0) / 12.0
}

/// Greatest normalised sum of the residuals over any interval of blocks: a scan for disturbances of
/// any length. A step of the mean in `inside` of `count` blocks has the variance inside (1 −
/// inside/count).
fn largest_step(rest: &[f64]) -> f64 {
    let count = rest.len() as f64;
    let mut largest: f64 = 0.0;
    for from in 0..rest.len() {
        let mut sum = 0.0;
        for (length, value) in rest[from..].iter().enumerate().take(rest.len() - 1) {
            sum += value;
            let inside = length as f64 + 1.0;
            let deviation = libm::sqrt(inside * (1.0 - inside / count).max(1e-9));
            largest = largest.max((sum / deviation).abs());
        }
    }
    largest
}

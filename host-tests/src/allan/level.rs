//! One octave of the estimator: means over 2ᵏ samples, and the squared differences of windows over them.

/// Means that come before they are summed.
const BLOCK: usize = 8192;
/// Sums that are kept side by side, so that a processor can add several at once.
const LANES: usize = 8;

/// Means over 2ᵏ samples each, and what their windows came to.
#[derive(Clone, Debug)]
pub(super) struct Level {
    windows: Vec<Windows>,
    /// The latest means: those that a window may still need, and those that came since.
    means: Vec<f64>,
    /// How many of them were summed already.
    summed: usize,
    /// How many a window may still need.
    history: usize,
    /// The last mean, where it has no partner yet.
    odd: Option<f64>,
    /// The running sum of the means less the first one, from zero: one more than they are.
    phases: Vec<f64>,
}

/// Pairs of adjacent windows of one length.
#[derive(Clone, Copy, Debug)]
struct Windows {
    /// Means in a window.
    span: usize,
    /// Sum of the squared differences of the windows' sums.
    squares: f64,
    /// How many they are.
    terms: u64,
}

impl Level {
    /// Level with windows over so many means.
    pub fn new(spans: &[u64]) -> Self {
        let window = |span: &u64| Windows {
            span: usize::try_from(*span).unwrap_or(usize::MAX / 2),
            squares: 0.0,
            terms: 0,
        };
        let windows: Vec<Windows> = spans.iter().map(window).collect();
        let history = windows.iter().map(|windows| 2 * windows.span).max().unwrap_or(0);
        Self { windows, means: Vec::new(), summed: 0, history, odd: None, phases: Vec::new() }
    }

    /// Takes a mean; whether enough came since the last were summed.
    pub fn push(&mut self, mean: f64) -> bool {
        self.means.push(mean);
        self.is_full()
    }

    /// Takes means; whether enough came since the last were summed.
    pub fn extend(&mut self, means: &[f64]) -> bool {
        self.means.extend_from_slice(means);
        self.is_full()
    }

    fn is_full(&self) -> bool {
        self.means.len() - self.summed >= BLOCK
    }

    /// Sums the windows that end with what came; the means of its pairs, for the level above.
    pub fn settle(&mut self) -> Vec<f64> {
        self.sum_up();
        for windows in &mut self.windows {
            windows.add(&self.phases, self.summed);
        }
        let above = self.pairs();
        let passed = self.means.len().saturating_sub(self.history);
        self.means.drain(..passed);
        self.summed = self.means.len();
        above
    }

    /// The running sums.
    fn sum_up(&mut self) {
        let first = self.means.first().copied().unwrap_or_default();
        let mut sum = 0.0;
        self.phases.clear();
        self.phases.push(sum);
        self.phases.extend(self.means.iter().map(|mean| {
            sum += mean - first;
            sum
        }));
    }

    /// The means of two each of what came.
    fn pairs(&mut self) -> Vec<f64> {
        let came = self.odd.take().into_iter().chain(self.means[self.summed..].iter().copied());
        let mut above = Vec::with_capacity(came.size_hint().0 / 2);
        for mean in came {
            match self.odd.take() {
                Some(first) => above.push(0.5 * (first + mean)),
                None => self.odd = Some(mean),
            }
        }
        above
    }

    /// Forgets the means: no window goes across what is missing here.
    pub fn part(&mut self) {
        self.means.clear();
        self.summed = 0;
        self.odd = None;
    }

    /// Numbers that are held.
    pub fn held(&self) -> usize {
        self.means.capacity() + self.phases.capacity()
    }

    /// The means in a window, the Allan variance, and from how many terms it is, where there is one.
    pub fn variances(&self) -> impl Iterator<Item = (usize, f64, u64)> {
        let there = self.windows.iter().filter(|windows| windows.terms > 0);
        there.map(|&Windows { span, squares, terms }| {
            let averaged = 2.0 * (span as f64) * (span as f64);
            (span, squares / terms as f64 / averaged, terms)
        })
    }
}

impl Windows {
    /// Adds the squared second differences of phases that end after so many means.
    fn add(&mut self, phases: &[f64], summed: usize) {
        // A pair that ends with the first mean after those began so far back.
        let first = (summed + 1).saturating_sub(2 * self.span);
        let Some(phases) = phases.get(first..).filter(|phases| phases.len() > 2 * self.span) else {
            return;
        };
        let (begins, middles, ends) = (phases, &phases[self.span..], &phases[2 * self.span..]);
        self.squares += squares(begins, middles, ends);
        self.terms += ends.len() as u64;
    }
}

/// The sum of the squares of ends − 2 middles + begins, as far as there are ends.
fn squares(begins: &[f64], middles: &[f64], ends: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let chunks = begins.chunks(LANES).zip(middles.chunks(LANES)).zip(ends.chunks(LANES));
    for ((begins, middles), ends) in chunks {
        for (((sum, begin), middle), end) in sums.iter_mut().zip(begins).zip(middles).zip(ends) {
            let difference = (end - middle) - (middle - begin);
            *sum += difference * difference;
        }
    }
    sums.iter().sum()
}

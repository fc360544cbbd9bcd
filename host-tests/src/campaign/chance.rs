//! How instruments, severities and faults are drawn.

use hal_mock::noise::Generator;

/// Draws from one random stream.
pub struct Chance(Generator);

impl Chance {
    /// The stream of a seed.
    pub fn new(seed: u64, stream: u64) -> Self {
        Self(Generator::stream(seed, stream))
    }

    /// Evenly between two values.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// Evenly in the logarithm.
    pub fn scaled(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.0.uniform())
    }

    /// One of several, each as likely.
    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[((self.0.uniform() * of.len() as f64) as usize).min(of.len() - 1)]
    }

    /// Whether something of this probability happens.
    pub fn happens(&mut self, part: f64) -> bool {
        self.0.uniform() < part
    }

    /// Plus or minus one.
    pub fn sign(&mut self) -> f64 {
        if self.happens(0.5) { 1.0 } else { -1.0 }
    }

    /// A factor or its inverse.
    pub fn factor_or_inverse(&mut self, factor: f64) -> f64 {
        if self.happens(0.5) { factor } else { 1.0 / factor }
    }

    /// A normal variable of variance one.
    pub fn normal(&mut self) -> f64 {
        self.0.gaussian()
    }
}

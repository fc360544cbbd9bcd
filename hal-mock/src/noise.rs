//! Random numbers: one generator, uniform and Gaussian, with independent streams.
//!
//! xoshiro256++ 1.0 (D. Blackman, S. Vigna, 2019, public domain, prng.di.unimi.it), seeded by
//! splitmix64 (S. Vigna, 2015, public domain) as its authors recommend. The Gaussian is a ziggurat of
//! 256 layers (Marsaglia and Tsang 2000) whose layer and abscissa come from disjoint bits of the word.

include!(concat!(env!("OUT_DIR"), "/ziggurat.rs"));

/// Step of splitmix64: 2⁶⁴ over the golden ratio, odd.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// One random stream: xoshiro256++, period 2²⁵⁶ − 1.
#[must_use]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Generator {
    /// The four words of xoshiro256++.
    state: [u64; 4],
}

impl Generator {
    /// The stream of a seed; any seed is good.
    pub fn new(seed: u64) -> Self {
        Self::stream(seed, 0)
    }

    /// Stream `index` of a seed. Streams of one seed always differ, and start at hashed, unrelated
    /// places of a period of 2²⁵⁶; streams of two seeds coincide with a probability of 2⁻⁶⁴.
    pub fn stream(seed: u64, index: u64) -> Self {
        // Hashing the index keeps streams from being shifted copies of one splitmix sequence.
        let mut place = mix(seed.wrapping_add(GOLDEN)) ^ mix(!index);
        let mut word = || {
            place = place.wrapping_add(GOLDEN);
            mix(place)
        };
        Self { state: [word(), word(), word(), word()] }
    }

    /// The generator in a given state, for comparison with published sequences. An all-zero state
    /// would stay zero for ever.
    pub const fn from_state(state: [u64; 4]) -> Self {
        Self { state }
    }

    /// The next 64 random bits.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        let [a, b, c, d] = self.state;
        let result = a.wrapping_add(d).rotate_left(23).wrapping_add(a);
        let (c, d) = (c ^ a, d ^ b);
        self.state = [a ^ d, b ^ c, c ^ (b << 17), d.rotate_left(45)];
        result
    }

    /// Uniform in the open interval (0, 1), resolution 2⁻⁵², symmetric about ½.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        ((self.next_u64() >> 12) as f64 + 0.5) * (1.0 / 4_503_599_627_370_496.0)
    }

    /// Standard normal: mean 0, variance 1, exact to the resolution of `f64` (no cut tail).
    ///
    /// One multiplication and one comparison in 98.8 % of calls.
    #[inline]
    pub fn gaussian(&mut self) -> f64 {
        loop {
            let bits = self.next_u64();
            let layer = (bits & 0xff) as usize;
            // The upper 53 bits, centred: never zero, symmetric, in (−1, 1).
            let signed = (bits.cast_signed() >> 11) as f64 + 0.5;
            let x = signed * (1.0 / 4_503_599_627_370_496.0) * EDGES[layer];
            if libm::fabs(x) < EDGES[layer + 1] {
                return x;
            }
            if let Some(x) = self.outside(layer, x) {
                return x;
            }
        }
    }

    /// Decides on `x` where its layer is not wholly under the curve.
    #[cold]
    fn outside(&mut self, layer: usize, x: f64) -> Option<f64> {
        if layer == 0 {
            return Some(libm::copysign(self.tail(), x));
        }
        let (low, high) = (density(EDGES[layer]), density(EDGES[layer + 1]));
        let height = low + self.uniform() * (high - low);
        (height < density(x)).then_some(x)
    }

    /// A normal variable given that it exceeds the base edge (Marsaglia 1964).
    fn tail(&mut self) -> f64 {
        loop {
            let beyond = -libm::log(self.uniform()) / EDGES[1];
            if -2.0 * libm::log(self.uniform()) > beyond * beyond {
                return EDGES[1] + beyond;
            }
        }
    }
}

/// White noise of given deviation from a stream of its own; noise of zero deviation draws nothing, and so
/// costs nothing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct White {
    /// Standard deviation, in the unit of the noise; zero for none.
    sigma: f64,
    /// The stream that it draws from.
    noise: Generator,
}

impl White {
    /// Noise of deviation `sigma` on stream `source` of `seed`.
    pub(crate) fn new(sigma: f64, seed: u64, source: u64) -> Self {
        Self { sigma, noise: Generator::stream(seed, source) }
    }

    /// The next value.
    #[inline]
    pub(crate) fn sample(&mut self) -> f64 {
        if self.sigma > 0.0 { self.sigma * self.noise.gaussian() } else { 0.0 }
    }
}

/// exp(−x²/2).
fn density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

/// The output function of splitmix64: a bijection that scatters every bit.
const fn mix(word: u64) -> u64 {
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// Which stream each source of noise draws from; fixed for ever, or recorded runs change.
pub(crate) mod source {
    /// What a gyro draws once per start: bias, scale.
    pub const GYRO_START: u64 = 1;
    /// White noise of a gyro.
    pub const GYRO_WHITE: u64 = 2;
    /// Flicker of a gyro.
    pub const GYRO_FLICKER: u64 = 3;
    /// Rate random walk of a gyro.
    pub const GYRO_WALK: u64 = 4;
    /// What an accelerometer draws once per start: bias of each axis.
    pub const ACCELEROMETER_START: u64 = 5;
    /// White noise of an accelerometer, three axes in turn.
    pub const ACCELEROMETER_WHITE: u64 = 6;
    /// White noise of a thermometer.
    pub const THERMOMETER: u64 = 7;
    /// White noise of the converter behind the gyro.
    pub const CONVERTER: u64 = 8;
    /// What the coarse sensors of the base draw once per start: scale, bias of each axis.
    pub const COARSE_START: u64 = 9;
    /// White noise of the coarse gyros, three axes in turn.
    pub const COARSE_RATE: u64 = 10;
    /// White noise of the coarse accelerometers, three axes in turn.
    pub const COARSE_FORCE: u64 = 11;
    /// The seeds of the three gyros of a vehicle: each has all of the streams above to itself.
    pub const VEHICLE_GYROS: [u64; 3] = [12, 13, 14];
    /// The seeds of the three gyros of a spinning body, as those of a vehicle.
    pub const SPIN_GYROS: [u64; 3] = [16, 17, 18];
    /// What a drawn day of a vehicle is like.
    pub const VEHICLE_SCENARIO: u64 = 15;
    /// How that day goes on.
    pub const VEHICLE_AFTERWARDS: u64 = 16;
    /// What is left of a laser gyro's dither.
    pub const GYRO_DITHER: u64 = 21;
}

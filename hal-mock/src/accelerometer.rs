//! Error model of the accelerometer on the platform.

use crate::noise::{Generator, White, source};

/// Errors of a three-axis accelerometer; the default is perfect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AccelerometerConfiguration {
    /// Noise density, m/s²/√Hz, one-sided as data sheets give it, ≥ 0.
    pub noise_m_s2_sqrt_hz: f64,
    /// Bias of x, y, z, m/s²: the fixed part.
    pub bias_m_s2: [f64; 3],
    /// Bias, m/s²: 1σ of the part drawn anew for every seed and axis.
    pub bias_sigma_m_s2: f64,
}

impl AccelerometerConfiguration {
    /// White noise of one sample at `rate_hz`, m/s²: density·√(`f_s`/2), the whole band to Nyquist.
    #[must_use]
    pub fn white_sigma_m_s2(&self, rate_hz: f64) -> f64 {
        self.noise_m_s2_sqrt_hz * libm::sqrt(0.5 * rate_hz)
    }
}

/// An accelerometer at work: what it drew at start and the state of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Accelerometer {
    bias_m_s2: [f64; 3],
    white: White,
}

impl Accelerometer {
    /// An accelerometer read `rate_hz` times a second (> 0); biases are drawn from the seed.
    #[must_use]
    pub fn new(configuration: &AccelerometerConfiguration, rate_hz: f64, seed: u64) -> Self {
        let mut start = Generator::stream(seed, source::ACCELEROMETER_START);
        let sigma = configuration.bias_sigma_m_s2;
        Self {
            bias_m_s2: configuration.bias_m_s2.map(|bias| bias + sigma * start.gaussian()),
            white: White::new(
                configuration.white_sigma_m_s2(rate_hz),
                seed,
                source::ACCELEROMETER_WHITE,
            ),
        }
    }

    /// Biases of this start, m/s².
    #[must_use]
    pub fn bias_m_s2(&self) -> [f64; 3] {
        self.bias_m_s2
    }

    /// The next output, m/s², for a true specific force in m/s².
    #[inline]
    pub fn sample(&mut self, force_m_s2: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = force_m_s2;
        let [bias_x, bias_y, bias_z] = self.bias_m_s2;
        [
            x + bias_x + self.white.sample(),
            y + bias_y + self.white.sample(),
            z + bias_z + self.white.sample(),
        ]
    }
}

//! Error model of the accelerometer on the platform, and what it feels off the axis of a turning one.

use crate::disturbance::Effect;
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
    /// Force at which an axis clips, m/s² (default never; ±2.048 g of an ADXL355 are 20.08).
    pub full_scale_m_s2: Option<f64>,
}

/// An accelerometer at work: what it drew at start and the state of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Accelerometer {
    /// Biases of x, y, z as drawn at this start, m/s².
    pub bias_m_s2: [f64; 3],
    /// White noise, m/s², drawn for x, y, z in turn.
    white: White,
    /// Force at which an axis clips, m/s².
    pub(crate) full_scale_m_s2: f64,
}

impl Accelerometer {
    /// An accelerometer read `rate_hz` times a second (> 0); biases are drawn from the seed.
    pub(crate) fn new(configuration: &AccelerometerConfiguration, rate_hz: f64, seed: u64) -> Self {
        let mut start = Generator::stream(seed, source::ACCELEROMETER_START);
        let sigma = configuration.bias_sigma_m_s2;
        // White noise of one sample: density·√(fs/2), the whole band to Nyquist.
        let white = configuration.noise_m_s2_sqrt_hz * libm::sqrt(0.5 * rate_hz);
        Self {
            bias_m_s2: configuration.bias_m_s2.map(|bias| bias + sigma * start.gaussian()),
            white: White::new(white, seed, source::ACCELEROMETER_WHITE),
            full_scale_m_s2: configuration.full_scale_m_s2.unwrap_or(f64::INFINITY),
        }
    }

    /// The next output, m/s², for a true specific force in m/s².
    #[inline]
    pub fn sample(&mut self, force_m_s2: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|axis| {
            let felt_m_s2 = force_m_s2[axis] + self.bias_m_s2[axis] + self.white.sample();
            felt_m_s2.max(-self.full_scale_m_s2).min(self.full_scale_m_s2)
        })
    }
}

/// An accelerometer that does not sit on the axis of the stage, and what the stage did at its latest
/// output.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lever {
    /// From the axis to the accelerometer along the gyro's axis and 90° clockwise of it, m.
    arm_m: [f64; 2],
    /// When the latest output came, s.
    seen_s: f64,
    /// The stage's rate at the latest output, rad/s.
    seen_rad_s: f64,
}

impl Lever {
    /// A lever along the gyro's axis and 90° clockwise of it, m, on a stage at rest.
    pub(crate) fn new(arm_m: [f64; 2]) -> Self {
        Self { arm_m, ..Self::default() }
    }

    /// Adds what the lever accelerates by, with the mean angular acceleration since the last output:
    /// ω̇ × r + ω × (ω × r), ω about z, down.
    pub(crate) fn add(&mut self, effect: &mut Effect, time_s: f64, rate_rad_s: f64) {
        let [x, y] = self.arm_m;
        if [x, y] == [0.0; 2] {
            return;
        }
        let elapsed_s = time_s - self.seen_s;
        let change_rad_s = rate_rad_s - self.seen_rad_s;
        let angular = if elapsed_s > 0.0 { change_rad_s / elapsed_s } else { 0.0 };
        (self.seen_s, self.seen_rad_s) = (time_s, rate_rad_s);
        let square = rate_rad_s * rate_rad_s;
        effect.force_m_s2[0] -= angular * y + square * x;
        effect.force_m_s2[1] += angular * x - square * y;
    }
}

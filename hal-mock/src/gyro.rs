//! Error model of one precise gyro, in the field's units.
//!
//! Per sample at rate `f_s`: white noise σ = N·√`f_s` (a rate of two-sided density N² averaged over one
//! period), rate random walk with steps K/√`f_s`, flicker (`flicker`), a ramp R·t, and quantisation of
//! the angle. The Allan variance of the sum is 3Q²/τ² + N²/τ + (2 ln 2/π)B² + K²τ/3 + R²τ²/2
//! (IEEE Std 952-1997, annex C).
//!
//! A molecular-electronic sensor ([`crate::molecular`]) has dynamics between what it feels, white noise
//! included, and the rest of these errors, which are those of its electronics.

use crate::flicker::Flicker;
use crate::molecular::{Molecular, MolecularConfiguration};
use crate::noise::{Generator, White, source};

/// One degree in radians.
const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// One degree per hour in rad/s.
pub const DEGREE_PER_HOUR: f64 = DEGREE / 3600.0;

/// One second of arc in radians.
const ARCSECOND: f64 = DEGREE / 3600.0;
/// Lower cut-off of the flicker, Hz: below any run of this project.
const FLICKER_LOW_HZ: f64 = 1e-5;
/// Upper cut-off of the flicker where nothing else is stated, Hz.
const FLICKER_HIGH_HZ: f64 = 10.0;
/// Temperature at which a gyro's bias is stated, °C.
const REFERENCE_C: f64 = 25.0;

/// Errors of a gyro as a data sheet states them; all zero (the default) is a perfect gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GyroConfiguration {
    /// N, angle random walk, °/√h, ≥ 0.
    pub n_deg_sqrt_h: f64,
    /// B, bias instability, °/h, ≥ 0: one-sided spectrum B²/(π f), Allan floor 0.664 B.
    pub b_deg_h: f64,
    /// Upper cut-off of the flicker, Hz (default 10); keep it below half the sample rate.
    pub flicker_high_hz: Option<f64>,
    /// K, rate random walk, °/h/√h, ≥ 0; zero at the first sample.
    pub k_deg_h_sqrt_h: f64,
    /// R, rate ramp, °/h², from the first sample.
    pub r_deg_h2: f64,
    /// Q, quantisation, arcsec RMS: the output angle has a least step of √12·Q.
    pub q_arcsec: f64,
    /// Noise of the angle itself, arcsec, 1σ of a sample: what a dithered laser gyro leaves of its dither. The
    /// rate shows its differences, and no rotation is lost to it.
    pub dither_arcsec: f64,
    /// Turn-on bias, °/h: the fixed part.
    pub bias_deg_h: f64,
    /// Turn-on bias, °/h: 1σ of the part drawn anew for every seed.
    pub bias_sigma_deg_h: f64,
    /// Scale factor error, 1: the gyro shows (1 + error) × the rate.
    pub scale_error: f64,
    /// Scale factor error, 1: 1σ of the part drawn anew for every seed.
    pub scale_sigma: f64,
    /// g-sensitivity (`k_s`, `k_o`), °/h/g, along the sensitive axis and 90° clockwise of it.
    pub g_sensitivity_deg_h_g: [f64; 2],
    /// Temperature coefficient of the bias, °/h/°C.
    pub temperature_deg_h_c: f64,
    /// Elevation of the sensitive axis above the platform plane, rad (non-orthogonality α).
    pub axis_elevation_rad: f64,
    /// The dynamics of a molecular-electronic sensor; none (the default) for a gyro.
    pub molecular: Option<MolecularConfiguration>,
}

impl GyroConfiguration {
    /// White noise of one sample at `rate_hz`, rad/s: N·√`f_s`.
    #[must_use]
    pub fn white_sigma_rad_s(&self, rate_hz: f64) -> f64 {
        // √h is 60 √s.
        self.n_deg_sqrt_h * (DEGREE / 60.0) * libm::sqrt(rate_hz)
    }
}

/// A gyro at work: what it drew at start, what of its errors is steady, and the state of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Gyro {
    /// g-sensitivity along the sensitive axis and 90° clockwise of it, °/h/g.
    g_sensitivity_deg_h_g: [f64; 2],
    /// Rate ramp, °/h².
    r_deg_h2: f64,
    /// Temperature coefficient of the bias, °/h/°C.
    temperature_deg_h_c: f64,
    /// Sine and cosine of the axis's elevation.
    elevation: [f64; 2],
    /// Turn-on bias of this start, rad/s.
    pub bias_rad_s: f64,
    /// Scale factor error of this start, 1.
    pub scale_error: f64,
    /// Angle random walk: white noise of the rate, rad/s.
    white: White,
    /// Steps of the rate random walk, rad/s.
    walk: White,
    /// Where the rate random walk stands, rad/s.
    walked_rad_s: f64,
    /// Bias instability, rad/s.
    flicker: Flicker,
    /// What is left of a laser gyro's dither.
    dither: Dither,
    /// The least step of its angle.
    quantiser: Quantiser,
    /// The dynamics of a molecular-electronic sensor.
    molecular: Option<Molecular>,
}

impl Gyro {
    /// A gyro read `rate_hz` times a second (> 0); bias and scale are drawn from the seed.
    #[must_use]
    pub fn new(configuration: &GyroConfiguration, rate_hz: f64, seed: u64) -> Self {
        let c = *configuration;
        let mut start = Generator::stream(seed, source::GYRO_START);
        let bias_deg_h = c.bias_deg_h + c.bias_sigma_deg_h * start.gaussian();
        let b = c.b_deg_h * DEGREE_PER_HOUR;
        // Step of the rate random walk from sample to sample, K/√fs; √h is 60 √s.
        let walk = c.k_deg_h_sqrt_h * (DEGREE_PER_HOUR / 60.0) / libm::sqrt(rate_hz);
        let noise = Generator::stream(seed, source::GYRO_FLICKER);
        let flicker_high_hz = c.flicker_high_hz.unwrap_or(FLICKER_HIGH_HZ);
        Self {
            g_sensitivity_deg_h_g: c.g_sensitivity_deg_h_g,
            r_deg_h2: c.r_deg_h2,
            temperature_deg_h_c: c.temperature_deg_h_c,
            elevation: [libm::sin(c.axis_elevation_rad), libm::cos(c.axis_elevation_rad)],
            bias_rad_s: bias_deg_h * DEGREE_PER_HOUR,
            scale_error: c.scale_error + c.scale_sigma * start.gaussian(),
            white: White::new(c.white_sigma_rad_s(rate_hz), seed, source::GYRO_WHITE),
            walk: White::new(walk, seed, source::GYRO_WALK),
            walked_rad_s: 0.0,
            flicker: Flicker::new(b, FLICKER_LOW_HZ, flicker_high_hz, rate_hz, noise),
            dither: Dither::new(c.dither_arcsec * ARCSECOND, rate_hz, seed),
            quantiser: Quantiser::new(c.q_arcsec * ARCSECOND, rate_hz),
            molecular: c.molecular.map(|dynamics| Molecular::new(&dynamics, rate_hz)),
        }
    }

    /// Rate along the sensitive axis, rad/s, of a platform turning at `platform_rad_s` (x along the
    /// axis, y 90° clockwise, z down; the stage's own rate included).
    pub(crate) fn along_axis(&self, platform_rad_s: [f64; 3]) -> f64 {
        let [sine, cosine] = self.elevation;
        // Elevation is up, platform z is down.
        cosine * platform_rad_s[0] - sine * platform_rad_s[2]
    }

    /// What the gyro shows without noise, ramp and temperature, rad/s: scale, bias, g-sensitivity.
    /// `axis_rad_s` is the inertial rate along the sensitive axis, `force_g` the specific force on
    /// platform x and y in g.
    #[must_use]
    pub fn steady(&self, axis_rad_s: f64, force_g: [f64; 2]) -> f64 {
        let [along, across] = self.g_sensitivity_deg_h_g;
        let gravity = (along * force_g[0] + across * force_g[1]) * DEGREE_PER_HOUR;
        (1.0 + self.scale_error) * axis_rad_s + gravity + self.bias_rad_s
    }

    /// The next output, rad/s, `elapsed_s` after the first sample at `temperature_c`, when
    /// [`Gyro::steady`] and any disturbance come to `steady_rad_s`, and nothing accelerates it.
    #[inline]
    pub fn sample(&mut self, steady_rad_s: f64, elapsed_s: f64, temperature_c: f64) -> f64 {
        self.sample_under([0.0; 2], steady_rad_s, elapsed_s, temperature_c)
    }

    /// The next output, rad/s, as [`Gyro::sample`] gives it, under a specific force on platform x and y
    /// in g: a molecular-electronic sensor answers to it beyond what [`Gyro::steady`] has of it. Call
    /// `rate_hz` times a second.
    #[inline]
    pub fn sample_under(
        &mut self,
        force_g: [f64; 2],
        steady_rad_s: f64,
        elapsed_s: f64,
        temperature_c: f64,
    ) -> f64 {
        let drift_deg_h = self.r_deg_h2 / 3600.0 * elapsed_s
            + self.temperature_deg_h_c * (temperature_c - REFERENCE_C);
        let slow = drift_deg_h * DEGREE_PER_HOUR + self.walked_rad_s + self.flicker.sample();
        self.walked_rad_s += self.walk.sample();
        let white = self.white.sample();
        let shown = match &mut self.molecular {
            None => steady_rad_s + slow + white,
            Some(dynamics) => {
                // The bias is the electronics' own and passes no filter.
                let felt_rad_s = steady_rad_s - self.bias_rad_s;
                dynamics.sample(felt_rad_s, white, force_g) + self.bias_rad_s + slow
            }
        };
        self.quantiser.sample(shown + self.dither.sample())
    }
}

/// White noise of the angle, as the rate shows it: each sample takes back what the one before it had.
#[derive(Clone, Debug, PartialEq)]
struct Dither {
    /// Noise of the angle over one sample, rad/s.
    white: White,
    /// The last one, rad/s over one sample.
    last_rad_s: f64,
}

impl Dither {
    /// Noise of `sigma_rad` of the angle at `rate_hz`.
    fn new(sigma_rad: f64, rate_hz: f64, seed: u64) -> Self {
        let white = White::new(sigma_rad * rate_hz, seed, source::GYRO_DITHER);
        Self { white, last_rad_s: 0.0 }
    }

    /// What it adds to the next rate, rad/s.
    #[inline]
    fn sample(&mut self) -> f64 {
        let now_rad_s = self.white.sample();
        now_rad_s - core::mem::replace(&mut self.last_rad_s, now_rad_s)
    }
}

/// Output of whole angle increments: the angle is rounded to a step, the rest is carried over, so
/// that no rotation is ever lost. Its error is uniform over a step of √12·Q: Q RMS.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quantiser {
    /// Rate of one step per sample, rad/s; zero for none.
    step_rad_s: f64,
    /// Angle not yet shown, steps, within ±½.
    carried: f64,
}

impl Quantiser {
    /// Quantisation of `q_rad` RMS at `rate_hz`.
    fn new(q_rad: f64, rate_hz: f64) -> Self {
        Self { step_rad_s: libm::sqrt(12.0) * q_rad * rate_hz, carried: 0.0 }
    }

    /// Quantises one sample, rad/s.
    #[inline]
    fn sample(&mut self, rate_rad_s: f64) -> f64 {
        if self.step_rad_s <= 0.0 {
            return rate_rad_s;
        }
        let steps = self.carried + rate_rad_s / self.step_rad_s;
        let shown = libm::rint(steps);
        self.carried = steps - shown;
        shown * self.step_rad_s
    }
}

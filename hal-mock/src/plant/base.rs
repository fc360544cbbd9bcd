//! The base as coarse sensors on it feel it: its sway, the Earth's rotation and gravity, and their
//! own errors.
//!
//! The sensors' axes are those of the body: forward, right, down. They stand `lever_m` from the
//! point that the base sways about, so they also feel what swaying accelerates there.

use embassy_time::Instant;

use super::STANDARD_GRAVITY_M_S2;
use super::journey::{Journey, JourneyConfiguration};
use super::sway::SwayConfiguration;
use crate::earth::{Attitude, Site, cross};
use crate::environment::{ForceInput, MotionInput};
use crate::instruments::InstrumentsConfiguration;
use crate::noise::{Generator, White, source};
use crate::sensor_fault::SensorFault;

/// What sensors show at full scale, beyond any range: of the gyros, rad/s, and of the accelerometers, g.
const FULL_SCALES: [f64; 2] = [100.0, f64::INFINITY];

/// Half the time over which the angular acceleration is taken, s: sways are slower by far.
const HALF_STEP_S: f64 = 1e-3;

/// Errors of coarse sensors, as data sheets state them; the default is perfect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoarseConfiguration {
    /// Outputs a second of each sensor, Hz: the band of its noise.
    pub rate_hz: f64,
    /// Noise density of the gyros, m°/s/√Hz, one-sided.
    pub rate_noise_mdps_sqrt_hz: f64,
    /// 1σ of the gyros' zero-rate level, °/s.
    pub rate_bias_sigma_deg_s: f64,
    /// Noise density of the accelerometers, µg/√Hz, one-sided.
    pub force_noise_ug_sqrt_hz: f64,
    /// 1σ of the accelerometers' offset, mg.
    pub force_bias_sigma_mg: f64,
    /// 1σ of the scale factor of each axis, relative.
    pub scale_sigma: f64,
    /// From the point that the base sways about to the sensors, body axes, m.
    pub lever_m: [f64; 3],
}

/// The base at work under its coarse sensors.
#[derive(Clone, Debug, PartialEq)]
pub struct Base<'a> {
    /// Where the base goes, where it leaves.
    journey: Option<Journey<'a>>,
    /// What goes wrong with the sensors on the way.
    faults: &'a [SensorFault],
    /// What was shown last: rates, rad/s, and forces, g.
    shown: [[f64; 3]; 2],
    /// Time between two outputs, s.
    period_s: f64,
    /// Attitude at rest.
    attitude: Attitude,
    /// Latitude and attitude at rest, with gravity and Earth rate.
    site: Site,
    /// How it sways.
    sway: SwayConfiguration,
    /// From the point that it sways about to the sensors, body axes, m.
    lever_m: [f64; 3],
    /// Scale factor, bias and noise of gyros (rad/s) and accelerometers (m/s²).
    sensors: [Errors; 2],
}

/// Errors of three equal axes.
#[derive(Clone, Debug, PartialEq)]
struct Errors {
    /// Scale factors, 1.
    scale: [f64; 3],
    /// Biases, in the unit of the sensors.
    bias: [f64; 3],
    /// White noise, in the unit of the sensors.
    white: White,
}

impl Errors {
    /// Draws scale factors of 1σ `scale` about one and biases of 1σ `bias`.
    fn new(start: &mut Generator, scale: f64, bias: f64, white: White) -> Self {
        let mut draw = |sigma: f64| [0; 3].map(|_| sigma * start.gaussian());
        Self { scale: draw(scale).map(|error| 1.0 + error), bias: draw(bias), white }
    }

    /// What the three axes show next of a truth.
    fn show(&mut self, truth: [f64; 3]) -> [f64; 3] {
        let mut shown = truth;
        for (axis, value) in shown.iter_mut().enumerate() {
            *value = *value * self.scale[axis] + self.bias[axis] + self.white.sample();
        }
        shown
    }
}

impl<'a> Base<'a> {
    /// The base of these instruments, swaying like this, with sensors of such errors; from the departure of
    /// a journey on the sensors feel its motion, not the sway.
    #[must_use]
    pub fn new(
        instruments: &InstrumentsConfiguration,
        sway: &SwayConfiguration,
        coarse: &CoarseConfiguration,
        journey: Option<&JourneyConfiguration<'a>>,
        seed: u64,
    ) -> Self {
        let attitude = instruments.attitude();
        let mut start = Generator::stream(seed, source::COARSE_START);
        let band = libm::sqrt(0.5 * coarse.rate_hz);
        let rate = (coarse.rate_noise_mdps_sqrt_hz * 1e-3).to_radians() * band;
        let force = coarse.force_noise_ug_sqrt_hz * 1e-6 * STANDARD_GRAVITY_M_S2 * band;
        let offset = coarse.force_bias_sigma_mg * 1e-3 * STANDARD_GRAVITY_M_S2;
        let white = |sigma, source| White::new(sigma, seed, source);
        let mut errors = |bias, white| Errors::new(&mut start, coarse.scale_sigma, bias, white);
        Self {
            journey: journey.map(|journey| Journey::new(journey, instruments)),
            faults: journey.map_or(&[], |journey| journey.faults),
            shown: [[0.0; 3]; 2],
            period_s: 1.0 / coarse.rate_hz,
            attitude,
            site: Site::new(instruments.latitude_deg.to_radians(), &attitude),
            sway: *sway,
            lever_m: coarse.lever_m,
            sensors: [
                errors(coarse.rate_bias_sigma_deg_s.to_radians(), white(rate, source::COARSE_RATE)),
                errors(offset, white(force, source::COARSE_FORCE)),
            ],
        }
    }

    /// What is shown instead of `values`, the `index`-th sensor's, at a time in s.
    fn spoilt(&mut self, index: usize, time_s: f64, values: [f64; 3]) -> [f64; 3] {
        let (last, full) = (self.shown[index], FULL_SCALES[index]);
        self.shown[index] = [0, 1, 2].map(|axis: usize| {
            let value = [values[axis], last[axis]];
            SensorFault::spoilt(self.faults, 3 * index + axis, time_s, value, full)
        });
        self.shown[index]
    }

    /// Where the base leans, and how fast it turns about its own axes, rad/s.
    fn motion(&self, time_s: f64) -> (Attitude, [f64; 3]) {
        let motion = self.sway.at(time_s);
        let attitude = motion.moved(&self.attitude);
        (attitude, motion.body_rad_s(&attitude))
    }

    /// What the lever accelerates by: ω̇ × r + ω × (ω × r), m/s².
    fn lever_m_s2(&self, time_s: f64, turning: [f64; 3]) -> [f64; 3] {
        let before = self.motion(time_s - HALF_STEP_S).1;
        let after = self.motion(time_s + HALF_STEP_S).1;
        let angular = [0, 1, 2].map(|i| (after[i] - before[i]) / (2.0 * HALF_STEP_S));
        let tangential = cross(angular, self.lever_m);
        let centripetal = cross(turning, cross(turning, self.lever_m));
        [0, 1, 2].map(|i| tangential[i] + centripetal[i])
    }
}

impl ForceInput for Base<'_> {
    fn force_g(&mut self, now: Instant) -> [f64; 3] {
        let (time_s, period_s) = (super::seconds(now), self.period_s);
        if let Some(felt) = self.journey.as_mut().and_then(|way| way.felt(1, time_s, period_s)) {
            let shown = self.sensors[1].show(felt.force_m_s2);
            return self.spoilt(1, time_s, shown.map(|force| force / STANDARD_GRAVITY_M_S2));
        }
        let (attitude, turning) = self.motion(time_s);
        let standing = self.site.with_attitude(&attitude).on_platform(0.0).force_m_s2;
        let lever = self.lever_m_s2(time_s, turning);
        let felt = [0, 1, 2].map(|i| standing[i] + lever[i]);
        self.sensors[1].show(felt).map(|force| force / STANDARD_GRAVITY_M_S2)
    }

    /// Room temperature: these sensors' warm-up is not simulated.
    fn temperature_c(&mut self, _: Instant) -> f64 {
        25.0
    }
}

impl MotionInput for Base<'_> {
    fn rate_rad_s(&mut self, now: Instant) -> [f64; 3] {
        let (time_s, period_s) = (super::seconds(now), self.period_s);
        if let Some(felt) = self.journey.as_mut().and_then(|way| way.felt(0, time_s, period_s)) {
            let shown = self.sensors[0].show(felt.rate_rad_s);
            return self.spoilt(0, time_s, shown);
        }
        let (attitude, turning) = self.motion(time_s);
        let earth = self.site.with_attitude(&attitude).on_platform(0.0).rate_rad_s;
        self.sensors[0].show([0, 1, 2].map(|i| earth[i] + turning[i]))
    }
}

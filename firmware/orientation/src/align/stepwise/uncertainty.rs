//! Where the standard deviation comes from: the limit, the budget, the Earth-rate ratio's σ.

use super::super::budget::Budget;
use super::super::direction::{Amplitude, Direction, dot, product, quadratic};
use super::super::regression::{Column, Regression};
use super::{COLUMNS, Model, Problem};
use crate::noise::model::GyroNoise;
use crate::signal::dwell::Dwell;

impl Problem<'_> {
    /// The bound that noise sets for these columns when all stationary time counts fully.
    pub(super) fn limit(&self, noise: &GyroNoise, model: &Model) -> Option<f64> {
        let regression = self.regression(noise, |_| 1.0);
        self.direction(&regression, model).map(|direction| libm::sqrt(direction.variance))
    }

    /// Splits the variance: noise alone, then what drift, temperature and scale add, then what the
    /// fit cannot see.
    pub(super) fn budget(
        &self,
        coloured: &Regression<COLUMNS>,
        model: &Model,
        direction: &Direction,
    ) -> Option<Budget> {
        let white = self.regression(&self.setting.noise.white_part(), Dwell::taper_factor);
        let variance = |regression: &Regression<COLUMNS>, model: &Model| {
            self.direction(regression, model).map(|direction| direction.variance)
        };
        let exact = match model.amplitude {
            Amplitude::Free => Amplitude::Free,
            Amplitude::Known(_) => Amplitude::Known(0.0),
        };
        let bare = Model { time: Column::Absent, temperature: Column::Absent, amplitude: exact };
        let noise = variance(&white, &bare)?;
        let drift = variance(coloured, &Model { time: model.time, ..bare })?.max(noise);
        let temperature = variance(coloured, &Model { amplitude: exact, ..*model })?.max(drift);
        let amplitude = (direction.variance - temperature).max(0.0);
        let tilted = self.tilted(direction);
        let share = self.scale_share();
        Some(Budget {
            noise: libm::sqrt(noise),
            drift: libm::sqrt(drift - noise),
            temperature: libm::sqrt(temperature - drift),
            scale: libm::sqrt(amplitude * share),
            latitude: libm::sqrt(amplitude * (1.0 - share)),
            g_sensitivity: tilted[0],
            accelerometer: tilted[1],
            encoder: self.setting.encoder_sigma,
        })
    }

    /// Which part of the amplitude's variance is the scale factor's.
    fn scale_share(&self) -> f64 {
        let amplitude = self.setting.amplitude_sigma();
        if amplitude > 0.0 {
            (self.setting.scale_sigma / amplitude) * (self.setting.scale_sigma / amplitude)
        } else {
            1.0
        }
    }

    /// What g-sensitivity and accelerometer cost in azimuth, rad: both turn with the stage as the
    /// Earth rate does, so they shift the two components.
    fn tilted(&self, direction: &Direction) -> [f64; 2] {
        let [kappa, tilt] = self.component_errors();
        [kappa, tilt].map(|covariance| libm::sqrt(quadratic(&covariance, direction.gain).max(0.0)))
    }

    /// Covariance of the components, in units of `Ω_h`, from κ and from the tilt.
    ///
    /// A tilt phasor F shifts them by `(Ω_v + κ)F/Ω_h`, as complex numbers.
    fn component_errors(&self) -> [[[f64; 2]; 2]; 2] {
        let rate = self.setting.latitude.horizontal_rate();
        let kappa = self.setting.g_sensitivity_sigma * self.tilt.magnitude() / rate;
        let real = (self.setting.latitude.vertical_rate() + self.setting.g_sensitivity[0]) / rate;
        let imaginary = self.setting.g_sensitivity[1] / rate;
        let rows = [[real, -imaginary], [imaginary, real]];
        let tilt = rows.map(|row| {
            let half = product(&self.tilt.covariance, row);
            [dot(rows[0], half), dot(rows[1], half)]
        });
        [[[kappa * kappa, 0.0], [0.0, kappa * kappa]], tilt]
    }

    /// 1σ of the Earth-rate ratio that `free` found: noise, κ and tilt along it, scale, latitude.
    pub(super) fn ratio_sigma(&self, free: &Direction) -> f64 {
        let (sine, cosine) = libm::sincos(free.azimuth);
        let [kappa, tilt] =
            self.component_errors().map(|errors| quadratic(&errors, [cosine, sine]));
        let amplitude = self.setting.amplitude_sigma();
        let variance = free.amplitude_variance + kappa + tilt + amplitude * amplitude;
        libm::sqrt(variance.max(0.0))
    }
}

//! The classes of faults of a rig, whatever turns it: of its base, its encoder, its gyro and its accelerometer, and of
//! what is said of them.

use std::f64::consts::TAU;

use hal_mock::gyro::DEGREE_PER_HOUR;
use hal_mock::stage::Harmonic;
use hal_mock::temperature::TemperatureConfiguration;

use super::axes::TURNED;
use super::class::Class;
use super::gyro::Drift;
use super::unit::Rig;
use crate::campaign::chance::Chance;

/// m/s² of a thousandth of gravity.
const MILLI_G: f64 = 9.81e-3;

/// The base turns about the vertical.
pub(super) fn base_turn<R: Rig>() -> Class {
    let fault = format!("the base turns about the vertical {}", R::MIDWAY);
    R::fault("base-turn", fault, [0.003, 20.0], "°").spoils(R::on_circle, |rig, chance, size| {
        let at = rig.some_time(chance);
        rig.unit_mut().base.turns.push((at, chance.sign() * size.to_radians()));
    })
}

/// The encoder slips.
pub(super) fn encoder_slip<R: Rig>() -> Class {
    let fault = format!("the encoder slips {}", R::MIDWAY);
    R::fault("encoder-slip", fault, [0.003, 90.0], "°").spoils(R::on_circle, |rig, chance, size| {
        let at = rig.some_time(chance);
        rig.unit_mut().slips.push((at, chance.sign() * size.to_radians()));
    })
}

/// The base moves slowly.
pub(super) fn base_moves<R: Rig>() -> [Class; 2] {
    let tilts = "the base tilts slowly";
    [
        R::spoilt("base-tilting", tilts, [0.001, 30.0], "°/h", |rig, chance, size| {
            let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
            let rates = [0.0, cosine, sine];
            rig.unit_mut().base.rates_rad_s = rates.map(|part| part * size * DEGREE_PER_HOUR);
        }),
        R::fault("base-yawing", "the base turns slowly about the vertical", [3e-4, 3.0], "°/min")
            .spoils(R::on_circle, |rig, chance, size| {
                rig.unit_mut().base.rates_rad_s[0] = chance.sign() * size.to_radians() / 60.0;
            }),
    ]
}

/// The encoder counts the other way, under so many degrees of tilt.
pub(super) fn reversed<R: Rig>(name: &str, fault: &str, drawn: fn(u64) -> R) -> Class {
    R::fault(name, fault, [0.01, 5.0], "° of tilt").drawn(move |seed, size| {
        let mut rig = drawn(seed);
        let uphill = 360.0 * Chance::new(seed, R::FAULT).between(0.0, 1.0);
        let instruments = &mut rig.unit_mut().instruments;
        *instruments = instruments.leaning(size, uphill);
        rig.pair(|rig, _| rig.unit_mut().is_reversed = true)
    })
}

/// The gyro's bias drifts as no key states; `steps` is what is said of two steps.
pub(super) fn drifts<R: Rig>(steps: &str) -> [Class; 3] {
    let unit = format!("σ of a {}", R::MEAN);
    let over = format!("{unit}, over the recording");
    let of = |name, fault, unit: &str| R::fault(name, fault, [0.1, 1000.0], unit);
    [
        of("bias-steps", steps, &unit).spoils(R::on_circle, |rig, chance, size| {
            for _ in 0..2 {
                let at_s = rig.some_time(chance);
                let rate = chance.sign() * size * rig.mean_sigma();
                rig.unit_mut().drift.push(Drift::Step { at_s, rate });
            }
        }),
        of("random-walk", "a rate random walk that no key states", &over).spoils(
            R::on_circle,
            |rig, _, size| {
                let density = size * rig.mean_sigma() / rig.seconds().sqrt();
                rig.unit_mut().drift.push(Drift::Walk { density });
            },
        ),
        of("warm-up", "a warm-up that no key states", &unit).spoils(
            R::on_circle,
            |rig, chance, size| {
                let rate = chance.sign() * size * rig.mean_sigma();
                let seconds = chance.scaled(0.1, 3.0) * rig.seconds();
                rig.unit_mut().drift.push(Drift::WarmUp { rate, seconds });
            },
        ),
    ]
}

/// The bias follows the temperature of a rig that becomes [`warm`].
pub(super) fn temperature<R: Rig>(fault: &str, drawn: fn(u64) -> R) -> Class {
    let unit = format!("σ of a {}", R::MEAN);
    R::fault("temperature", fault, [0.1, 1000.0], unit).spoils(drawn, |rig, chance, size| {
        let temperature = &rig.unit().instruments.temperature;
        let rise = temperature.at(rig.seconds()) - temperature.at(0.0);
        let rate = chance.sign() * size * rig.mean_sigma();
        rig.unit_mut().instruments.gyro.temperature_deg_h_c = rate / rise / DEGREE_PER_HOUR;
    })
}

/// A rig whose temperature rises or falls, with a noise in °C.
pub(super) fn warm<R: Rig>(mut rig: R, noise_c: f64) -> R {
    let mut chance = Chance::new(rig.seed(), R::FAULT + 2);
    rig.unit_mut().instruments.temperature = TemperatureConfiguration {
        rise_c: chance.sign() * chance.scaled(1.0, 20.0),
        time_constant_s: chance.scaled(0.1, 3.0) * rig.seconds(),
        noise_c,
        ..TemperatureConfiguration::default()
    };
    rig
}

/// What becomes of the columns of gyro and encoder: late by these times, s, and clipped, as is said.
pub(super) fn columns<R: Rig>(late_s: [f64; 2], clipped: &str) -> [Class; 5] {
    let (coarse, step) = ("the gyro's column has coarse steps", "σ of a sample");
    let errs = "the encoder errs twice a turn";
    [
        R::spoilt("gyro-lag", "the gyro lags", [0.01, 10.0], "s", |rig, _, size| {
            rig.unit_mut().gyro.lag_s = size;
        }),
        R::spoilt("gyro-late", "the gyro's column is late", late_s, "s", |rig, _, size| {
            rig.unit_mut().gyro.late_s = size;
        }),
        R::spoilt("gyro-coarse", coarse, [0.1, 100.0], step, |rig, _, size| {
            rig.unit_mut().gyro.step = size * rig.sample_sigma();
        }),
        clips::<R>(clipped),
        R::spoilt("encoder-second-harmonic", errs, [0.003, 3.0], "°", |rig, chance, size| {
            let (amplitude_rad, phase_rad) = (size.to_radians(), chance.between(0.0, TAU));
            rig.unit_mut().instruments.encoder.second = Harmonic { amplitude_rad, phase_rad };
        }),
    ]
}

/// The gyro's column is clipped, by parts of the horizontal Earth rate below the greatest rate.
fn clips<R: Rig>(fault: &str) -> Class {
    let unit = "of the horizontal Earth rate, below the greatest rate";
    R::spoilt("gyro-clipped", fault, [0.01, 10.0], unit, |rig, _, size| {
        let latitude = rig.unit().instruments.latitude_deg.to_radians();
        let earth = latitude.cos() * 15.041 * DEGREE_PER_HOUR;
        let greatest = rig.rates().into_iter().fold(f64::MIN, f64::max);
        rig.unit_mut().gyro.limit = Some(greatest - size * earth);
    })
}

/// Two of the accelerometer's axes are flipped together or turned by 90°, under so many degrees of tilt. As far as
/// the Earth-rate ratio shows: what the wrong axes add lies along the Earth rate.
pub(super) fn accelerometer_axes<R: Rig>(drawn: fn(u64) -> R) -> Class {
    let fault = "two of the accelerometer's axes are flipped together or turned by 90°";
    let fault = R::fault("accelerometer-axes", fault, [0.01, 5.0], "° of tilt");
    fault.drawn(move |seed, size| {
        let mut rig = drawn(seed);
        let mut chance = Chance::new(seed, R::FAULT);
        let [flipped, right, left] = TURNED;
        let (axes, turn) = chance.one_of(&[(flipped, 0.0), (right, -45.0), (left, 45.0)]);
        let aside = chance.sign() * chance.between(25.0, 40.0);
        let unit = rig.unit_mut();
        let along = -unit.instruments.azimuth_deg + turn + aside;
        unit.instruments = unit.instruments.leaning(size, along);
        let scale_sigma = chance.scaled(1e-5, 1e-4);
        unit.instruments.gyro.scale_sigma = scale_sigma;
        unit.header.gyro_scale_sigma = Some(scale_sigma);
        rig.pair(|rig, _| rig.unit_mut().axes = axes)
    })
}

/// The header's rate is not that of the times, by a part of it.
pub(super) fn period<R: Rig>() -> Class {
    let fault = "the header's rate is not that of the times";
    R::spoilt("period", fault, [0.0001, 2.0], "of the rate", |rig, chance, size| {
        rig.unit_mut().header.rate_hz = Some(R::RATE_HZ * chance.factor_or_inverse(1.0 + size));
    })
}

/// What no key states: healthy rigs that leave it unsaid have none of it.
pub(super) fn unstated<R: Rig>() -> [Class; 3] {
    let kappa = "a g-sensitivity that no key states";
    let kappa_unit = "times 50 000 °/h/g for each (°/√h)² of N";
    let scale = "a scale error that no key states";
    let bias = "accelerometer biases that no key states";
    [
        R::fault("unstated-g-sensitivity", kappa, [0.01, 4.0], kappa_unit).drawn(|seed, size| {
            let mut rig = R::drawn(seed);
            let header = &mut rig.unit_mut().header;
            header.g_sensitivity_deg_h_g = None;
            header.g_sensitivity_sigma_deg_h_g = None;
            rig.pair(|rig, chance| {
                let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
                let gyro = &mut rig.unit_mut().instruments.gyro;
                let size = (size * 50_000.0 * gyro.n_deg_sqrt_h * gyro.n_deg_sqrt_h).min(212.0);
                gyro.g_sensitivity_deg_h_g = [size * cosine, size * sine];
            })
        }),
        R::fault("unstated-scale", scale, [0.0001, 0.05], "").drawn(|seed, size| {
            let mut rig = R::drawn(seed);
            rig.unit_mut().header.gyro_scale_sigma = None;
            rig.unit_mut().instruments.gyro.scale_sigma = 0.0;
            rig.pair(|rig, chance| {
                rig.unit_mut().instruments.gyro.scale_error = chance.sign() * size;
            })
        }),
        R::fault("unstated-accelerometer-bias", bias, [0.1, 100.0], "mg").drawn(|seed, size| {
            let mut rig = R::drawn(seed);
            rig.unit_mut().header.accelerometer_bias_m_s2 = None;
            rig.unit_mut().instruments.accelerometer.bias_sigma_m_s2 = 0.0;
            rig.pair(|rig, chance| {
                rig.unit_mut().instruments.accelerometer.bias_m_s2 =
                    [0, 1, 2].map(|_| chance.sign() * size * MILLI_G);
            })
        }),
    ]
}

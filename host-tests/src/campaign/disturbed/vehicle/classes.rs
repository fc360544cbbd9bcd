//! The faults of three gyros and three accelerometers in a vehicle, and of what is said of them.

use hal_mock::vehicle::Leg;

use super::{DRAWN, MILLI_G, Unit};
use crate::campaign::chance::Chance;
use crate::campaign::disturbed::axes::turned;
use crate::campaign::disturbed::class::{Class, Fault, Subject};

/// Answers that may be wrong of a vehicle that only stands, where a bias is not what it was said to be: no data
/// distinguish the bias along east from north.
const WRONG_OF_FALSE_BIAS: f64 = 0.05;

/// The classes of a vehicle.
pub(super) fn classes() -> Vec<Class> {
    let mut classes: Vec<Class> = understated().into();
    classes.extend(wrong_times());
    classes.push(accelerometer_axes());
    classes.extend(unstated());
    classes
}

/// What is said of the gyros is too good, or nothing is said.
fn understated() -> [Class; 3] {
    let short = "N that no key states, and short stops of a long recording";
    let noise = "the gyros' N is so many times what is stated, on the way and standing";
    let bias = "the gyros' biases are so many times what is stated, in a vehicle that only stands";
    let name = "standing-bias-understated".to_owned();
    let of_bias = Fault { name, ..Unit::fault("", bias, [1.0, 30.0], "") }.spoils(
        Unit::standing,
        |unit, _, size| {
            unit.header.gyro_bias_deg_h = Some(unit.gyro().bias_sigma_deg_h / size);
        },
    );
    [
        Unit::fault("short-stops", short, [300.0, 6000.0], "samples of a stop").drawn(
            |seed, size| {
                let mut unit = Unit::siap(seed).stating_noise();
                unit.shorten_stops(size);
                unit.pair(|unit, _| unit.header.gyro_n_deg_sqrt_h = None)
            },
        ),
        Unit::fault("noise-understated", noise, [1.0, 30.0], "").spoils(
            |seed| Unit::drawn(seed).stating_noise(),
            |unit, _, size| {
                unit.header.gyro_n_deg_sqrt_h = Some(unit.gyro().n_deg_sqrt_h / size);
            },
        ),
        Class { wrong_allowed: WRONG_OF_FALSE_BIAS, ..of_bias },
    ]
}

/// The header's rate is not that of the times, or the times are not those of the sensors.
fn wrong_times() -> [Class; 2] {
    let rate = "the header's rate is not that of the times";
    let clock = "the times run at another pace than the sensors, whose rate is stated";
    [
        Unit::spoilt("rate", rate, [1e-4, 2.0], "of the rate", |unit, chance, size| {
            let wrong = chance.factor_or_inverse(1.0 + size);
            unit.header.rate_hz = unit.header.rate_hz.map(|rate| rate * wrong);
        }),
        Unit::spoilt("clock", clock, [1e-4, 2.0], "of the pace", |unit, chance, size| {
            unit.clock = chance.factor_or_inverse(1.0 + size);
        }),
    ]
}

fn accelerometer_axes() -> Class {
    let fault = "the accelerometers are turned by 90° or 180° about the vertical";
    Unit::fault("accelerometer-axes", fault, [0.005, 5.0], "° of slope").drawn(|seed, size| {
        let mut unit = Unit::moving(seed);
        unit.lean(size);
        let pair = unit.pair(|unit, chance| unit.accelerometer_axes = turned(chance));
        pair.never_harmless()
    })
}

/// What no key states.
fn unstated() -> [Class; 4] {
    let kappa = "a g-sensitivity of the gyros that no key states";
    let scale = "scale errors of the gyros that no key states";
    let force = "accelerometer biases that no key states";
    let bias = "biases of the gyros that no key states";
    let per_g = "of the bias's σ, per g";
    [
        Unit::spoilt("unstated-g-sensitivity", kappa, [0.01, 3.0], per_g, |unit, chance, size| {
            let size = size * unit.gyro().bias_sigma_deg_h;
            for gyro in &mut unit.day.vehicle.gyros {
                gyro.g_sensitivity_deg_h_g = [0, 1].map(|_| size * chance.normal());
            }
            unit.header.g_sensitivity_deg_h_g = None;
            unit.header.g_sensitivity_sigma_deg_h_g = None;
        }),
        Unit::spoilt("unstated-scale", scale, [1e-6, 1e-3], "", |unit, chance, size| {
            for gyro in &mut unit.day.vehicle.gyros {
                gyro.scale_sigma = 0.0;
                gyro.scale_error = size * chance.normal();
            }
            unit.header.gyro_scale_sigma = None;
        }),
        Unit::spoilt(
            "unstated-accelerometer-bias",
            force,
            [0.01, 10.0],
            "mg",
            |unit, chance, size| {
                let accelerometer = &mut unit.day.vehicle.accelerometer;
                accelerometer.bias_sigma_m_s2 = 0.0;
                accelerometer.bias_m_s2 = [0, 1, 2].map(|_| chance.normal() * size * MILLI_G);
                unit.header.accelerometer_bias_m_s2 = None;
            },
        ),
        Unit::fault("unstated-bias", bias, [0.003, 3.0], "°/h").spoils(
            Unit::siap,
            |unit, _, size| {
                unit.day.vehicle.gyros.iter_mut().for_each(|gyro| gyro.bias_sigma_deg_h = size);
                unit.header.gyro_bias_deg_h = None;
            },
        ),
    ]
}

impl Unit {
    /// This unit with its N stated.
    fn stating_noise(mut self) -> Self {
        self.header.gyro_n_deg_sqrt_h = Some(self.gyro().n_deg_sqrt_h);
        self
    }

    /// Makes the stops so many samples long: nearly a quarter of the recording, or down to a sixtieth.
    fn shorten_stops(&mut self, samples: f64) {
        let mut chance = Chance::new(self.seed, DRAWN + 2);
        let rate_hz = (samples / chance.between(20.0, 60.0)).clamp(10.0, 100.0);
        self.day.vehicle.rate_hz = rate_hz;
        self.header.rate_hz = Some(rate_hz);
        for leg in &mut self.day.legs {
            if let Leg::Stop(stop) = leg {
                stop.seconds = (samples / rate_hz).max(20.0);
            }
        }
    }

    /// Stands on ground of such a slope, °, whatever its direction.
    fn lean(&mut self, slope_deg: f64) {
        let mut chance = Chance::new(self.seed, DRAWN + 3);
        for leg in &mut self.day.legs {
            if let Leg::Stop(stop) = leg {
                let uphill = chance.between(0.0, std::f64::consts::TAU);
                stop.pitch_deg = slope_deg * uphill.cos();
                stop.roll_deg = slope_deg * uphill.sin();
            }
        }
    }
}

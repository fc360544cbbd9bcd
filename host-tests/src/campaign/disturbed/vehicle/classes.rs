//! The faults of three gyros and three accelerometers in a vehicle, and of what is said of them.

use hal_mock::vehicle::Leg;

use super::{Bench, DRAWN, MILLI_G};
use crate::campaign::disturbed::axes::turned;
use crate::campaign::disturbed::chance::Chance;
use crate::campaign::disturbed::{Class, Pair};

/// Answers that may be wrong of a vehicle that only stands, where a bias is not what it was said to be: no data
/// tell the bias along east from north.
const WRONG_OF_FALSE_BIAS: f64 = 0.05;

/// The classes of a vehicle.
pub const CLASSES: &[Class] = &[
    Class {
        name: "vehicle-short-stops",
        fault: "N that no key states, and short stops of a long recording",
        severity: [300.0, 6000.0],
        unit: "samples of a stop",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::siap(seed);
            bench.shorten_stops(size);
            bench.header.gyro_n_deg_sqrt_h = Some(bench.gyro().n_deg_sqrt_h);
            bench.pair(|bench, _| bench.header.gyro_n_deg_sqrt_h = None)
        },
    },
    Class {
        name: "vehicle-noise-understated",
        fault: "the gyros' N is so many times what is stated, on the way and standing",
        severity: [1.0, 30.0],
        unit: "",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            bench.header.gyro_n_deg_sqrt_h = Some(bench.gyro().n_deg_sqrt_h);
            let stated = Some(bench.gyro().n_deg_sqrt_h / size);
            bench.pair(|bench, _| bench.header.gyro_n_deg_sqrt_h = stated)
        },
    },
    Class {
        name: "standing-bias-understated",
        fault: "the gyros' biases are so many times what is stated, in a vehicle that only stands",
        severity: [1.0, 30.0],
        unit: "",
        wrong_allowed: WRONG_OF_FALSE_BIAS,
        draw: |seed, size| {
            let bench = Bench::standing(seed);
            let stated = Some(bench.gyro().bias_sigma_deg_h / size);
            bench.pair(|bench, _| bench.header.gyro_bias_deg_h = stated)
        },
    },
    Class {
        name: "vehicle-rate",
        fault: "the header's rate is not that of the times",
        severity: [1e-4, 2.0],
        unit: "of the rate",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let wrong = if chance.happens(0.5) { 1.0 + size } else { 1.0 / (1.0 + size) };
                bench.header.rate_hz = bench.header.rate_hz.map(|rate| rate * wrong);
            })
        },
    },
    Class {
        name: "vehicle-clock",
        fault: "the times run at another pace than the sensors, whose rate is stated",
        severity: [1e-4, 2.0],
        unit: "of the pace",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                bench.clock = if chance.happens(0.5) { 1.0 + size } else { 1.0 / (1.0 + size) };
            })
        },
    },
    Class {
        name: "vehicle-accelerometer-axes",
        fault: "the accelerometers are turned by 90° or 180° about the vertical",
        severity: [0.005, 5.0],
        unit: "° of slope",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::moving(seed);
            bench.lean(size);
            never_harmless(bench.pair(|bench, chance| bench.accelerometer_axes = turned(chance)))
        },
    },
    Class {
        name: "vehicle-unstated-g-sensitivity",
        fault: "a g-sensitivity of the gyros that no key states",
        severity: [0.01, 3.0],
        unit: "of the bias's σ, per g",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let size = size * bench.gyro().bias_sigma_deg_h;
                for gyro in &mut bench.day.vehicle.gyros {
                    gyro.g_sensitivity_deg_h_g = [0, 1].map(|_| size * chance.normal());
                }
                bench.header.g_sensitivity_deg_h_g = None;
                bench.header.g_sensitivity_sigma_deg_h_g = None;
            })
        },
    },
    Class {
        name: "vehicle-unstated-scale",
        fault: "scale errors of the gyros that no key states",
        severity: [1e-6, 1e-3],
        unit: "",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                for gyro in &mut bench.day.vehicle.gyros {
                    gyro.scale_sigma = 0.0;
                    gyro.scale_error = size * chance.normal();
                }
                bench.header.gyro_scale_sigma = None;
            })
        },
    },
    Class {
        name: "vehicle-unstated-accelerometer-bias",
        fault: "accelerometer biases that no key states",
        severity: [0.01, 10.0],
        unit: "mg",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let accelerometer = &mut bench.day.vehicle.accelerometer;
                accelerometer.bias_sigma_m_s2 = 0.0;
                accelerometer.bias_m_s2 = [0, 1, 2].map(|_| chance.normal() * size * MILLI_G);
                bench.header.accelerometer_bias_m_s2 = None;
            })
        },
    },
    Class {
        name: "vehicle-unstated-bias",
        fault: "biases of the gyros that no key states",
        severity: [0.003, 3.0],
        unit: "°/h",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::siap(seed).pair(|bench, _| {
                bench.change_gyros(|gyro| gyro.bias_sigma_deg_h = size);
                bench.header.gyro_bias_deg_h = None;
            })
        },
    },
];

/// Axes that are turned contradict whatever moves: an azimuth that comes near the true one is luck.
fn never_harmless(pair: Pair) -> Pair {
    Pair { unchecked_deg: None, ..pair }
}

impl Bench {
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

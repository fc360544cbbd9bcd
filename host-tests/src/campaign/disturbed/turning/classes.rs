//! The faults of a platform that turns all the time, of its base, its gyro and its accelerometer.

use std::f64::consts::TAU;

use hal_mock::stage::Harmonic;
use hal_mock::temperature::TemperatureConfiguration;

use super::gyro::Drift;
use super::{Bench, DEGREE_PER_HOUR, FAULT, RATE_HZ};
use crate::campaign::disturbed::Class;
use crate::campaign::disturbed::axes::TURNED;
use crate::campaign::disturbed::chance::Chance;

/// The classes of a platform that turns all the time.
pub const CLASSES: &[Class] = &[
    Class {
        name: "turning-base-tilting",
        fault: "the base tilts slowly",
        severity: [0.001, 30.0],
        unit: "°/h",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
                bench.base.rates_rad_s =
                    [0.0, cosine, sine].map(|part| part * size * DEGREE_PER_HOUR);
            })
        },
    },
    Class {
        name: "turning-base-yawing",
        fault: "the base turns slowly about the vertical",
        severity: [3e-4, 3.0],
        unit: "°/min",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                bench.base.rates_rad_s[0] = chance.sign() * size.to_radians() / 60.0;
            })
        },
    },
    Class {
        name: "turning-base-turn",
        fault: "the base turns about the vertical mid-way",
        severity: [0.003, 20.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let at = bench.some_time(chance);
                bench.base.turn = Some((at, chance.sign() * size.to_radians()));
            })
        },
    },
    Class {
        name: "turning-encoder-slip",
        fault: "the encoder slips mid-way",
        severity: [0.003, 90.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let at = bench.some_time(chance);
                bench.slips.push((at, chance.sign() * size.to_radians()));
            })
        },
    },
    Class {
        name: "turning-encoder-zero",
        fault: "the encoder has no index, no key states its zero, and it slips at the start",
        severity: [0.003, 0.6],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            bench.header.encoder_zero_sigma_deg = None;
            bench.slips.clear();
            bench.pair(|bench, chance| bench.slips.push((0.0, chance.sign() * size.to_radians())))
        },
    },
    Class {
        name: "turning-bias-steps",
        fault: "the gyro's bias steps, twice",
        severity: [0.1, 1000.0],
        unit: "σ of a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                for _ in 0..2 {
                    let at_s = bench.some_time(chance);
                    let rate = chance.sign() * size * bench.turn_sigma();
                    bench.drift.push(Drift::Step { at_s, rate });
                }
            })
        },
    },
    Class {
        name: "turning-random-walk",
        fault: "a rate random walk that no key states",
        severity: [0.1, 1000.0],
        unit: "σ of a turn, over the recording",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, _| {
                let density = size * bench.turn_sigma() / bench.seconds().sqrt();
                bench.drift.push(Drift::Walk { density });
            })
        },
    },
    Class {
        name: "turning-warm-up",
        fault: "a warm-up that no key states",
        severity: [0.1, 1000.0],
        unit: "σ of a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let rate = chance.sign() * size * bench.turn_sigma();
                let seconds = chance.scaled(0.1, 3.0) * bench.seconds();
                bench.drift.push(Drift::WarmUp { rate, seconds });
            })
        },
    },
    Class {
        name: "turning-temperature",
        fault: "the bias follows the temperature",
        severity: [0.1, 1000.0],
        unit: "σ of a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            let mut chance = Chance::new(seed, FAULT + 2);
            bench.instruments.temperature = TemperatureConfiguration {
                rise_c: chance.sign() * chance.scaled(1.0, 20.0),
                time_constant_s: chance.scaled(0.1, 3.0) * bench.seconds(),
                ..TemperatureConfiguration::default()
            };
            bench.pair(|bench, chance| {
                let rise = bench.instruments.temperature.at(bench.seconds())
                    - bench.instruments.temperature.at(0.0);
                let rate = chance.sign() * size * bench.turn_sigma();
                bench.instruments.gyro.temperature_deg_h_c = rate / rise / DEGREE_PER_HOUR;
            })
        },
    },
    Class {
        name: "turning-gyro-lag",
        fault: "the gyro lags",
        severity: [0.01, 10.0],
        unit: "s",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).pair(|bench, _| bench.gyro.lag_s = size),
    },
    Class {
        name: "turning-gyro-late",
        fault: "the gyro's column is late",
        severity: [0.02, 10.0],
        unit: "s",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).pair(|bench, _| bench.gyro.late_s = size),
    },
    Class {
        name: "turning-gyro-coarse",
        fault: "the gyro's column has coarse steps",
        severity: [0.1, 100.0],
        unit: "σ of a sample",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, _| bench.gyro.step = size * bench.sample_sigma())
        },
    },
    Class {
        name: "turning-gyro-clipped",
        fault: "the gyro's column is clipped on one side in the even turns",
        severity: [0.01, 10.0],
        unit: "of the horizontal Earth rate, below the greatest rate",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let bench = Bench::drawn(seed);
            let even = (bench.uneven_s + super::RAMP_SECONDS) * RATE_HZ;
            let rows = bench.rows();
            let rates = rows.iter().skip(even as usize).map(|row| row.rate_rad_s);
            let greatest = rates.fold(f64::MIN, f64::max);
            bench.pair(|bench, _| {
                let earth =
                    bench.instruments.latitude_deg.to_radians().cos() * 15.041 * DEGREE_PER_HOUR;
                bench.gyro.limit = Some(greatest - size * earth);
            })
        },
    },
    Class {
        name: "turning-encoder-second-harmonic",
        fault: "the encoder errs twice a turn",
        severity: [0.003, 3.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                bench.instruments.encoder.second = Harmonic {
                    amplitude_rad: size.to_radians(),
                    phase_rad: chance.between(0.0, TAU),
                };
            })
        },
    },
    Class {
        name: "turning-stage-reversed",
        fault: "the encoder counts the other way",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            let uphill = 360.0 * Chance::new(seed, FAULT).between(0.0, 1.0);
            bench.instruments = bench.instruments.leaning(size, uphill);
            bench.pair(|bench, _| bench.is_reversed = true)
        },
    },
    Class {
        name: "turning-accelerometer-axes",
        fault: "two of the accelerometer's axes are flipped together or turned by 90°",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            // As far as the Earth-rate ratio tells: what the wrong axes add lies along the Earth rate.
            let mut bench = Bench::drawn(seed);
            let mut chance = Chance::new(seed, FAULT);
            let [flipped, right, left] = TURNED;
            let (axes, turn) = chance.one_of(&[(flipped, 0.0), (right, -45.0), (left, 45.0)]);
            let aside = chance.sign() * chance.between(25.0, 40.0);
            let along = -bench.instruments.azimuth_deg + turn + aside;
            bench.instruments = bench.instruments.leaning(size, along);
            let scale_sigma = chance.scaled(1e-5, 1e-4);
            bench.instruments.gyro.scale_sigma = scale_sigma;
            bench.header.gyro_scale_sigma = Some(scale_sigma);
            bench.pair(|bench, _| bench.axes = axes)
        },
    },
    Class {
        name: "turning-period",
        fault: "the header's rate is not that of the times",
        severity: [0.0001, 2.0],
        unit: "of the rate",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Bench::drawn(seed).pair(|bench, chance| {
                let wrong = if chance.happens(0.5) { 1.0 + size } else { 1.0 / (1.0 + size) };
                bench.header.rate_hz = Some(RATE_HZ * wrong);
            })
        },
    },
    Class {
        name: "turning-unstated-g-sensitivity",
        fault: "a g-sensitivity that no key states",
        severity: [0.01, 4.0],
        unit: "times 50 000 °/h/g for each (°/√h)² of N",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            bench.header.g_sensitivity_deg_h_g = None;
            bench.header.g_sensitivity_sigma_deg_h_g = None;
            bench.pair(|bench, chance| {
                let (sine, cosine) = chance.between(0.0, TAU).sin_cos();
                let n = bench.instruments.gyro.n_deg_sqrt_h;
                let size = (size * 50_000.0 * n * n).min(212.0);
                bench.instruments.gyro.g_sensitivity_deg_h_g = [size * cosine, size * sine];
            })
        },
    },
    Class {
        name: "turning-unstated-scale",
        fault: "a scale error that no key states",
        severity: [0.0001, 0.05],
        unit: "",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            bench.header.gyro_scale_sigma = None;
            bench.instruments.gyro.scale_sigma = 0.0;
            bench.pair(|bench, chance| {
                bench.instruments.gyro.scale_error = chance.sign() * size;
            })
        },
    },
    Class {
        name: "turning-unstated-accelerometer-bias",
        fault: "accelerometer biases that no key states",
        severity: [0.1, 100.0],
        unit: "mg",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            bench.header.accelerometer_bias_m_s2 = None;
            bench.instruments.accelerometer.bias_sigma_m_s2 = 0.0;
            bench.pair(|bench, chance| {
                bench.instruments.accelerometer.bias_m_s2 =
                    [0, 1, 2].map(|_| chance.sign() * size * 9.81e-3);
            })
        },
    },
];

//! The faults of a platform that turns all the time, of its base, its gyro and its accelerometer.

use super::{Bench, RAMP_SECONDS};
use crate::campaign::disturbed::chance::Chance;
use crate::campaign::disturbed::unit::Rig;
use crate::campaign::disturbed::{Class, faults};

/// The classes of a platform that turns all the time.
pub const CLASSES: &[Class] = &[
    Class {
        name: "turning-base-tilting",
        fault: "the base tilts slowly",
        severity: [0.001, 30.0],
        unit: "°/h",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::base_tilts, size),
    },
    Class {
        name: "turning-base-yawing",
        fault: "the base turns slowly about the vertical",
        severity: [3e-4, 3.0],
        unit: "°/min",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::base_yaws, size),
    },
    Class {
        name: "turning-base-turn",
        fault: "the base turns about the vertical mid-way",
        severity: [0.003, 20.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::base_turns, size),
    },
    Class {
        name: "turning-encoder-slip",
        fault: "the encoder slips mid-way",
        severity: [0.003, 90.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::encoder_slips, size),
    },
    Class {
        name: "turning-encoder-zero",
        fault: "the encoder has no index, no key states its zero, and it slips at the start",
        severity: [0.003, 0.6],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            bench.unit.header.encoder_zero_sigma_deg = None;
            bench.unit.slips.clear();
            bench.with(zero_is_off, size)
        },
    },
    Class {
        name: "turning-bias-steps",
        fault: "the gyro's bias steps, twice",
        severity: [0.1, 1000.0],
        unit: "σ of a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::bias_steps, size),
    },
    Class {
        name: "turning-random-walk",
        fault: "a rate random walk that no key states",
        severity: [0.1, 1000.0],
        unit: "σ of a turn, over the recording",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::bias_walks, size),
    },
    Class {
        name: "turning-warm-up",
        fault: "a warm-up that no key states",
        severity: [0.1, 1000.0],
        unit: "σ of a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_warms_up, size),
    },
    Class {
        name: "turning-temperature",
        fault: "the bias follows the temperature",
        severity: [0.1, 1000.0],
        unit: "σ of a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            faults::warm(&mut bench, 0.0);
            bench.with(faults::bias_follows_temperature, size)
        },
    },
    Class {
        name: "turning-gyro-lag",
        fault: "the gyro lags",
        severity: [0.01, 10.0],
        unit: "s",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_lags, size),
    },
    Class {
        name: "turning-gyro-late",
        fault: "the gyro's column is late",
        severity: [0.02, 10.0],
        unit: "s",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_is_late, size),
    },
    Class {
        name: "turning-gyro-coarse",
        fault: "the gyro's column has coarse steps",
        severity: [0.1, 100.0],
        unit: "σ of a sample",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_is_coarse, size),
    },
    Class {
        name: "turning-gyro-clipped",
        fault: "the gyro's column is clipped on one side in the even turns",
        severity: [0.01, 10.0],
        unit: "of the horizontal Earth rate, below the greatest rate",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let bench = Bench::drawn(seed);
            let even = (bench.uneven_s + RAMP_SECONDS) * Bench::RATE_HZ;
            let rows = bench.rows();
            let rates = rows.iter().skip(even as usize).map(|row| row.rate_rad_s);
            bench.with(|bench, _, size| faults::gyro_clips(bench, size, rates), size)
        },
    },
    Class {
        name: "turning-encoder-second-harmonic",
        fault: "the encoder errs twice a turn",
        severity: [0.003, 3.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::encoder_errs_twice, size),
    },
    Class {
        name: "turning-stage-reversed",
        fault: "the encoder counts the other way",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        draw: |seed, size| faults::encoder_reversed(Bench::drawn(seed), size),
    },
    Class {
        name: "turning-accelerometer-axes",
        fault: "two of the accelerometer's axes are flipped together or turned by 90°",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        // Nothing tells them where the sensor's gain is not known.
        draw: |seed, size| faults::accelerometer_axes(Bench::with_gyro(seed), size),
    },
    Class {
        name: "turning-period",
        fault: "the header's rate is not that of the times",
        severity: [0.0001, 2.0],
        unit: "of the rate",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::period_is_wrong, size),
    },
    Class {
        name: "turning-unstated-g-sensitivity",
        fault: "a g-sensitivity that no key states",
        severity: [0.01, 4.0],
        unit: "times 50 000 °/h/g for each (°/√h)² of N",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::drawn(seed);
            faults::leave_g_sensitivity_unsaid(&mut bench);
            bench.with(faults::g_sensitivity, size)
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
            faults::leave_scale_unsaid(&mut bench);
            bench.with(faults::scale, size)
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
            faults::leave_accelerometer_bias_unsaid(&mut bench);
            bench.with(faults::accelerometer_bias, size)
        },
    },
];

/// The encoder slipped before the platform turned, °.
fn zero_is_off(bench: &mut Bench, chance: &mut Chance, size: f64) {
    bench.unit.slips.push((0.0, chance.sign() * size.to_radians()));
}

//! The faults of a stage that stops, of its base, its gyro and its accelerometer.

use std::f64::consts::TAU;

use super::Bench;
use crate::campaign::disturbed::chance::Chance;
use crate::campaign::disturbed::gyro::Drift;
use crate::campaign::disturbed::unit::Rig;
use crate::campaign::disturbed::{Class, faults};

/// The classes of a stage that stops.
pub const CLASSES: &[Class] = &[
    Class {
        name: "encoder-slip",
        fault: "the encoder slips between two dwells",
        severity: [0.003, 90.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(faults::encoder_slips, size),
    },
    Class {
        name: "base-turn",
        fault: "the base turns about the vertical between two dwells",
        severity: [0.003, 20.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(faults::base_turns, size),
    },
    Class {
        name: "stage-reversed",
        fault: "the encoder counts the other way",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        draw: |seed, size| faults::encoder_reversed(Bench::drawn(seed), size),
    },
    Class {
        name: "stage-reversed-on-arc",
        fault: "the encoder counts the other way, on an arc that does not come back",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        draw: |seed, size| faults::encoder_reversed(Bench::one_way(seed), size),
    },
    Class {
        name: "base-tilting",
        fault: "the base tilts slowly",
        severity: [0.001, 30.0],
        unit: "°/h",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::base_tilts, size),
    },
    Class {
        name: "base-yawing",
        fault: "the base turns slowly about the vertical",
        severity: [3e-4, 3.0],
        unit: "°/min",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(faults::base_yaws, size),
    },
    Class {
        name: "bias-steps",
        fault: "the gyro's bias steps between two dwells, twice",
        severity: [0.1, 1000.0],
        unit: "σ of a dwell",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(faults::bias_steps, size),
    },
    Class {
        name: "random-walk",
        fault: "a rate random walk that no key states",
        severity: [0.1, 1000.0],
        unit: "σ of a dwell, over the recording",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(faults::bias_walks, size),
    },
    Class {
        name: "warm-up",
        fault: "a warm-up that no key states",
        severity: [0.1, 1000.0],
        unit: "σ of a dwell",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(faults::gyro_warms_up, size),
    },
    Class {
        name: "temperature",
        fault: "the bias follows the temperature, whose column is there",
        severity: [0.1, 1000.0],
        unit: "σ of a dwell",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut bench = Bench::on_circle(seed);
            bench.has_temperature = true;
            faults::warm(&mut bench, 0.01);
            bench.with(faults::bias_follows_temperature, size)
        },
    },
    Class {
        name: "cable-torque",
        fault: "the bias follows the angle of the cables",
        severity: [0.1, 1000.0],
        unit: "σ of a dwell, a turn",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::on_circle(seed).with(cables_pull, size),
    },
    Class {
        name: "gyro-lag",
        fault: "the gyro lags",
        severity: [0.01, 10.0],
        unit: "s",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_lags, size),
    },
    Class {
        name: "gyro-late",
        fault: "the gyro's column is late",
        severity: [0.05, 4.5],
        unit: "s",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_is_late, size),
    },
    Class {
        name: "gyro-coarse",
        fault: "the gyro's column has coarse steps",
        severity: [0.1, 100.0],
        unit: "σ of a sample",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::gyro_is_coarse, size),
    },
    Class {
        name: "gyro-clipped",
        fault: "the gyro's column is clipped on one side",
        severity: [0.01, 10.0],
        unit: "of the horizontal Earth rate, below the greatest rate",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let bench = Bench::drawn(seed);
            let rows = bench.rows();
            let rates = rows.iter().map(|row| row.rate_rad_s);
            bench.with(|bench, _, size| faults::gyro_clips(bench, size, rates), size)
        },
    },
    Class {
        name: "encoder-second-harmonic",
        fault: "the encoder errs twice a turn",
        severity: [0.003, 3.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::encoder_errs_twice, size),
    },
    Class {
        name: "accelerometer-axes",
        fault: "two of the accelerometer's axes are flipped together or turned by 90°",
        severity: [0.01, 5.0],
        unit: "° of tilt",
        wrong_allowed: 0.0,
        draw: |seed, size| faults::accelerometer_axes(Bench::drawn(seed), size),
    },
    Class {
        name: "period",
        fault: "the header's rate is not that of the times",
        severity: [0.0001, 2.0],
        unit: "of the rate",
        wrong_allowed: 0.0,
        draw: |seed, size| Bench::drawn(seed).with(faults::period_is_wrong, size),
    },
    Class {
        name: "unstated-g-sensitivity",
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
        name: "unstated-scale",
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
        name: "unstated-accelerometer-bias",
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

/// The bias follows the angle of the cables, σ of a dwell a turn.
fn cables_pull(bench: &mut Bench, chance: &mut Chance, size: f64) {
    let rate_per_rad = chance.sign() * size * bench.mean_sigma() / TAU;
    bench.unit.drift.push(Drift::Cable { rate_per_rad });
}

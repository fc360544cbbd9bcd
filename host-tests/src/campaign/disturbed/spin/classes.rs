//! The faults of the gyro and the accelerometers of a spinning body.

use std::ops::Range;

use super::{Flight, Recorded};
use crate::campaign::disturbed::chance::Chance;
use crate::campaign::disturbed::{Class, Pair};
use crate::recording::SpinRow;

/// The classes of a spinning body.
pub const CLASSES: &[Class] = &[
    Class {
        name: "spin-accelerometer-stuck",
        fault: "an accelerometer shows one value, from the start, in between or to the end",
        severity: [1e-3, 2.0],
        unit: "of the flight",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let pair = Flight::drawn(seed).pair(|recorded, chance| {
                let axis = chance.one_of(&[0, 1]);
                let stuck = recorded.stretch(size, chance);
                let dead = if chance.happens(0.3) { 0.0 } else { 1.0 };
                let shown = dead * recorded.rows[stuck.start].force_m_s2[axis];
                for row in &mut recorded.rows[stuck] {
                    row.force_m_s2[axis] = shown;
                }
            });
            // Of one force alone nothing tells which way round it goes.
            if size < 1.0 { pair } else { never_harmless(pair) }
        },
    },
    Class {
        name: "spin-first-samples-zero",
        fault: "the first samples are zero, of the forces or of everything",
        severity: [1.0, 100.0],
        unit: "samples",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Flight::drawn(seed).pair(|recorded, chance| {
                let also_gyro = chance.happens(0.5);
                for row in &mut recorded.rows[..size as usize] {
                    row.force_m_s2 = [0.0; 2];
                    row.rate_rad_s *= if also_gyro { 0.0 } else { 1.0 };
                }
            })
        },
    },
    Class {
        name: "spin-gyro-stuck",
        fault: "the gyro shows one value, from the start, in between or to the end",
        severity: [1e-3, 2.0],
        unit: "of the flight",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Flight::drawn(seed).pair(|recorded, chance| {
                let stuck = recorded.stretch(size, chance);
                let dead = if chance.happens(0.3) { 0.0 } else { 1.0 };
                let shown = dead * recorded.rows[stuck.start].rate_rad_s;
                for row in &mut recorded.rows[stuck] {
                    row.rate_rad_s = shown;
                }
            })
        },
    },
    Class {
        name: "spin-gyro-scale",
        fault: "the gyro's scale is off by more than is stated",
        severity: [1e-4, 0.1],
        unit: "",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Flight::drawn(seed).pair(|recorded, chance| {
                let scale = 1.0 + chance.sign() * size;
                for row in &mut recorded.rows {
                    row.rate_rad_s *= scale;
                }
            })
        },
    },
    Class {
        name: "spin-second-harmonic",
        fault: "the gyro's rate, or a force, has a part that goes round twice a turn",
        severity: [1e-5, 0.3],
        unit: "of the rate, of the lift",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Flight::drawn(seed).pair(|recorded, chance| {
                let phase = chance.between(0.0, std::f64::consts::TAU);
                let twice = |roll: &f64| size * (2.0 * roll + phase).cos();
                let force = chance.one_of(&[None, Some(0), Some(1)]);
                for (row, roll) in recorded.rows.iter_mut().zip(&recorded.rolls_rad) {
                    match force {
                        None => row.rate_rad_s *= 1.0 + twice(roll),
                        Some(axis) => row.force_m_s2[axis] += recorded.lift_m_s2 * twice(roll),
                    }
                }
            })
        },
    },
    Class {
        name: "spin-axis-leaning",
        fault: "an accelerometer's axis leans towards the other's",
        severity: [1e-3, 6.0],
        unit: "°",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Flight::drawn(seed).pair(|recorded, chance| {
                let axis = chance.one_of(&[0, 1]);
                let (sine, cosine) = (chance.sign() * size.to_radians()).sin_cos();
                for SpinRow { force_m_s2: force, .. } in &mut recorded.rows {
                    force[axis] = cosine * force[axis] + sine * force[1 - axis];
                }
            })
        },
    },
    Class {
        name: "spin-axis-large",
        fault: "an accelerometer shows too much, or too little",
        severity: [1e-4, 0.1],
        unit: "",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            Flight::drawn(seed).pair(|recorded, chance| {
                let axis = chance.one_of(&[0, 1]);
                let scale = 1.0 + chance.sign() * size;
                for row in &mut recorded.rows {
                    row.force_m_s2[axis] *= scale;
                }
            })
        },
    },
    Class {
        name: "spin-forces-mirrored",
        fault: "the accelerometers are swapped, or one of them is turned round",
        severity: [1.0, 300.0],
        unit: "times the noise is the lift",
        wrong_allowed: 0.0,
        draw: |seed, size| {
            let mut flight = Flight::drawn(seed);
            flight.noise_m_s2 = flight.lift_m_s2[0].1 / size;
            never_harmless(flight.pair(|recorded, chance| {
                let shown: fn([f64; 2]) -> [f64; 2] =
                    chance.one_of(&[|[y, z]| [z, y], |[y, z]| [y, -z], |[y, z]| [-y, z]]);
                for row in &mut recorded.rows {
                    row.force_m_s2 = shown(row.force_m_s2);
                }
            }))
        },
    },
];

/// Forces that go round the other way contradict the gyro: a roll that comes near the true one is luck.
fn never_harmless(pair: Pair) -> Pair {
    Pair { unchecked_deg: None, ..pair }
}

impl Recorded {
    /// Such a part of the flight: from its start, somewhere, or to its end.
    fn stretch(&self, part: f64, chance: &mut Chance) -> Range<usize> {
        let whole = self.rows.len();
        let length = ((part * whole as f64) as usize).clamp(2, whole);
        let last = whole - length;
        let from = match chance.one_of(&[0, 1, 2]) {
            0 => 0,
            1 => (chance.between(0.0, last as f64)) as usize,
            _ => last,
        };
        from..from + length
    }
}

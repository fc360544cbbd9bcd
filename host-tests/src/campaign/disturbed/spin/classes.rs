//! The faults of the gyro and the accelerometers of a spinning body.

use std::ops::Range;

use super::{Flight, Recorded};
use crate::campaign::chance::Chance;
use crate::campaign::disturbed::class::{Class, Subject};
use crate::recording::SpinRow;

/// The classes of a spinning body.
pub(super) fn classes() -> Vec<Class> {
    let mut classes = vec![accelerometer_stuck(), starts_with_zeros(), gyro_stuck()];
    classes.extend(wrong_gains());
    classes.push(mirrored());
    classes
}

fn accelerometer_stuck() -> Class {
    let fault = "an accelerometer shows one value, from the start, in between or to the end";
    let fault = Recorded::fault("accelerometer-stuck", fault, [1e-3, 2.0], "of the flight");
    fault.drawn(|seed, size| {
        let pair = Recorded::drawn(seed).pair(|recorded, chance| {
            let axis = chance.one_of(&[0, 1]);
            recorded.stick(size, chance, |row| &mut row.force_m_s2[axis]);
        });
        // Of one force alone nothing shows which way round it goes.
        if size < 1.0 { pair } else { pair.never_harmless() }
    })
}

fn starts_with_zeros() -> Class {
    let fault = "the first samples are zero, of the forces or of everything";
    Recorded::spoilt(
        "first-samples-zero",
        fault,
        [1.0, 100.0],
        "samples",
        |flight, chance, size| {
            let also_gyro = chance.happens(0.5);
            for row in &mut flight.rows[..size as usize] {
                row.force_m_s2 = [0.0; 2];
                row.rate_rad_s *= if also_gyro { 0.0 } else { 1.0 };
            }
        },
    )
}

fn gyro_stuck() -> Class {
    let fault = "the gyro shows one value, from the start, in between or to the end";
    Recorded::spoilt("gyro-stuck", fault, [1e-3, 2.0], "of the flight", |recorded, chance, size| {
        recorded.stick(size, chance, |row| &mut row.rate_rad_s);
    })
}

/// Sensors that show too much or too little, of their own axis or of another's.
fn wrong_gains() -> [Class; 4] {
    let scale = "the gyro's scale is off by more than is stated";
    let twice = "the gyro's rate, or a force, has a part that goes round twice a turn";
    let twice_unit = "of the rate, of the lift";
    let leaning = "an accelerometer's axis leans towards the other's";
    let large = "an accelerometer shows too much, or too little";
    [
        Recorded::spoilt("gyro-scale", scale, [1e-4, 0.1], "", |recorded, chance, size| {
            let scale = 1.0 + chance.sign() * size;
            recorded.rows.iter_mut().for_each(|row| row.rate_rad_s *= scale);
        }),
        Recorded::spoilt("second-harmonic", twice, [1e-5, 0.3], twice_unit, goes_round_twice),
        Recorded::spoilt("axis-leaning", leaning, [1e-3, 6.0], "°", |recorded, chance, size| {
            let axis = chance.one_of(&[0, 1]);
            let (sine, cosine) = (chance.sign() * size.to_radians()).sin_cos();
            for SpinRow { force_m_s2: force, .. } in &mut recorded.rows {
                force[axis] = cosine * force[axis] + sine * force[1 - axis];
            }
        }),
        Recorded::spoilt("axis-large", large, [1e-4, 0.1], "", |recorded, chance, size| {
            let axis = chance.one_of(&[0, 1]);
            let scale = 1.0 + chance.sign() * size;
            recorded.rows.iter_mut().for_each(|row| row.force_m_s2[axis] *= scale);
        }),
    ]
}

fn goes_round_twice(recorded: &mut Recorded, chance: &mut Chance, size: f64) {
    let phase = chance.between(0.0, std::f64::consts::TAU);
    let twice = |roll: &f64| size * (2.0 * roll + phase).cos();
    let force = chance.one_of(&[None, Some(0), Some(1)]);
    for (row, roll) in recorded.rows.iter_mut().zip(&recorded.rolls_rad) {
        match force {
            None => row.rate_rad_s *= 1.0 + twice(roll),
            Some(axis) => row.force_m_s2[axis] += recorded.lift_m_s2 * twice(roll),
        }
    }
}

fn mirrored() -> Class {
    let fault = "the accelerometers are swapped, or one of them is turned round";
    let unit = "times the noise is the lift";
    Recorded::fault("forces-mirrored", fault, [1.0, 300.0], unit).drawn(|seed, size| {
        let mut flight = Flight::drawn(seed);
        flight.noise_m_s2 = flight.lift_m_s2[0].1 / size;
        let pair = flight.recorded().pair(|recorded, chance| {
            let shown: fn([f64; 2]) -> [f64; 2] =
                chance.one_of(&[|[y, z]| [z, y], |[y, z]| [y, -z], |[y, z]| [-y, z]]);
            for row in &mut recorded.rows {
                row.force_m_s2 = shown(row.force_m_s2);
            }
        });
        // Forces that go round the other way contradict the gyro.
        pair.never_harmless()
    })
}

impl Recorded {
    /// Lets a column show one value, or zero, for such a part of the flight.
    fn stick(&mut self, part: f64, chance: &mut Chance, column: impl Fn(&mut SpinRow) -> &mut f64) {
        let stuck = self.stretch(part, chance);
        let dead = if chance.happens(0.3) { 0.0 } else { 1.0 };
        let shown = dead * *column(&mut self.rows[stuck.start]);
        self.rows[stuck].iter_mut().for_each(|row| *column(row) = shown);
    }

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

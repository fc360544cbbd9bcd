//! The faults of a stage that stops, of its base, its gyro and its accelerometer.

use std::f64::consts::TAU;

use super::Bench;
use crate::campaign::disturbed::class::{Class, Subject};
use crate::campaign::disturbed::faults;
use crate::campaign::disturbed::gyro::Drift;
use crate::campaign::disturbed::unit::Rig;

/// The classes of a stage that stops.
pub(super) fn classes() -> Vec<Class> {
    let reversed = "the encoder counts the other way";
    let on_arc = "the encoder counts the other way, on an arc that does not come back";
    let mut classes = vec![
        faults::encoder_slip::<Bench>(),
        faults::base_turn::<Bench>(),
        faults::reversed("stage-reversed", reversed, Bench::drawn),
        faults::reversed("stage-reversed-on-arc", on_arc, Bench::one_way),
    ];
    classes.extend(faults::base_moves::<Bench>());
    classes.extend(faults::drifts::<Bench>("the gyro's bias steps between two dwells, twice"));
    classes.push(faults::temperature(
        "the bias follows the temperature, whose column is there",
        |seed| Bench { has_temperature: true, ..faults::warm(Bench::on_circle(seed), 0.01) },
    ));
    classes.push(cables_pull());
    classes
        .extend(faults::columns::<Bench>([0.05, 4.5], "the gyro's column is clipped on one side"));
    classes.extend([faults::accelerometer_axes(Bench::drawn), faults::period::<Bench>()]);
    classes.extend(faults::unstated::<Bench>());
    classes
}

/// The bias follows the angle of the cables.
fn cables_pull() -> Class {
    let fault = "the bias follows the angle of the cables";
    faults::of::<Bench>("cable-torque", fault, [0.1, 1000.0], "σ of a dwell, a turn").spoils(
        Bench::on_circle,
        |bench, chance, size| {
            let rate_per_rad = chance.sign() * size * bench.mean_sigma() / TAU;
            bench.unit.drift.push(Drift::Cable { rate_per_rad });
        },
    )
}

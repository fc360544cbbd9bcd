//! The faults of a stage that stops, of its base, its gyro and its accelerometer.

use std::f64::consts::TAU;

use super::Instrument;
use crate::campaign::disturbed::class::{Class, Subject};
use crate::campaign::disturbed::faults;
use crate::campaign::disturbed::gyro::Drift;
use crate::campaign::disturbed::unit::Rig;

/// The classes of a stage that stops.
pub(super) fn classes() -> Vec<Class> {
    let reversed = "the encoder counts the other way";
    let on_arc = "the encoder counts the other way, on an arc that does not come back";
    let mut classes = vec![
        faults::encoder_slip::<Instrument>(),
        faults::base_turn::<Instrument>(),
        faults::reversed("stage-reversed", reversed, Instrument::drawn),
        faults::reversed("stage-reversed-on-arc", on_arc, Instrument::one_way),
    ];
    classes.extend(faults::base_moves::<Instrument>());
    classes.extend(faults::drifts::<Instrument>("the gyro's bias steps between two dwells, twice"));
    classes.push(faults::temperature(
        "the bias follows the temperature, whose column is there",
        |seed| Instrument {
            has_temperature: true,
            ..faults::warm(Instrument::on_circle(seed), 0.01)
        },
    ));
    classes.push(cables_pull());
    classes.extend(faults::columns::<Instrument>(
        [0.05, 4.5],
        "the gyro's column is clipped on one side",
    ));
    classes.extend([faults::accelerometer_axes(Instrument::drawn), faults::period::<Instrument>()]);
    classes.extend(faults::unstated::<Instrument>());
    classes
}

/// The bias follows the angle of the cables.
fn cables_pull() -> Class {
    let fault = "the bias follows the angle of the cables";
    Instrument::fault("cable-torque", fault, [0.1, 1000.0], "σ of a dwell, a turn").spoils(
        Instrument::on_circle,
        |rig, chance, size| {
            let rate_per_rad = chance.sign() * size * rig.mean_sigma() / TAU;
            rig.unit.drift.push(Drift::Cable { rate_per_rad });
        },
    )
}

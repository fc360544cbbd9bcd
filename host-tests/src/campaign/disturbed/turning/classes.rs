//! The faults of a platform that turns all the time, of its base, its gyro and its accelerometer.

use super::Instrument;
use crate::campaign::disturbed::class::{Class, Subject};
use crate::campaign::disturbed::faults;

/// The classes of a platform that turns all the time.
pub(super) fn classes() -> Vec<Class> {
    let clipped = "the gyro's column is clipped on one side in the even turns";
    let reversed = "the encoder counts the other way";
    let mut classes: Vec<Class> = faults::base_moves::<Instrument>().into();
    classes.extend([
        faults::base_turn::<Instrument>(),
        faults::encoder_slip::<Instrument>(),
        zero_is_off(),
    ]);
    classes.extend(faults::drifts::<Instrument>("the gyro's bias steps, twice"));
    let warm = |seed| faults::warm(Instrument::drawn(seed), 0.0);
    classes.push(faults::temperature("the bias follows the temperature", warm));
    classes.extend(faults::columns::<Instrument>([0.02, 10.0], clipped));
    classes.extend([
        faults::reversed("stage-reversed", reversed, Instrument::drawn),
        // Nothing shows them where the sensor's gain is not known.
        faults::accelerometer_axes(Instrument::with_gyro),
        faults::period::<Instrument>(),
    ]);
    classes.extend(faults::unstated::<Instrument>());
    classes
}

/// The encoder slipped before the platform turned.
fn zero_is_off() -> Class {
    let fault = "the encoder has no index, no key states its zero, and it slips at the start";
    Instrument::fault("encoder-zero", fault, [0.003, 0.6], "°").spoils(
        |seed| {
            let mut rig = Instrument::drawn(seed);
            rig.unit.header.encoder_zero_sigma_deg = None;
            rig.unit.slips.clear();
            rig
        },
        |rig, chance, size| rig.unit.slips.push((0.0, chance.sign() * size.to_radians())),
    )
}

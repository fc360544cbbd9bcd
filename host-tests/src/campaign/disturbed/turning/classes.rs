//! The faults of a platform that turns all the time, of its base, its gyro and its accelerometer.

use super::Bench;
use crate::campaign::disturbed::class::{Class, Subject};
use crate::campaign::disturbed::faults;

/// The classes of a platform that turns all the time.
pub(super) fn classes() -> Vec<Class> {
    let clipped = "the gyro's column is clipped on one side in the even turns";
    let reversed = "the encoder counts the other way";
    let mut classes: Vec<Class> = faults::base_moves::<Bench>().into();
    classes.extend([faults::base_turn::<Bench>(), faults::encoder_slip::<Bench>(), zero_is_off()]);
    classes.extend(faults::drifts::<Bench>("the gyro's bias steps, twice"));
    let warm = |seed| faults::warm(Bench::drawn(seed), 0.0);
    classes.push(faults::temperature("the bias follows the temperature", warm));
    classes.extend(faults::columns::<Bench>([0.02, 10.0], clipped));
    classes.extend([
        faults::reversed("stage-reversed", reversed, Bench::drawn),
        // Nothing tells them where the sensor's gain is not known.
        faults::accelerometer_axes(Bench::with_gyro),
        faults::period::<Bench>(),
    ]);
    classes.extend(faults::unstated::<Bench>());
    classes
}

/// The encoder slipped before the platform turned.
fn zero_is_off() -> Class {
    let fault = "the encoder has no index, no key states its zero, and it slips at the start";
    faults::of::<Bench>("encoder-zero", fault, [0.003, 0.6], "°").spoils(
        |seed| {
            let mut bench = Bench::drawn(seed);
            bench.unit.header.encoder_zero_sigma_deg = None;
            bench.unit.slips.clear();
            bench
        },
        |bench, chance, size| bench.unit.slips.push((0.0, chance.sign() * size.to_radians())),
    )
}

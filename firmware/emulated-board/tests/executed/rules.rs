//! What an image does wrong is in its report, or ends its execution.

use std::rc::Rc;

use embassy_time::Instant;
use emulated_board::image::Image;
use emulated_board::run::{Execution, Order, execute};
use emulated_board::wiring::Pin;
use emulated_board::wiring::board::{STAGE, Selects};
use emulated_board::world::World;
use firmware::platform::Platform;
use hal_mock::chip::{Select, Transaction};
use hal_mock::wires::I2cWires;

use super::support::executed::execute_in;
use super::support::images::path;
use super::support::worlds::{ADDRESS, usual};

/// A stage from its start to the measurement of its tilt; nothing is found.
fn short() -> Order {
    Order { longest: 4.0, ..Order::usual(Platform::Stage, 1) }
}

/// What a stage is reported to have done wrong in a world.
fn violations(world: World) -> String {
    execute_in(&short(), world).report.violations.join("\n")
}

#[test]
fn two_chips_that_are_selected_at_once_are_reported() {
    // The accelerometer's select line goes to the gyro's converter, too.
    const SHORTED: Selects =
        &[STAGE[0], STAGE[1], (Pin::named(b"PA15"), 0, Select::Gyro), STAGE[2], STAGE[3]];
    let found = violations(usual(Platform::Stage).with_selects(SHORTED));
    assert!(found.contains("TwoSelected { other: Accelerometer } of Gyro"), "{found:?}");
}

#[test]
fn what_was_done_to_a_chip_is_reported() {
    let world = usual(Platform::Stage);
    let too_fast = Transaction { now: Instant::MIN, hertz: 50_000_000, sent: &[0x20, 0, 0] };
    world.carrier.borrow_mut().transact(Select::Gyro, &too_fast, &mut [0; 3]);
    let found = violations(world);
    assert!(found.contains("Gyro: "), "{found:?}");
}

#[test]
fn what_was_done_to_the_imu_on_the_base_is_reported() {
    let mut base = simulated::base::rig(&simulated::executed::stage(1), None);
    let mut wires = I2cWires::new();
    assert!(wires.start(&mut base, ADDRESS, false, 3_400_000, 0), "it acknowledges");
    wires.stop(&mut base, 100_000);
    let found = violations(usual(Platform::Stage).with_base(base));
    assert!(found.contains("base: "), "{found:?}");
}

#[test]
fn a_stack_that_reaches_the_statics_is_reported() {
    let mut image = Image::read(path(Platform::Stage)).expect("an image");
    // Of 96 KB three are left.
    image.stack_end = image.stack_start - 3072;
    let world = usual(Platform::Stage);
    let ended = execute(&Rc::new(image), &short(), world, |_| (), |_| Vec::new());
    let found = ended.expect("it is executed").violations.join("\n");
    assert_eq!(found, "the stack reached the statics");
}

/// Why the execution of an image ends that begins with these instructions.
fn end(instructions: &[u16]) -> String {
    let mut image = Image::read(path(Platform::Stage)).expect("an image");
    let reset = u32::from_le_bytes(image.flash[4..8].try_into().expect("four bytes"));
    let start = (reset & !1) as usize - emulated_board::FLASH as usize;
    let bytes: Vec<u8> = instructions.iter().flat_map(|half| half.to_le_bytes()).collect();
    image.flash[start..start + bytes.len()].copy_from_slice(&bytes);
    let execution = Execution::new(&Rc::new(image), &short(), usual(Platform::Stage));
    let ended = execution.expect("the image has a log").step();
    ended.expect_err("it does what is not modelled").to_string()
}

#[test]
fn what_the_model_does_not_answer_as_the_chip_ends_the_execution_with_the_reason() {
    // MOVS r0, #0; LDR r0, [r0].
    let null = end(&[0x2000, 0x6800]);
    assert!(null.contains("a read of 0x00000000") && null.contains("null pointer"), "{null}");
    // MOVS r0, #8; LSLS r0, r0, #24; STR r0, [r0].
    let store = end(&[0x2008, 0x0600, 0x6000]);
    assert!(store.contains("0x08000000") && store.contains("a store into the program"), "{store}");
}

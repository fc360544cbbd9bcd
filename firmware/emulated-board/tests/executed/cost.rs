//! What the images need of the controller's time and memory.

use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::executed;

/// Instructions for a sample of all converters, everything that is done meanwhile included.
fn all_in(carrier: Platform) -> f64 {
    executed(carrier, 1).report.instructions_per_sample
}

#[test]
#[should_panic(expected = "between 17500 and 20000 instructions a sample on a stage takes all in, the base's IMU included")]
fn a_sample_on_a_stage_takes_4000_instructions_at_most() {
    let words = "instructions a sample on a stage takes all in, the base's IMU included";
    hold(all_in(Platform::Stage), 0.0..=4000.0, 17_500.0..=20_000.0, words);
}

#[test]
#[should_panic(expected = "between 19000 and 22000 instructions a sample on a turntable takes all in, the base's IMU included")]
fn a_sample_on_a_turntable_takes_4000_instructions_at_most() {
    let words = "instructions a sample on a turntable takes all in, the base's IMU included";
    hold(all_in(Platform::Turntable), 0.0..=4000.0, 19_000.0..=22_000.0, words);
}

#[test]
#[should_panic(expected = "between 23500 and 26500 instructions a sample of three gyros in a vehicle takes all in")]
fn a_sample_of_three_gyros_takes_8000_instructions_at_most() {
    let words = "instructions a sample of three gyros in a vehicle takes all in";
    hold(all_in(Platform::Vehicle), 0.0..=8000.0, 23_500.0..=26_500.0, words);
}

#[test]
#[should_panic(expected = "between 42000 and 46000 bytes of stack a stage takes at its deepest")]
fn the_stack_fits_twice_into_what_the_statics_leave() {
    for carrier in [Platform::TwoFrame, Platform::Turntable, Platform::Vehicle, Platform::Spin] {
        let report = &executed(carrier, 1).report;
        let left = emulated_board::RAM_BYTES as u32 - report.static_bytes;
        assert!(2 * report.stack_bytes <= left, "{carrier}: {} bytes of stack, {left} are left", report.stack_bytes);
    }
    let report = &executed(Platform::Stage, 1).report;
    let half = f64::from(emulated_board::RAM_BYTES as u32 - report.static_bytes) / 2.0;
    let stack = f64::from(report.stack_bytes);
    hold(stack, 0.0..=half, 42_000.0..=46_000.0, "bytes of stack a stage takes at its deepest");
}

//! What the images need of the controller's time and memory.

use execution::report::Report;
use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::executed;
use super::support::worlds::calibrated_two_frames;

/// Instructions for a sample of all converters, everything that is done meanwhile included.
fn all_in(report: &Report) -> f64 {
    report.instructions_per_sample.expect("it has measured")
}

#[test]
#[should_panic(
    expected = "between 11500 and 13600 instructions a sample on a stage takes all in, the base's IMU included"
)]
fn a_sample_on_a_stage_takes_4000_instructions_at_most() {
    let words = "instructions a sample on a stage takes all in, the base's IMU included";
    hold(all_in(&executed(Platform::Stage, 1).report), 0.0..=4000.0, 11_500.0..=13_600.0, words);
}

#[test]
#[should_panic(
    expected = "between 12500 and 14700 instructions a sample on a turntable takes all in, the base's IMU included"
)]
fn a_sample_on_a_turntable_takes_4000_instructions_at_most() {
    let words = "instructions a sample on a turntable takes all in, the base's IMU included";
    hold(
        all_in(&executed(Platform::Turntable, 1).report),
        0.0..=4000.0,
        12_500.0..=14_700.0,
        words,
    );
}

#[test]
#[should_panic(
    expected = "between 8200 and 9600 instructions a sample of three gyros in a vehicle takes all in"
)]
fn a_sample_of_three_gyros_takes_8000_instructions_at_most() {
    let words = "instructions a sample of three gyros in a vehicle takes all in";
    hold(all_in(&executed(Platform::Vehicle, 1).report), 0.0..=8000.0, 8_200.0..=9_600.0, words);
}

#[test]
#[should_panic(
    expected = "between 13500 and 16000 instructions a sample on two frames takes all in, the base's IMU included"
)]
fn a_sample_on_two_frames_takes_5400_instructions_at_most() {
    let words = "instructions a sample on two frames takes all in, the base's IMU included";
    hold(all_in(&calibrated_two_frames().report), 0.0..=5400.0, 13_500.0..=16_000.0, words);
}

/// Bytes of stack at the deepest, and half of what the statics leave.
fn stack(report: &Report) -> (f64, f64) {
    let left = emulated_board::RAM_BYTES as u32 - report.static_bytes;
    (report.stack_bytes.into(), f64::from(left) / 2.0)
}

#[test]
fn the_stack_fits_twice_into_what_the_statics_leave_on_a_turntable_in_a_vehicle_and_on_a_spinning_body()
 {
    for carrier in [Platform::Turntable, Platform::Vehicle, Platform::Spin] {
        let (stack, half) = stack(&executed(carrier, 1).report);
        assert!(stack <= half, "{carrier}: {stack} bytes of stack, twice {half} are left");
    }
}

#[test]
fn the_stack_fits_twice_into_what_the_statics_leave_on_a_stage() {
    let (stack, half) = stack(&executed(Platform::Stage, 1).report);
    assert!(stack <= half, "{stack} bytes of stack, twice {half} are left");
}

#[test]
fn the_stack_fits_twice_into_what_the_statics_leave_on_two_frames() {
    let (stack, half) = stack(&calibrated_two_frames().report);
    assert!(stack <= half, "{stack} bytes of stack, twice {half} are left");
}

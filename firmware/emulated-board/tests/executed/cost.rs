//! What the images need of the controller's time and memory.

use execution::report::Report;
use firmware::budget;
use firmware::platform::Platform;

use super::support::executed::{executed, sampled_fast};
use super::support::figure::within;
use super::support::worlds::calibrated_two_frames;

/// Instructions for a sample of all converters, everything that is done meanwhile included.
fn all_in(report: &Report) -> f64 {
    report.instructions_per_sample.expect("it has measured")
}

/// The goal is that of 2 000 samples a second, which the converter does not have: what each sample takes, and what each
/// second takes whatever their number, such as reading the IMU on the base, are told apart by 400 and 2 400 samples.
#[test]
fn a_sample_on_a_stage_takes_no_more_than_its_budget() {
    let executions = [executed(Platform::Stage, 1), sampled_fast(Platform::Stage)];
    let [slow, fast] = executions.map(|shown| all_in(&shown.report));
    let sample = (2400.0 * fast - 400.0 * slow) / (2400.0 - 400.0);
    let second = 400.0 * (slow - sample);
    let words = "instructions a sample takes at 2 000 a second, the base's IMU included";
    let most = budget::BOARD_STAGE_SAMPLE_INSTRUCTIONS as f64;
    within(sample + second / 2000.0, 0.0..=most, words);
    within(fast, 0.0..=most, "instructions a sample takes at 2 400 a second");
}

/// At 2 400 samples a second, as the budget of the emulator's image has it.
#[test]
fn a_sample_on_a_turntable_takes_no_more_than_its_budget() {
    let shown = sampled_fast(Platform::Turntable);
    let words = "instructions a sample on a turntable takes all in, the base's IMU included";
    let most = budget::BOARD_TURNTABLE_SAMPLE_INSTRUCTIONS as f64;
    within(all_in(&shown.report), 0.0..=most, words);
}

/// At 2 400 samples a second, as the budget of the emulator's image has it.
#[test]
fn a_sample_on_two_frames_takes_no_more_than_its_budget() {
    let shown = sampled_fast(Platform::TwoFrame);
    let words = "instructions a sample on two frames takes all in, the base's IMU included";
    let most = budget::BOARD_TWO_FRAME_SAMPLE_INSTRUCTIONS as f64;
    within(all_in(&shown.report), 0.0..=most, words);
}

/// The image of 2 400 samples a second is as sound as the usual one.
#[test]
fn nothing_is_lost_at_2400_samples_a_second() {
    for carrier in [Platform::Stage, Platform::Turntable, Platform::TwoFrame] {
        let shown = sampled_fast(carrier);
        let Report { service, false_notices, violations, azimuth_deg, truth_deg, faults, .. } =
            &shown.report;
        assert_eq!(service.map(|service| service.lost), [0; 3], "{carrier}");
        assert_eq!((false_notices.len(), violations.len(), *faults), (0, 0, 0), "{carrier}");
        let [azimuth, sigma, _] = azimuth_deg.expect("it concludes");
        let error = (azimuth - truth_deg).abs();
        assert!(error <= 3.0 * sigma, "{carrier}: {error}° at a σ of {sigma}°");
    }
}

/// At 400 samples of three gyros and an accelerometer a second.
#[test]
fn a_sample_of_three_gyros_takes_no_more_than_its_budget() {
    let words = "instructions a sample of three gyros in a vehicle takes all in";
    let most = budget::BOARD_VEHICLE_SAMPLE_INSTRUCTIONS as f64;
    within(all_in(&executed(Platform::Vehicle, 1).report), 0.0..=most, words);
}

/// At 14 400 samples of five converters a second.
#[test]
fn a_sample_of_a_spinning_body_takes_no_more_than_its_budget() {
    let words = "instructions a sample of a spinning body takes all in";
    let most = budget::BOARD_SPIN_SAMPLE_INSTRUCTIONS as f64;
    within(all_in(&executed(Platform::Spin, 1).report), 0.0..=most, words);
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

//! A spinning body, whose five converters are more than the controller can read.

use emulated_board::run::Order;
use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::executed_by;

/// The part of the conversions that is lost once all converters run, and the instructions for one that is read, at so
/// many cycles an instruction.
fn shown(cycles: f64) -> (f64, f64) {
    let shown = executed_by(&Order { cycles, ..Order::usual(Platform::Spin, 1) });
    let report = &shown.report;
    let last = shown.line("right accelerometer: identity and self-test passed").seconds;
    let made = 5.0 * 14_400.0 * (report.seconds - report.start_seconds - last);
    let read: u64 = report.service.iter().map(|service| service.read).sum();
    (1.0 - read as f64 / made, report.instructions_per_sample / 5.0)
}

#[test]
#[should_panic(
    expected = "between 0.77 and 0.82 of the conversions are lost at one cycle an instruction"
)]
fn no_conversion_is_lost_at_one_cycle_an_instruction() {
    hold(
        shown(1.0).0,
        0.0..=0.0,
        0.77..=0.82,
        "of the conversions are lost at one cycle an instruction",
    );
}

#[test]
#[should_panic(
    expected = "between 0.83 and 0.87 of the conversions are lost at 1.4 cycles an instruction"
)]
fn no_conversion_is_lost_at_1_4_cycles_an_instruction() {
    hold(
        shown(1.4).0,
        0.0..=0.0,
        0.83..=0.87,
        "of the conversions are lost at 1.4 cycles an instruction",
    );
}

/// 80 MHz, 72 000 conversions a second, 1.4 cycles an instruction: 793 instructions for each.
#[test]
#[should_panic(expected = "between 5200 and 5800 instructions a conversion takes that is read")]
fn a_conversion_takes_790_instructions_at_most() {
    hold(
        shown(1.4).1,
        0.0..=790.0,
        5200.0..=5800.0,
        "instructions a conversion takes that is read",
    );
}

//! A spinning body, whose five converters are more than the controller can read.

use emulated_board::run::Order;
use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::executed_by;

/// Conversions of a converter in a second.
const HERTZ: f64 = 14_400.0;

/// The part of the conversions that is lost once all converters run, and the instructions for one that
/// is read, at so many cycles an instruction.
fn shown(cycles: f64) -> (f64, f64) {
    let shown = executed_by(&Order { cycles, ..Order::usual(Platform::Spin, 1) });
    let report = &shown.report;
    let starts = shown.lines("identity and self-test passed").map(|entry| entry.seconds);
    let starts: Vec<_> = starts.collect();
    let last = starts.iter().copied().fold(0.0, f64::max);
    let made = starts.len() as f64 * HERTZ * (report.seconds - report.start_seconds - last);
    // What came before the last converter ran, nothing wanted.
    let unwanted: f64 = starts.iter().map(|start| HERTZ * (last - start)).sum();
    let lost: u64 = report.service.iter().map(|service| service.lost).sum();
    let lost = lost as f64 - unwanted;
    let instructions = report.instructions_per_sample * report.samples as f64;
    (lost / made, instructions / (made - lost))
}

#[test]
#[should_panic(
    expected = "between 0.73 and 0.77 of the conversions are lost at one cycle an instruction"
)]
fn no_conversion_is_lost_at_one_cycle_an_instruction() {
    hold(
        shown(1.0).0,
        0.0..=0.0,
        0.73..=0.77,
        "of the conversions are lost at one cycle an instruction",
    );
}

#[test]
#[should_panic(
    expected = "between 0.79 and 0.83 of the conversions are lost at 1.4 cycles an instruction"
)]
fn no_conversion_is_lost_at_1_4_cycles_an_instruction() {
    hold(
        shown(1.4).0,
        0.0..=0.0,
        0.79..=0.83,
        "of the conversions are lost at 1.4 cycles an instruction",
    );
}

/// 80 MHz, 72 000 conversions a second, 1.4 cycles an instruction: 793 instructions for each.
#[test]
#[should_panic(expected = "between 4100 and 4700 instructions a conversion takes that is read")]
fn a_conversion_takes_790_instructions_at_most() {
    hold(
        shown(1.4).1,
        0.0..=790.0,
        4100.0..=4700.0,
        "instructions a conversion takes that is read",
    );
}

//! A spinning body, whose five converters are more than the controller can read.

use emulated_board::run::Order;
use execution::report::Service;
use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::executed_by;

/// Converters, each of which has one conversion in a sample.
const CONVERTERS: f64 = 5.0;

/// The part of the conversions that is lost once all converters run, and the instructions for one that
/// is read, at so many cycles an instruction.
fn shown(cycles: f64) -> (f64, f64) {
    let report = &executed_by(&Order { cycles, ..Order::usual(Platform::Spin, 1) }).report;
    let [Service { read, lost, .. }, concluding, after] = report.service;
    assert_eq!([concluding, after], [Service::default(); 2], "all of it is the measurement");
    let sample = report.instructions_per_sample.expect("it has measured");
    (lost as f64 / (read + lost) as f64, sample / CONVERTERS)
}

#[test]
#[should_panic(
    expected = "between 0.66 and 0.76 of the conversions are lost at one cycle an instruction"
)]
fn no_conversion_is_lost_at_one_cycle_an_instruction() {
    hold(
        shown(1.0).0,
        0.0..=0.0,
        0.66..=0.76,
        "of the conversions are lost at one cycle an instruction",
    );
}

#[test]
#[should_panic(
    expected = "between 0.75 and 0.8 of the conversions are lost at 1.4 cycles an instruction"
)]
fn no_conversion_is_lost_at_1_4_cycles_an_instruction() {
    hold(
        shown(1.4).0,
        0.0..=0.0,
        0.75..=0.8,
        "of the conversions are lost at 1.4 cycles an instruction",
    );
}

/// 80 MHz, 72 000 conversions a second, 1.4 cycles an instruction: 793 instructions for each.
#[test]
#[should_panic(expected = "between 3000 and 3600 instructions a conversion takes that is read")]
fn a_conversion_takes_790_instructions_at_most() {
    hold(
        shown(1.4).1,
        0.0..=790.0,
        3000.0..=3600.0,
        "instructions a conversion takes that is read",
    );
}

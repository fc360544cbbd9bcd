//! A spinning body, whose five converters are read in a chain.

use emulated_board::run::Order;
use execution::report::{Report, Service};
use firmware::platform::Platform;

use super::support::executed::executed_by;

/// Converters, each of which has one conversion in a sample.
const CONVERTERS: f64 = 5.0;

/// What came of a flight at so many cycles an instruction.
fn flight(cycles: f64) -> Report {
    let report = executed_by(&Order { cycles, ..Order::usual(Platform::Spin, 1) }).report.clone();
    let [_, concluding, after] = report.service;
    assert_eq!([concluding, after], [Service::default(); 2], "all of it is the measurement");
    report
}

#[test]
fn no_conversion_is_lost_at_one_cycle_an_instruction() {
    assert_eq!(flight(1.0).service[0].lost, 0);
}

#[test]
fn no_conversion_is_lost_at_1_4_cycles_an_instruction() {
    assert_eq!(flight(1.4).service[0].lost, 0);
}

#[test]
fn no_sample_is_lost_or_noticed_to_be_wrong_at_1_4_cycles_an_instruction() {
    let Report { faults, false_notices, .. } = flight(1.4);
    assert_eq!((faults, false_notices.len()), (0, 0), "{false_notices:?}");
}

/// 64 MHz, 72 000 conversions a second, 1.4 cycles an instruction: 634 instructions for each.
#[test]
fn a_conversion_takes_630_instructions_at_most() {
    let sample = flight(1.4).instructions_per_sample.expect("it has measured");
    assert!(sample / CONVERTERS <= 630.0, "{sample} instructions a sample");
}

#[test]
fn the_roll_is_found_within_a_second() {
    let shown = executed_by(&Order::usual(Platform::Spin, 1));
    let begun = shown.line("following the roll").seconds;
    let found = shown.line("roll: locked").seconds;
    assert!(found - begun < 1.0, "it took {} s", found - begun);
}

//! What a board does that times its samples by an oscillator without a crystal.

use std::sync::Arc;

use emulated_board::controller::rcc::Oscillators;
use emulated_board::run::Order;
use firmware::platform::Platform;

use super::sound::azimuth;
use super::support::angles::distance;
use super::support::executed::{Executed, executed_by};

/// A board whose crystal is dead, with this error of the controller's oscillator, until its result.
fn with_error(carrier: Platform, msi_error: f64) -> Arc<Executed> {
    let oscillators = Oscillators { has_crystal: false, msi_error };
    executed_by(&Order { oscillators, afterwards: 0.0, ..Order::usual(carrier, 1) })
}

/// Holds that a board refuses its samples, since they seem to come every so many milliseconds, not every other number.
fn refuses(carrier: Platform, error: f64, [found, stated]: [&str; 2]) {
    let shown = with_error(carrier, error);
    shown.line(&format!("samples come every {found} ms, not every {stated} ms as stated"));
}

#[test]
fn a_vehicle_with_a_dead_crystal_aligns_by_a_clock_that_is_a_per_cent_off() {
    for error in [-0.009, 0.009] {
        let shown = with_error(Platform::Vehicle, error);
        let (azimuth, sigma) = azimuth(&shown.report);
        let off = distance(azimuth, shown.report.truth_deg);
        assert!(off <= 3.0 * sigma, "{error}: {off}° at a σ of {sigma}°");
    }
}

#[test]
fn a_vehicle_with_a_dead_crystal_refuses_samples_of_another_period_than_its_clocks_allow() {
    for (error, period) in [(-0.0124, "2.469"), (0.0124, "2.531")] {
        refuses(Platform::Vehicle, error, [period, "2.5"]);
    }
}

/// The ADS1262 runs by its own oscillator, 2 %, beside the controller's, 1 %.
#[test]
fn a_turntable_refuses_samples_of_another_period_than_its_clocks_allow() {
    refuses(Platform::Turntable, -0.035, ["2.4125", "2.5"]);
    let shown = with_error(Platform::Turntable, 0.015);
    assert_eq!(shown.lines("ms as stated").count(), 0, "{}", shown.text());
}

#[test]
fn a_spinning_body_with_a_dead_crystal_refuses_samples_of_another_period_than_its_clocks_allow() {
    refuses(Platform::Spin, -0.0124, ["0.0686", "0.0694"]);
    let shown = with_error(Platform::Spin, 0.009);
    assert_eq!(shown.lines("ms as stated").count(), 0, "{}", shown.text());
}

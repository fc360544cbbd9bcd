//! What a board does that times its samples by an oscillator without a crystal.

use std::sync::Arc;

use emulated_board::controller::rcc::Oscillators;
use emulated_board::run::Order;
use firmware::platform::Platform;

use super::sound::{azimuth, distance};
use super::support::executed::{Executed, executed_by};

/// A vehicle whose crystal is dead, with this error of the controller's oscillator, until its result.
fn with_error(msi_error: f64) -> Arc<Executed> {
    let oscillators = Oscillators { has_crystal: false, msi_error };
    executed_by(&Order { oscillators, afterwards: 0.0, ..Order::usual(Platform::Vehicle, 1) })
}

#[test]
fn a_vehicle_with_a_dead_crystal_aligns_by_a_clock_that_is_a_per_cent_off() {
    for error in [-0.009, 0.009] {
        let shown = with_error(error);
        let (azimuth, sigma) = azimuth(&shown.report);
        let off = distance(azimuth, shown.report.truth_deg);
        assert!(off <= 3.0 * sigma, "{error}: {off}° at a σ of {sigma}°");
    }
}

#[test]
fn a_vehicle_with_a_dead_crystal_refuses_samples_of_another_period_than_its_clocks_allow() {
    for (error, period) in [(-0.0124, "2.469"), (0.0124, "2.531")] {
        let outcome = with_error(error).report.outcome.clone();
        let words = format!("samples come every {period} ms, not every 2.5 ms as stated");
        assert!(outcome.contains(&words), "{error}: {outcome}");
    }
}

//! Recordings of a stage.

use host::campaign::disturbed::{PLATFORMS, classes, healthy, row};

use crate::support::campaign::{Extent, campaigns};

use super::{covered, runs};

/// The faults of a stage of which some still get past, when they are just too small to be seen: a rate of the base that
/// shifts the last heading by five σ is hardly more than its own σ.
const PASSING: [&str; 4] = ["base-tilting", "base-yawing", "bias-steps", "random-walk"];

campaigns! {
    a_fault_that_the_dwells_show_is_answered_within_its_sigma_or_refused;
    healthy_recordings_are_answered_within_their_sigma;
}

fn a_fault_that_the_dwells_show_is_answered_within_its_sigma_or_refused(extent: Extent) {
    let [stage, ..] = PLATFORMS;
    for class in (stage.classes)() {
        let found = row(&class, runs(extent), &|| ());
        let allowed = usize::from(PASSING.contains(&class.fault.name.as_str()));
        assert!(found.wrong <= allowed, "{found:?}");
        // With so few harmless runs one refusal more than a tenth is chance.
        assert!(10 * found.harmless_answered + 10 >= 9 * found.harmless, "{found:?}");
    }
}

/// Runs in which a base turns slowly: about one of fifty passes.
const SLOW_RUNS: usize = 100;

#[test]
fn a_base_that_turns_too_slowly_to_be_seen_is_reported_beside_the_azimuth_that_it_puts_off() {
    let mut wrong = 0;
    for class in classes().filter(|class| class.fault.name.ends_with("base-yawing")) {
        let found = row(&class, SLOW_RUNS, &|| ());
        assert_eq!(found.wrong_stated, found.wrong, "{found:?}");
        wrong += found.wrong;
    }
    assert!(wrong > 0, "none is wrong at all");
}

fn healthy_recordings_are_answered_within_their_sigma(extent: Extent) {
    // A fourth of them by each method.
    for found in healthy(extent.of(600).max(240), &|| ()) {
        let precision = &found.precision;
        assert!(precision.refused <= extent.count(12), "{found:?}");
        assert!(precision.worst_sigmas < 5.0, "{found:?}");
        let within = covered(extent, [6.3, 3.4, 1.2], precision.runs);
        assert!(within(precision.coverage_percent), "{found:?}");
    }
}

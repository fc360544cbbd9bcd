//! Recordings of a stage.

use bench::campaign::disturbed::{classes, healthy, row, stage};

use super::RUNS;

/// The faults of a stage of which some still get past, when they are just too small to be seen: a rate of the base that
/// shifts the last heading by five σ is hardly more than its own σ.
const PASSING: [&str; 4] = ["base-tilting", "base-yawing", "bias-steps", "random-walk"];

#[test]
fn a_fault_that_the_dwells_show_is_answered_within_its_sigma_or_refused() {
    for class in stage::CLASSES {
        let found = row(class, RUNS, &|| ());
        let allowed = usize::from(PASSING.contains(&class.name));
        assert!(found.wrong <= allowed, "{found:?}");
        // With so few harmless runs one refusal more than a tenth is chance.
        assert!(10 * found.harmless_answered + 10 >= 9 * found.harmless, "{found:?}");
    }
}

/// Runs in which a base turns slowly: about one of fifty passes.
const SLOW_RUNS: usize = 100;

#[test]
fn a_base_that_turns_too_slowly_to_be_seen_is_told_beside_the_azimuth_that_it_puts_off() {
    let mut wrong = 0;
    for class in classes().filter(|class| class.name.ends_with("base-yawing")) {
        let found = row(class, SLOW_RUNS, &|| ());
        assert_eq!(found.wrong_told, found.wrong, "{found:?}");
        wrong += found.wrong;
    }
    assert!(wrong > 0, "none is wrong at all");
}

#[test]
fn healthy_recordings_are_answered_within_their_sigma() {
    for found in healthy(600, &|| ()) {
        let precision = &found.precision;
        assert!(precision.refused * 50 <= precision.runs, "{found:?}");
        assert!(precision.worst_sigmas < 5.0, "{found:?}");
        let [one, two, three] = precision.coverage_percent;
        assert!(one > 62.0 && two > 92.0 && three > 98.5, "{found:?}");
    }
}

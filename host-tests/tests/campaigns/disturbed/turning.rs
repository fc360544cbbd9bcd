//! Recordings of a platform that turns all the time.

use host::campaign::disturbed::{PLATFORMS, row};
use host::campaign::statistics::{Answer, Precision};
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

use super::{covered, healthy, runs};

/// The faults of which some get past, when they are just too small to be seen: a base that yaws, for a tilt lets the
/// gyro feel its rate as the Earth's; and one that is turned while the platform turns back, for that looks like a lag.
const SEEN_LATE: [&str; 2] = ["turning-base-yawing", "turning-base-turn"];

campaigns! {
    a_fault_that_the_turns_show_is_answered_within_its_sigma_or_refused;
    healthy_platforms_are_answered_and_their_errors_covered;
}

fn a_fault_that_the_turns_show_is_answered_within_its_sigma_or_refused(extent: Extent) {
    let [_, turning, ..] = PLATFORMS;
    for class in (turning.classes)() {
        let found = row(&class, runs(extent), &|| ());
        let allowed = usize::from(SEEN_LATE.contains(&class.fault.name.as_str()));
        assert!(found.wrong <= allowed, "{found:?}");
        // With so few harmless runs two refusals more than a tenth are chance.
        assert!(10 * found.harmless_answered + 20 >= 9 * found.harmless, "{found:?}");
    }
}

fn healthy_platforms_are_answered_and_their_errors_covered(extent: Extent) {
    let [_, turning, ..] = PLATFORMS;
    let answers: Vec<Result<Answer, String>> =
        (1..=healthy(extent, 300) as u64).into_par_iter().map(turning.healthy).collect();
    let precision = Precision::of(&answers);
    assert!(precision.refused <= extent.count(3), "{precision:?}");
    assert!(precision.worst_sigmas < 5.0, "{precision:?}");
    let within = covered(extent, [6.3, 3.4, 1.2], precision.runs);
    assert!(within(precision.coverage_percent), "{precision:?}");
    assert!(
        precision.coverage_percent[0] < 68.3 + extent.share(7.7, 68.3, precision.runs),
        "{precision:?}"
    );
}

//! Samples are stamped when a task comes round to them, so that conversions which came in time seem to be missing or
//! late.

use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::{Executed, executed};

/// Samples that the log says are missing.
fn missing(shown: &Executed) -> u64 {
    let counts = shown
        .lines("sample(s) missing")
        .map(|entry| entry.words.split(' ').next().unwrap_or_default());
    counts.map(|count| count.parse::<u64>().expect("the line begins with their count")).sum()
}

/// Conversions that the converters lost.
fn lost(shown: &Executed) -> u64 {
    shown.report.service.iter().map(|service| service.lost).sum()
}

#[test]
#[should_panic(
    expected = "between 10 and 20 samples more than were lost are said to be missing on a stage"
)]
fn a_sample_is_missing_only_where_a_conversion_was_lost() {
    let shown = executed(Platform::Stage, 1);
    let more = missing(&shown) as f64 - lost(&shown) as f64;
    hold(
        more,
        0.0..=0.0,
        10.0..=20.0,
        "samples more than were lost are said to be missing on a stage",
    );
}

#[test]
#[should_panic(
    expected = "between 12 and 24 samples are said to come beside their time on a stage"
)]
fn no_sample_on_a_stage_comes_beside_its_time() {
    let late = executed(Platform::Stage, 1).lines("beside its time").count();
    hold(
        late as f64,
        0.0..=0.0,
        12.0..=24.0,
        "samples are said to come beside their time on a stage",
    );
}

#[test]
#[should_panic(
    expected = "between 16 and 26 samples are said to come beside their time on a turntable"
)]
fn no_sample_on_a_turntable_comes_beside_its_time() {
    let late = executed(Platform::Turntable, 1).lines("beside its time").count();
    hold(
        late as f64,
        0.0..=0.0,
        16.0..=26.0,
        "samples are said to come beside their time on a turntable",
    );
}

#[test]
#[should_panic(
    expected = "between 2 and 5 readings of a vehicle's gyros are dropped as out of step"
)]
fn converters_with_one_clock_stay_in_step() {
    let lost =
        executed(Platform::Vehicle, 1).lines("reading lost: out of step with the others").count();
    hold(
        lost as f64,
        0.0..=0.0,
        2.0..=5.0,
        "readings of a vehicle's gyros are dropped as out of step",
    );
}

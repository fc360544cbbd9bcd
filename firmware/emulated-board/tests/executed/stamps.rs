//! Samples have the time at which their conversions ended, whatever the tasks did then.

use firmware::platform::Platform;

use super::support::executed::{Executed, executed};
use super::support::figure::within;

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

/// A notice of samples that are missing is false where nothing is lost, and right where as many are.
#[test]
fn samples_that_are_said_to_be_missing_are_false_notices_but_for_those_that_every_converter_lost() {
    for (carrier, converters) in
        [(Platform::Stage, 1), (Platform::Turntable, 1), (Platform::Vehicle, 3)]
    {
        let shown = executed(carrier, 1);
        let more = missing(&shown).saturating_sub(lost(&shown) / converters);
        let told = shown.report.false_notices.get("sample(s) missing").copied();
        assert_eq!(told.unwrap_or(0), more, "{carrier}");
    }
}

#[test]
fn nothing_that_a_drive_gives_reason_for_is_a_false_notice() {
    let shown = executed(Platform::Vehicle, 1);
    shown.line("keeping: coasting");
    let words: Vec<_> = shown.report.false_notices.keys().collect();
    assert_eq!(words, [""; 0]);
}

#[test]
fn a_sample_is_missing_only_where_a_conversion_was_lost() {
    let shown = executed(Platform::Stage, 1);
    within(
        shown.report.false_notices.get("sample(s) missing").map_or(0.0, |more| *more as f64),
        0.0..=0.0,
        "samples more than were lost are said to be missing on a stage",
    );
}

#[test]
fn no_sample_on_a_stage_comes_beside_its_time() {
    let late = executed(Platform::Stage, 1).lines("beside its time").count();
    within(late as f64, 0.0..=0.0, "samples are said to come beside their time on a stage");
}

#[test]
fn no_sample_on_a_turntable_comes_beside_its_time() {
    let late = executed(Platform::Turntable, 1).lines("beside its time").count();
    within(late as f64, 0.0..=0.0, "samples are said to come beside their time on a turntable");
}

#[test]
fn converters_with_one_clock_stay_in_step() {
    let lost =
        executed(Platform::Vehicle, 1).lines("reading lost: out of step with the others").count();
    within(lost as f64, 0.0..=0.0, "readings of a vehicle's gyros are dropped as out of step");
}

//! The images at the full load of their links, one way and both ways.

use emulated_board::run::Order;
use execution::report::{Report, Service};
use firmware::budget;
use firmware::platform::Platform;
use simulated::flood::Flood;

use super::support::executed::{Executed, execute_image, execute_told, fast_image};
use super::support::figure::within;
use super::support::images::image;
use super::support::sentences::sentences;
use super::support::worlds::at_full_load;

/// Bytes that 115 200 baud bring in a millisecond, at most.
const MILLISECOND: usize = 11;

/// The image of a carrier, which is the one of 2 400 samples a second where it has such a one, and sends all that it may.
fn loaded(carrier: Platform) -> Executed {
    let image = match carrier {
        Platform::Stage | Platform::Turntable | Platform::TwoFrame => fast_image(carrier),
        Platform::Vehicle | Platform::Spin => image(carrier),
    };
    execute_image(&image, &Order::usual(carrier, 1), at_full_load(carrier), Vec::new)
}

/// Nothing was lost, and nothing said that something was wrong.
#[track_caller]
fn sound(report: &Report) {
    let Report { service, false_notices, violations, faults, resets, .. } = report;
    assert_eq!(service.map(|Service { lost, .. }| lost), [0; 3]);
    assert_eq!(
        (false_notices.len(), violations.len(), *faults),
        (0, 0, 0),
        "{false_notices:?} {violations:?}"
    );
    assert!(resets.is_empty(), "{resets:?}");
}

/// Sends all sentences ten times a second, loses nothing, and takes no more than its budget for a sample.
#[track_caller]
fn holds(carrier: Platform, most: u64) {
    let Executed { report, link, log } = loaded(carrier);
    sound(&report);
    let sample = report.instructions_per_sample.expect("it has measured");
    within(
        sample,
        0.0..=most as f64,
        &format!("instructions a sample takes on {carrier}, with all that the link may send"),
    );
    let end = log.last().map_or(0.0, |entry| entry.seconds);
    let many = sentences(link.iter().map(String::as_str), "PMRDS").len() as f64;
    assert!(many > 9.0 * (end - 3.0), "{many} states in {end} s");
}

#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn a_stage_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Stage, budget::BOARD_STAGE_SAMPLE_INSTRUCTIONS);
}

#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn a_turntable_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Turntable, budget::BOARD_TURNTABLE_SAMPLE_INSTRUCTIONS);
}

#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn two_frames_hold_their_budget_whatever_their_link_sends() {
    holds(Platform::TwoFrame, budget::BOARD_TWO_FRAME_SAMPLE_INSTRUCTIONS);
}

#[test]
fn a_vehicle_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Vehicle, budget::BOARD_VEHICLE_SAMPLE_INSTRUCTIONS);
}

#[test]
fn a_spinning_body_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Spin, budget::BOARD_SPIN_SAMPLE_INSTRUCTIONS);
}

/// Both ways at once: whoever sends without a pause has no command among it, and is answered all the same.
#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn no_carrier_loses_anything_while_its_link_is_full_both_ways() {
    for carrier in Platform::ALL {
        let mut flood = Flood::new(1);
        let told = || flood.by_ref().take(MILLISECOND).collect();
        let shown = execute_told(&Order::usual(carrier, 1), at_full_load(carrier), told);
        println!(
            "{carrier}: {:?} instructions a sample, asleep for {:?}",
            shown.report.instructions_per_sample, shown.report.idle
        );
        sound(&shown.report);
        let answers = sentences(shown.link.iter().map(String::as_str), "PMRDR");
        assert!(answers.len() > 5, "{carrier}: {} answers", answers.len());
        assert!(answers.iter().all(|fields| fields[1] == "refused"), "{carrier}: {answers:?}");
    }
}

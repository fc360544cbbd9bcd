//! What a conclusion costs: the thread computes it in one piece, while acquisition and keeper go on above it.

use firmware::platform::Platform;

use super::support::executed::{Executed, executed};
use super::support::figure::within;
use super::support::sentences::sentences;
use super::support::worlds::calibrated_two_frames;

/// Conversions that were lost from the last step of the measurement to the result. The probe, which looks while the
/// core sleeps, may count the first of them to the measurement.
fn lost(shown: &Executed) -> f64 {
    let [measuring, concluding, _] = shown.report.service;
    (measuring.lost + concluding.lost) as f64
}

/// The number in a field of the latest sentence of an address.
fn shown_last(shown: &Executed, address: &str, field: usize) -> f64 {
    let sentences = sentences(shown.link.iter().map(String::as_str), address);
    let latest = sentences.last().expect("the link says something");
    latest[field].parse().unwrap_or_else(|_| panic!("no number in {latest:?}"))
}

#[test]
fn a_conclusion_on_a_stage_loses_no_conversion() {
    within(
        lost(&executed(Platform::Stage, 1)),
        0.0..=0.0,
        "conversions are lost to the conclusion on a stage",
    );
}

#[test]
fn a_conclusion_on_a_turntable_loses_no_conversion() {
    let lost = lost(&executed(Platform::Turntable, 1));
    within(lost, 0.0..=0.0, "conversions are lost to the conclusion on a turntable");
}

#[test]
fn a_conclusion_on_two_frames_loses_no_conversion() {
    let words = "conversions are lost to the conclusion on two frames";
    within(lost(&calibrated_two_frames()), 0.0..=0.0, words);
}

#[test]
fn a_conclusion_in_a_vehicle_loses_no_conversion() {
    let lost = executed(Platform::Vehicle, 1).report.service[1].lost as f64;
    within(lost, 0.0..=0.0, "conversions are lost to the conclusion in a vehicle");
}

#[test]
fn acquisition_does_not_wait_for_a_conclusion_on_a_stage() {
    let wait = 1e3 * executed(Platform::Stage, 1).report.service[2].longest_wait_seconds;
    within(wait, 0.0..=2.5, "ms acquisition waits for the conclusion on a stage");
}

#[test]
fn acquisition_does_not_wait_for_a_conclusion_in_a_vehicle() {
    let wait = 1e3 * executed(Platform::Vehicle, 1).report.service[2].longest_wait_seconds;
    within(wait, 0.0..=2.5, "ms acquisition waits for the conclusion in a vehicle");
}

/// The keeper has measured all motion since the last sample that the alignment uses: what it adds is the turn of the
/// base meanwhile, and of its σ.
#[test]
fn an_azimuth_that_is_handed_over_keeps_its_sigma() {
    let shown = executed(Platform::Stage, 1);
    let [_, sigma, _] = shown.report.azimuth_deg.expect("the alignment ends with an azimuth");
    let more = shown_last(&shown, "PMRDS", 1) - sigma;
    within(more, 0.0..=0.02, "° more is the σ of the azimuth that is kept on a stage");
}

#[test]
fn the_keeper_has_forces_all_the_time() {
    let count = executed(Platform::Stage, 1).lines("keeping: without forces").count();
    within(count as f64, 0.0..=0.0, "time the keeper is without forces after the result");
}

#[test]
fn the_heading_of_a_body_at_rest_is_saved_once_a_minute_at_most() {
    let rows = executed(Platform::Vehicle, 1).report.flash_use.rows as u32;
    // Twelve rows for a heading, and one that declares it void, but perhaps for the last.
    let written = rows - 11 * rows.div_ceil(13);
    let words = "times the heading of a vehicle at rest is written within ten seconds";
    within(f64::from(written), 0.0..=1.0, words);
}

/// The offset of the LSM6DSL's accelerometers, 20 mg (1σ) by its data sheet, is 1.1°: it is found by the ADXL355, which
/// turns on the platform.
#[test]
fn pitch_and_roll_of_a_base_are_within_three_sigma_of_the_truth() {
    let shown = executed(Platform::Stage, 1);
    let scenario = simulated::executed::stage(1);
    let pitch = (shown_last(&shown, "PHTRO", 0) - scenario.pitch_deg).abs();
    within(pitch, 0.0..=0.34, "° the pitch of a base is wrong, of which 0.11° are stated");
}

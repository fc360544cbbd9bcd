//! What a conclusion costs: the executor computes it in one piece, and acquisition waits.

use emulated_board::run::Order;
use firmware::platform::Platform;

use super::support::defect::hold;
use super::support::executed::{Executed, executed, executed_by};
use super::support::worlds::calibrated_two_frames;

/// Conversions that were lost from the last step of the measurement to the result. The probe, which looks while the
/// core sleeps, may count the first of them to the measurement.
fn lost(shown: &Executed) -> f64 {
    let [measuring, concluding, _] = shown.report.service;
    (measuring.lost + concluding.lost) as f64
}

/// Pitch, roll or another number of the latest status line, by the word before it.
fn shown_last(shown: &Executed, word: &str) -> f64 {
    let line = shown.link.last().expect("the link says something");
    let mut words = line.split(' ').skip_while(|found| *found != word);
    let number = words.nth(1).unwrap_or_else(|| panic!("no {word} in {line:?}"));
    number
        .trim_end_matches(',')
        .parse()
        .unwrap_or_else(|_| panic!("no number after {word} in {line:?}"))
}

#[test]
#[should_panic(expected = "between 230 and 280 conversions are lost to the conclusion on a stage")]
fn a_conclusion_on_a_stage_loses_no_conversion() {
    hold(
        lost(&executed(Platform::Stage, 1)),
        0.0..=0.0,
        230.0..=280.0,
        "conversions are lost to the conclusion on a stage",
    );
}

#[test]
#[should_panic(
    expected = "between 15 and 25 conversions are lost to the conclusion on a turntable"
)]
fn a_conclusion_on_a_turntable_loses_no_conversion() {
    let lost = lost(&executed(Platform::Turntable, 1));
    hold(lost, 0.0..=0.0, 15.0..=25.0, "conversions are lost to the conclusion on a turntable");
}

#[test]
#[should_panic(
    expected = "between 210 and 255 conversions are lost to the conclusion on two frames"
)]
fn a_conclusion_on_two_frames_loses_no_conversion() {
    let words = "conversions are lost to the conclusion on two frames";
    hold(lost(&calibrated_two_frames()), 0.0..=0.0, 210.0..=255.0, words);
}

#[test]
#[should_panic(
    expected = "between 1000 and 1150 conversions are lost to the conclusion in a vehicle"
)]
fn a_conclusion_in_a_vehicle_loses_no_conversion() {
    let lost = executed(Platform::Vehicle, 1).report.service[1].lost as f64;
    hold(lost, 0.0..=0.0, 1000.0..=1150.0, "conversions are lost to the conclusion in a vehicle");
}

#[test]
#[should_panic(expected = "between 580 and 700 ms acquisition waits for the conclusion on a stage")]
fn acquisition_does_not_wait_for_a_conclusion_on_a_stage() {
    let wait = 1e3 * executed(Platform::Stage, 1).report.service[2].longest_wait_seconds;
    hold(wait, 0.0..=2.5, 580.0..=700.0, "ms acquisition waits for the conclusion on a stage");
}

#[test]
#[should_panic(
    expected = "between 850 and 950 ms acquisition waits for the conclusion in a vehicle"
)]
fn acquisition_does_not_wait_for_a_conclusion_in_a_vehicle() {
    let wait = 1e3 * executed(Platform::Vehicle, 1).report.service[2].longest_wait_seconds;
    hold(wait, 0.0..=2.5, 850.0..=950.0, "ms acquisition waits for the conclusion in a vehicle");
}

/// The samples that the conclusion loses are a gap in the motion of the base, for which the keeper allows 0.3 of the
/// recent rate. It takes that rate as the gyros show it, with the zero-rate level of the LSM6DSL: on a base at rest.
#[test]
#[should_panic(
    expected = "between 1.1 and 1.4 ° more is the σ of the azimuth that is kept on a stage"
)]
fn an_azimuth_that_is_handed_over_keeps_its_sigma() {
    let usual = Order::usual(Platform::Stage, 1);
    let more = |cycles: f64| {
        let shown = executed_by(&Order { cycles, ..usual });
        let [_, sigma, _] = shown.report.azimuth_deg.expect("the alignment ends with an azimuth");
        let kept = shown_last(&shown, "sigma");
        (
            (kept * kept - sigma * sigma).sqrt(),
            kept - sigma,
            shown.report.service[2].longest_wait_seconds,
        )
    };
    let ((added, more, gap), (quick_added, _, quick_gap)) =
        (more(usual.cycles), more(0.5 * usual.cycles));
    let (rate, quick_rate) = (added / gap, quick_added / quick_gap);
    assert!(
        (rate / quick_rate - 1.0).abs() < 0.05,
        "{rate} and {quick_rate} °/s: not in proportion to the gap"
    );
    hold(more, 0.0..=0.02, 1.1..=1.4, "° more is the σ of the azimuth that is kept on a stage");
}

#[test]
#[should_panic(expected = "exactly 1 time the keeper is without forces after the result")]
fn the_keeper_has_forces_all_the_time() {
    let count = executed(Platform::Stage, 1).lines("keeping: without forces").count();
    hold(count as f64, 0.0..=0.0, 1.0..=1.0, "time the keeper is without forces after the result");
}

/// What is lost makes a body at rest seem to move. Its heading is then declared void, and saved again once it rests.
#[test]
#[should_panic(
    expected = "between 3 and 7 times the heading of a vehicle at rest is written within ten seconds"
)]
fn the_heading_of_a_body_at_rest_is_saved_once_a_minute_at_most() {
    let rows = executed(Platform::Vehicle, 1).report.flash_use.rows;
    let words = "times the heading of a vehicle at rest is written within ten seconds";
    hold(f64::from(rows as u32) / 11.0, 0.0..=1.0, 3.0..=7.0, words);
}

/// The image takes the accelerometers of the LSM6DSL for calibrated to 2 mg, and nothing calibrates them: their offset
/// is 20 mg (1σ) by its data sheet, which is 1.1°.
#[test]
#[should_panic(
    expected = "between 1 and 1.15 ° the pitch of a base is wrong, of which 0.11° are stated"
)]
fn pitch_and_roll_of_a_base_are_within_three_sigma_of_the_truth() {
    let shown = executed(Platform::Stage, 1);
    let scenario = simulated::executed::stage(1);
    let pitch = (shown_last(&shown, "pitch") - scenario.pitch_deg).abs();
    hold(
        pitch,
        0.0..=0.34,
        1.0..=1.15,
        "° the pitch of a base is wrong, of which 0.11° are stated",
    );
}

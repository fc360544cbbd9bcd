//! Orders to an instrument that runs.

use firmware::event::Event;
use host::instrument::Trial;
use mavlink::dialects::common::MavCmd;
use orientation::alignment::Progress;
use orientation::alignment::refusal::Refusal;
use simulated::executed;
use simulated::hold::Hold;
use simulated::scenario::Scenario;

use super::frames::{command, frame};
use super::{Typed, answers_in};
use crate::support::link::{sentences, states};

/// A stage that holds its azimuth for so long, s.
fn stage(hold_s: f64) -> Scenario {
    Scenario {
        hold: Hold::of(hold_s),
        has_base_imu: true,
        sample_rate_hz: 100.0,
        ..Scenario::usual(3)
    }
}

/// What came of the alignments of a run in which lines are sent at times, s: azimuth, or the reason for which there is none;
/// and what the link said.
fn ran(scenario: &Scenario, lines: &[(u64, &str)]) -> (Vec<Option<Refusal>>, String) {
    ran_with(scenario, &Typed::lines(lines))
}

/// The same of a run in which bytes are sent.
fn ran_with(scenario: &Scenario, typed: &Typed) -> (Vec<Option<Refusal>>, String) {
    let run = Trial::of(scenario).traffic(typed).run().expect("it begins");
    let ends = run.events.iter().filter_map(|(_, event)| match event {
        Event::Alignment(Progress::Concluded(_)) => Some(None),
        Event::Alignment(Progress::Refused(reason)) => Some(Some(*reason)),
        _ => None,
    });
    (ends.collect(), run.lines)
}

#[test]
fn an_alignment_that_is_stopped_ends_without_an_azimuth_and_begins_by_an_order_alone() {
    let (ends, lines) = ran(&stage(400.0), &[(30, "stop"), (33, "stop"), (36, "start")]);
    let answers = answers_in(&lines);
    assert_eq!(ends, [Some(Refusal::Stopped), None], "{answers:?}");
    assert_eq!(answers, ["stop,ok", "stop,refused,no alignment runs", "start,ok"]);
    assert!(states(&lines).iter().any(|state| state[0] == "failed"));
}

#[test]
fn an_alignment_that_was_ordered_to_end_is_followed_by_one_that_is_ordered_at_once() {
    let (ends, lines) = ran(&stage(200.0), &[(30, "stop\r\nstart")]);
    assert_eq!(ends, [Some(Refusal::Stopped), None]);
    assert_eq!(sentences(&lines, "PMRDR"), [["stop", "ok"], ["start", "ok"]]);
}

/// As a ground station ends the calibration of an autopilot: all parameters of the command for one are zero.
#[test]
fn an_alignment_is_stopped_by_a_calibration_of_nothing() {
    let order = command(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, [0.0; 3]);
    let (ends, lines) = ran_with(&stage(60.0), &Typed::bytes([(30, frame(&order))]));
    assert_eq!(ends, [Some(Refusal::Stopped)]);
    assert!(lines.contains("$PMRDS,failed,"), "{lines}");
}

#[test]
fn an_alignment_is_begun_anew_while_it_runs() {
    let often = [(1, "set pmrds_rate 10"), (40, "realign")];
    let (ends, lines) = ran(&stage(200.0), &often);
    assert_eq!(ends, [Some(Refusal::Stopped), None]);
    assert_eq!(sentences(&lines, "PMRDR")[1], ["realign", "ok"]);
    assert!(states(&lines).iter().all(|state| state[0] != "failed"), "none has failed");
}

#[test]
fn one_that_runs_is_not_started_once_more() {
    let (ends, lines) = ran(&stage(0.0), &[(100, "start")]);
    assert_eq!(ends, [None]);
    assert_eq!(sentences(&lines, "PMRDR"), [["start", "refused", "an alignment runs"]]);
}

/// It is of a vehicle or a ship whose heading is known, and the alignment confirms it.
#[test]
fn an_azimuth_from_outside_is_held_before_an_alignment_has_found_one() {
    let scenario = stage(10.0);
    let truth = scenario.azimuth_deg;
    let (ends, lines) = ran(&scenario, &[(60, &format!("azimuth {truth:.3} 2"))]);
    assert_eq!(ends, [None]);
    assert_eq!(sentences(&lines, "PMRDR"), [["azimuth", "ok"]]);
    let headings = sentences(&lines, "HETHS");
    let held: Vec<&Vec<&str>> = headings.iter().filter(|fields| fields[1] != "V").collect();
    assert!(held.len() > 100, "from a minute on: {}", held.len());
    for fields in held {
        let off: f64 = fields[0].parse::<f64>().expect("a heading") - truth;
        assert!(off.abs() < 6.0, "{fields:?}");
    }
}

/// One that contradicts the one before is judged, or refused: it does not take its place unseen.
#[test]
fn an_azimuth_that_comes_before_the_last_one_was_taken_is_refused() {
    let lines = [(60, "azimuth 10 2\r\nazimuth 190 2"), (61, "azimuth 190 2")];
    let (_, lines) = ran(&stage(10.0), &lines);
    let busy = "azimuth,refused,the one before is being taken";
    assert_eq!(answers_in(&lines), ["azimuth,ok", busy, "azimuth,ok"]);
}

#[test]
fn settings_that_count_from_the_next_start_on_are_not_taken_for_those_of_this_one() {
    let lines = [(100, "set dwell 5"), (110, "realign"), (120, "set hdt_rate 5")];
    let (ends, lines) = ran(&stage(0.0), &lines);
    assert_eq!(ends, [None]);
    let answers = sentences(&lines, "PMRDR");
    assert_eq!(answers[1], ["realign", "refused", "settings were changed: save and reboot"]);
    assert_eq!(answers[2], ["set", "hdt_rate", "5"]);
}

#[test]
fn the_settings_of_a_run_are_those_of_its_carrier() {
    let asked = || Typed::lines(&[(1, "get carrier"), (2, "get latitude")]);
    let asked = [asked(), asked()];
    let stage = Trial::of(&executed::stage(1)).traffic(&asked[0]).run().expect("it begins");
    let vehicle = Trial::of(&executed::vehicle(1)).traffic(&asked[1]).run().expect("it begins");
    for (carrier, lines) in [("stage", stage.lines), ("vehicle", vehicle.lines)] {
        let answers = sentences(&lines, "PMRDR");
        assert_eq!(answers, [["get", "carrier", carrier], ["get", "latitude", "47.58"]]);
    }
}

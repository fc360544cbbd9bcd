//! Which lines of the log are kept over a loss of supply, and how many.

use drivers::fault::Fault;
use firmware::event::Event;
use firmware::kept_lines::{KeptLines, Weight};
use firmware::postmortem::Outlasting;
use firmware::retry_budget::Symptom;
use firmware::storage::CONTENT;
use orientation::alignment::{Azimuth, Progress, Solution};
use orientation::device::{Device, Trouble};
use orientation::navigation;
use orientation::units::Radians;

/// A record that is known by a number.
fn record(number: u8) -> [u8; CONTENT] {
    [number; CONTENT]
}

/// Gives records until one is not taken; how many were. Each is written at once.
fn taken(lines: &KeptLines, weight: Weight) -> usize {
    let is_taken = |number| {
        let is_taken = lines.give(weight, &record(number));
        assert_eq!(lines.first(), is_taken.then(|| record(number)));
        lines.first().iter().for_each(|_| lines.drop_first());
        is_taken
    };
    (0..100).take_while(|number| is_taken(*number)).count()
}

/// Lets seconds pass.
fn pass(run: &Outlasting, seconds: usize) {
    (0..seconds).for_each(|_| run.pass_second());
}

#[test]
fn symptoms_have_half_of_the_credit_and_outcomes_the_rest() {
    let run = Outlasting::new();
    run.begin();
    assert_eq!(taken(&run.lines, Weight::Symptom), 16);
    assert_eq!(taken(&run.lines, Weight::Outcome), 16);
    assert_eq!(taken(&run.lines, Weight::Outcome), 0);
}

#[test]
fn a_minute_brings_another_record_and_a_day_not_more_than_thirty_two() {
    let run = Outlasting::new();
    run.begin();
    taken(&run.lines, Weight::Outcome);
    pass(&run, 59);
    assert_eq!(taken(&run.lines, Weight::Outcome), 0);
    pass(&run, 1);
    assert_eq!(taken(&run.lines, Weight::Outcome), 1);
    pass(&run, 86_400);
    assert_eq!(taken(&run.lines, Weight::Outcome), 32);
}

#[test]
fn what_waits_and_the_credit_outlast_a_reset_but_not_a_loss_of_supply() {
    let run = Outlasting::new();
    run.begin();
    for number in 0..3 {
        assert!(run.lines.give(Weight::Outcome, &record(number)));
    }
    run.begin();
    for number in 0..3 {
        assert_eq!(run.lines.first(), Some(record(number)));
        run.lines.drop_first();
    }
    assert_eq!(taken(&run.lines, Weight::Outcome), 29);
    let powered = Outlasting::new();
    powered.begin();
    assert_eq!(powered.lines.first(), None);
    assert_eq!(taken(&powered.lines, Weight::Outcome), 32);
}

#[test]
fn sixteen_records_may_wait_and_what_comes_then_is_counted() {
    let run = Outlasting::new();
    run.begin();
    let given = (0..20).filter(|number| run.lines.give(Weight::Outcome, &record(*number))).count();
    assert_eq!(given, 16);
    assert_eq!(run.lines.take_omitted(), None, "the credit for a line of it has yet to come");
    pass(&run, 60);
    assert_eq!(run.lines.take_omitted(), Some(4));
    assert_eq!(run.lines.take_omitted(), None);
    for number in 0..16 {
        assert_eq!(run.lines.first(), Some(record(number)));
        run.lines.drop_first();
    }
    assert_eq!(run.lines.first(), None);
}

#[test]
fn failures_and_conclusions_are_kept_and_what_goes_as_it_should_is_not() {
    let azimuth = Azimuth { angle: Radians(1.0), sigma: Radians(1e-3) };
    let solution = Solution { azimuth, limit: Radians(1e-3) };
    let symptom = Symptom::Chip(Fault::Bus);
    for (event, weight) in [
        (Event::Started(Device::Gyro), None),
        (Event::Lost(Device::Gyro, symptom), Some(Weight::Symptom)),
        (Event::Restarting(Device::Base, symptom), Some(Weight::Symptom)),
        (Event::GivenUp(Device::Stage, Trouble::Alarm), Some(Weight::Outcome)),
        (Event::Alignment(Progress::Concluded(solution)), Some(Weight::Outcome)),
        (Event::Alignment(Progress::Levelled([Radians(0.0); 2])), None),
        (Event::Navigation(navigation::Progress::AzimuthLost), Some(Weight::Outcome)),
        (Event::Navigation(navigation::Progress::Realigning), None),
    ] {
        assert_eq!(event.weight(), weight, "{event}");
    }
}

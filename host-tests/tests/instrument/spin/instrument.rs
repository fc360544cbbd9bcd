//! The instrument on a spinning body: five converters in step at 14 400 samples a second, its log, its link,
//! and every fault in the catalogue.

use crate::support::link::{sentences, states, words};
use firmware::event::Event;
use host::instrument::{SpinRun, Trial};
use host::methods::spin::errors::wrapped;
use host::methods::spin::follow;
use orientation::alignment;
use orientation::roll::Progress::{Begun, Changed, Ended, Flown, LiftBack};
use orientation::roll::{Condition, State};
use simulated::fault::{Fault, Platform};
use simulated::spin::SpinScenario;

/// The event, or the pattern of one, of a progress of the roll.
macro_rules! rolled {
    ($($progress:tt)+) => {
        Event::Alignment(alignment::Progress::Roll($($progress)+))
    };
}

fn flown(scenario: &SpinScenario, fault: Option<Fault>) -> SpinRun {
    Trial::of(scenario).fault(fault).run().unwrap_or_else(|error| panic!("{error}"))
}

/// A flight of one second.
fn short() -> SpinScenario {
    SpinScenario { seconds: 1.0, ..SpinScenario::default() }
}

/// Error of the roll at the end, rad.
fn error(run: &SpinRun) -> f64 {
    wrapped(run.replay.spin.roll().rad() - run.truth.end.roll_rad)
}

#[test]
fn it_follows_the_roll_of_a_healthy_body_and_carries_course_and_pitch_on() {
    let run = flown(&SpinScenario::default(), None);
    let flight = &run.replay;
    let sigma = flight.spin.sigma().expect("it is locked");
    assert!(error(&run).abs() < 4.0 * sigma.0, "{} {}", error(&run), sigma.0);
    assert!(sigma.degrees() < 0.3, "{sigma:?}");
    let [scale, of_scale] = flight.spin.scale().expect("two seconds tell it");
    assert!((scale - run.truth.end.gyro_scale_error[0]).abs() < 4.0 * of_scale, "{scale}");
    // More lift than weight bends the flight upwards, and nothing to the side.
    let risen = run.truth.end.flight.pitch_rad - run.truth.start.flight.pitch_rad;
    let pitch = flight.attitude.pitch.0 - risen;
    let course = wrapped(flight.attitude.course.0 - run.truth.end.flight.course_rad);
    assert!(risen.to_degrees() > 5.0, "{risen}");
    assert!(pitch.abs().to_degrees() < 0.3 && course.abs().to_degrees() < 0.3, "{pitch} {course}");
    let health = run.health;
    assert_eq!((health.faults(), run.violations.len()), (0, 0), "{health:?}");
    // Two seconds at 14 400 samples a second.
    assert!(run.truth.samples.len().abs_diff(28_800) < 10, "{}", run.truth.samples.len());
}

/// Whether an event tells that the roll has come into one of these conditions.
fn is_roll(event: &Event, of: &[Condition]) -> bool {
    matches!(event, rolled!(Changed(State { condition, .. })) if of.contains(condition))
}

#[test]
fn it_tells_when_it_locks_and_what_the_roll_was_at_the_end() {
    let run = flown(&short(), None);
    let events: Vec<Event> = run.events.iter().map(|(_, event)| *event).collect();
    assert!(events.contains(&rolled!(Begun)));
    assert!(events.iter().any(|event| is_roll(event, &[Condition::Locked])), "{events:?}");
    assert!(matches!(events.last(), Some(rolled!(Flown(_, Some(_))))), "{events:?}");
    let rolls = sentences(&run.lines, "PMRDL");
    assert!(matches!(rolls.last().map(Vec::as_slice), Some([_, _, "locked"])), "{}", run.lines);
    let states = states(&run.lines);
    assert!(matches!(states.last(), Some(["ready", .., "0", _, _, _, _])), "{}", run.lines);
}

#[test]
fn the_board_and_a_replay_of_its_samples_agree_to_the_last_bit() {
    let scenario = short();
    let run = flown(&scenario, None);
    let replay = follow(&run.truth.samples, scenario.setting(), f64::INFINITY, Vec::new());
    let end = &replay.answer().end;
    let flight = run.replay.spin;
    assert_eq!(end.roll_rad.to_bits(), flight.roll().rad().to_bits());
    assert_eq!(end.sigma_rad.map(f64::to_bits), flight.sigma().map(|sigma| sigma.0.to_bits()));
    // One seed gives one run.
    assert_eq!(flown(&scenario, None).truth.samples, run.truth.samples);
}

#[test]
fn it_holds_the_roll_while_there_is_no_lift_and_tells_when_it_is_back() {
    let run = flown(&SpinScenario::default(), Some(Fault::LiftFades));
    let events: Vec<Event> = run.events.iter().map(|(_, event)| *event).collect();
    assert!(events.iter().any(|event| is_roll(event, &[Condition::Holding])), "{events:?}");
    let back = events.iter().find_map(|event| match event {
        rolled!(LiftBack(seconds)) => Some(*seconds),
        _ => None,
    });
    assert!(back.is_some_and(|seconds| (0.2..0.6).contains(&seconds.0)), "{events:?}");
    let sigma = run.replay.spin.sigma().expect("it is back");
    assert!(error(&run).abs() < 4.0 * sigma.0);
}

#[test]
fn a_spin_that_stops_is_reported() {
    let run = flown(&SpinScenario::default(), Some(Fault::SpinStops));
    let stopped = [Condition::NotSpinning, Condition::RotationLost];
    let mut events = run.events.iter();
    assert!(events.any(|(_, event)| is_roll(event, &stopped)), "{:?}", run.events);
}

#[test]
fn no_fault_makes_a_roll_that_its_sigma_does_not_cover() {
    let scenario = short();
    for fault in Fault::all(Platform::Spin) {
        let run = flown(&scenario, Some(fault));
        let Some(sigma) = run.replay.spin.sigma() else { continue };
        // Held on the gyro alone, that is what its scale leaves.
        assert!(error(&run).abs() < 5.0 * sigma.0, "{fault}: {} {}", error(&run), sigma.0);
    }
}

#[test]
fn a_chip_that_fails_for_good_ends_the_flight_with_its_name() {
    let scenario = short();
    for fault in Fault::all(Platform::Spin).filter(|fault| {
        let name = fault.to_string();
        name.ends_with("-silent") || name.ends_with("bus-always") || name.ends_with("identity")
    }) {
        let run = flown(&SpinScenario { seconds: 3.0, ..scenario }, Some(fault));
        let ended = run.events.iter().any(|(_, event)| matches!(event, rolled!(Ended(_))));
        assert!(ended, "{fault}: {:?}", run.events.last());
        let last = words(&run.lines).pop().unwrap_or_default();
        assert!(last.starts_with("no roll: "), "{fault}: {last}");
        assert_eq!(states(&run.lines).last().expect("it is told")[0], "failed", "{fault}");
    }
}

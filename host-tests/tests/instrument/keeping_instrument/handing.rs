//! The moment of the handing over, sample by sample.

use embassy_time::Duration;
use orientation::alignment::{Azimuth, Progress, Refusal};
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::navigation::{self, Input, Motion, Navigator, Order, Output, Policy, Realignment};
use orientation::signal::InertialSample;
use orientation::units::{
    AngleIncrement, DEGREE, Instant, MetresPerSecond, Radians, RadiansPerSecond, Seconds,
    SpecificForce,
};

use super::{drive, vehicle};
use firmware::event::Event;
use simulated::hold::Hold;

/// Turn of a sample about down, rad: 10 °/s at 100 Hz.
pub const TURN: f64 = 0.1 * DEGREE;

pub fn sample(index: u64, turn: f64) -> InertialSample {
    InertialSample {
        time: Instant(index * 10_000),
        turned: [0.0, 0.0, turn].map(|angle| AngleIncrement::from_rad(angle, &mut 0.0)),
        force: Some([0.0, 0.0, -9.81].map(SpecificForce::from_m_per_s2)),
    }
}

fn gyro() -> Gyro {
    Gyro { scale_sigma: 1e-4, bias_sigma: RadiansPerSecond(1e-6), ..Gyro::default() }
}

pub fn policy() -> Policy {
    Policy {
        hold_seconds: Seconds(f64::INFINITY),
        realignment: Realignment::Never,
        knows_stops: true,
        skips_known: false,
        beside: gyro(),
        precise: gyro(),
    }
}

pub fn moved(index: u64, turn: f64) -> Input {
    Input::Motion(Motion::Moved(sample(index, turn)))
}

pub fn keeper() -> Keeper {
    let latitude = Latitude::from_degrees(45.0).expect("a latitude");
    Keeper::new(&Setting::precise(latitude, Seconds(0.01), gyro()))
}

/// The azimuth, °, after so many samples behind the session's last one, all of which waited in the queue
/// when the session's azimuth of 100° came.
fn azimuth_after(later: u64) -> f64 {
    let mut keeper = keeper();
    (1..=500).for_each(|index| keeper.push(&sample(index, 0.0)));
    let mut navigator = Navigator::new(&mut keeper, &policy());
    let azimuth =
        Azimuth { angle: Radians::from_degrees(100.0), sigma: Radians::from_degrees(0.01) };
    navigator.take(&Input::Found(Instant(505 * 10_000), azimuth), &mut |_| ());
    for index in 501..=505 + later {
        navigator.take(&moved(index, TURN), &mut |_| ());
    }
    navigator.take(&Input::Settled, &mut |_| ());
    let azimuth = keeper.report().azimuth.expect("it was handed over");
    azimuth.angle.degrees()
}

#[test]
fn what_turns_between_the_sessions_last_sample_and_the_handing_over_counts() {
    for later in [0, 1, 3, 8] {
        let azimuth = azimuth_after(later);
        let expected = 100.0 + later as f64 * 0.1;
        assert!((azimuth - expected).abs() < 2e-3, "{later} later: {azimuth}°, not {expected}°");
    }
}

#[test]
fn what_a_biased_gyro_has_turned_before_another_takes_its_place_is_free_of_its_bias() {
    let coarse = Gyro { bias_sigma: RadiansPerSecond(0.1), ..Gyro::default() };
    let latitude = Latitude::from_degrees(45.0).expect("a latitude");
    // What the Earth turns a body at rest in a sample.
    let earth = -latitude.vertical_rate().0 * 0.01;
    for later in 0..4 {
        let mut keeper = Keeper::new(&Setting::precise(latitude, Seconds(0.01), coarse));
        let last = 6000 + later;
        // At rest, with a bias of 3 °/s; then the other gyro, without any.
        (1..=last).for_each(|index| keeper.push(&sample(index, earth + 0.03 * DEGREE)));
        keeper.hand_over(azimuth(100.0, 0.01));
        keeper.exchange_down(gyro());
        (1..=500).for_each(|index| keeper.push(&sample(last + index, earth)));
        let kept = keeper.report().azimuth.expect("it is kept").angle.degrees();
        assert!((kept - 100.0).abs() < 2e-3, "{later} samples later: {kept}°");
    }
}

/// An azimuth and its 1σ, °.
pub fn azimuth(angle: f64, sigma: f64) -> Azimuth {
    Azimuth { angle: Radians::from_degrees(angle), sigma: Radians::from_degrees(sigma) }
}

/// Azimuth and σ, °, of a body that turns by 0.1° a sample, by a gyro with this error of its scale, after inputs that come
/// before samples of this turn. The first sample of the turn is the 501st.
fn turned(count: u64, scale: f64, inputs: &[(u64, Input)]) -> [f64; 2] {
    let mut keeper = keeper();
    (1..=500).for_each(|index| keeper.push(&sample(index, 0.0)));
    let mut navigator = Navigator::new(&mut keeper, &policy());
    for index in 0..=count {
        for (_, input) in inputs.iter().filter(|(at, _)| *at == index) {
            navigator.take(input, &mut |_| ());
        }
        if index < count {
            navigator.take(&moved(501 + index, TURN * (1.0 + scale)), &mut |_| ());
        }
    }
    navigator.take(&Input::Settled, &mut |_| ());
    let Azimuth { angle, sigma } = keeper.report().azimuth.expect("it is handed over");
    [angle.degrees(), sigma.degrees()]
}

/// The moment of the 500th sample, to which the azimuths of the alignments below belong.
const CONCLUDED: Instant = Instant(500 * 10_000);

#[test]
fn what_turns_while_a_conclusion_is_computed_counts_and_costs_no_less_than_it_costs_a_held_azimuth()
{
    let found = azimuth(100.0, 0.01);
    for count in [1, 10, 100, 900] {
        // The scale factor is off by its 1σ.
        let at_once = turned(count, 1e-4, &[(0, Input::Aided(None, Some(found)))]);
        let announced = (0, Input::Concluding(CONCLUDED));
        let late = turned(count, 1e-4, &[announced, (count, Input::Found(CONCLUDED, found))]);
        let turn = count as f64 * 0.1;
        assert!((late[0] - 100.0 - turn).abs() < 2e-3 + 1e-4 * turn, "{count}: {late:?}");
        // As long as north is not known, biases may contain the Earth rate.
        assert!((0.99..2.5).contains(&(late[1] / at_once[1])), "{count}: {late:?}, {at_once:?}");
    }
}

#[test]
fn an_azimuth_from_outside_while_a_conclusion_is_computed_is_fused_with_what_is_found() {
    let (found, outside) = (azimuth(100.0, 0.01), azimuth(145.0, 0.02));
    let given = (450, Input::Aided(None, Some(outside)));
    let [announced, concluded] =
        [(0, Input::Concluding(CONCLUDED)), (900, Input::Found(CONCLUDED, found))];
    let [angle, sigma] = turned(900, 0.0, &[announced, given, concluded]);
    let [_, found_alone] = turned(900, 0.0, &[announced, concluded]);
    let [_, given_alone] = turned(900, 0.0, &[given]);
    assert!((angle - 190.0).abs() < 5e-3, "{angle}°");
    // As of two azimuths that nothing connects, or worse.
    let best = (found_alone.powi(-2) + given_alone.powi(-2)).powf(-0.5);
    let alone = found_alone.min(given_alone);
    assert!((0.98 * best..=alone).contains(&sigma), "{sigma}°, {found_alone}°, {given_alone}°");
}

#[test]
fn an_azimuth_that_was_shown_and_is_withdrawn_is_shown_as_unknown() {
    let (mut keeper, mut shown) = (keeper(), Vec::new());
    let mut navigator = Navigator::new(&mut keeper, &policy());
    for index in 1..=500 {
        let mut outlet = |output| {
            if let Output::Attitude(attitude) = output {
                shown.push(attitude.azimuth.is_some());
            }
        };
        let outside = match index {
            150 => Some(100.0),
            350 => Some(130.0),
            _ => None,
        };
        let azimuth = outside.map(|it| Azimuth {
            angle: Radians::from_degrees(it),
            sigma: Radians::from_degrees(0.01),
        });
        navigator.take(&Input::Aided(None, azimuth), &mut outlet);
        navigator.take(&moved(index, 0.0), &mut outlet);
        navigator.take(&Input::Settled, &mut outlet);
    }
    shown.dedup();
    assert_eq!(shown, [false, true, false]);
}

/// Inputs from outside that cannot be used; with a velocity that cannot comes an azimuth of 100° that can.
fn unusable() -> [Input; 7] {
    let (nan, infinite, zero) = (f64::NAN, f64::INFINITY, MetresPerSecond(0.0));
    let azimuths = [(nan, 0.1), (infinite, 0.1), (100.0, nan), (100.0, 0.0), (100.0, -0.1)];
    let [a, b, c, d, e] =
        azimuths.map(|(angle, sigma)| Input::Aided(None, Some(azimuth(angle, sigma))));
    let good = Some(azimuth(100.0, 0.01));
    let [f, g] =
        [nan, infinite].map(|speed| Input::Aided(Some([zero, MetresPerSecond(speed)]), good));
    [a, b, c, d, e, f, g]
}

#[test]
fn what_is_not_finite_or_without_a_sigma_from_outside_is_told_once_and_not_used() {
    for input in unusable() {
        let follows = [input, input].into_iter().chain((3001..=3200).map(|i| moved(i, 0.0)));
        let outputs = outputs(&policy(), follows);
        let told = Output::Progress(navigation::Progress::AidingUnusable);
        assert_eq!(outputs.iter().filter(|output| **output == told).count(), 1, "{input:?}");
        let last = outputs.iter().rev().find_map(|output| match output {
            Output::Report(report) => Some(report),
            _ => None,
        });
        let last = last.expect("a report a second");
        let azimuth = last.azimuth.map(|azimuth| azimuth.angle.degrees().round());
        let is_velocity = matches!(input, Input::Aided(Some(_), _));
        assert_eq!(azimuth, is_velocity.then_some(100.0), "{input:?}");
        assert!(last.attitude.iter().all(|part| part.is_finite()), "{input:?}");
    }
}

/// A body whose precise gyro is replaced by one with another error of its scale, and which then turns once around.
#[test]
fn a_held_azimuth_has_the_errors_of_the_gyro_that_carries_it() {
    let coarse = Gyro { scale_sigma: 5e-3, ..gyro() };
    let turn = 3600.0 * 0.1 * DEGREE;
    for (first, second, scale) in [(gyro(), coarse, 5e-3), (coarse, gyro(), 1e-4)] {
        let mut keeper = keeper();
        keeper.exchange_down(first);
        (1..=500).for_each(|index| keeper.push(&sample(index, 0.0)));
        keeper.hand_over(azimuth(100.0, 0.01));
        (501..=600).for_each(|index| keeper.push(&sample(index, 0.0)));
        keeper.exchange_down(second);
        // Not even, as a bias is.
        let turned = |index: u64| TURN * (1.0 + 0.9 * (0.05 * index as f64).sin());
        (601..=4200).for_each(|index| keeper.push(&sample(index, turned(index))));
        let sigma = keeper.report().azimuth.expect("it is held").sigma.0;
        assert!((0.95..1.3).contains(&(sigma / (scale * turn))), "{sigma} of {}", scale * turn);
    }
}

#[test]
fn the_azimuth_goes_on_from_the_sessions_last_sample_without_a_gap() {
    for seed in 1..=3 {
        let found = drive(&vehicle(seed, Hold::of(5.0)));
        let concluded = found.events.iter().find_map(|(at, event)| match event {
            Event::Alignment(Progress::Concluded(solution)) => {
                Some((*at, solution.azimuth.angle.degrees()))
            }
            _ => None,
        });
        let (at, azimuth) = concluded.expect("a healthy run");
        let handed = found.events.iter().find_map(|(at, event)| match event {
            Event::Navigation(navigation::Progress::HandedOver(..)) => Some(*at),
            _ => None,
        });
        let late = handed.expect("it is handed over") - at;
        assert!(late <= Duration::from_millis(10), "{late:?}");
        // The vehicle stands: what is kept a moment later is what was found.
        let (point, [error, _]) = found.kept.with_azimuth().next().expect("it is kept");
        let truth = point.truth.azimuth_rad.to_degrees();
        let found_error = (azimuth - truth + 180.0).rem_euclid(360.0) - 180.0;
        assert!((error.to_degrees() - found_error).abs() < 0.01, "seed {seed}");
    }
}

/// Outputs of a navigator in a vehicle beside an alignment, which has samples of half a minute at rest and then what
/// follows.
fn outputs(policy: &Policy, follows: impl Iterator<Item = Input>) -> Vec<Output> {
    let (mut keeper, mut outputs) = (keeper(), Vec::new());
    let mut navigator = Navigator::new(&mut keeper, policy);
    for input in (1..=3000).map(|index| moved(index, 0.0)).chain(follows) {
        navigator.take(&input, &mut |output| outputs.push(output));
    }
    outputs
}

/// Time that passes from 30 s on without a sample, ten times a second.
fn silence() -> impl Iterator<Item = Input> {
    (1..=900).map(|tenth| Input::Passed(Instant(30_000_000 + tenth * 100_000)))
}

#[test]
fn a_body_at_rest_of_which_nothing_is_measured_any_more_has_not_set_off() {
    let policy = Policy { knows_stops: false, ..policy() };
    let failed = Output::Order(Order::Fail(Refusal::MovedDuringAlignment));
    let outputs = outputs(&policy, silence());
    assert!(outputs.contains(&Output::Progress(navigation::Progress::NoMotion)));
    assert!(!outputs.contains(&failed));
}

#[test]
fn a_body_that_sets_off_before_nothing_is_measured_any_more_has_set_off() {
    let policy = Policy { knows_stops: false, ..policy() };
    let failed = Output::Order(Order::Fail(Refusal::MovedDuringAlignment));
    let off = (3001..=3200).map(|index| moved(index, TURN));
    let later = silence().map(|input| match input {
        Input::Passed(now) => Input::Passed(Instant(now.0 + 2_000_000)),
        other => other,
    });
    assert!(outputs(&policy, off.chain(later)).contains(&failed));
}

#[test]
fn gaps_at_rest_do_not_void_the_heading_of_a_vehicle_that_is_saved() {
    let azimuth =
        Azimuth { angle: Radians::from_degrees(100.0), sigma: Radians::from_degrees(0.01) };
    let found = Input::Found(Instant(3000 * 10_000), azimuth);
    // Two and ninety samples are missing in turn, every two seconds.
    let is_missing = |index: u64| index % 400 < 90 || (200..202).contains(&(index % 400));
    let samples = (3001..=8000).filter(move |index| !is_missing(*index));
    let outputs = outputs(&policy(), [found].into_iter().chain(samples.map(|i| moved(i, 0.0))));
    let count = |is: fn(&Output) -> bool| outputs.iter().filter(|output| is(output)).count();
    assert_eq!(count(|output| matches!(output, Output::Save(_))), 1);
    assert_eq!(count(|output| matches!(output, Output::Forget)), 0);
}

//! Stops as the criteria find them on simulated days.

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Drive, Event, Leg, Stop, Vehicle};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops;
use orientation::signal::rest::Sensors;
use orientation::units::{
    ForceNoise, MetresPerSecondSquared, RadiansPerRootSecond, RadiansPerSecond, Seconds,
};

use super::assert_near;
use super::drives::two;
use super::world::{Day, Place};

/// A day whose legs are these.
pub fn day(legs: &[Leg], seed: u64) -> Day {
    let mut day = two(seed);
    day.scenario.legs = legs.iter().copied().collect();
    day
}

/// A stop on level ground.
pub fn stop(seconds: f64) -> Leg {
    Leg::Stop(Stop { seconds, pitch_deg: 1.0, roll_deg: -2.0, ..Stop::default() })
}

/// A drive as a scenario draws it.
pub fn drive(seconds: f64) -> Leg {
    let Scenario { legs, .. } = Scenario::stops(5, 2, 60.0, 6.0 * seconds);
    legs[1]
}

#[test]
fn limits_follow_the_noise_and_the_root_of_the_time() {
    // So noisy that shaking and gravity's tolerance do not matter.
    let noisy = |factor: f64| Sensors {
        angle_random_walk: RadiansPerRootSecond(1.0 * factor),
        force_noise: ForceNoise(1e4 * factor),
        ..Sensors::default()
    };
    let [short, long, twice] = [(1.0, 10.0), (1.0, 40.0), (2.0, 10.0)]
        .map(|(factor, seconds)| noisy(factor).limits(Seconds(seconds)));
    for (short, long, twice) in
        [(short.rate.0, long.rate.0, twice.rate.0), (short.force.0, long.force.0, twice.force.0)]
    {
        assert_near(short / long, 2.0, 1e-3);
        assert_near(twice / short, 2.0, 1e-3);
    }
    // Four σ of a mean: N/√T of a gyro, n/√(2T) of an accelerometer with one-sided density n.
    assert_near(short.rate.0, 4.0 / 10f64.sqrt(), 1e-3);
    assert_near(short.force.0, 4e4 / 20f64.sqrt(), 1.0);
    // Biases do not average out.
    let biased = Sensors {
        bias_sigma: RadiansPerSecond(1e-2),
        force_bias_sigma: MetresPerSecondSquared(100.0),
        ..Sensors::default()
    };
    assert_near(biased.limits(Seconds(1e6)).rate.0, 4e-2, 1e-6);
    assert_near(biased.limits(Seconds(1e6)).force.0, 400.0, 0.1);
}

#[test]
fn stops_begin_and_end_within_seconds_of_the_truth() {
    let (mut late, mut early) = ([f64::MAX, 0.0f64], [f64::MAX, 0.0f64]);
    for seed in 0..12 {
        let day = Day::new(Scenario::stops(seed, 3, 60.0, 180.0), seed);
        let outcome = day.run();
        let truth: Vec<_> = day.scenario.configuration().stops().collect();
        assert_eq!(outcome.stops.len(), truth.len(), "seed {seed}");
        for (stop, [from, to]) in outcome.stops.iter().zip(truth) {
            late = [late[0].min(stop.from.0 - from), late[1].max(stop.from.0 - from)];
            early = [early[0].min(to - stop.to.0), early[1].max(to - stop.to.0)];
        }
    }
    println!("stops begin {late:?} s after the truth and end {early:?} s before it");
    // T₀ is 3 s, and up to 7 s more in which the vehicle still rocks are no part of it; the end of a stop is not believed for
    // 2 s.
    assert!(late[0] >= 3.0 && late[1] <= 10.0, "{late:?}");
    assert!(early[0] >= 1.0 && early[1] <= 4.0, "{early:?}");
}

#[test]
fn steady_driving_is_a_stop_by_kryt2_alone_but_not_by_both() {
    let Leg::Drive(drawn) = drive(100.0) else { panic!("a drive") };
    let straight = Drive {
        seconds: 300.0,
        heading_change_deg: 0.0,
        winding_deg: 0.0,
        hills_deg: 0.0,
        vibration_m_s2: 0.5,
        ..drawn
    };
    let (mut by_force, mut by_both) = (0, 0);
    let day = day(&[stop(60.0), Leg::Drive(straight), stop(60.0)], 3);
    let mut last = 0.0;
    day.watch(
        |_| true,
        |session, time| {
            let Some((criteria, limits)) = session.criteria() else { return };
            if !(90.0..330.0).contains(&time) || time < last + 1.0 {
                return;
            }
            last = time;
            by_force += u32::from(criteria.force.0.abs() <= limits.force.0);
            by_both += u32::from(criteria.is_rest(&limits));
        },
    );
    println!("of 240 s of steady driving {by_force} are a stop by Kryt2 alone, {by_both} by both");
    assert!(by_force >= 150, "{by_force}");
    assert_eq!(by_both, 0);
}

#[test]
fn a_halt_at_a_crossing_is_no_stop_and_spoils_nothing() {
    for seconds in [10.0, 11.0, 12.0, 13.0, 14.0] {
        let outcome =
            day(&[stop(60.0), drive(200.0), stop(seconds), drive(200.0), stop(60.0)], 9).run();
        assert_eq!(outcome.stops.len(), 2, "{seconds} s");
        assert!(outcome.ratios().iter().all(|ratio| ratio.abs() < 3.5), "{seconds} s");
    }
}

/// Where the vehicle stands at its stops, north and east of the beginning, m.
fn places(day: &Day) -> Vec<[f64; 2]> {
    let configuration = day.scenario.configuration();
    let mut vehicle = Vehicle::new(&configuration, day.seed);
    let mut place_at = |[_, until]: [f64; 2]| {
        while vehicle.next().is_some_and(|sample| sample.time_s < until) {}
        vehicle.truth().displacement_m
    };
    configuration.stops().map(&mut place_at).collect()
}

#[test]
fn a_halt_too_short_for_a_stop_leaves_no_place_behind() {
    let (long, way) = (stop(60.0), drive(200.0));
    for halt in [0, 1] {
        let mut short = 0;
        for tenths in 125..=150 {
            let brief = stop(0.1 * f64::from(tenths));
            let mut legs = vec![long, way, long];
            legs.splice(2 * halt..2 * halt, [brief, way]);
            let day = Day { place: Place::Asked, ..day(&legs, 9) };
            let outcome = day.run();
            // A longer one is a stop.
            let [_, last] = &outcome.stops[..] else { continue };
            short += 1;
            let mut truth = places(&day);
            truth.remove(halt);
            let found = last.displacement.expect("the session asked where it stands");
            for axis in 0..2 {
                assert_near(found[axis].0, truth[1][axis] - truth[0][axis], 0.1);
            }
            let [_, ratio] = outcome.ratios();
            assert!(ratio.abs() < 3.5, "{tenths} tenths of a second at {halt}: {ratio} σ");
        }
        assert!(short >= 5, "{short} halts were too short");
    }
}

#[test]
fn somebody_who_gets_in_does_not_break_a_healthy_day() {
    for tenths in [1.0, 2.0, 5.0, 10.0, 100.0] {
        for at_s in [80.0 + 480.0 - 60.0, 500.0 + 20.0] {
            let mut day = day(&[stop(60.0), drive(430.0), stop(80.0)], 4);
            let (pitch_deg, roll_deg) = (0.004 * tenths, 0.01 * tenths);
            let boarding = Event::Boarding { at_s, seconds: 2.0, pitch_deg, roll_deg };
            assert!(day.scenario.events.push(boarding).is_ok());
            let outcome = day.run();
            assert!(outcome.ratios().iter().all(|ratio| ratio.abs() < 3.5), "{tenths} at {at_s} s");
        }
    }
}

#[test]
fn a_vehicle_that_sways_stands_nowhere_by_the_criteria() {
    for seed in 0..6 {
        let outcome = Day::new(Scenario::parked(seed, 300.0), seed).run();
        assert!(outcome.conclusion.verdict.is_err(), "seed {seed}");
    }
}

#[test]
fn a_vehicle_that_never_stops_stood_nowhere() {
    let outcome = day(&[drive(100.0), drive(100.0), drive(100.0)], 1).run();
    assert_eq!(outcome.conclusion.verdict, Err(Refusal::Stops(stops::Refusal::NoStop)));
}

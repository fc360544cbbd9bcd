//! The moment of the handing over, sample by sample.

use embassy_time::Duration;
use orientation::alignment::{Azimuth, Progress};
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::navigation::{self, Input, Motion, Navigator, Output, Policy, Realignment};
use orientation::signal::InertialSample;
use orientation::units::{
    AngleIncrement, DEGREE, Instant, Radians, RadiansPerSecond, Seconds, SpecificForce,
};

use super::{drive, vehicle};
use firmware::event::Event;
use simulated::hold::Hold;

/// Turn of a sample about down, rad: 10 °/s at 100 Hz.
const TURN: f64 = 0.1 * DEGREE;

fn sample(index: u64, turn: f64) -> InertialSample {
    InertialSample {
        time: Instant(index * 10_000),
        turned: [0.0, 0.0, turn].map(|angle| AngleIncrement::from_rad(angle, &mut 0.0)),
        force: Some([0.0, 0.0, -9.81].map(SpecificForce::from_m_per_s2)),
    }
}

fn gyro() -> Gyro {
    Gyro { scale_sigma: 1e-4, bias_sigma: RadiansPerSecond(1e-6), ..Gyro::default() }
}

fn policy() -> Policy {
    Policy {
        hold_seconds: Seconds(f64::INFINITY),
        realignment: Realignment::Never,
        knows_stops: true,
        skips_known: false,
        beside: gyro(),
        precise: gyro(),
    }
}

fn moved(index: u64, turn: f64) -> Input {
    Input::Motion(Motion::Moved(sample(index, turn)))
}

fn keeper() -> Keeper {
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
fn an_azimuth_that_was_shown_and_is_withdrawn_is_shown_as_unknown() {
    let (mut keeper, mut shown) = (keeper(), Vec::new());
    let mut navigator = Navigator::new(&mut keeper, &policy());
    for index in 1..=500 {
        let mut outlet = |output| {
            if let Output::Report(_, attitude) = output {
                shown.push(attitude.map(|attitude| attitude.azimuth.is_some()));
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
    assert_eq!(shown, [None, Some(true), Some(true), Some(false)]);
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

//! Lift that fades or turns round, a spin that stops, sensors that fail: the state says so, and the roll
//! comes back by itself within a bounded time.

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::sensor_fault::{SensorFailure, SensorFault};
use hal_mock::spin::profile::Profile;
use hal_mock::spin::{SpinConfiguration, SpinWorld};
use host::campaign::spin::world::{RATE_HZ, SCALE_ERROR};
use host::methods::spin::errors::wrapped;
use host::methods::spin::samples::Converter;
use orientation::roll::{Condition, Setting, Spin, State};
use orientation::units::{RadiansPerRootSecond, Seconds};

/// 80 turns a second.
const SPIN: f64 = 160.0 * std::f64::consts::PI;
/// Time in which the roll must be back after anything, s: thirty turns.
const BOUNDED_S: f64 = 0.4;

/// One sample as it was followed.
#[derive(Clone, Copy, Debug)]
struct Seen {
    time_s: f64,
    error_rad: f64,
    sigma_rad: Option<f64>,
    state: State,
}

impl Seen {
    /// Whether a stated σ covers the error: within four of them, since some hundred looks are taken.
    fn is_covered(&self) -> bool {
        self.sigma_rad.is_none_or(|sigma| self.error_rad.abs() <= 4.0 * sigma)
    }
}

/// A body on a lift of 30 m/s² with a twentieth of that as noise.
fn body<'a>() -> SpinConfiguration<'a> {
    let mut body = SpinConfiguration {
        roll_rad: 1.0,
        spin_rad_s: Profile(&[(0.0, SPIN)]),
        seconds: 1.5,
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 1.5 / (0.5 * RATE_HZ).sqrt(),
            ..AccelerometerConfiguration::default()
        },
        ..SpinConfiguration::default()
    };
    body.forces.lift_m_s2 = Profile(&[(0.0, 30.0)]);
    body.gyros[0].scale_error = SCALE_ERROR;
    body
}

/// Follows a body by its phase.
fn followed(body: &SpinConfiguration, seed: u64) -> Vec<Seen> {
    let mut world = SpinWorld::new(body, seed);
    let mut converter = Converter::new(1.0 / RATE_HZ);
    let mut spin = Spin::new(&Setting {
        angle_random_walk: RadiansPerRootSecond(1e-5),
        scale_sigma: 0.01,
        ..Setting::new(Seconds(1.0 / RATE_HZ))
    });
    let mut seen = Vec::new();
    while let Some(sample) = world.next() {
        spin.push(&converter.sample(sample.time_s, sample.rate_rad_s, sample.force_m_s2));
        seen.push(Seen {
            time_s: sample.time_s,
            error_rad: wrapped(spin.roll().rad() - world.truth().roll_rad),
            sigma_rad: spin.sigma().map(|sigma| sigma.0),
            state: spin.state(),
        });
    }
    seen
}

/// What was seen between two times, s.
fn between(seen: &[Seen], from_s: f64, to_s: f64) -> impl Iterator<Item = &Seen> {
    seen.iter().filter(move |seen| (from_s..to_s).contains(&seen.time_s))
}

/// That the roll is locked from a time on, s, and its σ true.
fn assert_back(seen: &[Seen], from_s: f64) {
    let after: Vec<&Seen> = between(seen, from_s, f64::INFINITY).collect();
    let is_good = |seen: &&&Seen| {
        seen.state.condition == Condition::Locked
            && seen.sigma_rad.is_some_and(|s| s < 0.02)
            && seen.is_covered()
    };
    assert!(after.len() > 1000);
    assert_eq!(after.iter().find(|seen| !is_good(seen)).map(|seen| format!("{seen:?}")), None);
}

/// That a state was reported between two times.
fn assert_stated(seen: &[Seen], from_s: f64, to_s: f64, is_state: impl Fn(&State) -> bool) {
    let states: Vec<_> = between(seen, from_s, to_s).map(|seen| seen.state).collect();
    assert!(states.iter().any(is_state), "{:?}", states.last());
}

#[test]
fn a_healthy_body_is_locked_after_a_tenth_of_a_second() {
    assert_back(&followed(&body(), 1), 0.15);
}

#[test]
fn quiet_accelerometers_tell_the_scale_within_its_sigma_at_any_spin() {
    for turns_per_s in [50.0, 65.0, 80.0, 100.0, 120.0] {
        let spin = [(0.0, turns_per_s * std::f64::consts::TAU)];
        let mut quiet = SpinConfiguration { spin_rad_s: Profile(&spin), ..body() };
        quiet.accelerometer.noise_m_s2_sqrt_hz = 0.01 / (0.5 * RATE_HZ).sqrt();
        assert_back(&followed(&quiet, 1), 0.2);
    }
}

#[test]
fn a_lift_that_is_gone_for_three_tenths_of_a_second_is_bridged_within_the_stated_sigma() {
    let mut body = body();
    body.forces.lift_m_s2 = Profile(&[(0.5, 30.0), (0.52, 0.0), (0.82, 0.0), (0.84, 30.0)]);
    for seed in 1..=10 {
        let seen = followed(&body, seed);
        assert_stated(&seen, 0.6, 0.82, |state| matches!(state.condition, Condition::Holding));
        let sigmas = |seen: &Seen| seen.sigma_rad.map_or(0.0, |sigma| seen.error_rad.abs() / sigma);
        let greatest = between(&seen, 0.5, 0.9).map(sigmas).fold(0.0, f64::max);
        let held = between(&seen, 0.8, 0.82).map(sigmas).fold(0.0, f64::max);
        println!("seed {seed}: {greatest:.2} σ at most, {held:.2} σ before the lift is back");
        assert!(greatest <= 3.5 && held <= 3.0, "seed {seed}: {greatest} {held}");
        assert_back(&seen, 0.84 + BOUNDED_S);
    }
}

#[test]
fn a_lift_that_turns_round_is_distinguished_from_a_body_that_did() {
    let mut body = SpinConfiguration { seconds: 1.8, ..body() };
    body.forces.lift_m_s2 = Profile(&[(0.5, 30.0), (0.55, -30.0), (1.0, -30.0), (1.05, 30.0)]);
    let seen = followed(&body, 1);
    assert!(between(&seen, 0.2, 1.5).all(Seen::is_covered));
    assert_back(&seen, 1.05 + BOUNDED_S);
}

#[test]
fn a_spin_that_stops_is_reported_and_found_again_when_it_goes_on() {
    let mut body = body();
    body.spin_rad_s = Profile(&[(0.4, SPIN), (0.45, 0.0), (0.8, 0.0), (0.85, SPIN)]);
    let seen = followed(&body, 1);
    assert_stated(&seen, 0.5, 0.95, |state| {
        matches!(state.condition, Condition::NotSpinning | Condition::RotationLost)
    });
    assert!(between(&seen, 0.2, 1.5).all(Seen::is_covered));
    assert_back(&seen, 0.85 + BOUNDED_S);
}

/// What the body shows with a fault of its sensors.
fn faulty(fault: SensorFault) -> Vec<Seen> {
    followed(&SpinConfiguration { faults: &[fault], ..body() }, 1)
}

#[test]
fn gyro_readings_that_are_no_numbers_or_clip_are_reported_and_got_over() {
    for (from_s, until_s) in [(0.5, 0.5005), (0.5, 0.505), (0.5, 0.55), (0.5, 0.8)] {
        for fault in [
            SensorFault { failure: SensorFailure::NotANumber(0), from_s, until_s },
            SensorFault { failure: SensorFailure::Saturated(0), from_s, until_s },
        ] {
            let seen = faulty(fault);
            let before = between(&seen, 0.49, 0.5).last().and_then(|seen| seen.sigma_rad);
            let after =
                between(&seen, until_s, until_s + 1e-3).next().and_then(|seen| seen.sigma_rad);
            // Either nothing is stated any more, or more doubt than before.
            assert!(after.zip(before).is_none_or(|(after, before)| after > before), "{fault:?}");
            assert_back(&seen, until_s + BOUNDED_S);
        }
    }
}

#[test]
fn forces_that_are_no_numbers_are_reported_and_the_gyro_holds_the_roll() {
    for channel in [3, 4] {
        let seen = faulty(SensorFault {
            failure: SensorFailure::NotANumber(channel),
            from_s: 0.5,
            until_s: 0.8,
        });
        assert_stated(&seen, 0.6, 0.8, |state| matches!(state.condition, Condition::ForceLost));
        assert!(between(&seen, 0.2, 1.5).all(Seen::is_covered));
        assert_back(&seen, 0.8 + BOUNDED_S);
    }
}

#[test]
fn missing_samples_are_bridged_and_cost_sigma() {
    for until_s in [0.5003, 0.502, 0.52, 0.6] {
        let seen = faulty(SensorFault { failure: SensorFailure::Gap, from_s: 0.5, until_s });
        assert!(between(&seen, 0.2, 1.5).all(Seen::is_covered), "until {until_s} s");
        let before = between(&seen, 0.49, 0.5).last().and_then(|seen| seen.sigma_rad);
        let after = between(&seen, until_s, until_s + 1e-3).next().and_then(|seen| seen.sigma_rad);
        assert!(after.zip(before).is_none_or(|(after, before)| after >= before));
        assert_back(&seen, until_s + BOUNDED_S);
    }
}

#[test]
fn an_accelerometer_that_sticks_costs_accuracy_only_while_it_does() {
    let seen = faulty(SensorFault { failure: SensorFailure::Stuck(3), from_s: 0.5, until_s: 0.8 });
    assert_back(&seen, 0.8 + BOUNDED_S);
}

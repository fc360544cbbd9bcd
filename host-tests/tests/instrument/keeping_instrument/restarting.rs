//! A device of the platform fails for good while the attitude is kept by the sensors on the base, and is tried again
//! and again: the keeper has their motion all the time.

use std::cell::Cell;

use super::reported;
use embassy_time::{Duration, Instant};
use firmware::event::Event;
use firmware::ports::{NoRecorder, Observer, Recorder};
use hal_mock::chip::Select;
use hal_mock::fault::{BusFault, FaultPlan, When};
use host::instrument::kept::KeptPlan;
use host::instrument::{Carrier, Run, Trial};
use orientation::navigation::{Input, Motion};
use orientation::signal::InertialSample;
use orientation::units;
use simulated::fault::Injection;
use simulated::hold::Hold;
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;

/// When a device fails that does not start, or amid the alignment, and how long after it, s.
const POWER_ON: f64 = 0.0;
const AMID: f64 = 40.0;
const AFTER: f64 = 60.0;
/// Longest time between two motions, µs: the eight periods of 10 ms after which a gyro counts as silent, and two of the
/// coarse sensors' outputs, of 19 ms.
const LONGEST: u64 = 120_000;
/// Longest time from power-on to the first motion, µs: the coarse sensors' self-test takes 0.7 s.
const FIRST: u64 = 800_000;

/// A stage whose base drives for half a minute and stands for a minute, in alternation.
fn stage() -> Scenario {
    let hold = Hold { drive_s: 30.0, ..Hold::of(200.0) };
    let usual =
        Scenario { positions: 8, dwell_s: 5.0, sample_rate_hz: 100.0, ..Scenario::usual(1) };
    Scenario { hold, has_base_imu: true, ..usual }
}

fn turntable() -> TurntableScenario {
    let usual = TurntableScenario::default();
    TurntableScenario { base: stage(), modulated_turns: 6, turns: 4, ..usual }
}

/// What goes wrong where every transfer of a chip fails from some time on, s.
fn dead(select: Select, from_s: f64) -> KeptPlan {
    let start = Instant::from_micros((from_s * 1e6) as u64);
    let plan = FaultPlan { fault: BusFault::Error, when: When::always(start) };
    let chips = Injection { buses: [(select, plan)].into_iter().collect(), ..Injection::NONE };
    KeptPlan { chips, ..KeptPlan::of(None) }
}

/// The keeper's motions, by their times.
#[derive(Default)]
struct Motions {
    first: Cell<Option<units::Instant>>,
    latest: Cell<Option<units::Instant>>,
    /// The longest time between two of them, µs.
    gap: Cell<u64>,
}

impl Observer for Motions {
    fn event(&self, _: Instant, _: &Event) {}

    fn navigates(&self, input: &Input) {
        if let Input::Motion(Motion::Moved(InertialSample { time, .. })) = input {
            self.first.set(self.first.get().or(Some(*time)));
            let gap = self.latest.replace(Some(*time)).map_or(0, |latest| time.0 - latest.0);
            self.gap.set(self.gap.get().max(gap));
        }
    }
}

/// Holds that a device that fails for good from some time on, s, is given up more than once, and that the keeper always
/// has motion.
fn holds_motion<C, R, T>(carrier: &C, (select, name): (Select, &str), from_s: f64)
where
    C: Carrier<Plan = KeptPlan, Run = Run<R, T>>,
    NoRecorder: Recorder<C::Sample>,
{
    let motions = Motions::default();
    let run = Trial::of(carrier).plan(dead(select, from_s)).watch(&motions).run();
    let lines = reported(&run.expect("the scenario is possible"));
    let count = |words: &str| lines.iter().filter(|line| line.contains(words)).count();
    assert_eq!(count("handed over: it is kept"), usize::from(from_s > AMID), "{lines:#?}");
    assert!(count(&format!("{name}: given up")) > 1, "{lines:#?}");
    assert_eq!(count("no motion is measured"), 0, "{lines:#?}");
    assert!(motions.gap.get() <= LONGEST, "{} µs: {lines:#?}", motions.gap.get());
    let first = motions.first.get().expect("the keeper has motion");
    assert!(first.0 <= FIRST, "{} µs: {lines:#?}", first.0);
}

/// Holds it on a stage and on a turntable, from power-on, amid the alignment and after it.
fn costs_no_motion(device: (Select, &str)) {
    let (stage, turntable) = (stage(), turntable());
    for from_s in [POWER_ON, AMID, stage.alignment_seconds() + AFTER] {
        holds_motion(&stage, device, from_s);
    }
    for from_s in [POWER_ON, AMID, turntable.alignment_seconds() + AFTER] {
        holds_motion(&turntable, device, from_s);
    }
}

#[test]
fn an_encoder_that_is_started_again_and_again_costs_the_keeper_no_motion() {
    costs_no_motion((Select::Encoder, "encoder"));
}

#[test]
fn a_gyro_that_is_started_again_and_again_costs_the_keeper_no_motion() {
    costs_no_motion((Select::Gyro, "gyro"));
}

#[test]
fn an_accelerometer_that_is_started_again_and_again_costs_the_keeper_no_motion() {
    costs_no_motion((Select::Accelerometer, "accelerometer"));
}

/// What a device does whose transfers fail for so long from some time on, s.
fn away(select: Select, from_s: f64, millis: u64) -> KeptPlan {
    let start = Instant::from_micros((from_s * 1e6) as u64);
    let when = When::during(start, Duration::from_millis(millis));
    let plan = FaultPlan { fault: BusFault::Error, when };
    let chips = Injection { buses: [(select, plan)].into_iter().collect(), ..Injection::NONE };
    KeptPlan { chips, ..KeptPlan::of(None) }
}

/// The base stops for long enough to align anew, more than once.
#[test]
fn an_alignment_that_is_begun_after_the_motor_was_given_up_is_refused_at_once() {
    let hold = Hold { realigns: true, drive_s: 30.0, stop_s: Some(60.0), ..Hold::of(300.0) };
    let stage = Scenario { hold, ..stage() };
    for from_s in [POWER_ON, AMID] {
        let run = Trial::of(&stage).plan(dead(Select::Actuator, from_s)).run();
        let lines = reported(&run.expect("the scenario is possible"));
        let begun = lines.iter().filter(|line| line.ends_with("aligning anew")).count();
        let refused = lines.iter().filter(|line| line.starts_with("no azimuth: ")).count();
        assert!(begun > 1 && refused == begun + 1, "{begun} begun, {refused} refused: {lines:#?}");
    }
}

/// No angle is read while a sensor that was given up rests, whatever moves meanwhile.
#[test]
fn an_encoder_is_not_given_up_for_the_rest_of_another_sensor() {
    let hold = Hold { drive_s: 30.0, ..Hold::of(100.0) };
    for (select, from_s) in [(Select::Accelerometer, 60.0), (Select::Gyro, 69.0)] {
        let run = super::keep(&super::frames(1, hold), &away(select, from_s, 2500));
        let lines = reported(&run);
        assert!(lines.iter().any(|line| line.contains("given up")), "{lines:#?}");
        let encoder = lines.iter().find(|line| line.contains("encoder: given up"));
        assert_eq!(encoder, None, "{select:?}: {lines:#?}");
    }
}

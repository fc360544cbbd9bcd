//! Recordings of runs: a run comes to the same result with and without one, and its replay to the same again, to the
//! last bit.

use std::fmt::Debug;
use std::path::Path;

use firmware::event::Event;
use firmware::ports::Frames;
use simulated::fault::{Fault, Platform};
use simulated::mount::FramesScenario;
use simulated::scenario::{Aim, Scenario};
use simulated::spin::SpinScenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::{Place, VehicleScenario};

use host::instrument::recorder::{self, Recorded, Samples};
use host::instrument::{Run, SpinRun, Trial, TurntableRun};
use host::methods::asked::{Asked, REQUIRED_SIGMA};
use host::methods::spin::follow;
use host::methods::{rotating, spin, stepwise, stops};
use host::outcome::Finished;
use host::recording::{self, Body, Header, Truth};
use orientation::alignment::Progress;
use orientation::alignment::stops::session as stops_session;
use orientation::roll;
use orientation::signal::Sample;
use orientation::units::{Angle, DEGREE, Instant};
use serde_json::Value;

use crate::support::files::Scratch;

/// Faults that lose samples, or what a sensor measures, for a while.
const LOSSES: [&str; 5] = [
    "overflow-once",
    "saturation-once",
    "overload-once",
    "spin-saturation-once",
    "spin-overload-once",
];

/// Those faults of a platform, and every seventh of its catalogue.
fn some_faults(platform: Platform) -> impl Iterator<Item = Fault> {
    let losses = Fault::all(platform).filter(|fault| LOSSES.contains(&fault.to_string().as_str()));
    Fault::all(platform).step_by(7).chain(losses)
}

/// What a reader finds in the recording of a run; none of a run without a sample.
fn read_back<C: Recorded>(
    carrier: &C,
    run: &C::Run,
    samples: &[C::Sample],
) -> Option<(Header, Body)> {
    samples.first()?;
    let scratch = Scratch::new("recorded");
    let path = scratch.path("run.csv");
    recorder::write(Path::new(&path), carrier, run, samples).expect("the folder is ours");
    let recording = recording::read(Path::new(&path)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(recording.warning_lines(Path::new(&path)), [""; 0]);
    let (header, body, _) = recording.into_parts();
    Some((header, body))
}

/// All that is reported of an analysis but what it assumed, and its numbers in full.
fn reported(finished: &dyn Finished, conclusion: &impl Debug) -> (Value, String) {
    let mut outcome = serde_json::to_value(finished.outcome(&Truth::default()));
    let keys = outcome.as_mut().ok().and_then(Value::as_object_mut).expect("it is an object");
    keys.remove("assumed");
    (outcome.expect("it is an object"), format!("{conclusion:?}"))
}

/// What is reported of an alignment in positions.
fn reported_of_stage(replay: &stepwise::Replay) -> (Value, String) {
    reported(
        replay,
        &(replay.session.conclusion(), replay.session.dwells(), &replay.session.repetitions),
    )
}

/// Compares runs without and with a recorder with what a replay makes of the recording.
fn compare_stage<T, C: Recorded<Run = Run<stepwise::Replay, T>>>(
    plain: &C::Run,
    carrier: &C,
    run: &C::Run,
    it: &[C::Sample],
) {
    assert_eq!(reported_of_stage(&plain.replay), reported_of_stage(&run.replay));
    let Some((header, body)) = read_back(carrier, run, it) else { return };
    let again = stepwise::replay(&header, &body, &Asked::default(), |_| {});
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reported_of_stage(&again), reported_of_stage(&run.replay));
    assert_eq!(again.session.setting, run.replay.session.setting);
}

fn replay_stage(scenario: &Scenario, fault: Option<Fault>) {
    let plain = Trial::of(scenario).fault(fault).run().expect("it is possible");
    let found = plain.conclusion().map(|conclusion| conclusion.verdict);
    assert!(fault.is_some() || matches!(found, Some(Ok(_))), "{found:?}");
    let mut samples = Samples::default();
    let run = Trial::of(scenario).fault(fault).record(&mut samples).run().expect("it is possible");
    compare_stage(&plain, scenario, &run, &samples.taken);
}

fn replay_frames(scenario: &FramesScenario, fault: Option<Fault>) {
    let plain = Trial::of(scenario).fault(fault).run().expect("it is possible");
    let found = plain.conclusion().map(|conclusion| conclusion.verdict);
    assert!(fault.is_some() || matches!(found, Some(Ok(_))), "{found:?}");
    let mut samples = Samples::default();
    let frames =
        Trial::of(scenario).fault(fault).record(&mut samples).run().expect("it is possible");
    compare_stage(&plain, scenario, &frames, &samples.taken);
}

/// So many samples a second of a platform that turns at a rate, rad/s, for a second and rests for another; its encoder is
/// read with one in `every` of them.
fn turned_and_rested(hz: u64, rate: f64, every: u64) -> Vec<Sample> {
    let read = |index: u64| (index - index % every).min(hz) as f64 / hz as f64;
    let sample = |index: u64| Sample {
        time: Instant(index * 1_000_000 / hz),
        stage: Angle::from_rad(rate * read(index)),
        ..Sample::default()
    };
    (0..2 * hz).map(sample).collect()
}

#[test]
fn the_platforms_rate_is_that_between_two_readings_however_seldom_its_encoder_is_read() {
    for every in [1, 2, 5, 10] {
        for rate in [0.8, -0.8, 3.0] {
            let rows = recorder::turning_rows(&turned_and_rested(400, rate, every));
            let (turning, rest) = rows.split_at(401);
            let step = Angle::STEP * 400.0 / every as f64;
            for row in &turning[1..] {
                assert!((row.stage_rate_rad_s - rate).abs() < 1.01 * step, "{every}: {row:?}");
            }
            assert!(rest.iter().all(|row| row.stage_rate_rad_s == 0.0), "{every}");
        }
    }
}

fn replay_turntable(scenario: &TurntableScenario, fault: Option<Fault>) {
    let of_run = |run: &TurntableRun| {
        let (session, assumed) = (run.replay.clone(), Vec::new());
        let replay = rotating::Replay { session, zero_s: 0.0, assumed, is_followed: false };
        reported(&replay, &replay.session.conclusion())
    };
    let plain = Trial::of(scenario).fault(fault).run().expect("it is possible");
    let found = plain.replay.conclusion().map(|conclusion| conclusion.verdict);
    assert!(fault.is_some() || matches!(found, Some(Ok(_))), "{found:?}");
    let mut samples = Samples::default();
    let run = Trial::of(scenario).fault(fault).record(&mut samples).run().expect("it is possible");
    assert_eq!(of_run(&plain), of_run(&run));
    let Some((header, body)) = read_back(scenario, &run, &samples.taken) else { return };
    let again = rotating::replay(&header, &body, &Asked::default());
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reported(&again, &again.session.conclusion()), of_run(&run));
}

fn replay_vehicle(scenario: &VehicleScenario, fault: Option<Fault>) {
    let reported = |session: &stops_session::Session| {
        format!("{:?} {:?}", session.conclusion(), session.stops())
    };
    let plain = Trial::of(scenario).fault(fault).run().expect("it is possible");
    let found = plain.replay.conclusion().map(|conclusion| conclusion.verdict);
    assert!(fault.is_some() || matches!(found, Some(Ok(_))), "{found:?}");
    let mut samples = Samples::default();
    let found =
        Trial::of(scenario).fault(fault).record(&mut samples).run().expect("it is possible");
    assert_eq!(reported(&plain.replay), reported(&found.replay));
    let Some((header, body)) = read_back(scenario, &found, &samples.taken) else { return };
    let again = stops::replay(&header, &body, &Asked::default());
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reported(&again.session), reported(&found.replay));
}

fn replay_spin(scenario: &SpinScenario, fault: Option<Fault>) {
    let run = Trial::of(scenario).fault(fault).run().expect("it is possible");
    let Some((header, body)) = read_back(scenario, &run, &run.truth.samples) else { return };
    let again = spin::replay(&header, &body, &Asked::default());
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(format!("{again:?}"), format!("{:?}", of_spin(scenario, &run, &again.assumed)));
    let end = again.answer().end;
    assert_eq!(end.roll_rad.to_bits(), run.replay.spin.roll().rad().to_bits());
    assert_eq!(end.sigma_rad, run.replay.spin.sigma().map(|sigma| sigma.0));
}

/// What the command line tells of a flight.
fn of_spin(scenario: &SpinScenario, run: &SpinRun, assumed: &[String]) -> spin::Replay {
    let ended = run.events.iter().find_map(|(_, event)| match event {
        Event::Alignment(Progress::Roll(roll::Progress::Ended(_))) => Some(event.to_string()),
        _ => None,
    });
    spin::Replay {
        ended,
        ..follow(&run.truth.samples, scenario.setting(), REQUIRED_SIGMA, assumed.to_vec())
    }
}

/// A circle of eight positions, the first again, four seconds each.
fn stage(seed: u64) -> Scenario {
    let azimuth_deg = 137.5 * seed as f64 % 360.0;
    let (positions, dwell_s, sample_rate_hz) = (9, 4.0, 100.0);
    Scenario { azimuth_deg, positions, dwell_s, sample_rate_hz, ..Scenario::usual(seed) }
}

fn turntable(seed: u64) -> TurntableScenario {
    let base = Scenario { sample_rate_hz: 100.0, ..Scenario::usual(seed) };
    let brief = TurntableScenario::brief(seed);
    TurntableScenario { base, modulated_turns: 6, turns: 4, ..brief }
}

/// Two stops of half a minute.
fn vehicle(seed: u64) -> VehicleScenario {
    let usual = VehicleScenario::usual(seed);
    let base = Scenario { sample_rate_hz: 50.0, ..usual.base };
    VehicleScenario { base, stops: 2, stop_s: 30.0, ..usual }
}

#[test]
fn a_recorded_turntable_replays_bit_for_bit() {
    (1..=2).for_each(|seed| replay_turntable(&turntable(seed), None));
    let molecular = TurntableScenario { turns: 2, ..TurntableScenario::molecular(3) };
    let base = Scenario { sample_rate_hz: 100.0, ..molecular.base };
    replay_turntable(&TurntableScenario { base, ..molecular }, None);
}

#[test]
fn a_recorded_turntable_with_a_fault_replays_bit_for_bit() {
    for fault in some_faults(Platform::Turntable) {
        println!("{fault}");
        replay_turntable(&turntable(1), Some(fault));
    }
}

#[test]
fn a_recorded_vehicle_replays_bit_for_bit() {
    (1..=2).for_each(|seed| replay_vehicle(&vehicle(seed), None));
    replay_vehicle(&VehicleScenario { place: Place::Unknown, ..vehicle(3) }, None);
}

#[test]
fn a_recorded_vehicle_with_a_fault_replays_bit_for_bit() {
    for fault in some_faults(Platform::Vehicle) {
        println!("{fault}");
        replay_vehicle(&vehicle(1), Some(fault));
    }
}

#[test]
fn a_recorded_flight_replays_bit_for_bit() {
    for seed in 1..=2 {
        replay_spin(&SpinScenario { seed, seconds: 0.6, ..SpinScenario::default() }, None);
    }
}

#[test]
fn a_recorded_flight_with_a_fault_replays_bit_for_bit() {
    for fault in some_faults(Platform::Spin) {
        println!("{fault}");
        replay_spin(&SpinScenario { seconds: 0.6, ..SpinScenario::default() }, Some(fault));
    }
}

#[test]
fn a_recorded_stage_replays_bit_for_bit() {
    replay_stage(&stage(1), None);
    replay_stage(&Scenario { sample_rate_hz: 400.0, ..stage(2) }, None);
    replay_stage(&Scenario { aim: Aim::Time(60.0), ..stage(3) }, None);
    replay_stage(&Scenario::surveying(4), None);
}

#[test]
fn a_recorded_stage_with_a_fault_replays_bit_for_bit() {
    for fault in some_faults(Platform::Stage) {
        println!("{fault}");
        replay_stage(&stage(1), Some(fault));
    }
}

#[test]
fn a_recorded_stage_on_a_base_that_sways_replays_bit_for_bit() {
    for (seed, sway_deg) in [(1, 0.05), (2, 0.0)] {
        let base = Scenario { sway_deg, sway_hz: 2.0, has_base_imu: true, ..stage(seed) };
        replay_stage(&Scenario { positions: 24, dwell_s: 10.0, ..base }, None);
    }
}

#[test]
fn a_recording_on_a_base_with_sensors_holds_what_they_showed() {
    let scenario = Scenario { sway_deg: 0.2, has_base_imu: true, ..stage(1) };
    let mut samples = Samples::default();
    let run = Trial::of(&scenario).record(&mut samples).run().expect("it is possible");
    let read = read_back(&scenario, &run, &samples.taken);
    let Some((_, Body::Stage(rows))) = read else { panic!("it is a stage") };
    let shown: Vec<f64> =
        rows.iter().filter_map(|row| row.base).map(|base| base.rates_rad_s[0]).collect();
    let from = samples.taken.first().expect("there are samples").time.0;
    let until = samples.taken.last().expect("there are samples").time.0;
    let within = run.base.iter().filter(|(at, _)| (from..=until).contains(&at.as_micros()));
    let given: Vec<f64> = within.map(|(_, reading)| reading.rate[0].rad_per_s()).collect();
    assert!(shown.len() > 1000 && shown.len().abs_diff(given.len()) <= 1, "{}", shown.len());
    assert!(shown.iter().zip(&given).all(|(shown, given)| (shown - given).abs() < 1e-12));
}

/// Two passes of a mount.
fn frames(seed: u64) -> FramesScenario {
    let base = Scenario { dwell_s: 6.0, ..stage(seed) };
    let start_deg = Frames { outer: 30.0, inner: -20.0 };
    let orthogonality_sigma = 0.002 * DEGREE;
    FramesScenario { base, passes: 2, start_deg, orthogonality_sigma, ..FramesScenario::default() }
}

#[test]
fn a_recorded_mount_replays_bit_for_bit() {
    (1..=2).for_each(|seed| replay_frames(&frames(seed), None));
    let planned = frames(3);
    let base = Scenario { aim: Aim::Time(120.0), has_base_imu: true, ..planned.base };
    replay_frames(&FramesScenario { base, ..planned }, None);
}

#[test]
fn a_recorded_mount_with_a_fault_replays_bit_for_bit() {
    for fault in some_faults(Platform::TwoFrame).step_by(2) {
        println!("{fault}");
        replay_frames(&frames(1), Some(fault));
    }
}

#[test]
fn what_a_session_was_given_counts_as_the_run_wrote_it_or_not_at_all() {
    let scenario = SpinScenario { seconds: 0.6, ..SpinScenario::default() };
    let run = Trial::of(&scenario).run().expect("it is possible");
    let (header, body) = read_back(&scenario, &run, &run.truth.samples).expect("there are samples");
    let changed = Header { session: Some("{}".to_owned()), ..header };
    let refused = spin::replay(&changed, &body, &Asked::default()).map(|_| ());
    let why = refused.expect_err("nothing was given").to_string();
    assert!(why.starts_with("key session: missing field `setting`"), "{why}");
}

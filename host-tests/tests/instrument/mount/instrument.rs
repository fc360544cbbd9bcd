//! The whole instrument on a simulated two-frame mount.

use embassy_time::{Duration, Instant};
use firmware::event::Event;
use firmware::ports::Frames;
use hal_mock::noise::Generator;
use hal_mock::plant::StageFault;
use host::campaign::statistics::rms;
use host::instrument::kept::KeptPlan;
use host::instrument::{FramesRun, Trial};
use host::output::azimuth_error;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise;
use orientation::alignment::stepwise::mount::TwoFrame;
use orientation::device::{Device, Trouble};
use orientation::units::{DEGREE, Degrees, Radians};
use rayon::prelude::*;
use simulated::fault::Injection;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;

use crate::support::campaign::{Extent, campaigns};

/// Runs of the statistics.
const RUNS: usize = 48;

/// A site, an attitude and a mount drawn from a seed; non-orthogonalities up to 0.2°.
fn drawn(seed: u64) -> FramesScenario {
    let mut chance = Generator::new(seed);
    let mut within = |limit: f64| limit * (2.0 * chance.uniform() - 1.0);
    let base = Scenario {
        seed,
        latitude_deg: within(65.0),
        azimuth_deg: within(180.0) + 180.0,
        pitch_deg: within(3.0),
        roll_deg: within(3.0),
        sample_rate_hz: 100.0,
        ..Scenario::default()
    };
    let calibrated = TwoFrame {
        azimuth: Radians(within(0.2 * DEGREE)),
        pitch: Radians(within(0.2 * DEGREE)),
        frames: Radians(within(0.2 * DEGREE)),
        gyro: Radians(within(0.2 * DEGREE)),
        outer_zero: Radians(within(0.2 * DEGREE)),
        inner_zero: Radians(within(0.2 * DEGREE)),
    };
    let start_deg = Frames { outer: within(90.0), inner: within(90.0) };
    FramesScenario { base, calibrated, start_deg, ..FramesScenario::default() }
}

/// A short alignment of two passes.
fn short(seed: u64) -> FramesScenario {
    let drawn = drawn(seed);
    let base = Scenario { dwell_s: 6.0, latitude_deg: 55.0, ..drawn.base };
    FramesScenario { base, passes: 2, ..drawn }
}

fn run(scenario: &FramesScenario, injection: &Injection) -> FramesRun {
    let plan = KeptPlan { chips: injection.clone(), ..KeptPlan::of(None) };
    Trial::of(scenario).plan(plan).run().expect("the scenario is possible")
}

fn healthy(scenario: &FramesScenario) -> FramesRun {
    run(scenario, &Injection::NONE)
}

/// Error and σ, °, or why there is none.
fn found(scenario: &FramesScenario, run: &FramesRun) -> Result<[f64; 2], Refusal> {
    let azimuth = run.conclusion().expect("every run concludes").verdict?;
    let error = azimuth_error(azimuth.angle.degrees(), scenario.base.azimuth_deg);
    Ok([error, azimuth.sigma.degrees()])
}

fn reported(run: &FramesRun) -> Vec<String> {
    run.events.iter().map(|(_, event)| event.to_string()).collect()
}

campaigns! {
    errors_are_those_that_sigma_says_and_the_gyro_ends_vertical;
}

fn errors_are_those_that_sigma_says_and_the_gyro_ends_vertical(extent: Extent) {
    let runs = extent.of(RUNS);
    let outcomes: Vec<[f64; 2]> = (1..=runs as u64)
        .into_par_iter()
        .map(|seed| {
            let scenario = drawn(seed);
            let run = healthy(&scenario);
            assert_eq!(run.violations, Vec::<String>::new());
            assert_eq!(run.health.faults(), 0, "seed {seed}: {:?}", run.health);
            assert_eq!(run.replay.session.dwells().len(), 24);
            assert!(run.events.iter().any(|(_, event)| matches!(event, Event::Stored(..))));
            // Within what the drives tolerate, in both angles, of the base's vertical.
            let [forward, right, down] = run.truth;
            assert!(forward.hypot(right).atan2(down).to_degrees() < 0.05, "{:?}", run.truth);
            found(&scenario, &run).unwrap_or_else(|reason| panic!("seed {seed}: {reason}"))
        })
        .collect();
    let ratios: Vec<f64> = outcomes.iter().map(|[error, sigma]| error / sigma).collect();
    let worst = ratios.iter().fold(0.0_f64, |worst, ratio| worst.max(ratio.abs()));
    let rms = rms(&ratios);
    let [least, most] = [0.15, 0.2].map(|whole| extent.rms(whole, runs));
    assert!(
        (1.0 - least..1.0 + most).contains(&rms) && worst < 4.0,
        "RMS {rms} σ, worst {worst} σ"
    );
}

#[test]
fn a_calibration_that_the_board_does_not_know_turns_its_azimuth() {
    // The axis leans by 0.2°: at 70° and facing north that turns the azimuth by tan 70° of it.
    let calibrated = TwoFrame { gyro: Radians::from_degrees(0.2), ..TwoFrame::default() };
    let base = Scenario { latitude_deg: 70.0, azimuth_deg: 0.0, ..drawn(3).base };
    let scenario = FramesScenario { base, calibrated, ..FramesScenario::default() };
    let [error, sigma] = found(&scenario, &healthy(&scenario)).expect("it is healthy");
    assert!(error.abs() < 4.0 * sigma, "{error}° of σ {sigma}°");
    let blind = FramesScenario { is_calibrated: false, ..scenario };
    let [error, sigma] = found(&blind, &healthy(&blind)).expect("it looks healthy");
    let expected = -0.2 * 70.0_f64.to_radians().tan();
    assert!((error - expected).abs() < 4.0 * sigma, "{error}° is not {expected}° ± {sigma}°");
    assert!(error.abs() > 4.0 * sigma, "{error}° of σ {sigma}°");
}

/// When frames fail: within the first pass.
const MIDDLE: Instant = Instant::from_secs(50);

fn of_inner(fault: StageFault) -> Injection {
    let inner = [fault].into_iter().collect();
    Injection { axes: Frames { inner, ..Frames::default() }, ..Injection::NONE }
}

fn of_outer(fault: StageFault) -> Injection {
    let outer = [fault].into_iter().collect();
    Injection { axes: Frames { outer, ..Frames::default() }, ..Injection::NONE }
}

fn assert_refused(
    scenario: &FramesScenario,
    plan: &Injection,
    device: Device,
    is_expected: impl Fn(Trouble) -> bool,
) {
    let run = run(scenario, plan);
    match found(scenario, &run) {
        Err(Refusal::Device { device: found, trouble }) if found == device => {
            assert!(is_expected(trouble), "{trouble}");
        }
        other => panic!("{other:?}: {:#?}", reported(&run)),
    }
    assert!(!run.events.iter().any(|(_, event)| matches!(event, Event::Stored(..))));
    assert!(run.seconds < 400.0, "it takes {} s", run.seconds);
}

/// A second into a frame's first half turn, as a healthy run of this scenario has it.
fn in_half_turn(scenario: &FramesScenario, device: Device) -> Instant {
    let mut before: Option<f64> = None;
    for (at, event) in healthy(scenario).events {
        let Event::Turning(axis, angle) = event else { continue };
        let turns = axis == device && before.is_some_and(|before| (angle - before).abs() > 170.0);
        if turns {
            return at + Duration::from_secs(1);
        }
        if axis == device {
            before = Some(angle);
        }
    }
    panic!("{device} does not turn by a half");
}

/// A scenario with one frame blocked in its first half turn.
fn blocked(seed: u64, device: Device, seconds: Duration) -> (FramesScenario, Injection) {
    let scenario = short(seed);
    let from = in_half_turn(&scenario, device);
    let block =
        StageFault::Block { from, until: from.checked_add(seconds).unwrap_or(Instant::MAX) };
    (scenario, if device == Device::InnerFrame { of_inner(block) } else { of_outer(block) })
}

#[test]
fn a_frame_that_stays_blocked_is_refused_by_its_name() {
    for device in [Device::InnerFrame, Device::OuterFrame] {
        for seed in 1..=4 {
            let (scenario, plan) = blocked(seed, device, Duration::MAX);
            let is_stalled = |trouble| matches!(trouble, Trouble::Stalled(_));
            assert_refused(&scenario, &plan, device, is_stalled);
        }
    }
}

#[test]
fn an_encoder_that_slips_is_refused_by_the_frame_that_disagrees_with_it() {
    for (seed, by_deg) in [(1, 0.5), (2, -0.5), (3, 0.15)] {
        let slip = StageFault::Slip { at: MIDDLE, by_rad: by_deg * DEGREE };
        let is_near = |apart: Degrees| (apart.0 - by_deg).abs() < 0.06;
        let disagrees =
            |trouble: Trouble| matches!(trouble, Trouble::Disagrees(apart) if is_near(apart));
        assert_refused(&short(seed), &of_inner(slip), Device::InnerFrame, disagrees);
        assert_refused(&short(seed), &of_outer(slip), Device::OuterFrame, disagrees);
    }
}

#[test]
fn an_encoder_that_has_slipped_before_the_start_is_refused_at_the_index() {
    let slip = StageFault::Slip { at: Instant::MIN, by_rad: 0.5 * DEGREE };
    let disagrees = |trouble| matches!(trouble, Trouble::Disagrees(_));
    assert_refused(&short(1), &of_inner(slip), Device::InnerFrame, disagrees);
    assert_refused(&short(1), &of_outer(slip), Device::OuterFrame, disagrees);
}

#[test]
fn a_frame_that_is_blocked_for_a_while_homes_again_and_north_is_found() {
    for (device, name) in [(Device::InnerFrame, "inner frame"), (Device::OuterFrame, "outer frame")]
    {
        for seed in 1..=3 {
            let (scenario, plan) = blocked(seed, device, Duration::from_secs(12));
            let run = run(&scenario, &plan);
            let [error, sigma] =
                found(&scenario, &run).unwrap_or_else(|reason| panic!("{seed}: {reason}"));
            assert!(error.abs() < 4.0 * sigma, "{error}° of σ {sigma}°");
            let blocked = format!("{name}: blocked, trying again");
            assert!(reported(&run).contains(&blocked), "{:#?}", reported(&run));
        }
    }
}

/// A frame may be held in any dwell or movement, also in one of a tenth of a degree, by which the calibrated
/// geometry turns the inner frame between two headings.
#[test]
fn whenever_a_frame_is_held_for_a_while_north_is_found_and_no_encoder_is_blamed() {
    let moments: Vec<u64> = (20..120).step_by(5).collect();
    moments.into_par_iter().for_each(|second| {
        let from = Instant::from_secs(second);
        let held = StageFault::Block { from, until: from + Duration::from_secs(15) };
        for plan in [of_inner(held), of_outer(held)] {
            let scenario = short(second);
            let run = run(&scenario, &plan);
            let [error, sigma] = found(&scenario, &run).unwrap_or_else(|reason| {
                panic!("held at {second} s: {reason}: {:#?}", reported(&run))
            });
            assert!(error.abs() < 4.0 * sigma, "held at {second} s: {error}° of σ {sigma}°");
        }
    });
}

#[test]
fn whenever_a_frame_is_held_for_good_it_is_refused_as_blocked() {
    let moments: Vec<u64> = (20..80).step_by(5).collect();
    moments.into_par_iter().for_each(|second| {
        let held = StageFault::Block { from: Instant::from_secs(second), until: Instant::MAX };
        let is_stalled = |trouble| matches!(trouble, Trouble::Stalled(_));
        assert_refused(&short(second), &of_inner(held), Device::InnerFrame, is_stalled);
        assert_refused(&short(second), &of_outer(held), Device::OuterFrame, is_stalled);
    });
}

/// A slip may come in any dwell, the last one included, where no movement follows to notice it.
#[test]
fn whenever_an_encoder_slips_there_is_never_a_wrong_north() {
    let moments: Vec<u64> = (20..150).step_by(6).collect();
    moments.into_par_iter().for_each(|second| {
        let slip = StageFault::Slip { at: Instant::from_secs(second), by_rad: 0.5 * DEGREE };
        for plan in [of_inner(slip), of_outer(slip)] {
            let scenario = short(second);
            let run = run(&scenario, &plan);
            if let Ok([error, sigma]) = found(&scenario, &run) {
                assert!(error.abs() < 4.0 * sigma, "slip at {second} s: {error}° of σ {sigma}°");
            }
        }
    });
}

#[test]
fn the_log_tells_both_frames_and_the_storage_in_order() {
    let run = healthy(&short(1));
    let reported = reported(&run);
    let mut rest = reported.iter();
    for part in [
        "begin: 8 positions of 6.0 s",
        "outer encoder: identity and self-test passed",
        "inner encoder: identity and self-test passed",
        "outer frame: looking for its index",
        "inner frame: looking for its index",
        "inner frame: to ",
        "inner frame: stands at ",
        "level: platform inclined",
        "dwell 1 of 8",
        "dwell 8 of 8",
        "azimuth ",
        "outer frame: to ",
        "gyro vertical to store the azimuth",
    ] {
        assert!(rest.any(|line| line.contains(part)), "{part} is missing in {reported:#?}");
    }
    assert!(run.lines.contains("azimuth "), "{}", run.lines);
    // The frames turn the gyro about its own axis: nothing of that has come into a dwell.
    assert_eq!(run.replay.session.repetitions.len(), 0);
}

#[test]
fn a_seed_gives_one_run_and_another_seed_another() {
    let azimuth = |seed| {
        let verdict = healthy(&short(seed)).conclusion().and_then(|c| c.verdict.ok());
        verdict.expect("a healthy run").angle.0.to_bits()
    };
    assert_eq!(azimuth(5), azimuth(5));
    assert_ne!(azimuth(5), azimuth(6));
}

#[test]
fn a_swaying_base_is_taken_off_the_gyro_in_its_frames_too() {
    let swaying = |seed: u64, has_base_imu: bool| {
        let scenario = drawn(seed);
        let base = Scenario { sway_deg: 0.1, sway_hz: 0.5, has_base_imu, ..scenario.base };
        FramesScenario { base, ..scenario }
    };
    let alone = swaying(1, false);
    let verdict = found(&alone, &run(&alone, &Injection::NONE));
    assert!(
        matches!(verdict, Err(Refusal::Stepwise(stepwise::Refusal::Disturbed { .. }))),
        "{verdict:?}"
    );
    let ratios: Vec<f64> = (1..=16_u64)
        .into_par_iter()
        .filter_map(|seed| {
            let scenario = swaying(seed, true);
            // Near a pole σ may exceed the 10° that are accepted.
            let [error, sigma] = found(&scenario, &run(&scenario, &Injection::NONE)).ok()?;
            Some(error / sigma)
        })
        .collect();
    assert!(ratios.len() >= 10, "{ratios:?}");
    // The whitening overstates σ where the axis turns by quarters.
    assert!((0.4..1.1).contains(&rms(&ratios)), "{ratios:?}");
}

//! The whole instrument on simulated chips with a platform that turns all the time: it finds north,
//! tells what it did, comes to rest at the end, and never reports a wrong north.

use crate::support::link::states;
use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::Frames;
use hal_mock::plant::StageFault;
use host::instrument::kept::KeptPlan;
use host::instrument::{Trial, TurntableRun};
use host::output::azimuth_error;
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating;
use orientation::alignment::rotating::turn::SPEEDS;
use orientation::device::{Device, Trouble};
use rayon::prelude::*;
use simulated::fault::{ChipFault, Fault, Injection, Platform};
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;

/// A short alignment, for what does not depend on its length.
fn short(seed: u64) -> TurntableScenario {
    let base = Scenario { sample_rate_hz: 100.0, ..Scenario::usual(seed) };
    let brief = TurntableScenario::brief(seed);
    TurntableScenario { base, modulated_turns: 6, turns: 4, ..brief }
}

fn run_with(scenario: &TurntableScenario, fault: Option<Fault>) -> TurntableRun {
    Trial::of(scenario).fault(fault).run().expect("the scenario is possible")
}

fn run(scenario: &TurntableScenario) -> TurntableRun {
    run_with(scenario, None)
}

fn verdict(run: &TurntableRun) -> Result<Azimuth, Refusal> {
    run.replay.conclusion().expect("every run concludes").verdict
}

fn reported(run: &TurntableRun) -> Vec<String> {
    run.events.iter().map(|(_, event)| event.to_string()).collect()
}

/// The error of an azimuth, °, and its σ.
fn error(scenario: &TurntableScenario, azimuth: Azimuth) -> (f64, f64) {
    let error = azimuth_error(azimuth.angle.degrees(), scenario.base.azimuth_deg);
    (error, azimuth.sigma.degrees())
}

fn assert_north(scenario: &TurntableScenario, run: &TurntableRun) {
    let azimuth = verdict(run).unwrap_or_else(|reason| panic!("{reason}"));
    let (error, sigma) = error(scenario, azimuth);
    assert!(error.abs() < 4.0 * sigma, "off by {error}° of σ {sigma}°");
}

/// What the fault named so ends in.
fn with_fault(name: &str) -> TurntableRun {
    let fault = Fault::all(Platform::Turntable).find(|fault| fault.to_string() == name);
    run_with(&short(1), Some(fault.expect("it is in the catalogue")))
}

fn refusal(name: &str) -> Refusal {
    verdict(&with_fault(name)).expect_err("no azimuth may come of it")
}

#[test]
fn the_default_run_finds_north_and_breaks_no_rule_of_a_chip() {
    let scenario = TurntableScenario::usual(1);
    let run = run(&scenario);
    assert_north(&scenario, &run);
    assert_eq!(run.violations, Vec::<String>::new());
    assert_eq!(run.health.faults(), 0, "{:?}", run.health);
    let misalignment = run.replay.misalignments().next().expect("the rate-modulated turns show it");
    let off = misalignment.angle().degrees() - scenario.elevation_deg;
    assert!(off.abs() < 1e-3, "the axis is found {off}° beside its elevation");
    assert_eq!(run.replay.turns(), (20, 20));
}

#[test]
fn a_molecular_electronic_sensor_finds_north_at_two_speeds() {
    let scenario = TurntableScenario::molecular(2);
    let run = run(&scenario);
    assert_north(&scenario, &run);
    let fit = run.replay.conclusion().and_then(|conclusion| conclusion.fit).expect("a fit");
    assert!(fit.molecular.size() > 0.1, "its g-sensitivity counts: {}", fit.molecular.size());
    assert!(fit.phases[0].0 > 0.2, "it runs ahead: {} rad", fit.phases[0].0);
}

#[test]
fn a_sensor_that_leads_finds_north_at_every_azimuth_although_its_motor_is_fast() {
    // Where the unevenness acts across the Earth rate, a misalignment beside the turn would show at 8 σ.
    for azimuth_deg in [33.7, 123.7, 303.7] {
        let molecular = TurntableScenario::molecular(1);
        let base = Scenario { azimuth_deg, ..molecular.base };
        let scenario = TurntableScenario { base, ..molecular };
        let run = run(&scenario);
        let azimuth = verdict(&run).unwrap_or_else(|reason| panic!("{reason}"));
        let (error, sigma) = error(&scenario, azimuth);
        assert!(
            error.abs() < 0.25 && error.abs() < 3.0 * sigma,
            "{azimuth_deg}: {error} ± {sigma}"
        );
    }
}

#[test]
fn a_seed_gives_one_run_and_another_seed_another() {
    let bits = |seed| verdict(&run(&short(seed))).map(|found| found.angle.0.to_bits());
    assert_eq!(bits(3), bits(3));
    assert_ne!(bits(3), bits(4));
}

#[test]
fn the_log_tells_what_the_board_did_in_order() {
    let reported = reported(&run(&short(1)));
    let mut rest = reported.iter();
    for part in [
        "begin: 8 turns at latitude 47.58",
        "identity and self-test passed",
        "level: platform inclined",
        "rate-modulated turns, 72.00 °/s in the mean",
        "stage: turns at 72.00 °/s",
        "gyro's axis 0.80",
        "turns count from here: clockwise, 72.00 °/s",
        "turn 4 of 8",
        "stage: turns at -72.00 °/s",
        "turns count from here: counter-clockwise",
        "turn 8 of 8",
        "azimuth 213.",
        "stage: comes to rest",
    ] {
        assert!(
            rest.any(|line| line.contains(part)),
            "{part}: not, or not there, in {reported:#?}"
        );
    }
    let lines = run(&short(1)).lines;
    let is_told = |done: &str| states(&lines).iter().any(|state| state[6..8] == [done, "8"]);
    assert!(is_told("0") && is_told("7"), "{lines}");
}

/// Between two commands of a rate-modulated turn pass 50 ms: they are not worth a line each.
#[test]
fn the_commands_of_a_modulated_turn_are_not_reported() {
    let run = run(&short(1));
    let rates = run.events.iter().filter(|(_, event)| matches!(event, Event::Revolving(..)));
    assert_eq!(rates.count(), 3, "clockwise, counter-clockwise, at rest");
}

#[test]
fn the_platform_comes_to_rest_whatever_the_end() {
    for name in ["", "encoder-slip", "overload-always", "gyro-silent", "saturation-always"] {
        let fault = Fault::all(Platform::Turntable).find(|fault| fault.to_string() == name);
        let run = run_with(&short(1), fault);
        // It still rings, by a hundredth of what it turned at.
        assert!(run.truth.abs() < 0.0126, "{name}: it turns at {} rad/s", run.truth);
    }
}

#[test]
fn a_stored_misalignment_spares_the_modulated_turns() {
    let before = run(&short(5)).replay;
    let mut stored = [None; SPEEDS];
    stored.iter_mut().zip(before.misalignments()).for_each(|(place, found)| *place = Some(found));
    let scenario = TurntableScenario { modulated_turns: 0, stored, ..short(6) };
    let run = run(&scenario);
    assert_north(&scenario, &run);
    assert!(!reported(&run).iter().any(|line| line.contains("rate-modulated")));
}

#[test]
fn an_uneven_gear_is_no_disagreement() {
    for seed in [7, 8] {
        let scenario = TurntableScenario { unevenness: [0.005, 0.003], ..short(seed) };
        let run = run(&scenario);
        assert!(
            !reported(&run).iter().any(|line| line.contains("disagree")),
            "{:?}",
            reported(&run)
        );
    }
}

#[test]
fn a_badly_aligned_sensor_is_to_be_aligned() {
    let scenario = TurntableScenario { elevation_deg: -2.5, ..short(1) };
    let reason = verdict(&run(&scenario)).expect_err("it exceeds the limit");
    assert!(
        matches!(reason, Refusal::Rotating(rotating::Refusal::Misaligned { angle, .. }) if (angle.0 + 2.5).abs() < 0.01)
    );
    assert!(reason.to_string().contains("align the sensor mechanically"), "{reason}");
}

#[test]
fn a_slipping_or_creeping_encoder_is_found_by_the_motor() {
    for (name, least) in [("encoder-slip", 0.4), ("encoder-creep", 0.15)] {
        match refusal(name) {
            Refusal::Device { device: Device::Stage, trouble: Trouble::Disagrees(angle) } => {
                assert!((least..0.6).contains(&angle.0.abs()), "{name}: {}°", angle.0);
            }
            other => panic!("{name}: {other}"),
        }
    }
}

/// A run in which the encoder's magnet slips by so many degrees at a time.
fn slipped(scenario: &TurntableScenario, by_deg: f64, at: Instant) -> TurntableRun {
    let slip = StageFault::Slip { at, by_rad: by_deg.to_radians() };
    let outer = [slip].into_iter().collect();
    let axes = Frames { outer, ..Frames::default() };
    let chips = Injection { axes, ..Injection::NONE };
    let plan = KeptPlan { chips, ..KeptPlan::of(None) };
    Trial::of(scenario).plan(plan).run().expect("the scenario is possible")
}

/// Runs in which the encoder shows so many degrees too much: before power-on, while the platform is
/// levelled, and once it turns.
fn assert_slip_is_named(speeds_hz: [f64; 2], by_deg: f64) {
    for at in [Instant::MIN, Instant::from_millis(700), Instant::from_millis(4_200)] {
        let run = slipped(&TurntableScenario { speeds_hz, ..short(2) }, by_deg, at);
        match verdict(&run) {
            Err(Refusal::Device {
                device: Device::Stage | Device::Encoder,
                trouble: Trouble::Disagrees(apart),
            }) => assert!((apart.0 - by_deg).abs() < 0.15, "{by_deg}° at {at}: {}°", apart.0),
            other => panic!("{by_deg}° at {at}, {speeds_hz:?}: {other:?}"),
        }
    }
}

#[test]
fn a_slip_of_the_encoder_at_the_start_is_refused_by_how_far_it_is() {
    let slips = [0.25, -0.25, 0.5, -0.5, 2.0, -10.0, 10.0, 90.0, -140.0];
    slips.into_par_iter().for_each(|by_deg| {
        for speeds_hz in [[0.05, 0.0], [0.137, 0.0], [0.5, 0.0]] {
            assert_slip_is_named(speeds_hz, by_deg);
        }
    });
}

#[test]
fn a_slip_too_small_to_be_refused_stays_within_the_stated_sigma() {
    for by_deg in [0.05, -0.05, 0.1, -0.1] {
        let scenario = TurntableScenario { turns: 8, ..short(3) };
        let azimuth = verdict(&slipped(&scenario, by_deg, Instant::MIN)).expect("it is small");
        let (error, sigma) = error(&scenario, azimuth);
        // What the encoder shows too much the azimuth shows too little.
        assert!((error + by_deg).abs() < 0.2, "{by_deg}°: {error}°");
        assert!(error.abs() < 2.0 * sigma, "{by_deg}°: {error}° of σ {sigma}°");
    }
}

#[test]
fn a_platform_whose_index_never_passes_is_refused_before_it_has_turned_three_times() {
    let scenario = TurntableScenario { index_deg: None, ..short(1) };
    let run = run(&scenario);
    let missing = Refusal::Device { device: Device::Stage, trouble: Trouble::NoIndex };
    assert_eq!(verdict(&run).expect_err("its switch is broken"), missing);
    assert!(run.seconds < 10.0 + 3.0 / scenario.speeds_hz[0], "{} s", run.seconds);
}

/// The motor driver's counter has 32 bits, which are 466 turns of the platform.
#[test]
fn a_platform_that_turns_on_beyond_its_motors_counter_finds_north() {
    let scenario = TurntableScenario { speeds_hz: [0.5, 0.0], turns: 500, ..short(4) };
    let run = run(&scenario);
    assert_north(&scenario, &run);
    assert_eq!(run.violations, Vec::<String>::new());
}

#[test]
fn two_speeds_however_far_apart_find_north_on_a_sound_platform() {
    let speeds = [[0.1, 0.15], [0.1, 0.25], [0.25, 0.1], [0.1, 0.5], [0.05, 0.5], [0.5, 0.04]];
    speeds.into_par_iter().for_each(|speeds_hz| {
        let scenario = TurntableScenario { speeds_hz, ..short(6) };
        assert_north(&scenario, &run(&scenario));
    });
}

#[test]
fn a_misalignment_that_is_not_known_is_named_and_not_the_encoder() {
    let scenario = TurntableScenario { modulated_turns: 0, ..short(1) };
    let reason = verdict(&run(&scenario)).expect_err("σ is far beyond what is accepted");
    assert_eq!(reason, Refusal::MisalignmentUnknown);
}

/// Wherever in its turn the platform is, and whichever way its motor counts.
#[test]
fn a_motor_driver_whose_answers_cannot_be_read_is_named_for_that() {
    let fault = Fault::Chip(Device::Stage, ChipFault::ChecksumAlways);
    (1..=24).into_par_iter().for_each(|seed: u32| {
        let scenario = TurntableScenario { turns: 4 + seed % 5, ..short(seed.into()) };
        let run = run_with(&scenario, Some(fault));
        match verdict(&run) {
            Err(Refusal::Device { device: Device::Stage, trouble }) => assert!(
                !matches!(trouble, Trouble::Disagrees(_) | Trouble::Stalled(_)),
                "seed {seed}: {trouble}"
            ),
            other => panic!("seed {seed}: {other:?}"),
        }
    });
}

#[test]
fn a_blocked_platform_is_tried_once_more_from_rest() {
    let run = with_fault("stage-blocked");
    let blocked =
        reported(&run).iter().filter(|line| line.contains("blocked, trying again")).count();
    assert_eq!(blocked, 1);
    let reason = verdict(&run).expect_err("it does not turn");
    let is_blocked = |trouble| matches!(trouble, Trouble::Stalled(_));
    assert!(
        matches!(reason, Refusal::Device { device: Device::Stage, trouble } if is_blocked(trouble)),
        "{reason}"
    );
}

/// The turn in which it clips is taken anew, so that nothing else would tell of it.
#[test]
fn a_gyro_that_clips_for_a_moment_is_reported_once() {
    let run = with_fault("saturation-once");
    let clipped = reported(&run).iter().filter(|line| line.contains("limit of its range")).count();
    assert_eq!(clipped, 1, "{:#?}", reported(&run));
    assert_north(&short(1), &run);
}

#[test]
fn an_overloaded_accelerometer_is_named() {
    let named = Refusal::Device { device: Device::Accelerometer, trouble: Trouble::Saturated };
    assert_eq!(refusal("overload-always"), named);
}

#[test]
fn a_motor_driver_that_was_reset_turns_on() {
    let run = with_fault("stage-reset");
    let reported = reported(&run);
    assert!(reported.iter().any(|line| line.contains("it has restarted")), "{reported:#?}");
    assert!(run.events.len() > 20, "{reported:#?}");
    if verdict(&run).is_ok() {
        assert_north(&short(1), &run);
    }
}

#[test]
fn no_fault_gives_a_wrong_north() {
    let mut refused = 0;
    for fault in Fault::all(Platform::Turntable) {
        let scenario = short(1);
        let run = run_with(&scenario, Some(fault));
        let Ok(azimuth) = verdict(&run) else {
            refused += 1;
            continue;
        };
        let (error, sigma) = error(&scenario, azimuth);
        assert!(error.abs() < 4.0 * sigma, "{fault}: off by {error}° of σ {sigma}°");
    }
    assert!(refused > 20, "only {refused} were refused");
    assert!(
        Fault::all(Platform::Turntable).any(|fault| matches!(fault, Fault::Chip(Device::Gyro, _)))
    );
}

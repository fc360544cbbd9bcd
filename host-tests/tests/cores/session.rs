//! The session with a simulated stage that obeys it: retries, travel, direction, refusals.

use hal_mock::disturbance::Disturbance;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use host::output::azimuth_error;
use host::simulate::run;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::setup::SetupError;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::procedure::Survey;
use orientation::alignment::stepwise::session::schedule::{Position, Schedule, StopRule};
use orientation::alignment::stepwise::session::{Phase, Session};
use orientation::alignment::stepwise::setting::Setting;
use orientation::alignment::{Input, Method};
use orientation::device::{Device, Trouble};
use orientation::earth::Latitude;
use orientation::noise::fit::FitError;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::planner::order::Order;
use orientation::planner::{Conditions, Rotation, for_time};
use orientation::signal::Sample;
use orientation::units::{AngularRate, Instant, Radians, Seconds};

const N_DEG_SQRT_H: f64 = 0.001;
const LATITUDE_DEG: f64 = 47.58;

fn setting() -> Setting {
    Setting::new(Site {
        noise: StatedNoise::Whole(GyroNoise::from_field_units(N_DEG_SQRT_H, 0.0, 0.0, 0.0)),
        ..Site::at(Latitude::from_degrees(LATITUDE_DEG).expect("it is one"))
    })
}

fn world(azimuth_deg: f64) -> InstrumentsConfiguration {
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: N_DEG_SQRT_H,
        bias_sigma_deg_h: 1.0,
        ..GyroConfiguration::default()
    };
    InstrumentsConfiguration {
        latitude_deg: LATITUDE_DEG,
        azimuth_deg,
        pitch_deg: 0.3,
        roll_deg: -0.4,
        rate_hz: 100.0,
        gyro,
        ..InstrumentsConfiguration::default()
    }
}

fn circle() -> Procedure {
    Procedure::new(Schedule::circle(12, Seconds(5.0)), Seconds(0.01))
}

#[test]
fn a_circle_repeats_its_first_position_where_a_board_has_room_for_it() {
    let length = |positions| Schedule::closed_circle(positions, Seconds(1.0)).len();
    assert_eq!([4, 24, 63, 64, 100].map(length), [5, 25, 64, 64, 64]);
}

fn session(procedure: Procedure) -> Session {
    Session::new(setting(), procedure).expect("it begins")
}

/// Error over σ.
fn error_in_sigmas(session: &Session, azimuth_deg: f64) -> f64 {
    let conclusion = session.conclusion().expect("it has ended");
    let azimuth = conclusion.verdict.expect("there is an azimuth");
    azimuth_error(azimuth.angle.degrees(), azimuth_deg) / azimuth.sigma.degrees()
}

#[test]
fn a_circle_is_turned_step_by_step_and_gives_north() {
    for (seed, azimuth) in [(1, 3.3), (2, 123.4), (3, 359.9), (4, 200.0)] {
        let mut session = session(circle());
        let sent =
            run(&mut session, &world(azimuth), &[], Rotation::fixed(Seconds(1.0)), 200.0, seed);
        let expected: Vec<f64> = (1..12).map(|i| f64::from(i) * 30.0_f64.to_radians()).collect();
        assert_eq!(sent.len(), expected.len());
        assert!(sent.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{sent:?}");
        assert!(error_in_sigmas(&session, azimuth).abs() < 3.5);
    }
}

#[test]
fn a_disturbed_dwell_is_measured_again_without_moving_the_stage() {
    let nudge =
        Disturbance { start_s: 14.0, seconds: 2.0, rate_deg_h: 5.0, ..Disturbance::default() };
    let mut session = session(circle());
    let sent = run(&mut session, &world(77.0), &[nudge], Rotation::fixed(Seconds(1.0)), 200.0, 5);
    assert_eq!(sent.len(), 11);
    assert_eq!(session.repetitions.len(), 1);
    assert_eq!(session.repetitions[0].position, 2);
    assert!(session.conclusion().expect("done").disturbances.iter().all(Option::is_none));
    assert!(error_in_sigmas(&session, 77.0).abs() < 3.5);
}

#[test]
fn retries_are_bounded_and_a_lasting_disturbance_is_refused() {
    let lasting: Vec<Disturbance> = (0..400)
        .map(|i| Disturbance {
            start_s: f64::from(i) * 3.0,
            seconds: 1.0,
            rate_deg_h: 60.0,
            ..Disturbance::default()
        })
        .collect();
    let mut session = session(circle());
    run(&mut session, &world(10.0), &lasting, Rotation::fixed(Seconds(1.0)), 2000.0, 6);
    let conclusion = session.conclusion().expect("it has ended");
    assert!(
        matches!(conclusion.verdict, Err(Refusal::Stepwise(stepwise::Refusal::Disturbed { .. }))),
        "{:?}",
        conclusion.verdict
    );
    assert_eq!(session.dwells().len(), 12);
    assert_eq!(session.repetitions.len(), 24);
}

#[test]
fn the_whole_session_is_bounded_in_time() {
    let mut session = session(Procedure { longest_seconds: Seconds(20.0), ..circle() });
    run(&mut session, &world(10.0), &[], Rotation::fixed(Seconds(1.0)), 2000.0, 7);
    let verdict = session.conclusion().expect("it has ended").verdict;
    assert_eq!(verdict, Err(Refusal::TimeExhausted));
}

#[test]
fn a_stage_that_does_not_arrive_is_refused() {
    let mut session = session(Procedure { longest_rotation: Seconds(30.0), ..circle() });
    // It takes longer for a rotation than is allowed.
    run(&mut session, &world(10.0), &[], Rotation::fixed(Seconds(50.0)), 2000.0, 8);
    let verdict = session.conclusion().expect("it has ended").verdict;
    assert!(
        matches!(verdict, Err(Refusal::Stepwise(stepwise::Refusal::StageNotThere { .. }))),
        "{verdict:?}"
    );
}

#[test]
fn a_platform_that_is_not_level_enough_is_refused_before_anything_turns() {
    let mut session = session(circle());
    let tilted = InstrumentsConfiguration { pitch_deg: 20.0, ..world(10.0) };
    let sent = run(&mut session, &tilted, &[], Rotation::fixed(Seconds(1.0)), 200.0, 9);
    assert_eq!(sent, [0.0; 0]);
    let verdict = session.conclusion().expect("it has ended").verdict;
    assert!(matches!(verdict, Err(Refusal::TiltTooGreat { .. })), "{verdict:?}");
}

#[test]
fn samples_without_a_force_are_refused_long_before_the_sessions_time_is_over() {
    let procedure = circle();
    let longest = procedure.longest_seconds.0;
    let mut session = session(procedure);
    let mut number = 0_u32;
    while session.verdict().is_none() {
        number += 1;
        let rate = AngularRate((1000.0 * f64::from(number).sin()) as i32);
        let time = Instant(u64::from(number) * 10_000);
        session.feed(Input::Sample(&Sample { time, rate, ..Sample::default() }));
    }
    let accelerometer = Refusal::Device { device: Device::Accelerometer, trouble: Trouble::Silent };
    assert_eq!(session.verdict(), Some(Err(accelerometer)));
    assert!(0.01 * f64::from(number) < 0.1 * longest, "{number}");
}

fn ascending(positions: usize) -> Procedure {
    let schedule = Schedule::TowardMaximum {
        start: Radians(0.0),
        step: Radians::from_degrees(6.0),
        positions,
        seconds: Seconds(5.0),
    };
    let travel = [-200.0, 200.0].map(Radians::from_degrees);
    Procedure { travel, ..Procedure::new(schedule, Seconds(0.01)) }
}

#[test]
fn the_stage_turns_towards_growing_rate() {
    for (azimuth, towards) in [(60.0, -1.0), (300.0, 1.0), (150.0, -1.0), (210.0, 1.0)] {
        let mut session = session(ascending(20));
        let sent =
            run(&mut session, &world(azimuth), &[], Rotation::fixed(Seconds(0.5)), 400.0, 10);
        let last = sent.last().expect("it was sent");
        assert!(last * towards > 0.0, "{azimuth}: {sent:?}");
        assert!(error_in_sigmas(&session, azimuth).abs() < 3.5, "{azimuth}");
    }
}

#[test]
fn the_significant_stop_rule_ends_past_the_maximum_where_the_papers_stops_short() {
    let positions_with = |stop| {
        let mut session = session(Procedure { stop, ..ascending(40) });
        run(&mut session, &world(300.0), &[], Rotation::fixed(Seconds(0.5)), 600.0, 11);
        assert_eq!(session.phase, Phase::Done);
        session.dwells().len()
    };
    let (paper, significant) =
        (positions_with(StopRule::SignChange), positions_with(StopRule::Significant(3.0)));
    // The maximum is 60° away: ten steps, so that the eleventh position points north.
    assert!(paper < significant, "{paper} {significant}");
    assert!((12..16).contains(&significant), "{significant}");
}

#[test]
fn the_stage_never_leaves_its_travel() {
    let travel = [-0.2, 0.2].map(Radians);
    let mut session = session(Procedure { travel, ..ascending(20) });
    let sent = run(&mut session, &world(100.0), &[], Rotation::fixed(Seconds(0.5)), 400.0, 12);
    assert!(
        sent.iter().all(|angle| (travel[0]..=travel[1]).contains(&Radians(*angle))),
        "{sent:?}"
    );
    let positions =
        [0.0, 7.0].map(|angle| Position { angle: Radians(angle), seconds: Seconds(5.0) });
    let listed = Schedule::listed(&positions).expect("they fit");
    let begun = Session::new(setting(), Procedure::new(listed, Seconds(0.01)));
    assert_eq!(begun.err(), Some(SetupError::BeyondTravel(Radians(7.0))));
}

#[test]
fn dwells_that_the_filter_has_no_time_to_settle_in_are_unbiased() {
    // 20 samples at 100 Hz: the cut-off is a fifth of the sample rate and settling takes 42.
    let procedure = Procedure::new(Schedule::circle(24, Seconds(0.2)), Seconds(0.01));
    let (mut errors, mut ratios) = (Vec::new(), Vec::new());
    for seed in 0..200 {
        let mut session = session(procedure.clone());
        let azimuth = seed as f64 * 1.7;
        run(&mut session, &world(azimuth), &[], Rotation::fixed(Seconds(0.1)), 60.0, 1000 + seed);
        errors.push(error_in_sigmas(&session, azimuth));
        let fit = session.conclusion().and_then(|conclusion| conclusion.fit.as_ref());
        let fit = fit.expect("there is a fit");
        ratios.push(fit.sigma().0 / fit.limit.0);
    }
    let ratio = orientation::math::median(&mut ratios);
    assert!(ratio < 1.12, "{ratio} of the limit");
    let rms = host::campaign::statistics::rms(&errors);
    // A tenth of the sessions scatter by chance as if the base had moved, which widens their σ.
    assert!((0.8..1.12).contains(&rms), "RMS {rms} σ");
}

#[test]
fn a_dwell_too_short_for_the_filters_lag_is_no_procedure() {
    let begun =
        Session::new(setting(), Procedure::new(Schedule::circle(12, Seconds(0.1)), Seconds(0.01)));
    assert!(matches!(begun.err(), Some(SetupError::DwellTooShort { samples: 10, .. })));
}

/// A plan for the gyro of these tests on a stage that takes a second to turn.
fn planned(seconds: f64) -> Schedule {
    let conditions = Conditions {
        noise: *setting().site.noise.model(),
        rotation: Rotation::fixed(Seconds(1.0)),
        shortest: Seconds(1.0),
        fewest: 8,
        orders: &Order::COMPARED,
    };
    Schedule::Planned(for_time(&conditions, Seconds(seconds)).expect("there is time"))
}

/// A session that is to reach σ of so many degrees within so many seconds, by a gyro of so many times
/// the stated noise; how many dwells it took and what came of it.
fn until(sigma_deg: f64, seconds: f64, noise: f64, seed: u64) -> (Session, f64) {
    let required_sigma = sigma_deg.to_radians();
    let procedure = Procedure::new(planned(60.0), Seconds(0.01)).until_accurate(Seconds(seconds));
    let mut session = Session::new(
        Setting::new(Site { required_sigma: Radians(required_sigma), ..setting().site }),
        procedure,
    )
    .expect("it begins");
    let mut configuration = world(123.4);
    configuration.gyro.n_deg_sqrt_h *= noise;
    run(&mut session, &configuration, &[], Rotation::fixed(Seconds(1.0)), 4.0 * seconds, seed);
    let end = session.dwells().last().map_or(0.0, |dwell| dwell.end().0);
    (session, end)
}

#[test]
fn a_session_ends_as_soon_as_the_accuracy_asked_for_is_reached() {
    // √2 N/(Ω_h √T) is 0.062° for N = 0.001 °/√h, 47.58° and 60 s of dwells.
    for (wanted, least, most) in [(0.1, 20.0, 62.0), (0.05, 95.0, 130.0), (0.035, 190.0, 250.0)] {
        let (session, end) = until(wanted, 400.0, 1.0, 3);
        let azimuth = session.conclusion().expect("done").verdict.expect("it is reached");
        assert!(azimuth.sigma.degrees() <= wanted, "{wanted}: {azimuth:?}");
        assert!((least..most).contains(&end), "{wanted}° took {end} s");
        assert!(error_in_sigmas(&session, 123.4).abs() < 3.5);
    }
}

#[test]
fn a_session_goes_on_when_its_dwells_scatter_more_than_the_noise_predicts() {
    let mean_end = |noise: f64| {
        let ends = (1..=8).map(|seed| {
            let (session, end) = until(0.068, 500.0, noise, seed);
            assert!(session.conclusion().expect("done").verdict.is_ok());
            end
        });
        ends.sum::<f64>() / 8.0
    };
    let (quiet, noisy) = (mean_end(1.0), mean_end(1.3));
    assert!((60.0..75.0).contains(&quiet), "{quiet} s");
    // 1.3² = 1.69 times the time, in steps of four positions, and some whose scatter widens σ by more.
    assert!((1.5..2.3).contains(&(noisy / quiet)), "{quiet} s, {noisy} s");
}

#[test]
fn a_session_that_cannot_reach_its_accuracy_in_time_says_so_early_and_how_near_it_could_come() {
    let (session, end) = until(0.01, 300.0, 1.0, 5);
    let verdict = session.conclusion().expect("done").verdict;
    let Err(Refusal::Stepwise(stepwise::Refusal::OutOfReach { sigma, required, seconds })) =
        verdict
    else {
        panic!("{verdict:?}")
    };
    assert!((required.0 - 0.01).abs() < 1e-9 && seconds.0 == 300.0);
    // White noise: √2 N/(Ω_h √T) for the dwells' part of 300 s.
    assert!((0.027..0.032).contains(&sigma.0), "{sigma:?}");
    assert!(end < 70.0, "it took {end} s to see that");
}

/// A session that stands still for ten minutes first, to know its gyro.
fn surveyed(configuration: &InstrumentsConfiguration, stop: StopRule, seed: u64) -> Session {
    let survey = Survey {
        seconds: Seconds(600.0),
        rotation: Rotation::fixed(Seconds(1.0)),
        orders: &Order::COMPARED,
        shortest: Seconds(1.0),
        plan_seconds: Seconds(240.0),
    };
    let procedure = Procedure { stop, ..circle().after(survey) };
    // What the data sheet says is five times what this gyro does.
    let stated = StatedNoise::Whole(GyroNoise::from_field_units(5.0 * N_DEG_SQRT_H, 0.0, 0.0, 0.0));
    let required_sigma = 0.05_f64.to_radians();
    let setting = Setting::new(Site {
        noise: stated,
        required_sigma: Radians(required_sigma),
        ..setting().site
    });
    let mut session = Session::new(setting, procedure).expect("it begins");
    run(&mut session, configuration, &[], Rotation::fixed(Seconds(1.0)), 2000.0, seed);
    session
}

#[test]
fn a_survey_learns_the_gyros_noise_and_the_plan_and_sigma_follow_from_it() {
    for (seed, azimuth) in [(21, 40.0), (22, 160.0), (23, 280.0)] {
        let session = surveyed(&world(azimuth), StopRule::AllPositions, seed);
        let [_, (_, found), ..] = session.surveyed.expect("there was a survey").in_field_units();
        let n = found.value().expect("N is observable");
        assert!((n / N_DEG_SQRT_H - 1.0).abs() < 0.02, "{n}");
        let Schedule::Planned(plan) = session.procedure.schedule else { panic!("no plan") };
        assert!(
            (plan.seconds.0 - 240.0).abs() < 1e-9 && session.dwells().len() == plan.positions()
        );
        // √2 N/(Ω_h √T) for the plan's dwells.
        let standing = plan.dwell.0 * plan.positions() as f64 / 3600.0;
        let rate = setting().site.latitude.horizontal_rate().0.to_degrees() * 3600.0;
        let expected = 2.0_f64.sqrt() * N_DEG_SQRT_H / (rate * standing.sqrt());
        let sigma = session.conclusion().expect("done").verdict.expect("north").sigma;
        assert!((sigma.0 / expected - 1.0).abs() < 0.05, "{sigma:?} against {expected}");
        assert!(error_in_sigmas(&session, azimuth).abs() < 3.5);
    }
}

#[test]
fn a_survey_that_shows_the_accuracy_out_of_reach_ends_before_anything_turns() {
    let mut noisy = world(70.0);
    noisy.gyro.n_deg_sqrt_h = 0.02;
    let session = surveyed(&noisy, StopRule::Accuracy { seconds: Seconds(900.0) }, 24);
    let verdict = session.conclusion().expect("done").verdict;
    // The 900 s after the survey give √2·0.02/(10.15·√(1/4)) rad = 0.32°, less the rotations' time.
    assert!(
        matches!(verdict, Err(Refusal::Stepwise(stepwise::Refusal::OutOfReach { sigma, .. })) if (0.32..0.36).contains(&sigma.0)),
        "{verdict:?}"
    );
    assert!(session.dwells().is_empty());
    // The same gyro as stated and five times the time: what is asked for is reached.
    let quiet = surveyed(&world(70.0), StopRule::Accuracy { seconds: Seconds(900.0) }, 25);
    let azimuth = quiet.conclusion().expect("done").verdict.expect("it is reached");
    assert!(azimuth.sigma.degrees() <= 0.05);
}

#[test]
fn a_survey_of_a_stuck_or_saturated_gyro_says_so() {
    let mut stuck = world(70.0);
    stuck.gyro.n_deg_sqrt_h = 0.0;
    let session = surveyed(&stuck, StopRule::AllPositions, 26);
    let verdict = session.conclusion().expect("done").verdict;
    assert_eq!(
        verdict,
        Err(Refusal::Stepwise(stepwise::Refusal::NoiseUnknown(FitError::Constant)))
    );
    let overload =
        Disturbance { start_s: 100.0, seconds: 1.0, rate_deg_h: 1e9, ..Disturbance::default() };
    let mut session = Session::new(
        setting(),
        circle().after(Survey {
            seconds: Seconds(300.0),
            rotation: Rotation::fixed(Seconds(1.0)),
            orders: &Order::COMPARED,
            shortest: Seconds(1.0),
            plan_seconds: Seconds(240.0),
        }),
    )
    .expect("it begins");
    run(&mut session, &world(70.0), &[overload], Rotation::fixed(Seconds(1.0)), 900.0, 27);
    let verdict = session.conclusion().expect("done").verdict;
    assert_eq!(
        verdict,
        Err(Refusal::Stepwise(stepwise::Refusal::NoiseUnknown(FitError::Saturated)))
    );
}

//! Hundreds of instruments drawn at random: a stated σ is true, and a healthy run is not refused.

use std::collections::BTreeMap;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::disturbance::Disturbance;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::noise::Generator;
use hal_mock::stage::Stop;
use hal_mock::world::{World, WorldConfiguration};
use host::campaign::statistics::rms;
use host::methods::stepwise::drive;
use host::output::azimuth_error;
use host::simulate::stage_path;
use orientation::alignment::Azimuth;
use orientation::alignment::Input;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise;
use orientation::alignment::stepwise::session::Session;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::schedule::{Position, Schedule};
use orientation::alignment::stepwise::setting::Setting;
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::units::{GSensitivity, MetresPerSecondSquared, Radians, Seconds};
use rayon::prelude::*;

/// One instrument at one place, with what the solver is stated of it.
struct Case {
    world: InstrumentsConfiguration,
    setting: Setting,
    stops: Vec<Stop>,
    seconds: f64,
}

/// Between `low` and `high`, evenly in the logarithm.
fn logarithmic(generator: &mut Generator, low: f64, high: f64) -> f64 {
    low * (high / low).powf(generator.uniform())
}

/// A draw of everything; `arc` limits the turn to 60–180° with a well-calibrated instrument.
fn case(seed: u64, arc: bool) -> Case {
    let mut generator = Generator::new(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * generator.uniform();
    let (latitude_deg, azimuth_deg) = (between(-70.0, 70.0), between(0.0, 360.0));
    let tilt = if arc { 0.01 } else { 5.0 };
    let (pitch_deg, roll_deg) = (between(-tilt, tilt), between(-tilt, tilt));
    let kappa = [between(-20.0, 20.0), between(-20.0, 20.0)];
    let positions = between(4.0, 37.0) as usize;
    let span = if arc { between(60.0, 180.0) } else { 360.0 };
    let seconds = between(3.0, 12.0);
    let n = logarithmic(&mut generator, 2e-4, if arc { 1e-3 } else { 2e-2 });
    let b = if generator.uniform() < 0.5 { 0.0 } else { n * 5.0 };
    let k = if generator.uniform() < 0.5 { 0.0 } else { n * 30.0 };
    let r = if generator.uniform() < 0.5 { 0.0 } else { n * 300.0 };
    let scale_sigma = if arc { 2e-4 } else { 0.02 };
    let kappa_sigma = 0.02;
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: n,
        b_deg_h: b,
        k_deg_h_sqrt_h: k,
        r_deg_h2: r * generator.gaussian(),
        bias_sigma_deg_h: 3.0,
        scale_sigma,
        g_sensitivity_deg_h_g: kappa.map(|part| part + kappa_sigma * generator.gaussian()),
        ..GyroConfiguration::default()
    };
    let accelerometer_bias_sigma = if arc { 1e-4 } else { 0.1 };
    let world = InstrumentsConfiguration {
        latitude_deg,
        azimuth_deg,
        pitch_deg,
        roll_deg,
        rate_hz: 50.0,
        gyro,
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 2.5e-4,
            bias_sigma_m_s2: accelerometer_bias_sigma,
            ..AccelerometerConfiguration::default()
        },
        ..InstrumentsConfiguration::default()
    };
    let setting = Setting::new(Site {
        noise: StatedNoise::Whole(GyroNoise::from_field_units(n, b, k, r)),
        scale_sigma,
        g_sensitivity: kappa.map(GSensitivity::from_degrees_per_hour),
        g_sensitivity_sigma: GSensitivity::from_degrees_per_hour(kappa_sigma),
        accelerometer_bias_sigma: MetresPerSecondSquared(accelerometer_bias_sigma),
        ..Site::at(Latitude::from_degrees(latitude_deg).expect("it is one"))
    });
    let step = (span / positions as f64).to_radians();
    let stops = (0..positions).map(|i| Stop::new(i as f64 * step, seconds).after(1.0)).collect();
    Case { world, setting, stops, seconds }
}

fn verdict(case: &Case, disturbances: &[Disturbance], seed: u64) -> Result<Azimuth, Refusal> {
    let positions: Vec<Position> = case
        .stops
        .iter()
        .map(|stop| Position { angle: Radians(stop.angle_rad), seconds: Seconds(case.seconds) })
        .collect();
    let schedule = Schedule::listed(&positions).expect("they fit");
    let procedure = Procedure { retries: 0, ..Procedure::new(schedule, Seconds(0.02)) };
    let mut session = Session::new(case.setting, procedure).expect("it begins");
    let configuration =
        WorldConfiguration { instruments: case.world, stops: &case.stops, disturbances };
    let world = World::new(configuration, seed);
    drive(&mut session, world.map(|reading| stage_path(&reading)), Input::End, |_| {});
    session.conclusion().expect("it has ended").verdict
}

/// Errors over σ of those that answered, and the refusals of the others.
fn sweep(
    cases: u64,
    draw: impl Fn(u64) -> (Case, Vec<Disturbance>) + Sync,
) -> (Vec<f64>, BTreeMap<String, usize>) {
    let verdicts: Vec<(f64, Result<Azimuth, Refusal>)> = (0..cases)
        .into_par_iter()
        .map(|seed| {
            let (case, disturbances) = draw(seed);
            (case.world.azimuth_deg, verdict(&case, &disturbances, seed + 1_000_000))
        })
        .collect();
    let mut refusals = BTreeMap::new();
    let mut errors = Vec::new();
    for (truth, verdict) in verdicts {
        match verdict {
            Ok(Azimuth { angle, sigma }) => {
                errors.push(azimuth_error(angle.degrees(), truth) / sigma.degrees());
            }
            Err(reason) => {
                let name = format!("{reason:?}");
                let name = name.split([' ', '{']).next().unwrap_or_default().to_owned();
                *refusals.entry(name).or_default() += 1;
            }
        }
    }
    (errors, refusals)
}

fn within(errors: &[f64], sigmas: f64) -> f64 {
    let inside = errors.iter().filter(|error| error.abs() <= sigmas).count();
    100.0 * inside as f64 / errors.len() as f64
}

/// Asserts that the stated σ is true: coverage within two points of the normal's, or what 1000
/// cases scatter, and hardly a refusal.
fn assert_true(errors: &[f64], refusals: &BTreeMap<String, usize>, allowed: usize) {
    println!("{} answers, RMS {:.3} σ, refused {refusals:?}", errors.len(), rms(errors));
    assert!(refusals.values().sum::<usize>() <= allowed, "{refusals:?}");
    assert!((0.93..1.07).contains(&rms(errors)), "RMS {} σ", rms(errors));
    for (sigmas, normal, tolerance) in [(1.0, 68.3, 4.0), (2.0, 95.4, 2.0), (3.0, 99.7, 0.6)] {
        let found = within(errors, sigmas);
        assert!((found - normal).abs() <= tolerance, "within {sigmas} σ: {found} %");
    }
    assert!(errors.iter().all(|error| error.abs() < 5.0), "a wrong north was reported as right");
}

#[test]
fn on_a_full_circle_sigma_is_true_for_any_instrument() {
    let (errors, refusals) = sweep(1000, |seed| (case(seed, false), Vec::new()));
    assert_true(&errors, &refusals, 0);
}

#[test]
fn on_an_arc_sigma_is_true_for_any_instrument() {
    let (errors, refusals) = sweep(1000, |seed| (case(seed, true), Vec::new()));
    assert_true(&errors, &refusals, 0);
}

#[test]
fn an_estimated_noise_gives_a_true_sigma_too() {
    let unknown = |seed| {
        let mut case = case(seed, seed % 2 == 0);
        let noise = *case.setting.site.noise.model();
        case.setting.site.noise = StatedNoise::ExceptWhite(noise);
        (case, Vec::new())
    };
    let (errors, refusals) = sweep(1000, unknown);
    assert_true(&errors, &refusals, 2);
}

/// A nudge or a bump of any size, from unnoticeable to wild, somewhere in the run.
fn disturbed(seed: u64) -> (Case, Vec<Disturbance>) {
    let case = case(seed, false);
    let mut generator = Generator::new(seed + 77);
    let whole = case.stops.len() as f64 * (case.seconds + 1.0);
    let seconds = case.seconds * (0.1 + 0.8 * generator.uniform());
    let start_s = generator.uniform() * (whole - seconds);
    // In units of the noise of a mean over the disturbance.
    let noise = case.world.gyro.n_deg_sqrt_h * 60.0 / seconds.sqrt();
    let rate_deg_h = noise * logarithmic(&mut generator, 1.0, 1000.0);
    let disturbance = if seed.is_multiple_of(2) {
        Disturbance { start_s, seconds, rate_deg_h, ..Disturbance::default() }
    } else {
        let rate_deg_h = 30.0 * rate_deg_h;
        Disturbance {
            start_s,
            seconds,
            frequency_hz: 3.0,
            rate_deg_h,
            force_m_s2: [0.05, 0.02, 0.0],
        }
    };
    (case, vec![disturbance])
}

#[test]
fn a_disturbance_of_any_size_never_makes_a_wrong_north() {
    let (errors, refusals) = sweep(2000, disturbed);
    println!("{} answers, RMS {:.3} σ, refused {refusals:?}", errors.len(), rms(&errors));
    assert!(errors.len() > 1900, "{refusals:?}");
    // What is too small to be noticed may add to the noise, but not more than the noise itself.
    assert!(rms(&errors) < 1.2, "RMS {} σ", rms(&errors));
    let worst = errors.iter().map(|error| error.abs()).fold(0.0, f64::max);
    // Four positions leave one degree of freedom: a nudge over most of one dwell hides best there.
    assert!(worst < 6.0, "an error of {worst} σ");
}

/// Where cos φ changes enough to show: a latitude that is 12° wrong, between 35° and 70°.
#[test]
fn a_wrong_latitude_shows_in_the_earth_rate() {
    let wrong = |seed| {
        let mut case = case(seed, seed % 2 == 0);
        let latitude = 47.0 + 10.0 * (seed as f64 * 0.7).sin();
        case.world.latitude_deg = latitude;
        case.setting.site.latitude = Latitude::from_degrees(latitude + 12.0).expect("it is one");
        (case, Vec::new())
    };
    let (errors, refusals) = sweep(600, wrong);
    println!("{} answers, RMS {:.3} σ, refused {refusals:?}", errors.len(), rms(&errors));
    // Near the equator, or within the gyro's own scale tolerance, nothing can tell.
    assert!(errors.len() < 6, "{} answers", errors.len());
}

/// A quiet instrument on a full circle, to be spoilt in one way.
fn sound() -> Case {
    let mut case = case(4, false);
    case.world.latitude_deg = 50.0;
    case.world.pitch_deg = 0.5;
    case.world.roll_deg = 0.5;
    case.setting.site.latitude = Latitude::from_degrees(50.0).expect("it is one");
    let gyro = GyroConfiguration { n_deg_sqrt_h: 0.001, ..GyroConfiguration::default() };
    case.world.gyro = gyro;
    *case.setting.site.noise.model_mut() = GyroNoise::from_field_units(0.001, 0.0, 0.0, 0.0);
    case.setting.site.g_sensitivity = [GSensitivity(0.0); 2];
    turned(&mut case, 12, 30.0);
    case
}

fn turned(case: &mut Case, positions: u32, step_deg: f64) {
    let step = step_deg.to_radians();
    case.stops =
        (0..positions).map(|i| Stop::new(f64::from(i) * step, case.seconds).after(1.0)).collect();
}

#[test]
fn a_sound_instrument_is_not_refused() {
    assert!(verdict(&sound(), &[], 1).is_ok());
}

#[test]
fn two_positions_are_too_few() {
    let mut case = sound();
    turned(&mut case, 2, 180.0);
    assert_eq!(verdict(&case, &[], 2), Err(Refusal::Stepwise(stepwise::Refusal::SignUnknown)));
    // Coming back to the same two places does not help.
    case.stops.extend_from_within(..);
    assert_eq!(verdict(&case, &[], 3), Err(Refusal::Stepwise(stepwise::Refusal::SignUnknown)));
}

#[test]
fn a_short_arc_about_the_turning_point_cannot_tell() {
    let mut case = sound();
    // The rate's slope alone shows: A and 180° − A fit alike.
    case.world.azimuth_deg = 60.0;
    case.world.pitch_deg = 0.0;
    case.world.roll_deg = 0.0;
    turned(&mut case, 6, 1.0);
    let verdict = verdict(&case, &[], 4);
    assert!(
        matches!(
            verdict,
            Err(Refusal::Stepwise(stepwise::Refusal::AzimuthUnobservable)
                | Refusal::BudgetNotMet { .. })
        ),
        "{verdict:?}"
    );
}

#[test]
fn an_accelerometer_bias_on_a_short_arc_makes_the_tilt_too_uncertain() {
    let mut case = sound();
    case.setting.site.accelerometer_bias_sigma = MetresPerSecondSquared(5.0);
    case.world.accelerometer.noise_m_s2_sqrt_hz = 0.5;
    case.setting.site.required_sigma = Radians::from_degrees(0.5);
    turned(&mut case, 12, 4.0);
    let verdict = verdict(&case, &[], 5);
    assert!(
        matches!(verdict, Err(Refusal::Stepwise(stepwise::Refusal::TiltTooUncertain { .. }))),
        "{verdict:?}"
    );
}

#[test]
fn a_gyro_that_is_noisier_than_stated_is_refused() {
    let mut case = sound();
    case.world.gyro.k_deg_h_sqrt_h = 20.0;
    let verdict = verdict(&case, &[], 6);
    assert!(
        matches!(
            verdict,
            Err(Refusal::ResidualsNotWhite { .. }
                | Refusal::ResidualsCorrelated { .. }
                | Refusal::Stepwise(stepwise::Refusal::Disturbed { .. }))
        ),
        "{verdict:?}"
    );
}

#[test]
fn a_platform_that_tips_during_a_dwell_loses_that_dwell() {
    let case = sound();
    let tip = Disturbance {
        start_s: 3.0 * (case.seconds + 1.0),
        seconds: case.seconds,
        frequency_hz: 0.1,
        rate_deg_h: 0.0,
        force_m_s2: [0.5, 0.0, 0.0],
    };
    assert!(verdict(&case, &[tip], 7).is_ok());
}

/// Runs a spoilt instrument many times; the azimuths that came out, as errors over σ.
fn answers(runs: u64, spoil: impl Fn(&mut Case, u64) -> Vec<Disturbance> + Sync) -> Vec<f64> {
    let errors = (0..runs).into_par_iter().filter_map(|seed| {
        let mut case = sound();
        let disturbances = spoil(&mut case, seed);
        let Azimuth { angle, sigma } = verdict(&case, &disturbances, seed).ok()?;
        let error = azimuth_error(angle.degrees(), case.world.azimuth_deg);
        Some(error / sigma.degrees())
    });
    errors.collect()
}

fn greatest(errors: &[f64]) -> f64 {
    errors.iter().map(|error| error.abs()).fold(0.0, f64::max)
}

#[test]
fn an_accelerometer_that_does_not_feel_gravity_is_refused() {
    let spoil: [fn(f64) -> [f64; 3]; 3] =
        [|_| [0.0, 0.0, 9.81], |_| [0.0, 0.0, 19.62], |_| [0.0, 0.0, 8.8]];
    for bias in spoil {
        let mut case = sound();
        case.world.accelerometer.bias_m_s2 = bias(0.0);
        case.setting.site.accelerometer_bias_sigma = MetresPerSecondSquared(0.05);
        let verdict = verdict(&case, &[], 8);
        let refused = matches!(verdict, Err(Refusal::AccelerometerImplausible { .. }));
        assert!(refused, "{:?}: {verdict:?}", bias(0.0));
    }
}

#[test]
fn a_scale_error_that_is_not_stated_is_named_whichever_way_it_goes() {
    for scale_error in [-0.04, -0.03, 0.03, 0.04] {
        let mut case = sound();
        case.world.gyro.scale_error = scale_error;
        case.setting.site.scale_sigma = 0.0;
        let verdict = verdict(&case, &[], 9);
        let named = matches!(verdict, Err(Refusal::EarthRateMismatch { .. }));
        assert!(named, "{scale_error}: {verdict:?}");
    }
}

#[test]
fn an_unknown_g_sensitivity_refuses_no_healthy_run_and_leaves_sigma_true() {
    let errors = answers(300, |case, seed| {
        let mut generator = Generator::new(seed);
        case.world.pitch_deg = 6.0 * generator.uniform() - 3.0;
        case.world.roll_deg = 6.0 * generator.uniform() - 3.0;
        let kappa = [generator.gaussian(), generator.gaussian()];
        case.world.gyro.g_sensitivity_deg_h_g = kappa.map(|k| 10.0 * k);
        case.setting.site.g_sensitivity_sigma = GSensitivity::from_degrees_per_hour(10.0);
        case.setting.site.scale_sigma = 0.0;
        if seed % 2 == 0 {
            turned(case, 12, 15.0);
        }
        Vec::new()
    });
    assert!(errors.len() >= 297, "{} of 300 answered", errors.len());
    assert!((0.85..1.15).contains(&rms(&errors)), "RMS {} σ", rms(&errors));
}

#[test]
fn few_positions_and_a_nudge_over_a_whole_dwell_stay_within_what_can_be_noticed() {
    let errors = answers(400, |case, seed| {
        let positions = 4 + seed as u32 % 3;
        turned(case, positions, 360.0 / f64::from(positions));
        let mut generator = Generator::new(seed);
        let dwell = (generator.uniform() * f64::from(positions)).floor();
        let noise = 0.001 * 60.0 / case.seconds.sqrt();
        vec![Disturbance {
            start_s: dwell * (case.seconds + 1.0),
            seconds: case.seconds,
            rate_deg_h: noise * (3.0 + 7.0 * generator.uniform()),
            ..Disturbance::default()
        }]
    });
    println!("{} answers, RMS {}, greatest {} σ", errors.len(), rms(&errors), greatest(&errors));
    // One degree of freedom shows half of a nudge in one of four dwells: what it hides may reach
    // this much, no more.
    assert!(errors.len() < 200 && rms(&errors) < 2.1 && greatest(&errors) < 6.5);
}

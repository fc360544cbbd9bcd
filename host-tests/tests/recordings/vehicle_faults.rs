//! What a vehicle's recording shows of faults: in itself, and in what its header says.

use hal_mock::noise::Generator;
use host::methods::asked::Asked;
use host::methods::error::ReplayError;
use host::methods::stops::floor::Spectrum;
use host::methods::stops::{Replay, grade, noise, replay};
use host::recording::{Body, Header, ImuRow};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::site::Site;
use orientation::alignment::stops::Setting;
use orientation::alignment::stops::session::{Procedure, Session};
use orientation::alignment::stops::stop_detector::Rests;
use orientation::alignment::{Input, Method};
use orientation::earth::Latitude;
use orientation::signal::InertialSample;
use orientation::units::{Instant, Seconds};

use crate::support::files::recording;

const FOG: &str = "drive-fog-1dph";
const IDEAL: &str = "drive-ideal";
const PARKED: &str = "parked-swaying";

fn recorded(name: &str) -> (Header, Vec<ImuRow>) {
    let (header, body, _) = recording(name).into_parts();
    let Body::Imu(rows) = body else { panic!("{name} is {}", body.kind()) };
    (header, rows)
}

fn replayed(header: &Header, rows: &[ImuRow]) -> Result<Replay, ReplayError> {
    replay(header, &Body::Imu(rows.to_vec()), &Asked::default())
}

fn reason(header: &Header, rows: &[ImuRow]) -> String {
    replayed(header, rows).expect_err("it does not replay").to_string()
}

#[test]
fn a_rate_that_the_times_contradict_by_more_than_a_per_cent_is_refused_with_both() {
    let (mut header, rows) = recorded(FOG);
    header.rate_hz = Some(25.5);
    let reason = reason(&header, &rows);
    println!("{reason}");
    assert!(reason.contains("rate_hz: 25.5 Hz") && reason.contains("25.000 Hz, 2.0 %"), "{reason}");
    header.rate_hz = Some(25.1);
    let replay = replayed(&header, &rows).expect("within a per cent");
    // What is left of the contradiction is a scale error.
    assert!(replay.session.setting.site.scale_sigma >= 0.003);
}

/// A session that is given one period and given another, s.
fn paced(reported: f64, given: f64, tolerance: f64) -> Option<Refusal> {
    let latitude = Latitude::from_degrees(50.0).expect("a latitude");
    let procedure = Procedure {
        period_tolerance: tolerance,
        ..Procedure::recorded(Rests::Whole, Seconds(reported))
    };
    let setting = Setting::new(Site::at(latitude));
    let mut session = Session::new(setting, procedure).expect("a procedure");
    for index in 1..2000 {
        let time = Instant::from_seconds(f64::from(index) * given);
        let sample = InertialSample { time, ..InertialSample::default() };
        session.feed(Input::Sample(&sample));
    }
    session.feed(Input::End);
    session.conclusion().and_then(|conclusion| conclusion.verdict.err())
}

#[test]
fn a_session_is_held_to_its_sample_period_as_far_as_its_clock_goes() {
    let is_refused = |reported, given, tolerance| {
        matches!(paced(reported, given, tolerance), Some(Refusal::PeriodContradicted { .. }))
    };
    assert!(is_refused(0.02, 0.0203, 0.01));
    assert!(!is_refused(0.02, 0.0201, 0.01));
    // A converter's own oscillator may be 2 % off.
    assert!(!is_refused(0.02, 0.0203, 0.02) && is_refused(0.02, 0.0206, 0.02));
    let words = paced(0.02, 0.0203, 0.01).map(|reason| reason.to_string());
    assert_eq!(
        words.as_deref(),
        Some(
            "samples come every 20.2998 ms, not every 20.0000 ms as stated: correct the sample rate or the times"
        )
    );
}

#[test]
fn gyros_in_degrees_per_second_are_named() {
    for name in [FOG, PARKED] {
        let (header, mut rows) = recorded(name);
        for row in &mut rows {
            row.sample.rates_rad_s = row.sample.rates_rad_s.map(f64::to_degrees);
        }
        // Sway hides what the rate at rest is.
        let Err(error) = replayed(&header, &rows) else { continue };
        println!("{name}: {error}");
        assert!(error.to_string().contains("57.3 in °/s: convert them"), "{error}");
    }
}

#[test]
fn displacements_in_kilometres_are_named() {
    let (mut header, rows) = recorded(IDEAL);
    header.gyro_scale_sigma = Some(0.0);
    header.accelerometer_bias_m_s2 = Some(0.0);
    let places = header.displacements_m.as_mut().expect("it states them");
    places.iter_mut().flatten().for_each(|part| *part /= 1000.0);
    let reason = reason(&header, &rows);
    println!("{reason}");
    assert!(reason.contains("kilometres") && reason.contains("state them in metres"), "{reason}");
}

#[test]
fn a_stuck_gyro_is_named_by_its_column_with_a_remedy() {
    let (header, mut rows) = recorded(FOG);
    for row in &mut rows[5000..] {
        row.sample.rates_rad_s[1] = 1e-4;
    }
    let reason = reason(&header, &rows);
    println!("{reason}");
    for words in ["gy_rad_s", "stuck", "check its supply"] {
        assert!(reason.contains(words), "{reason}");
    }
}

#[test]
fn a_recording_without_latitude_says_what_can_be_had_without_it() {
    let (mut header, rows) = recorded(FOG);
    header.latitude_deg = None;
    let reason = reason(&header, &rows);
    assert!(reason.contains("--latitude") && reason.contains("--method vertical"), "{reason}");
}

#[test]
fn noise_is_refused_where_there_is_nothing_to_estimate_it_from() {
    let (mut header, rows) = recorded(FOG);
    header.gyro_n_deg_sqrt_h = None;
    header.stops_s = Some(vec![[0.0, 1.0], [960.0, 961.0]]);
    assert_eq!(replayed(&header, &rows).expect_err("25 samples"), ReplayError::NoiseUnknown);
    // What was stated needs no estimate: the stops are too short for another reason.
    header.gyro_n_deg_sqrt_h = Some(0.05);
    assert!(replayed(&header, &rows).is_ok());
}

#[test]
fn what_the_header_says_of_grade_counts_zero_too() {
    let mut assumed = Vec::new();
    let silent = Header { gyro_bias_deg_h: Some(0.01), ..Header::default() };
    let filled = grade::filled(&silent, &mut assumed);
    assert_eq!(assumed.len(), 3, "{assumed:?}");
    assert!(filled.gyro_scale_sigma > Some(0.0) && filled.accelerometer_bias_m_s2 > Some(0.0));
    // Accelerometers beside a navigation gyro: 0.2 mg.
    assert!((filled.accelerometer_bias_m_s2.expect("it is filled") - 2e-3).abs() < 1e-9);
    let stated = Header {
        gyro_scale_sigma: Some(0.0),
        accelerometer_bias_m_s2: Some(0.0),
        g_sensitivity_deg_h_g: Some([0.0; 2]),
        ..silent
    };
    assumed.clear();
    assert_eq!(grade::filled(&stated, &mut assumed), stated);
    assert!(assumed.is_empty(), "{assumed:?}");
}

#[test]
fn noise_that_was_stated_too_small_is_taken_as_the_recording_shows_it() {
    for (name, true_n) in [(FOG, 0.05), (PARKED, 0.01)] {
        let (mut header, rows) = recorded(name);
        header.gyro_n_deg_sqrt_h = Some(true_n / 10.0);
        let replay = replayed(&header, &rows).expect("it replays");
        let walk = replay.session.setting.site.noise.model().angle_random_walk;
        let n = walk.0 / orientation::units::DEGREE_PER_SQRT_HOUR;
        println!("{name}: {n:.4} °/√h of {true_n}");
        assert!((n / true_n - 1.0).abs() < 0.3, "{name}: {n}");
        let is_reported = |words: &String| words.contains("more than the stated");
        assert!(replay.assumed.iter().any(is_reported), "{:?}", replay.assumed);
    }
}

#[test]
fn a_false_bias_of_a_vehicle_that_stands_widens_sigma() {
    let (mut header, rows) = recorded(PARKED);
    let options = Asked { method: Some("static"), ..Asked::default() };
    let sigma = |header: &Header| {
        let replay = replay(header, &Body::Imu(rows.clone()), &options).expect("it replays");
        replay
            .session
            .conclusion()
            .and_then(|it| it.found)
            .map(|found| (found.azimuth.sigma.0, found.widening))
    };
    let (honest, _) = sigma(&header).expect("something was found");
    header.gyro_bias_deg_h = Some(0.0002);
    let (kept, widening) = sigma(&header).expect("something was found");
    println!("{honest} {kept} {widening}");
    assert!(widening >= 1.0 && kept > 0.0);
}

#[test]
fn the_floor_of_a_spectrum_is_the_white_noise_beneath_noise_of_the_angle_and_sway() {
    let (period_s, count) = (0.02, 30_000);
    let mut chance = Generator::new(5);
    for (angle, sway) in [(0.0, 0.0), (3e-6, 0.0), (0.0, 1e-2), (3e-6, 1e-2)] {
        let mut before = 0.0;
        let mut sample = |index: usize| {
            let now = angle * chance.gaussian();
            let blue = (now - std::mem::replace(&mut before, now)) / period_s;
            let slow = sway * (std::f64::consts::TAU * 0.37 * index as f64 * period_s).sin();
            1e-6 / period_s.sqrt() * chance.gaussian() + blue + slow
        };
        let signal: Vec<f64> = (0..count).map(&mut sample).collect();
        let mut spectrum = Spectrum::new(period_s);
        signal.chunks(3000).for_each(|stretch| spectrum.push(stretch));
        let floor = spectrum.floor().expect("there is a spectrum");
        let walk = floor.white.sqrt();
        println!(
            "{angle} {sway}: {walk:.3e} ± {:.2}, {:.2e}",
            floor.relative_sigma,
            floor.angle.sqrt()
        );
        assert!((walk / 1e-6 - 1.0).abs() < 0.25, "{walk}");
        assert!((floor.angle.sqrt() - angle).abs() < 0.1 * angle + 2e-7, "{}", floor.angle.sqrt());
    }
    let (_, rows) = recorded(PARKED);
    let white = noise::at_rest(&rows, None, 0.04).unwrap_or_default();
    assert!(white.force > 0.0);
}

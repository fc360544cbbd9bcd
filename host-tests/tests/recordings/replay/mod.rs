//! The recordings of an independent simulator, replayed through the session.

mod moment;
mod slow;

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::fmt::Write;

use hal_mock::noise::Generator;
use host::campaign::statistics::rms;
use host::methods::asked::Asked;
use host::methods::error::ReplayError;
use host::methods::stepwise::{Replay, replay};
use host::outcome::{self, Finished};
use host::output::{azimuth_error, columns};
use host::recording::{Body, Header, StageRow, Truth};
use host::report::{Look, Verbosity};
use orientation::alignment::budget::Source;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::quality::Disturbance;
use orientation::alignment::stepwise::setting::Half;
use orientation::earth::Latitude;
use orientation::units::Radians;
use rayon::prelude::*;

use crate::support::files::recording;
use crate::support::program::words;

struct Replayed {
    replay: Replay,
    header: Header,
    truth_deg: f64,
}

impl Replayed {
    fn conclusion(&self) -> &Conclusion {
        self.replay.session.conclusion().expect("the session has ended")
    }

    /// Error and σ, °; none where it is refused.
    fn answer(&self) -> Option<(f64, f64)> {
        let azimuth = self.conclusion().verdict.ok()?;
        let error = azimuth_error(azimuth.angle.degrees(), self.truth_deg);
        Some((error, azimuth.sigma.degrees()))
    }

    /// Error and σ, °.
    fn error_and_sigma(&self) -> (f64, f64) {
        self.answer().expect("there is an azimuth")
    }

    fn sigma_over_limit(&self) -> f64 {
        let fit = self.conclusion().fit.as_ref().expect("there is a fit");
        fit.sigma().0 / fit.limit.0
    }

    /// The dwells left out: start, end, why.
    fn excluded(&self) -> Vec<(f64, f64, Disturbance)> {
        let dwells = self.replay.session.dwells().iter().zip(&self.conclusion().disturbances);
        dwells.filter_map(|(d, why)| why.map(|why| (d.start().0, d.end().0, why))).collect()
    }
}

fn replayed_with(name: &str, options: &Asked) -> Replayed {
    let (header, body, truth) = recording(name).into_parts();
    let replay = replay(&header, &body, options, |_| {}).expect("it replays");
    Replayed { replay, header, truth_deg: truth.azimuth_deg.expect("it carries a truth") }
}

/// The rows of a stage, of which the truth is known.
fn of_rows(header: &Header, rows: Vec<StageRow>, truth_deg: f64) -> Result<Replayed, ReplayError> {
    let replay = replay(header, &Body::Stage(rows), &Asked::default(), |_| {})?;
    Ok(Replayed { replay, header: header.clone(), truth_deg })
}

fn replayed(name: &str) -> Replayed {
    replayed_with(name, &Asked::default())
}

const ALL: [&str; 10] = [
    "positions-four-fog",
    "stepwise-bumped",
    "stepwise-circle",
    "stepwise-mems",
    "stepwise-nudged",
    "stepwise-paper-1",
    "stepwise-paper-2",
    "stepwise-paper-3",
    "stepwise-tilted-drift",
    "stepwise-unknown-g",
];

#[test]
fn every_recording_gives_north_within_three_and_a_half_sigma() {
    for name in ALL {
        let (error, sigma) = replayed(name).error_and_sigma();
        println!("{name}: {error:+.4}° ± {sigma:.4}°");
        assert!(error.abs() <= 3.5 * sigma, "{name}: {error}° ± {sigma}°");
    }
}

#[test]
fn sigma_is_within_a_tenth_of_the_limit_where_noise_alone_limits() {
    for name in ALL.iter().filter(|name| **name != "stepwise-unknown-g") {
        let ratio = replayed(name).sigma_over_limit();
        assert!((0.999..1.1).contains(&ratio), "{name}: σ is {ratio} of the limit");
    }
}

#[test]
fn the_limit_on_the_full_circle_is_the_closed_form() {
    for name in ["stepwise-circle", "stepwise-bumped", "stepwise-nudged"] {
        let replayed = replayed(name);
        let n = replayed.header.gyro_n_deg_sqrt_h.expect("N is stated");
        let latitude = replayed.header.latitude_deg.expect("it is stated").to_radians();
        let kept = replayed.replay.session.dwells().iter().zip(&replayed.conclusion().disturbances);
        let hours: f64 =
            kept.filter(|(_, why)| why.is_none()).map(|(d, _)| d.seconds.0 / 3600.0).sum();
        // √2 N / (Ω_h √T), and what a dwell left out of twelve changes of the circle's symmetry.
        let expected = 2.0_f64.sqrt() * n / (15.041_067 * latitude.cos() * hours.sqrt());
        let fit = replayed.conclusion().fit.as_ref().expect("there is a fit");
        assert!((fit.limit.0 / expected - 1.0).abs() < 0.12, "{name}: {} {expected}", fit.limit.0);
    }
}

#[test]
fn a_bumped_and_a_nudged_dwell_are_left_out_and_nothing_else() {
    for (name, from, to) in [("stepwise-bumped", 47.0, 51.0), ("stepwise-nudged", 79.0, 83.0)] {
        let excluded = replayed(name).excluded();
        assert_eq!(excluded.len(), 1, "{name}: {excluded:?}");
        assert!(excluded[0].0 < from && to < excluded[0].1, "{name}: {excluded:?}");
    }
    for name in ALL.iter().filter(|name| !name.ends_with("bumped") && !name.ends_with("nudged")) {
        assert_eq!(replayed(name).excluded(), [], "{name}");
    }
}

#[test]
fn an_unknown_g_sensitivity_dominates_and_is_said_to() {
    let replayed = replayed("stepwise-unknown-g");
    let fit = replayed.conclusion().fit.as_ref().expect("there is a fit");
    assert_eq!(fit.budget.dominant(fit.excess), Some(Source::GSensitivity));
    let (finished, truth) = (&replayed.replay, Truth::default());
    let block = outcome::report("x", &finished.outcome(&truth), finished, Vec::new())
        .text(Look::plain(Verbosity::Usual));
    let dominates = "g-sensitivity dominates: level the platform mechanically";
    assert!(words(&block).contains(dominates), "{block}");
}

#[test]
fn a_mems_gyro_is_honestly_good_to_one_or_two_degrees() {
    let replayed = replayed("stepwise-mems");
    let (_, sigma) = replayed.error_and_sigma();
    assert!((1.0..2.0).contains(&sigma), "{sigma}");
    let fit = replayed.conclusion().fit.as_ref().expect("there is a fit");
    assert!(fit.earth_rate_is_free());
    assert!((fit.ratio - 1.0).abs() < 2.0 * fit.ratio_sigma);
}

#[test]
fn all_of_the_papers_criteria_answer_within_their_sigma() {
    let criteria = [
        Criterion::LeastSquares,
        Criterion::LeastAbsolute,
        host::criterion::parse("within-squares=0.05").expect("it parses"),
    ];
    for criterion in criteria {
        for name in ["stepwise-circle", "stepwise-paper-1", "stepwise-paper-2", "stepwise-paper-3"]
        {
            let options = Asked { criterion: Some(criterion), ..Asked::default() };
            let (error, sigma) = replayed_with(name, &options).error_and_sigma();
            assert!(error.abs() <= 3.5 * sigma, "{name} {criterion:?}: {error} ± {sigma}");
        }
    }
}

#[test]
fn a_left_out_dwell_makes_the_steps_uneven_for_the_papers_criteria() {
    let options = Asked { criterion: Some(Criterion::LeastSquares), ..Asked::default() };
    let replayed = replayed_with("stepwise-bumped", &options);
    assert_eq!(
        replayed.conclusion().verdict,
        Err(Refusal::Stepwise(stepwise::Refusal::StepsUneven))
    );
}

#[test]
fn a_wrong_latitude_is_noticed_by_the_earth_rate() {
    let options = Asked { latitude: Latitude::from_degrees(60.0), ..Asked::default() };
    let replayed = replayed_with("stepwise-circle", &options);
    let verdict = replayed.conclusion().verdict;
    assert!(matches!(verdict, Err(Refusal::EarthRateMismatch { .. })), "{verdict:?}");
}

#[test]
fn the_wrong_half_of_the_circle_gives_no_azimuth_that_is_wrong() {
    for name in ALL {
        for half in [Half::East, Half::West] {
            let options = Asked { half: Some(half), ..Asked::default() };
            let replayed = replayed_with(name, &options);
            let conclusion = replayed.conclusion();
            let is_right = half.contains(Radians::from_degrees(replayed.truth_deg));
            match conclusion.verdict {
                Ok(_) => {
                    let (error, sigma) = replayed.error_and_sigma();
                    assert!(error.abs() < 4.0 * sigma, "{name}, {half:?}: {error}° ± {sigma}°");
                }
                Err(reason) => assert!(!is_right, "{name}, {half:?}: {reason}"),
            }
        }
    }
}

#[test]
fn beyond_eighty_five_degrees_north_is_refused() {
    let options = Asked { latitude: Latitude::from_degrees(-85.5), ..Asked::default() };
    let replayed = replayed_with("stepwise-circle", &options);
    let verdict = replayed.conclusion().verdict;
    assert!(matches!(verdict, Err(Refusal::LatitudeTooHigh { .. })), "{verdict:?}");
}

#[test]
fn a_demand_beyond_the_limit_is_refused_and_names_what_limits() {
    let required_sigma = Some(0.01_f64.to_radians());
    let options = Asked { required_sigma, ..Asked::default() };
    let replayed = replayed_with("stepwise-circle", &options);
    let verdict = replayed.conclusion().verdict;
    let Err(Refusal::BudgetNotMet { source, .. }) = verdict else { panic!("{verdict:?}") };
    assert_eq!(source, Source::Noise);
}

#[test]
fn noise_that_is_not_stated_is_estimated_from_the_dwells() {
    for name in ["stepwise-circle", "stepwise-tilted-drift"] {
        let (mut header, body, truth) = recording(name).into_parts();
        let stated = header.gyro_n_deg_sqrt_h.take().expect("N is stated");
        let replay = replay(&header, &body, &Asked::default(), |_| {}).expect("it replays");
        let conclusion = replay.session.conclusion().expect("it has ended");
        let found = conclusion.angle_random_walk.0.to_degrees() * 60.0;
        assert!((found / stated - 1.0).abs() < 0.15, "{name}: {found} for {stated}");
        let azimuth = conclusion.verdict.expect("there is an azimuth");
        let truth = truth.azimuth_deg.expect("it carries a truth");
        let error = azimuth_error(azimuth.angle.degrees(), truth);
        assert!(error.abs() < 3.5 * azimuth.sigma.degrees(), "{name}: {error}");
    }
}

#[test]
fn rows_of_averaged_dwells_give_the_same_north_as_their_samples() {
    let sampled = replayed("stepwise-tilted-drift");
    let mut text = String::from("# kind: dwells\n# latitude_deg: 55.75\n");
    text += "# gyro_K_deg_h_sqrt_h: 0.2\n# gyro_R_deg_h2: 2\n# g_sensitivity_deg_h_g: 9,-5\n";
    text += "# g_sensitivity_sigma_deg_h_g: 0.05\n# accelerometer_bias_m_s2: 0.05\n";
    text += "stage_rad,rate_rad_s,sigma_rad_s,seconds,mid_s,fx_m_s2,fy_m_s2,fz_m_s2\n";
    let density = 0.004 * (PI / 180.0 / 60.0);
    for dwell in sampled.replay.session.dwells() {
        let sigma = density / dwell.seconds.0.sqrt() * dwell.taper.sqrt();
        let [x, y, z] = dwell.force.expect("it was measured").map(|part| part.0);
        let (stage, rate) = (dwell.stage.rad(), dwell.rate.0);
        let (seconds, middle) = (dwell.seconds.0, dwell.middle.0);
        writeln!(text, "{stage:e},{rate:e},{sigma:e},{seconds},{middle},{x:e},{y:e},{z:e}")
            .expect("strings take all");
    }
    let replay = replayed_dwells(&text, &Asked::default()).expect("it replays");
    let conclusion = replay.session.conclusion().expect("it has ended");
    let (a, b) = (conclusion.verdict.expect("ok"), sampled.conclusion().verdict.expect("ok"));
    assert!(
        (a.angle.0 - b.angle.0).abs() < 1e-9 && (a.sigma.0 - b.sigma.0).abs() < 1e-9,
        "{a:?} {b:?}"
    );
}

/// A recording of so many dwells of 10 s in steps of 42° at 55.75°, whose noise is that of 0.001 °/√h, and its 1σ in
/// rad/s.
fn dwells(count: usize, azimuth_deg: f64) -> (String, f64) {
    dwells_with(count, azimuth_deg, |_, _| [0.0; 2])
}

/// What turns the heading, rad, and adds to the rate, in the horizontal Earth rate, at a part of the time and a stage
/// angle.
type Disturbing = fn(f64, f64) -> [f64; 2];

/// Averaged dwells of a circle while something is disturbed.
fn dwells_with(count: usize, azimuth_deg: f64, disturbed: Disturbing) -> (String, f64) {
    let sigma = 0.001_f64.to_radians() / 60.0 / 10.0_f64.sqrt();
    let horizontal = 15.041_067_f64.to_radians() / 3600.0 * 55.75_f64.to_radians().cos();
    let mut noise = Generator::stream(1, 1);
    let mut text = String::from("# kind: dwells\n# latitude_deg: 55.75\n");
    text += "# gyro_N_deg_sqrt_h: 0.001\n# gyro_B_deg_h: 0\n# gyro_K_deg_h_sqrt_h: 0\n";
    text += "# gyro_R_deg_h2: 0\n# gyro_scale_sigma: 0.0001\n";
    text += "stage_rad,rate_rad_s,sigma_rad_s,seconds\n";
    for index in 0..count {
        let stage = (42.0 * index as f64).rem_euclid(360.0).to_radians();
        let [turned, added] = disturbed(index as f64 / count as f64, stage);
        let heading = azimuth_deg.to_radians() + stage + turned;
        let rate = horizontal * (heading.cos() + added) + sigma * noise.gaussian();
        writeln!(text, "{stage:e},{:e},{sigma:e},10", rate + 1e-7).expect("strings take all");
    }
    (text, sigma / horizontal)
}

fn replayed_dwells(text: &str, options: &Asked) -> Result<Replay, ReplayError> {
    let recording = host::recording::read_from("dwells.csv", text.as_bytes()).expect("it reads");
    let (header, body, _) = recording.into_parts();
    replay(&header, &body, options, |_| {})
}

#[test]
fn a_thousand_positions_are_one_alignment_and_one_more_is_refused() {
    let azimuth_deg = 213.7;
    let (text, sigma) = dwells(1024, azimuth_deg);
    for criterion in [Criterion::MaximumLikelihood, Criterion::OnTable, Criterion::LeastAbsolute] {
        let options = Asked { criterion: Some(criterion), ..Asked::default() };
        let replay = replayed_dwells(&text, &options).expect("it replays");
        let conclusion = replay.session.conclusion().expect("it has ended");
        let azimuth = conclusion.verdict.expect("there is an azimuth");
        let error = azimuth_error(azimuth.angle.degrees(), azimuth_deg).to_radians();
        assert!(
            error.abs() < 3.5 * azimuth.sigma.0,
            "{criterion:?}: {error} ± {}",
            azimuth.sigma.0
        );
        // √(2/n) σ of a dwell over the Earth rate, for positions spread over the circle.
        let limit = conclusion.fit.as_ref().expect("there is a fit").limit;
        let expected = sigma * (2.0_f64 / 1024.0).sqrt();
        assert!((limit.0 / expected - 1.0).abs() < 0.02, "{criterion:?}: {limit:?} {expected}");
    }
    let (text, _) = dwells(1025, azimuth_deg);
    let error = replayed_dwells(&text, &Asked::default()).err().map(|error| error.to_string());
    assert!(error.is_some_and(|words| words.contains("1025 positions are more than the 1024")));
}

#[test]
fn what_explains_the_dwells_beside_the_earth_rate_stands_in_the_model_and_costs_no_truth() {
    let disturbed: [(&str, Disturbing); 4] = [
        ("yaws", |part, _| [0.1 * (part - 1.0), 0.0]),
        ("second harmonic", |_, stage| [0.02 * (2.0 * stage).sin(), 0.0]),
        ("t²", |part, _| [0.0, 0.1 * part * part]),
        ("t³", |part, _| [0.0, 0.08 * (-3.0 * part).exp()]),
    ];
    for (name, disturbed) in disturbed {
        let (text, _) = dwells_with(45, 213.7, disturbed);
        let replay = replayed_dwells(&text, &Asked::default()).expect("it replays");
        let conclusion = replay.session.conclusion().expect("it has ended");
        let azimuth = conclusion.verdict.expect(name);
        let model = columns(conclusion.fit.as_ref().expect("there is a fit"));
        assert!(model.iter().any(|column| column.contains(name)), "{name}: {model:?}");
        let error = azimuth_error(azimuth.angle.degrees(), 213.7).to_radians();
        assert!(error.abs() < 4.0 * azimuth.sigma.0, "{name}: {error} ± {}", azimuth.sigma.0);
    }
}

/// Stage angles, °, and the 1σ of a dwell, °/h, of signals at which noise is not small against the
/// Earth rate: arcs from 45° to 120° and circles of few positions.
const WEAK: [(&[f64], f64); 6] = [
    (&[0.0, 15.0, 30.0, 45.0], 0.2),
    (&[0.0, 15.0, 30.0, 45.0, 60.0], 0.5),
    (&[0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0], 1.0),
    (&[0.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0], 1.3),
    (&[0.0, 90.0, 180.0, 270.0], 1.2),
    (&[0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0], 2.0),
];

/// Error over σ of averaged dwells whose gyro is stated by their σ alone; none where it is refused.
fn of_weak_signal(angles_deg: &[f64], sigma_deg_h: f64, seed: u64) -> Option<f64> {
    let mut generator = Generator::stream(seed, 9);
    let azimuth_deg = 360.0 * generator.uniform();
    let horizontal = 15.041_067 * 50_f64.to_radians().cos();
    let mut text = String::from("# kind: dwells\n# latitude_deg: 50\n");
    text += "stage_rad,rate_rad_s,sigma_rad_s,seconds\n";
    for angle in angles_deg {
        let stage = angle.to_radians();
        let heading = azimuth_deg.to_radians() + stage;
        let rate = horizontal * heading.cos() + 0.7 + sigma_deg_h * generator.gaussian();
        let [rate, sigma] = [rate, sigma_deg_h].map(|rate| rate.to_radians() / 3600.0);
        writeln!(text, "{stage:e},{rate:e},{sigma:e},60").expect("strings take all");
    }
    let replay = replayed_dwells(&text, &Asked::default()).expect("it replays");
    let azimuth = replay.session.conclusion().expect("it has ended").verdict.ok()?;
    Some(azimuth_error(azimuth.angle.degrees(), azimuth_deg) / azimuth.sigma.degrees())
}

#[test]
fn a_signal_that_noise_all_but_hides_is_refused_or_within_its_sigma() {
    for (angles_deg, sigma_deg_h) in WEAK {
        let errors: Vec<f64> = (0..200)
            .into_par_iter()
            .filter_map(|seed| of_weak_signal(angles_deg, sigma_deg_h, seed))
            .collect();
        let greatest = errors.iter().map(|error| error.abs()).fold(0.0, f64::max);
        let rms = rms(&errors);
        println!("{angles_deg:?}: {} found, RMS {rms:.2}, greatest {greatest:.1} σ", errors.len());
        assert!(errors.len() > 20, "{angles_deg:?}: {} found", errors.len());
        assert!(greatest < 4.0, "{angles_deg:?}: {greatest} σ");
        assert!((0.7..1.35).contains(&rms), "{angles_deg:?}: RMS {rms} σ");
    }
}

#[test]
fn what_no_dwell_can_tell_is_assumed() {
    let assumes = |name: &str, words: &str| {
        replayed(name).replay.assumed.iter().any(|assumed| assumed.contains(words))
    };
    for name in ["stepwise-circle", "stepwise-paper-1", "positions-four-fog"] {
        assert!(assumes(name, "drift in step with the turn"), "{name}");
        assert!(assumes(name, "last quarter of the dwells"), "{name}");
    }
    assert!(assumes("stepwise-paper-1", "scale of the gyro, which no arc shows"));
    assert!(!assumes("stepwise-circle", "scale of the gyro, which no arc shows"));
    assert!(!assumes("stepwise-tilted-drift", "sense of the stage"));
    assert!(!assumes("stepwise-tilted-drift", "sign of the gyro"));
}

#[test]
fn dwells_without_forces_are_reported_to_be_taken_as_level() {
    let mut text =
        "# kind: dwells\n# latitude_deg: 45\nstage_rad,rate_rad_s,sigma_rad_s,seconds\n".to_owned();
    for position in 0..9 {
        let stage = f64::from(position) * 0.25 * PI;
        let rate = 7.292_115e-5 * FRAC_1_SQRT_2 * (0.7 + stage).cos();
        writeln!(text, "{stage},{rate},1e-8,60").expect("a String takes all");
    }
    let (header, body, _) =
        host::recording::read_from("level", text.as_bytes()).expect("it reads").into_parts();
    let replay = replay(&header, &body, &Asked::default(), |_| {}).expect("it replays");
    let level =
        "a level platform, for there are no forces: by each degree of tilt north is 1.00° off";
    assert!(replay.assumed.iter().any(|line| line == level), "{:?}", replay.assumed);
}

/// What it does to a row.
type Change = fn(&mut StageRow);

/// Ways in which a stage may be built otherwise than stated: what a row then shows.
const OTHERWISE: [(&str, Change); 4] = [
    ("sign of the gyro", |row| row.rate_rad_s = -row.rate_rad_s),
    ("axes of the accelerometer", |row| {
        let [x, y, z] = row.force_m_s2;
        row.force_m_s2 = [-x, -y, z];
    }),
    ("axes of the accelerometer", |row| {
        let [x, y, z] = row.force_m_s2;
        row.force_m_s2 = [y, -x, z];
    }),
    ("axes of the accelerometer", |row| {
        let [x, y, z] = row.force_m_s2;
        row.force_m_s2 = [-y, x, z];
    }),
];

#[test]
fn a_stage_that_is_built_otherwise_is_refused_or_stands_under_what_is_assumed_with_its_size() {
    let mut reported = 0;
    for name in ALL {
        let (header, body, truth) = recording(name).into_parts();
        let truth_deg = truth.azimuth_deg.expect("it carries a truth");
        let Body::Stage(rows) = body else { continue };
        for (words, change) in OTHERWISE {
            let mut rows = rows.clone();
            rows.iter_mut().for_each(change);
            let replayed = of_rows(&header, rows, truth_deg).expect("it replays");
            let Some((error, sigma)) = replayed.answer() else { continue };
            let error = error.abs();
            if error > 4.0 * sigma {
                let size = size_of(&replayed.replay.assumed, words);
                let size = size.unwrap_or_else(|| panic!("{name}, {words}: {error}° in silence"));
                // The wrong gravity gives the other sensitivities another size, too.
                assert!(
                    error < 1.1 * size + 4.0 * sigma,
                    "{name}, {words}: {error}° beyond {size}°"
                );
                reported += 1;
            }
        }
    }
    assert!(reported > 12, "only {reported} are wrong at all");
}

#[test]
fn accelerometer_biases_that_drift_are_distinguished_from_a_base_that_tilts() {
    let per_second = [3e-5, 1e-4, 1e-3].map(|per_minute| per_minute / 60.0);
    let mut answered = 0;
    for name in ["stepwise-circle", "positions-four-fog", "stepwise-tilted-drift", "stepwise-mems"]
    {
        for (rate, [x, y]) in
            per_second.into_iter().flat_map(|rate| [(rate, [1.0, -1.0]), (rate, [0.5, 1.0])])
        {
            let (header, body, truth) = recording(name).into_parts();
            let Body::Stage(mut rows) = body else { panic!("{name} is no stage") };
            for row in &mut rows {
                let drift = 9.81 * rate * row.time_s;
                row.force_m_s2 = [
                    row.force_m_s2[0] + x * drift,
                    row.force_m_s2[1] + y * drift,
                    row.force_m_s2[2],
                ];
            }
            let options = Asked::default();
            let replay = replay(&header, &Body::Stage(rows), &options, |_| {}).expect("it replays");
            let verdict = replay.session.conclusion().expect("it has ended").verdict;
            let Ok(azimuth) = verdict else { continue };
            let truth_deg = truth.azimuth_deg.expect("it carries a truth");
            let error = azimuth_error(azimuth.angle.degrees(), truth_deg);
            let sigma = azimuth.sigma.degrees();
            assert!(error.abs() < 4.0 * sigma, "{name}, {rate} g/s: {error}° ± {sigma}°");
            answered += 1;
        }
    }
    assert!(answered >= 22, "only {answered} of 24 are answered");
}

#[test]
fn a_dead_accelerometer_across_the_vertical_is_named() {
    for axes in [vec![0], vec![1], vec![0, 1]] {
        let (header, body, _) = recording("stepwise-circle").into_parts();
        let Body::Stage(mut rows) = body else { panic!("it is a stage") };
        for (index, row) in rows.iter_mut().enumerate() {
            for axis in &axes {
                row.force_m_s2[*axis] = if index % 2 == 0 { 0.0 } else { -0.0 };
            }
        }
        let error = replay(&header, &Body::Stage(rows), &Asked::default(), |_| {}).err();
        let column = ["fx_m_s2", "fy_m_s2"][axes[0]];
        assert!(
            matches!(error, Some(ReplayError::Stuck { column: named, .. }) if named == column),
            "{axes:?}: {error:?}"
        );
    }
}

/// The size in ° that what is assumed in these words has.
fn size_of(assumed: &[String], words: &str) -> Option<f64> {
    let line = assumed.iter().find(|line| line.starts_with(words))?;
    let before = line.rsplit_once("° away")?.0;
    before.rsplit_once(' ')?.1.parse().ok()
}

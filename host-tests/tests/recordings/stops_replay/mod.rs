//! Recordings of vehicles, replayed through the session that finds the azimuth from stops.

mod oracle;
mod output;
mod parts;
mod spoilt;

use host::methods::asked::Asked;
use host::methods::stops::averaging::Averages;
use host::methods::stops::{Replay, SIAP, STATIC, replay};
use host::output::{azimuth_error, degrees, degrees_per_hour};
use host::recording::{Body, Header, ImuRow, Truth};
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops::conclusion::{Conclusion, Found};
use orientation::units::Radians;

use crate::support::files::recording;

const IDEAL: &str = "drive-ideal";
const FOG: &str = "drive-fog-1dph";
const THREE: &str = "drive-fog-three-stops";
const PARKED: &str = "parked-swaying";

/// Greatest error in σ that a recording's noise makes.
const SIGMAS: f64 = 3.5;

/// A recording, its truth apart.
struct Recorded {
    header: Header,
    rows: Vec<ImuRow>,
    truth: Truth,
}

fn recorded(name: &str) -> Recorded {
    let (header, body, truth) = recording(name).into_parts();
    let Body::Imu(rows) = body else { panic!("{name} is {}", body.kind()) };
    Recorded { header, rows, truth }
}

impl Recorded {
    fn replayed_by(&self, options: &Asked) -> Replay {
        let body = Body::Imu(self.rows.clone());
        replay(&self.header, &body, options).expect("it replays")
    }

    fn replayed(&self) -> Replay {
        self.replayed_by(&Asked::default())
    }

    fn refusal(&self) -> Refusal {
        conclusion(&self.replayed()).verdict.expect_err("it is refused")
    }

    /// Error at the end, °, and its σ, °.
    fn error(&self, conclusion: &Conclusion) -> [f64; 2] {
        let azimuth = conclusion.verdict.expect("there is an azimuth");
        off(azimuth, self.truth.azimuth_deg)
    }

    /// Error of the azimuth at the start, and its σ.
    fn start_error(&self, conclusion: &Conclusion) -> [f64; 2] {
        off(found(conclusion).start, self.truth.start_azimuth_deg)
    }
}

fn off(azimuth: Azimuth, truth_deg: Option<f64>) -> [f64; 2] {
    let truth = truth_deg.expect("it carries a truth");
    [azimuth_error(azimuth.angle.degrees(), truth), azimuth.sigma.degrees()]
}

fn found(conclusion: &Conclusion) -> &Found {
    conclusion.found.as_ref().expect("there was something to solve")
}

fn conclusion(replay: &Replay) -> &Conclusion {
    replay.session.conclusion().expect("the session has ended")
}

#[test]
fn an_ideal_drive_gives_north_within_three_thousandths_of_a_degree_at_both_ends() {
    let recorded = recorded(IDEAL);
    let replay = recorded.replayed();
    let conclusion = conclusion(&replay);
    let ([end, _], [start, _]) = (recorded.error(conclusion), recorded.start_error(conclusion));
    println!("{start:+.5}° at the start, {end:+.5}° at the end");
    assert!(start.abs() <= 0.003 && end.abs() <= 0.003, "{start}° {end}°");
}

#[test]
fn fibre_optic_gyros_give_north_within_their_sigma_at_both_ends() {
    for name in [FOG, THREE] {
        let recorded = recorded(name);
        let replay = recorded.replayed();
        let conclusion = conclusion(&replay);
        for [error, sigma] in [recorded.error(conclusion), recorded.start_error(conclusion)] {
            println!("{name}: {error:+.4}° ± {sigma:.4}°");
            assert!(error.abs() <= SIGMAS * sigma, "{name}: {error}° ± {sigma}°");
        }
    }
}

#[test]
fn rest_rates_leave_at_most_a_third_of_what_the_papers_method_leaves() {
    let recorded = recorded(FOG);
    let replay = recorded.replayed();
    let conclusion = conclusion(&replay);
    let [_, sigma] = recorded.error(conclusion);
    let plain = &found(conclusion).plain;
    println!("{sigma:.4}° by everything, {:.4}° by the paper", plain.sigma.degrees());
    assert!(sigma <= plain.sigma.degrees() / 3.0, "{sigma}° {}°", plain.sigma.degrees());
    // And the paper's own σ is an honest one.
    let start_deg = recorded.truth.start_azimuth_deg;
    let [error, sigma] = off(Azimuth { angle: plain.azimuth, sigma: plain.sigma }, start_deg);
    assert!(error.abs() <= SIGMAS * sigma, "{error}° ± {sigma}°");
}

#[test]
fn three_stops_show_the_biases_that_the_gyros_had() {
    let replay = recorded(THREE).replayed();
    let found = found(conclusion(&replay));
    assert!(found.are_biases_observed);
    let both = found.biases.into_iter().zip(found.bias_sigmas);
    for ((bias, sigma), truth) in both.zip([0.9, 0.7, -1.1]) {
        let [bias, sigma] = [bias.0, sigma.0].map(degrees_per_hour);
        println!("{bias:+.4} ± {sigma:.4} °/h, truly {truth}");
        assert!((bias - truth).abs() <= 3.0 * sigma, "{bias} ± {sigma}, truly {truth}");
        // 1 °/h was what was known of them.
        assert!(sigma < 0.5, "{sigma}");
    }
}

#[test]
fn a_swaying_vehicle_aligns_where_averaging_does_not() {
    let recorded = recorded(PARKED);
    let options = Asked { method: Some("static"), ..Asked::default() };
    let replay = recorded.replayed_by(&options);
    let [error, sigma] = recorded.error(conclusion(&replay));
    println!("{error:+.4}° ± {sigma:.4}°");
    assert!(error.abs() <= SIGMAS * sigma && error.abs() < 0.5, "{error}° ± {sigma}°");
    let mut averages = Averages::default();
    for ImuRow { sample, .. } in &recorded.rows {
        averages.push(sample.rates_rad_s, sample.force_m_s2);
    }
    let plain = Azimuth { angle: Radians(averages.azimuth()), sigma: Radians(0.0) };
    let [averaged, _] = off(plain, recorded.truth.azimuth_deg);
    println!("{averaged:+.4}° by averaging");
    assert!(averaged.abs() > 3.0 * error.abs(), "{averaged}° by averaging, {error}°");
}

#[test]
fn a_recording_without_stops_shows_by_itself_what_it_is() {
    assert_eq!(recorded(PARKED).replayed().method, STATIC);
    for name in [IDEAL, FOG, THREE] {
        let mut recorded = recorded(name);
        assert_eq!(recorded.replayed().method, SIAP);
        recorded.header.stops_s = None;
        assert_eq!(recorded.replayed().method, SIAP);
    }
}

#[test]
fn the_criteria_find_the_stops_that_were_not_stated() {
    for name in [IDEAL, FOG, THREE] {
        let mut recorded = recorded(name);
        let stated = recorded.header.stops_s.take().expect("they are stated");
        let replay = recorded.replayed();
        let found: Vec<[f64; 2]> = replay
            .session
            .stops()
            .iter()
            .map(|stop| [stop.from, stop.to].map(|time| time.0 + replay.zero_s))
            .collect();
        println!("{name}: {found:?}");
        assert_eq!(found.len(), stated.len(), "{name}: {found:?}");
        for (found, stated) in found.iter().zip(&stated) {
            // Averages of 10 s lag behind; what is found lies within what is true.
            assert!(
                found[0] >= stated[0] - 1.0 && found[1] <= stated[1] + 1.0,
                "{name}: {found:?}"
            );
            assert!(found[1] - found[0] > 30.0, "{name}: {found:?}");
        }
        let [error, sigma] = recorded.error(conclusion(&replay));
        assert!(error.abs() <= SIGMAS * sigma.max(0.001), "{name}: {error}° ± {sigma}°");
    }
}

#[test]
fn brents_search_and_the_closed_form_agree_on_every_drive() {
    for name in [IDEAL, FOG, THREE] {
        let replay = recorded(name).replayed();
        let plain = &found(conclusion(&replay)).plain;
        let apart = |azimuth: f64| azimuth_error(degrees(azimuth), plain.azimuth.degrees()).abs();
        let [angle, euler] = [plain.angle.at, plain.euler.at].map(apart);
        println!("{name}: {angle:.1e}° as an angle, {euler:.1e}° in Euler form");
        assert!(angle < 1e-6, "{name}: {angle}°");
        // The minima of both forms are up to 4e-4° apart on a real residual.
        assert!(euler < 1e-3, "{name}: {euler}°");
    }
}

#[test]
fn an_independent_solution_of_the_drives_agrees_with_the_papers_method() {
    for name in [IDEAL, FOG, THREE] {
        let recorded = recorded(name);
        let independent = oracle::start_azimuth_deg(&recorded.header, &recorded.rows);
        let replay = recorded.replayed();
        let plain = &found(conclusion(&replay)).plain;
        let apart = azimuth_error(plain.azimuth.degrees(), independent);
        println!("{name}: {apart:+.1e}° from the independent solution");
        // The heading at the first stop is that of its middle here, a mean of all of it there: gyros that
        // walk turn by 0.05 °/√h · √30 s = 0.005° between.
        let same = if name == IDEAL { 1e-3 } else { 0.01 };
        assert!(apart.abs() < same, "{name}: {apart}°");
    }
}

#[test]
fn an_unknown_displacement_costs_accuracy_and_nothing_else() {
    let mut recorded = recorded(FOG);
    let known = recorded.replayed();
    recorded.header.displacements_m = None;
    let unknown = recorded.replayed();
    let [_, known] = recorded.error(conclusion(&known));
    let [error, sigma] = recorded.error(conclusion(&unknown));
    println!("± {known:.4}° known, {error:+.4}° ± {sigma:.4}° unknown");
    assert!(sigma > known && error.abs() <= SIGMAS * sigma, "{error}° ± {sigma}°, {known}°");
}

#[test]
fn displacements_of_the_user_count_before_those_of_the_header() {
    let mut recorded = recorded(IDEAL);
    let displacements_m = recorded.header.displacements_m.take();
    let options = Asked { displacements_m: displacements_m.clone(), ..Asked::default() };
    let reported = recorded.replayed_by(&options);
    recorded.header.displacements_m = Some(vec![[0.0; 2], [9e3, 9e3]]);
    let instead = recorded.replayed_by(&options);
    let angle = |replay: &Replay| conclusion(replay).verdict.map(|azimuth| azimuth.angle);
    assert_eq!(angle(&reported), angle(&instead));
    let [error, _] = recorded.error(conclusion(&reported));
    assert!(error.abs() <= 0.003, "{error}°");
}

#[test]
fn what_is_not_known_is_said() {
    let mut recorded = recorded(FOG);
    recorded.header.gyro_n_deg_sqrt_h = None;
    recorded.header.gyro_bias_deg_h = None;
    let replay = recorded.replayed();
    let says = |words: &str| replay.assumed.iter().any(|assumed| assumed.contains(words));
    for words in [
        "gyro noise N",
        "accelerometer noise",
        "gyro biases unknown",
        "gyro scale errors unknown",
        "accelerometer biases unknown",
        "g-sensitivity unknown",
        "latitude exact",
    ] {
        assert!(says(words), "{words}: {:?}", replay.assumed);
    }
    assert!(!says("encoder"), "{:?}", replay.assumed);
    assert!(!replay.session.setting.site.noise.is_white_known());
}

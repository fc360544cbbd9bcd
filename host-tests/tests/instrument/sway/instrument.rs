//! The whole instrument on a base that sways.

use drivers::fault::Fault as BusFault;
use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::{BaseReading, BaseSensors, Startable};
use firmware::sway::SwayCompensation;
use host::instrument::{Run, RunError, Trial, align_on};
use host::methods::stepwise::Replay;
use host::output::{azimuth_error, degrees};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise;
use orientation::device::Device;
use orientation::signal::sway::CoarseSensors;
use orientation::units::{AngularRate, DEGREE, DEGREE_PER_HOUR, SpecificForce};
use rayon::prelude::*;
use simulated::coarse::CoarseClass;
use simulated::fault::{ChipFault, Fault};
use simulated::mount::FramesScenario;
use simulated::scenario::{GyroClass, Scenario};

use crate::support::campaign::{Extent, campaigns};

/// Amplitudes, °, and frequencies, Hz, of the sways.
const SWAYS: [(f64, f64); 6] =
    [(0.05, 2.0), (0.1, 1.0), (0.2, 0.5), (0.5, 0.3), (0.1, 0.5), (0.05, 0.3)];

fn run(scenario: &Scenario) -> Run {
    Trial::of(scenario).run().expect("the scenario is possible")
}

/// The scenario of a seed: another azimuth and another sway each.
fn scenario(seed: u64) -> Scenario {
    let (sway_deg, sway_hz) = SWAYS[(seed % 6) as usize];
    let azimuth_deg = (137.5 * seed as f64).rem_euclid(360.0);
    Scenario { seed, azimuth_deg, sway_deg, sway_hz, has_base_imu: true, ..Scenario::default() }
}

/// Error and σ of a run, °.
fn found<T>(scenario: &Scenario, run: &Run<Replay, T>) -> Result<[f64; 2], Refusal> {
    let verdict = run.conclusion().expect("every run concludes").verdict;
    verdict.map(|azimuth| {
        let error = azimuth_error(azimuth.angle.degrees(), scenario.azimuth_deg);
        [error, azimuth.sigma.degrees()]
    })
}

/// σ of a fit, °, without what it allows for doubts: these are chance.
fn sigma_of_the_fit(run: &Run) -> f64 {
    let fit = run.conclusion().and_then(|conclusion| conclusion.fit.as_ref());
    degrees(fit.expect("a healthy run has a fit").direction.variance.sqrt())
}

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

fn reported(run: &Run) -> Vec<String> {
    run.events.iter().map(|(_, event)| event.to_string()).collect()
}

/// Azimuth by plain least squares on all dwells of a full circle, whatever the session says, °.
fn plain_azimuth(run: &Run) -> f64 {
    let dwells = run.replay.session.dwells();
    let part = |of: fn(f64) -> f64| {
        dwells.iter().map(|dwell| dwell.rate.0 * of(dwell.stage.rad())).sum::<f64>()
    };
    // Rates are Ω_h cos(A + θ): the sine's coefficient is −sin A.
    (-part(f64::sin)).atan2(part(f64::cos)).to_degrees()
}

campaigns! {
    a_subtracted_sway_leaves_an_azimuth_with_its_true_sigma;
    what_would_be_wrong_by_tens_of_degrees_becomes_right_to_a_few;
}

fn a_subtracted_sway_leaves_an_azimuth_with_its_true_sigma(extent: Extent) {
    let runs = extent.of(48);
    let outcomes: Vec<[f64; 2]> = (1..=runs as u64)
        .into_par_iter()
        .filter_map(|seed| {
            let scenario = scenario(seed);
            let run = run(&scenario);
            assert_eq!(run.violations, Vec::<String>::new());
            match found(&scenario, &run) {
                Ok(outcome) => Some(outcome),
                // By chance its dwells scatter as if something moved, which widens σ.
                Err(Refusal::BudgetNotMet { sigma, .. }) if sigma.0 < 12.0 => None,
                Err(reason) => panic!("seed {seed}: {reason}"),
            }
        })
        .collect();
    assert!(outcomes.len() + 1 >= runs, "{} of {runs} were answered", outcomes.len());
    let ratio = rms(outcomes.iter().map(|[error, sigma]| error / sigma));
    let [least, most] = [0.2, 0.25].map(|whole| extent.rms(whole, runs));
    assert!((1.0 - least..=1.0 + most).contains(&ratio), "{ratio}");
    for [error, sigma] in &outcomes {
        assert!(error.abs() < 5.0 * sigma, "{error}° of {sigma}°");
        // What a coarse gyro of 0.17 °/√h costs: a few degrees, not the hundredths of a still base.
        assert!((2.0..10.0).contains(sigma), "{sigma}°");
    }
}

#[test]
fn without_the_base_imu_the_same_sways_are_refused() {
    let reasons: Vec<Refusal> = (1..=3_u64)
        .into_par_iter()
        .map(|seed| {
            let scenario =
                Scenario { has_base_imu: false, sample_rate_hz: 100.0, ..scenario(seed) };
            found(&scenario, &run(&scenario)).expect_err("a fibre-optic gyro feels every sway")
        })
        .collect();
    for reason in reasons {
        assert!(
            matches!(reason, Refusal::Stepwise(stepwise::Refusal::Disturbed { disturbed: 25, .. })),
            "{reason}"
        );
    }
}

fn what_would_be_wrong_by_tens_of_degrees_becomes_right_to_a_few(extent: Extent) {
    let errors: Vec<[f64; 2]> = (1..=extent.of(30) as u64)
        .into_par_iter()
        .map(|seed| {
            let scenario = scenario(seed);
            let with = Scenario { sway_deg: 0.2, sway_hz: 0.47, sample_rate_hz: 100.0, ..scenario };
            let without = Scenario { has_base_imu: false, ..with };
            [with, without].map(|s| azimuth_error(plain_azimuth(&run(&s)), s.azimuth_deg))
        })
        .collect();
    let [with, without] = [0, 1].map(|index| rms(errors.iter().map(|pair| pair[index])));
    assert!(with < 6.0, "{with}°");
    assert!(without > 5.0 * with, "{without}° without, {with}° with");
}

#[test]
fn better_coarse_sensors_give_a_better_azimuth() {
    let outcomes: Vec<[f64; 2]> = (1..=6_u64)
        .into_par_iter()
        .map(|seed| {
            let sway = Scenario { sway_deg: 0.05, sway_hz: 0.5, ..scenario(seed) };
            let fine = Scenario { coarse: CoarseClass::FINE, ..sway };
            found(&fine, &run(&fine)).unwrap_or_else(|reason| panic!("seed {seed}: {reason}"))
        })
        .collect();
    assert!(rms(outcomes.iter().map(|[_, sigma]| *sigma)) < 0.8, "{outcomes:?}");
    for [error, sigma] in outcomes {
        assert!(error.abs() < 4.0 * sigma, "{error}° of {sigma}°");
    }
}

#[test]
fn on_a_still_base_nothing_is_subtracted_and_sigma_is_the_same() {
    for seed in 1..=3 {
        let with = Scenario { sway_deg: 0.0, ..scenario(seed) };
        let without = Scenario { has_base_imu: false, ..with };
        let run_with = run(&with);
        let [error, sigma] = found(&with, &run_with).expect("a healthy run");
        assert!(error.abs() < 4.0 * sigma);
        let [sigma, expected] = [&run_with, &run(&without)].map(sigma_of_the_fit);
        // The accelerometer's own noise differs, as the session begins later.
        assert!((sigma / expected - 1.0).abs() < 0.01, "{sigma}° instead of {expected}°");
        assert!(reported(&run_with).iter().any(|line| line.contains("nothing is subtracted")));
    }
}

#[test]
fn the_log_tells_the_size_of_the_sway() {
    let run = run(&Scenario { sway_deg: 0.1, sway_hz: 1.0, ..scenario(1) });
    let line = reported(&run).into_iter().find(|line| line.contains("base: sways"));
    // 0.1° of roll and of pitch are 0.0707° along any axis; at 1 Hz and 0.83 Hz.
    let line = line.expect("it is stated");
    assert!(line.contains("by 0.07") && line.contains("at 0.9"), "{line}");
    assert!(line.contains("it is subtracted but for 0.0"), "{line}");
}

#[test]
fn a_tactical_gyro_is_rescued_at_little_cost() {
    let gyro = GyroClass::MICROMECHANICAL_FINE;
    let with = Scenario { gyro, sway_deg: 0.1, ..scenario(3) };
    let still = Scenario { sway_deg: 0.0, ..with };
    let [error, sigma] = found(&with, &run(&with)).expect("the sway is subtracted");
    let [_, alone] = found(&still, &run(&still)).expect("a healthy run");
    assert!(error.abs() < 4.0 * sigma && sigma < 6.0 * alone, "{error}° of {sigma}°, {alone}°");
}

/// Sensors on a still base that answer until some time, if at all.
struct Failing {
    until: Instant,
    /// Whether they feel a sway of 0.1° that is not there.
    feels: bool,
    count: u32,
}

impl Startable for Failing {
    async fn start(&mut self) -> Result<(), BusFault> {
        if Instant::now() < self.until { Ok(()) } else { Err(BusFault::Identity { found: 0 }) }
    }
}

impl BaseSensors for Failing {
    async fn read(&mut self) -> Result<Option<BaseReading>, BusFault> {
        if Instant::now() >= self.until {
            return Err(BusFault::Bus);
        }
        self.count += 1;
        let seconds = Instant::now().as_micros() as f64 * 1e-6;
        let amplitude = if self.feels { 0.1 * DEGREE } else { 0.0 };
        let (sine, cosine) = (std::f64::consts::TAU * seconds).sin_cos();
        // The last bits differ from reading to reading, as noise would have them.
        let p = amplitude * std::f64::consts::TAU * cosine + f64::from(self.count % 7) * 1e-6;
        let rate = [p, 0.0, 0.0].map(AngularRate::from_rad_per_s);
        let force = [0.0, -9.8 * amplitude * sine, -9.8].map(SpecificForce::from_m_per_s2);
        Ok(Some(BaseReading { rate, force, is_clipped: false }))
    }

    fn sensors(&self) -> CoarseSensors {
        CoarseSensors::of_densities(4.0, 90.0)
    }

    fn divider(&self) -> u32 {
        1
    }

    fn output_period(&self) -> core::time::Duration {
        core::time::Duration::from_micros(2_500)
    }
}

/// A run on a base with these sensors.
fn on_base(base: &mut impl BaseSensors, scenario: &Scenario) -> Result<Run, RunError> {
    align_on(SwayCompensation::new(base), None, Trial::of(scenario))
}

#[test]
fn a_base_imu_that_fails_ends_only_a_session_that_needs_it() {
    let scenario = Scenario { sample_rate_hz: 100.0, sway_deg: 0.0, ..scenario(2) };
    for (until, feels, goes_on) in [(0, false, true), (60, false, true), (60, true, false)] {
        let mut base = Failing { until: Instant::from_secs(until), feels, count: 0 };
        let run = on_base(&mut base, &scenario).expect("the scenario is possible");
        let outcome = found(&scenario, &run);
        assert_eq!(outcome.is_ok(), goes_on, "{outcome:?}");
        let is_given_up = |(_, event): &(Instant, Event)| matches!(event, Event::GivenUp(..));
        assert!(run.events.iter().any(is_given_up), "{:?}", reported(&run));
        if let Err(reason) = outcome {
            assert!(reason.to_string().starts_with("base: "), "{reason}");
        }
    }
}

#[test]
fn a_sway_that_a_missing_imu_would_have_measured_is_refused_for_the_missing_imu() {
    (0..=2_u64).into_par_iter().for_each(|seed| {
        let scenario = Scenario { sample_rate_hz: 100.0, ..scenario(seed) };
        let fault = Some(Fault::Chip(Device::Base, ChipFault::Identity));
        let frames = FramesScenario { base: scenario, passes: 2, ..FramesScenario::default() };
        // It never answers, on a stage and in two frames, or fails before it has seen enough.
        let never = Trial::of(&scenario).fault(fault).run().expect("possible");
        let in_frames = Trial::of(&frames).fault(fault).run().expect("possible");
        let mut base = Failing { until: Instant::from_secs(5), feels: false, count: 0 };
        let early = on_base(&mut base, &scenario).expect("possible");
        let found =
            [found(&scenario, &never), found(&scenario, &in_frames), found(&scenario, &early)];
        for found in found {
            let reason = found.expect_err("nothing takes the sway off");
            assert_eq!(reason, Refusal::Stepwise(stepwise::Refusal::SwayUnmeasured), "seed {seed}");
            assert!(reason.to_string().contains("the coarse IMU is missing"), "{reason}");
        }
    });
}

#[test]
fn rates_that_are_subtracted_are_small_beside_what_a_still_base_leaves_in_them() {
    // A sway that is felt but not there goes into the rates as its change over a dwell: nothing is
    // subtracted but that.
    let scenario = Scenario { sample_rate_hz: 100.0, sway_deg: 0.0, ..scenario(2) };
    let mut base = Failing { until: Instant::MAX, feels: true, count: 0 };
    let felt = on_base(&mut base, &scenario).expect("possible");
    let bound = 2.0 * 0.1 * DEGREE / 10.0 * 1.1;
    let azimuth = scenario.azimuth_deg.to_radians();
    let rate = 15.041 * scenario.latitude_deg.to_radians().cos() * DEGREE_PER_HOUR;
    let dwells = felt.replay.session.dwells();
    let rest = |i: usize| dwells[i].rate.0 - rate * (azimuth + dwells[i].stage.rad()).cos();
    let spread = (0..dwells.len()).map(|i| (rest(i) - rest(0)).abs()).fold(0.0, f64::max);
    assert!(spread < 2.0 * bound + 0.2 * rate, "{spread} rad/s");
}

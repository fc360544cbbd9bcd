//! A vehicle that stands and sways: gravity seen from inertial space does not care, plain averaging does.

use hal_mock::noise::Generator;
use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Leg, VehicleSample};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops;
use orientation::math::rotation::{Vector, cross, dot, unit};
use rayon::prelude::*;

use super::drives::{rms, two};
use super::world::{Day, Kind, Outcome, apart, known};

/// Ten minutes with gyros of a navigation grade, with or without sway and doors.
fn parked(seed: u64, sways: bool) -> Day {
    let mut scenario = Scenario::parked(seed, 600.0);
    for gyro in &mut scenario.vehicle.gyros {
        (gyro.n_deg_sqrt_h, gyro.bias_sigma_deg_h) = (0.01, 0.02);
    }
    if !sways {
        undisturbed(&mut scenario, SwayConfiguration::default());
    }
    let mut day = Day { rests: Kind::Whole, ..Day::new(scenario, seed) };
    day.setting = known(52.0, 0.01, Some(0.02));
    day
}

/// Takes the doors out of a day, and gives its stops this sway.
fn undisturbed(scenario: &mut Scenario, sway: SwayConfiguration) {
    scenario.events.clear();
    for leg in &mut scenario.legs {
        if let Leg::Stop(stop) = leg {
            stop.sway = sway;
        }
    }
}

/// Errors at the end over σ, of the days that are answered.
fn answered(seeds: std::ops::Range<u64>, day: impl Fn(u64) -> Day + Sync) -> Vec<f64> {
    let ratio = |seed| {
        let outcome = day(seed).run();
        outcome.conclusion.verdict.is_ok().then(|| outcome.ratios()[1])
    };
    seeds.into_par_iter().filter_map(ratio).collect()
}

/// Azimuth from the mean force and the mean rate, as if nothing moved.
fn averaged(day: &Day) -> (f64, Outcome) {
    let (mut force, mut rate) = ([0.0; 3], [0.0; 3]);
    let outcome = day.run_through(|sample: &mut VehicleSample| {
        for axis in 0..3 {
            force[axis] += sample.force_m_s2[axis];
            rate[axis] += sample.turned_rad[axis];
        }
        true
    });
    let up: Vector = unit(&force);
    let east = unit(&cross(&rate, &up));
    let north = cross(&up, &east);
    (dot(&[1.0, 0.0, 0.0], &east).atan2(dot(&[1.0, 0.0, 0.0], &north)), outcome)
}

/// RMS errors at the end, °: ours, and those of averaging; and how many were refused.
fn figures(sways: bool, count: u64) -> ([f64; 2], usize) {
    let all: Vec<(f64, f64, bool)> = (0..count)
        .into_par_iter()
        .map(|seed| {
            let day = parked(seed, sways);
            let (azimuth, outcome) = averaged(&day);
            let found = outcome.conclusion.found.as_ref().expect("something to solve");
            let [_, end] = outcome.azimuths;
            let ours = apart(found.azimuth.angle.0, end).to_degrees();
            (ours, apart(azimuth, end).to_degrees(), outcome.conclusion.verdict.is_err())
        })
        .collect();
    let errors = [rms(all.iter().map(|errors| errors.0)), rms(all.iter().map(|errors| errors.1))];
    (errors, all.iter().filter(|errors| errors.2).count())
}

#[test]
fn sway_and_doors_cost_no_more_than_half_of_the_quiet_error() {
    let count = 40;
    let ([quiet, _], healthy) = figures(false, count);
    let ([swaying, averaging], refused) = figures(true, count);
    println!(
        "parked: quiet {quiet:.4}° ({healthy} of {count} refused), swaying {swaying:.4}° ({refused} refused), averaging {averaging:.2}°"
    );
    assert!(swaying <= 1.5 * quiet, "{swaying}° {quiet}°");
    assert!(averaging > 2.0, "{averaging}°");
    assert_eq!(healthy, 0);
    // One of 40 may sway so that its blocks look like no noise at all.
    assert!(refused <= 1, "{refused}");
}

#[test]
fn errors_of_a_swaying_vehicle_are_covered_by_sigma() {
    let ratios = answered(100..140, |seed| parked(seed, true));
    let ratio = rms(ratios.iter().copied());
    println!("parked and swaying: {ratio:.3} over σ, {} of 40 answered", ratios.len());
    assert!(ratio < 1.2, "{ratio}");
    assert!(ratios.iter().all(|ratio| ratio.abs() < 3.5), "{ratios:?}");
}

/// Two minutes of a vehicle that rocks about both axes, apart from each other, and its sensors up to 2 m off that in
/// any direction, or on it.
fn off_axis(seed: u64, is_off: bool) -> Day {
    let mut draw = Generator::stream(seed, 19);
    let mut between = |from: f64, to: f64| from + (to - from) * draw.uniform();
    let mut day = parked(seed, true);
    for gyro in &mut day.scenario.vehicle.gyros {
        (gyro.n_deg_sqrt_h, gyro.bias_sigma_deg_h) = (0.002, 0.005);
    }
    day.setting = known(52.0, 0.002, Some(0.005));
    let lever_m = [0; 3].map(|_| between(-1.2, 1.2));
    day.scenario.vehicle.lever_m = if is_off { lever_m } else { [0.0; 3] };
    let mut component = |pitch_deg: f64, roll_deg: f64| SwayComponent {
        pitch_deg,
        roll_deg,
        frequency_hz: between(0.3, 2.0),
        phase_rad: between(0.0, std::f64::consts::TAU),
        ..SwayComponent::default()
    };
    let components = [component(0.3, 0.0), component(0.0, 0.3), SwayComponent::default()];
    undisturbed(&mut day.scenario, SwayConfiguration { components });
    if let Leg::Stop(stop) = &mut day.scenario.legs[0] {
        stop.seconds = 120.0;
    }
    day
}

#[test]
fn sensors_off_the_axis_of_the_sway_are_aligned_nearly_as_well_as_on_it() {
    let sigma = |seed, is_off| {
        let verdict = off_axis(seed, is_off).run().conclusion.verdict;
        verdict.map_or(f64::INFINITY, |azimuth| azimuth.sigma.0)
    };
    let mut worse: Vec<f64> =
        (0..60).into_par_iter().map(|seed| sigma(seed, true) / sigma(seed, false)).collect();
    worse.sort_by(f64::total_cmp);
    let ratios = answered(0..60, |seed| off_axis(seed, true));
    let ratio = rms(ratios.iter().copied());
    println!("off the axis: {ratio:.3} over σ, σ {:.3} times that on it at the median", worse[30]);
    assert!(ratios.len() >= 57 && worse[30] < 1.2, "{}: {worse:?}", ratios.len());
    assert!(ratio > 0.7 && ratio < 1.2, "{ratio}");
    assert!(ratios.iter().all(|ratio| ratio.abs() < 4.0), "{ratios:?}");
}

/// One to two minutes with gyros of a navigation grade and a sway that goes on half a cycle from one block of 5 s to the
/// next, so that blocks of 10 s hide it.
fn hidden(seed: u64) -> Day {
    let mut draw = Generator::stream(seed, 17);
    let mut between = |from: f64, to: f64| from + (to - from) * draw.uniform();
    let mut scenario = Scenario::parked(seed, between(80.0, 140.0));
    for gyro in &mut scenario.vehicle.gyros {
        (gyro.n_deg_sqrt_h, gyro.bias_sigma_deg_h) = (0.002, 0.005);
    }
    let mut components = [SwayComponent::default(); 3];
    components[0] = SwayComponent {
        pitch_deg: 0.3,
        roll_deg: -0.3,
        frequency_hz: (between(1.0, 8.0).floor() + between(0.45, 0.55)) / 5.0,
        phase_rad: between(0.0, std::f64::consts::TAU),
        ..SwayComponent::default()
    };
    undisturbed(&mut scenario, SwayConfiguration { components });
    let mut day = Day { rests: Kind::Whole, ..Day::new(scenario, seed) };
    day.setting = known(52.0, 0.002, Some(0.005));
    day
}

#[test]
fn a_sway_that_long_blocks_hide_is_in_sigma() {
    let ratios = answered(0..60, hidden);
    let ratio = rms(ratios.iter().copied());
    println!("a hidden sway: {ratio:.3} over σ, {} of 60 answered", ratios.len());
    assert!(ratios.len() >= 40 && ratio < 1.2, "{ratio}, {}", ratios.len());
    assert!(ratios.iter().all(|ratio| ratio.abs() < 5.0), "{ratios:?}");
}

/// A sway that comes back to where it was in nearly every second, so that its seconds hide it.
fn hidden_by_seconds(seed: u64) -> Day {
    let mut draw = Generator::stream(seed, 18);
    let mut between = |from: f64, to: f64| from + (to - from) * draw.uniform();
    let mut day = parked(seed, false);
    let mut components = [SwayComponent::default(); 3];
    components[0] = SwayComponent {
        pitch_deg: 0.3,
        roll_deg: -0.3,
        frequency_hz: between(1.0, 4.0).floor() + between(-0.02, 0.02),
        phase_rad: between(0.0, std::f64::consts::TAU),
        ..SwayComponent::default()
    };
    undisturbed(&mut day.scenario, SwayConfiguration { components });
    day
}

#[test]
fn a_sway_that_seconds_hide_is_in_sigma_and_no_turn_of_the_vehicle() {
    let verdict = |seed| hidden_by_seconds(seed).run().conclusion.verdict;
    let is_turning = |seed: &u64| {
        matches!(verdict(*seed), Err(Refusal::Stops(stops::Refusal::EarthNotFelt { .. })))
    };
    assert_eq!((0..60).into_par_iter().filter(is_turning).count(), 0);
    // The forces of some go round so slowly that they look like a vehicle that moves.
    let ratios = answered(0..60, hidden_by_seconds);
    let ratio = rms(ratios.iter().copied());
    println!("a sway of whole hertz: {ratio:.3} over σ, {} of 60 answered", ratios.len());
    assert!(ratios.len() >= 30 && ratio < 1.2, "{ratio}, {}", ratios.len());
    assert!(ratios.iter().all(|ratio| ratio.abs() < 4.0), "{ratios:?}");
}

#[test]
fn accelerometers_that_stand_on_their_side_or_head_are_named() {
    let changes: [fn(&mut VehicleSample); 3] = [
        |sample| sample.force_m_s2[2] *= -1.0,
        |sample| sample.force_m_s2.swap(1, 2),
        |sample| sample.force_m_s2.swap(0, 2),
    ];
    for change in changes {
        let days: [fn() -> Day; 3] = [|| parked(1, false), || parked(1, true), || two(1)];
        for day in days {
            let outcome = day().run_through(|sample| {
                change(sample);
                true
            });
            let verdict = outcome.conclusion.verdict;
            assert!(
                matches!(verdict, Err(Refusal::AccelerometerImplausible { .. })),
                "{verdict:?}"
            );
        }
    }
}

//! A vehicle that stands and sways: gravity seen from inertial space does not care, plain averaging does.

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Leg, VehicleSample};
use orientation::math::rotation::{Vector, cross, dot, unit};
use rayon::prelude::*;

use crate::drives::rms;
use crate::world::{Day, Kind, Outcome, apart, known};

/// Ten minutes with gyros of a navigation grade, with or without sway and doors.
fn parked(seed: u64, sways: bool) -> Day {
    let mut scenario = Scenario::parked(seed, 600.0);
    for gyro in &mut scenario.vehicle.gyros {
        (gyro.n_deg_sqrt_h, gyro.bias_sigma_deg_h) = (0.01, 0.02);
    }
    if !sways {
        scenario.events.clear();
        for leg in &mut scenario.legs {
            if let Leg::Stop(stop) = leg {
                stop.sway = Default::default();
            }
        }
    }
    let mut day = Day { rests: Kind::Whole, ..Day::new(scenario, seed) };
    day.setting = known(52.0, 0.01, Some(0.02));
    day
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
            let ours = apart(found.azimuth.angle, end).to_degrees();
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
    let ratios: Vec<f64> = (100..140_u64)
        .into_par_iter()
        .filter_map(|seed| {
            let outcome = parked(seed, true).run();
            outcome.conclusion.verdict.is_ok().then(|| outcome.ratios()[1])
        })
        .collect();
    let ratio = rms(ratios.iter().copied());
    println!("parked and swaying: {ratio:.3} over σ, {} of 40 answered", ratios.len());
    assert!(ratio < 1.2, "{ratio}");
    assert!(ratios.iter().all(|ratio| ratio.abs() < 3.5), "{ratios:?}");
}

#[test]
fn wrong_axes_of_a_parked_vehicle_are_never_silently_wrong() {
    type Change = fn(&mut VehicleSample, usize);
    let changes: [(&str, Change); 5] = [
        ("sign of a gyro", |sample, axis| sample.turned_rad[axis] *= -1.0),
        ("swapped gyros", |sample, axis| sample.turned_rad.swap(axis, (axis + 1) % 3)),
        ("dead gyro", |sample, axis| sample.turned_rad[axis] = 0.0),
        ("sign of an accelerometer", |sample, axis| sample.force_m_s2[axis] *= -1.0),
        ("swapped accelerometers", |sample, axis| sample.force_m_s2.swap(axis, (axis + 1) % 3)),
    ];
    let mut wrong = Vec::new();
    for (name, change) in changes {
        for axis in 0..3 {
            for seed in 0..4 {
                for sways in [false, true] {
                    let outcome = parked(seed, sways).run_through(|sample| {
                        change(sample, axis);
                        true
                    });
                    if outcome.conclusion.verdict.is_ok() && outcome.ratios()[1].abs() > 5.0 {
                        let found = outcome.found();
                        wrong.push((
                            name,
                            axis,
                            seed,
                            sways,
                            outcome.ratios()[1],
                            found.turning,
                            found.chi_square,
                        ));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

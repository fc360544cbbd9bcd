//! Missing samples cost σ as far as their neighbours bound what the vehicle turned meanwhile.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops;
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

use super::drives::{rms, two, with_gyros};
use super::world::{Day, Outcome};

/// Samples a second.
const RATE: f64 = 100.0;
/// Gaps at rest, three in the first stop, s.
const AT_REST: [f64; 3] = [25.0, 33.7, 45.2];
/// Gaps on the way, s.
const DRIVING: [f64; 7] = [100.0, 130.0, 170.0, 210.0, 250.0, 290.0, 330.0];
/// Gaps of how many samples.
const REST_SAMPLES: [u32; 5] = [1, 2, 5, 20, 50];
const DRIVE_SAMPLES: [u32; 3] = [1, 2, 5];

/// A day whose gyros leave room for what gaps cost: two stops of a minute, five minutes of driving.
fn day(seed: u64) -> Day {
    let mut day = with_gyros(two(seed), 0.003, 0.005);
    day.scenario.vehicle.rate_hz = RATE;
    day
}

/// The day without so many samples from each of these times on, s.
fn without(day: &Day, times: &[f64], samples: u32) -> Outcome {
    let seconds = (f64::from(samples) - 0.5) / RATE;
    let is_missing = |at: f64| times.iter().any(|time| (*time..*time + seconds).contains(&at));
    day.run_through(|sample| !is_missing(sample.time_s))
}

/// Errors over σ of so many days with gaps, none of which is refused, and the RMS of σ, °.
fn errors(count: usize, times: &[f64], samples: u32) -> (Vec<f64>, f64) {
    let outcomes: Vec<Outcome> =
        (0..count as u64).into_par_iter().map(|seed| without(&day(seed), times, samples)).collect();
    let sigma = rms(outcomes.iter().map(|outcome| outcome.found().azimuth.sigma.degrees()));
    (outcomes.iter().map(|outcome| outcome.ratios()[1]).collect(), sigma)
}

/// Holds errors to σ: as large as it says at rest, and on the way no larger.
fn assert_covered(count: usize, tolerance: f64) {
    let (_, whole) = errors(count, &[], 0);
    for (name, times, samples, least) in [
        ("at rest", &AT_REST[..], &REST_SAMPLES[..], 1.0 - tolerance),
        ("on the way", &DRIVING, &DRIVE_SAMPLES, 0.3),
    ] {
        let mut before = whole;
        for samples in samples {
            let (ratios, sigma) = errors(count, times, *samples);
            let ratio = rms(ratios.iter().copied());
            let most = ratios.iter().fold(0.0, |most: f64, ratio| most.max(ratio.abs()));
            println!(
                "{samples} samples {name}: σ {sigma:.4}° of {whole:.4}°, {ratio:.3}, {most:.2} at most"
            );
            assert!((least..1.0 + tolerance).contains(&ratio), "{samples} {name}: {ratio}");
            assert!(most < 3.8, "{samples} {name}: {most} σ");
            assert!(sigma > 0.99 * before, "{samples} {name}: {sigma}° after {before}°");
            before = sigma;
        }
        assert!(before > 1.1 * whole, "{name}: {before}° of {whole}°");
    }
}

#[test]
fn gaps_that_their_neighbours_bound_cost_sigma_and_not_the_alignment() {
    assert_covered(8, 0.5);
}

campaigns! {
    errors_are_what_sigma_says_with_gaps_at_rest_and_no_greater_with_gaps_on_the_way;
}

fn errors_are_what_sigma_says_with_gaps_at_rest_and_no_greater_with_gaps_on_the_way(
    extent: Extent,
) {
    let count = extent.of(100);
    assert_covered(count, extent.rms(0.15, count));
}

#[test]
fn a_gap_in_which_a_vehicle_may_have_turned_by_more_than_is_useful_is_named() {
    // Half a second on the way, and more than one at rest.
    for (time, samples) in [(200.0, 50), (35.0, 120)] {
        for seed in 0..4 {
            let verdict = without(&day(seed), &[30.0, time], samples).conclusion.verdict;
            let Err(Refusal::Stops(stops::Refusal::RotationMissing { at, seconds })) = verdict
            else {
                panic!("{time} s, seed {seed}: {verdict:?}");
            };
            let is_first = (at.0 - 30.0).abs() < 0.02 && samples == 120;
            assert!(is_first || (at.0 - time).abs() < 0.02, "{at:?}");
            assert!((seconds.0 - f64::from(samples + 1) / RATE).abs() < 0.02, "{seconds:?}");
        }
    }
}

#[test]
fn a_gap_of_an_alignment_that_needs_a_small_sigma_is_what_is_named() {
    let mut day = day(1);
    let whole = day.run().found().azimuth.sigma;
    day.setting.site.required_sigma.0 = 1.2 * whole.0;
    assert!(day.run().conclusion.verdict.is_ok());
    let verdict = without(&day, &[200.0], 10).conclusion.verdict;
    assert!(
        matches!(verdict, Err(Refusal::Stops(stops::Refusal::RotationMissing { .. }))),
        "{verdict:?}"
    );
}

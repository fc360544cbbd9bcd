//! Gyros whose biases turn the frame far, or whose noise hides the Earth: the error is what σ says, and a refusal names
//! the noise.

use hal_mock::vehicle::scenario::Scenario;
use orientation::alignment::Refusal;
use orientation::alignment::budget::Source;
use orientation::noise::model::{GyroNoise, StatedNoise};
use rayon::prelude::*;

use super::drives::rms;
use super::world::{Day, Outcome};

/// Relative 1σ of the gyros' scale factors.
const SCALE_SIGMA: f64 = 5e-4;

/// Stops of so many seconds, with so many of driving between them.
#[derive(Clone, Copy)]
struct Way {
    stops: usize,
    stop_s: f64,
    drive_s: f64,
}

/// Gyros: N, °/√h, B, °/h, and 1σ of the bias, °/h.
#[derive(Clone, Copy)]
struct Gyros {
    n: f64,
    b: f64,
    bias: f64,
}

/// Micromechanical gyros of tactical grade: in the 24 minutes between three stops a bias of 1σ turns the frame by 12°.
const TACTICAL: Gyros = Gyros { n: 0.15, b: 0.5, bias: 30.0 };

/// So many days, each from a random azimuth with biases of its own.
fn days(way: Way, gyros: Gyros, count: u64) -> Vec<Outcome> {
    (0..count).into_par_iter().map(|seed| day(seed, way, gyros).run()).collect()
}

fn day(seed: u64, Way { stops, stop_s, drive_s }: Way, Gyros { n, b, bias }: Gyros) -> Day {
    let mut scenario = Scenario::stops(seed, stops, stop_s, drive_s);
    for gyro in &mut scenario.vehicle.gyros {
        (gyro.n_deg_sqrt_h, gyro.b_deg_h, gyro.bias_sigma_deg_h) = (n, b, bias);
        gyro.scale_sigma = SCALE_SIGMA;
    }
    let mut day = Day::new(scenario, seed);
    day.setting.site.noise = StatedNoise::Whole(GyroNoise::from_field_units(n, b, 0.0, 0.0));
    day.setting.site.scale_sigma = SCALE_SIGMA;
    day
}

/// Refused only for a σ above the accepted one, which the gyros' noise makes.
fn is_too_noisy(outcome: &Outcome) -> bool {
    matches!(outcome.conclusion.verdict, Err(Refusal::BudgetNotMet { source: Source::Noise, .. }))
}

/// All are found, but for some that are too noisy; none is wrong by more than 5 σ, nor are all together.
#[track_caller]
fn assert_honest(name: &str, outcomes: &[Outcome], too_noisy: usize) {
    let (noisy, found): (Vec<_>, Vec<_>) = outcomes.iter().partition(|day| is_too_noisy(day));
    assert!(noisy.len() <= too_noisy, "{name}: {} are too noisy", noisy.len());
    let [start, end] = [0, 1].map(|end: usize| rms(found.iter().map(|day| day.ratios()[end])));
    let most =
        found.iter().flat_map(|day| day.ratios()).fold(0.0, |most: f64, z| most.max(z.abs()));
    println!("{name}: {start:.3} σ at the start, {end:.3} at the end, {most:.2} at most");
    assert!([start, end].iter().all(|ratio| (0.8..1.3).contains(ratio)), "{name}: {start}, {end}");
    assert!(most < 5.0, "{name}: {most} σ");
}

#[test]
fn biases_that_turn_the_frame_by_tens_of_degrees_leave_errors_that_sigma_covers() {
    let way = Way { stops: 3, stop_s: 60.0, drive_s: 600.0 };
    let three = days(way, TACTICAL, 30);
    assert_honest("three stops", &three, 0);
    let two = days(Way { stops: 2, ..way }, TACTICAL, 20);
    assert_honest("two stops", &two, 2);
    for found in three.iter().chain(&two).filter_map(|day| day.conclusion.found) {
        let (limit, sigma) = (found.limit.0, found.azimuth.sigma.0);
        // A limit that is σ itself was cut down to it.
        assert!(limit < sigma, "a limit of {limit} rad for a σ of {sigma} rad");
    }
}

#[test]
fn what_a_stop_leaves_is_small_where_biases_turn_the_frame_by_tens_of_degrees() {
    let way = Way { stops: 3, stop_s: 60.0, drive_s: 600.0 };
    let outcomes = days(way, Gyros { n: 0.036, b: 0.0, bias: 30.0 }, 15);
    assert_honest("N 0.036 °/√h", &outcomes, 0);
    let residuals = outcomes.iter().flat_map(|day| &day.residuals).flatten();
    let ratio = rms(residuals.flat_map(|left| left.tilt.map(|part| part.0 / left.sigma.0)));
    println!("residuals: {ratio:.3} σ");
    // Of six parts the fit takes up azimuth, level and biases.
    assert!((0.3..1.0).contains(&ratio), "{ratio}");
}

#[test]
fn flicker_is_covered_between_long_stops_and_long_drives() {
    let gyros = Gyros { n: 0.01, b: 0.3, bias: 1.0 };
    for [stop_s, drive_s] in [[60.0, 600.0], [300.0, 300.0]] {
        let way = Way { stops: 3, stop_s, drive_s };
        assert_honest(&format!("{stop_s} s, {drive_s} s"), &days(way, gyros, 30), 0);
    }
}

#[test]
fn gyros_too_noisy_for_the_signal_are_refused_for_their_noise_alone() {
    let way = Way { stops: 3, stop_s: 20.0, drive_s: 60.0 };
    for n in [0.5, 2.0] {
        let outcomes = days(way, Gyros { n, ..TACTICAL }, 15);
        for (seed, outcome) in outcomes.iter().enumerate() {
            assert!(is_too_noisy(outcome), "N {n}, {seed}: {:?}", outcome.conclusion.verdict);
        }
    }
}

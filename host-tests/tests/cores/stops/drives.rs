//! Healthy vehicles: errors are what σ says, whatever is known or not known of the sensors and the way.

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Leg, Stop};
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::units::{MetresPerSecondSquared, Radians};
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

use super::world::{Day, Kind, Outcome, Place, known};

/// What many drives show.
struct Figures {
    outcomes: Vec<Outcome>,
}

impl Figures {
    /// So many drives, none of which may be refused.
    fn of(count: usize, day: impl Fn(u64) -> Day + Sync) -> Self {
        Self { outcomes: (0..count as u64).into_par_iter().map(|seed| day(seed).run()).collect() }
    }

    fn rms(&self, value: impl Fn(&Outcome) -> f64) -> f64 {
        rms(self.outcomes.iter().map(value))
    }

    /// Errors over σ at the start and at the end.
    fn ratios(&self) -> [f64; 2] {
        [0, 1].map(|end| self.rms(|outcome| outcome.ratios()[end]))
    }

    fn greatest(&self) -> f64 {
        (self.outcomes.iter())
            .flat_map(Outcome::ratios)
            .fold(0.0, |most, ratio| most.max(ratio.abs()))
    }

    /// RMS of the error at the end over the least σ of any estimator.
    fn over_limit(&self) -> f64 {
        self.rms(|outcome| outcome.errors()[1] / outcome.found().limit.0)
    }

    /// Errors of the biases over their σ.
    fn biases(&self) -> Vec<f64> {
        let of = |outcome: &Outcome| {
            let found = outcome.found();
            [0, 1, 2].map(|axis: usize| {
                (found.biases[axis].0 - outcome.biases[axis]) / found.bias_sigmas[axis].0
            })
        };
        self.outcomes.iter().flat_map(of).collect()
    }

    fn sigma(&self) -> f64 {
        self.rms(|outcome| outcome.found().azimuth.sigma.degrees())
    }

    fn print(&self, name: &str) {
        let ([start, end], biases) = (self.ratios(), self.biases());
        println!(
            "{name}: error {:.4}°, σ {:.4}° RMS; over σ {start:.3} at the start, {end:.3} at the end, {:.2} at most; over the limit {:.3}; biases {:.3}, {:.2} at most",
            self.rms(|outcome| outcome.errors()[1].to_degrees()),
            self.sigma(),
            self.greatest(),
            self.over_limit(),
            rms(biases.iter().copied()),
            biases.iter().fold(0.0f64, |most, ratio| most.max(ratio.abs())),
        );
    }

    /// Errors as σ says; the RMS of all may differ by `tolerance`.
    #[track_caller]
    fn assert_calibrated(&self, name: &str, extent: Extent, tolerance: f64) {
        let tolerance = extent.rms(tolerance, self.outcomes.len());
        self.print(name);
        for ratio in self.ratios() {
            assert!((ratio - 1.0).abs() <= tolerance, "{name}: {ratio}");
        }
        assert!(self.greatest() <= 3.8, "{name}: {} σ", self.greatest());
    }

    /// Errors no greater than σ says, where it must allow for more than these drives do.
    #[track_caller]
    fn assert_covered(&self, name: &str) {
        self.print(name);
        assert!(self.ratios().iter().all(|ratio| *ratio <= 1.1), "{name}: {:?}", self.ratios());
        assert!(self.greatest() <= 3.8, "{name}: {} σ", self.greatest());
    }
}

pub fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) =
        values.fold((0.0, 0.0), |(sum, count), value| (sum + value * value, count + 1.0));
    f64::sqrt(sum / count)
}

/// Two stops of a minute, five minutes of driving: LN-200 class.
pub fn two(seed: u64) -> Day {
    Day::new(Scenario::stops(seed, 2, 60.0, 300.0), seed)
}

/// Three stops, of a minute, at different headings.
pub fn three(seed: u64) -> Day {
    Day::new(Scenario::stops(seed, 3, 60.0, 240.0), seed)
}

/// A day with gyros a hundred times better, so that the rest shows.
pub fn quiet(day: Day) -> Day {
    with_gyros(day, 0.001, 0.005)
}

/// A day with gyros of this N, °/√h, and 1σ of bias, °/h.
pub fn with_gyros(mut day: Day, n: f64, bias: f64) -> Day {
    for gyro in &mut day.scenario.vehicle.gyros {
        (gyro.n_deg_sqrt_h, gyro.bias_sigma_deg_h) = (n, bias);
    }
    day.setting = known(day.scenario.vehicle.latitude_deg, n, Some(bias));
    day
}

campaigns! {
    two_stops_give_both_azimuths_as_well_as_sigma_says;
    three_stops_at_different_headings_reach_the_limit_and_tell_the_biases;
    five_stops_are_calibrated_too;
    stated_stops_do_as_well_as_found_ones;
    accelerometer_biases_are_covered_by_their_sigma;
    scale_errors_are_covered_by_their_sigma;
    biases_that_walk_are_covered;
    biases_that_flicker_are_covered;
    the_southern_hemisphere_and_steep_ground_change_nothing;
    a_vehicle_that_still_rocks_as_its_stop_begins_at_any_part_of_a_second_is_covered;
}

fn two_stops_give_both_azimuths_as_well_as_sigma_says(extent: Extent) {
    let figures = Figures::of(extent.of(200), two);
    figures.assert_calibrated("two stops", extent, 0.1);
    let most = 1.0 + extent.rms(0.1, figures.outcomes.len());
    assert!(figures.over_limit() <= most, "{}", figures.over_limit());
}

fn three_stops_at_different_headings_reach_the_limit_and_tell_the_biases(extent: Extent) {
    let figures = Figures::of(extent.of(160), |seed| three(1000 + seed));
    figures.assert_calibrated("three stops", extent, 0.1);
    let most = 1.0 + extent.rms(0.1, figures.outcomes.len());
    assert!(figures.over_limit() <= most, "{}", figures.over_limit());
    let biases = figures.biases();
    let ratio = rms(biases.iter().copied());
    assert!((ratio - 1.0).abs() < extent.rms(0.1, biases.len()), "{ratio}");
    // One of 500 lies beyond 3 σ by chance.
    let beyond = biases.iter().filter(|ratio| ratio.abs() > 3.0).count();
    assert!(beyond <= extent.count(5), "{beyond} of {}", biases.len());
}

fn five_stops_are_calibrated_too(extent: Extent) {
    let figures = Figures::of(extent.of(60), five);
    figures.assert_calibrated("five stops", extent, 0.2);
    // Of ten parts the fit takes up azimuth, level and biases.
    let residuals = figures.outcomes.iter().flat_map(|outcome| &outcome.residuals).flatten();
    let ratios = residuals.flat_map(|left| left.tilt.map(|part| part.0 / left.sigma.0));
    let ratio = rms(ratios);
    assert!((0.4..0.95).contains(&ratio), "{ratio}");
}

fn five(seed: u64) -> Day {
    Day::new(Scenario::stops(seed, 5, 60.0, 180.0), seed)
}

#[test]
fn a_force_that_is_tilted_at_the_last_stop_alone_is_the_residual_of_that_stop_alone() {
    let (tilt, last_s) = (1e-3, 4.0 * (60.0 + 180.0));
    for seed in 0..4 {
        let outcome = quiet(five(seed)).run_through(|sample| {
            let by = if sample.time_s > last_s { tilt } else { 0.0 };
            sample.force_m_s2[0] += 9.8 * by;
            true
        });
        let [_, azimuth] = outcome.azimuths;
        let wanted = [tilt * azimuth.cos(), tilt * azimuth.sin()];
        for (stop, left) in outcome.residuals.iter().enumerate() {
            let left = left.expect("its place is known");
            let wanted = if stop == 4 { wanted } else { [0.0; 2] };
            println!("{seed} {stop} {left:?}, {wanted:?}");
            for (part, wanted) in left.tilt.into_iter().zip(wanted) {
                assert!((part.0 - wanted).abs() < 0.1 * tilt, "{seed} {stop}: {part:?}, {wanted}");
            }
        }
    }
}

#[test]
fn a_stop_whose_place_is_not_known_has_no_residual() {
    let outcome = Day { place: Place::Nothing, ..three(1) }.run();
    let are_there: Vec<bool> = outcome.residuals.iter().map(Option::is_some).collect();
    assert_eq!(are_there, [true, false, false]);
}

#[test]
fn stops_beyond_the_eighth_are_not_taken_for_the_eighth() {
    let figures = Figures::of(8, |seed| Day::new(Scenario::stops(seed, 10, 40.0, 90.0), seed));
    figures.print("ten stops");
    // Eight days are too few for their RMS.
    assert!(figures.greatest() <= 3.8, "{} σ", figures.greatest());
    assert!(figures.outcomes.iter().all(|outcome| outcome.stops.len() == 8));
    assert!(figures.outcomes.iter().all(|outcome| outcome.stops[7].seconds().0 < 40.0));
}

fn stated_stops_do_as_well_as_found_ones(extent: Extent) {
    let figures = Figures::of(extent.of(60), |seed| Day { rests: Kind::Stated, ..two(seed) });
    figures.assert_calibrated("stated stops", extent, 0.2);
}

#[test]
fn an_unknown_displacement_widens_sigma_as_far_as_the_vehicle_could_have_driven() {
    let middling = |seed| with_gyros(two(seed), 0.01, 0.005);
    let known = Figures::of(40, middling);
    known.assert_covered("N 0.01 °/√h, displacement known");
    let unknown = Figures::of(40, |seed| Day { place: Place::Nothing, ..middling(seed) });
    unknown.assert_covered("N 0.01 °/√h, displacement unknown");
    assert!(unknown.sigma() > 1.3 * known.sigma(), "{} {}", unknown.sigma(), known.sigma());
}

fn accelerometer_biases_are_covered_by_their_sigma(extent: Extent) {
    Figures::of(extent.of(60), |seed| {
        let mut day = quiet(two(seed));
        day.scenario.vehicle.accelerometer.bias_sigma_m_s2 = 0.01;
        day.setting.site.accelerometer_bias_sigma = MetresPerSecondSquared(0.01);
        day
    })
    .assert_calibrated("accelerometer biases of 1 mg", extent, 0.2);
}

fn scale_errors_are_covered_by_their_sigma(extent: Extent) {
    Figures::of(extent.of(60), |seed| {
        let mut day = quiet(two(seed));
        for gyro in &mut day.scenario.vehicle.gyros {
            gyro.scale_sigma = 3e-4;
        }
        day.setting.site.scale_sigma = 3e-4;
        day
    })
    .assert_calibrated("scale errors of 300 ppm", extent, 0.2);
}

fn biases_that_walk_are_covered(extent: Extent) {
    Figures::of(extent.of(60), |seed| {
        let mut day = with_gyros(three(seed), 0.01, 1.0);
        for gyro in &mut day.scenario.vehicle.gyros {
            gyro.k_deg_h_sqrt_h = 1.0;
        }
        day.setting.site.noise =
            StatedNoise::Whole(GyroNoise::from_field_units(0.01, 0.0, 1.0, 0.0));
        day
    })
    .assert_calibrated("K 1 °/h/√h", extent, 0.2);
}

fn biases_that_flicker_are_covered(extent: Extent) {
    Figures::of(extent.of(60), |seed| {
        let mut day = with_gyros(three(seed), 0.01, 1.0);
        for gyro in &mut day.scenario.vehicle.gyros {
            gyro.b_deg_h = 0.3;
        }
        day.setting.site.noise =
            StatedNoise::Whole(GyroNoise::from_field_units(0.01, 0.3, 0.0, 0.0));
        day
    })
    .assert_calibrated("B 0.3 °/h", extent, 0.25);
}

fn the_southern_hemisphere_and_steep_ground_change_nothing(extent: Extent) {
    Figures::of(extent.of(60), |seed| {
        let mut day = two(seed);
        day.scenario.vehicle.latitude_deg = -40.0;
        for leg in &mut day.scenario.legs {
            if let Leg::Stop(Stop { pitch_deg, roll_deg, .. }) = leg {
                (*pitch_deg, *roll_deg) = (*pitch_deg * 4.0, *roll_deg * 4.0);
            }
        }
        day.setting = known(-40.0, 0.05, Some(1.0));
        day
    })
    .assert_calibrated("40° south, tilts up to 12°", extent, 0.2);
}

fn a_vehicle_that_still_rocks_as_its_stop_begins_at_any_part_of_a_second_is_covered(
    extent: Extent,
) {
    Figures::of(extent.of(120), |seed| {
        let mut day = with_gyros(three(seed), 0.001, 0.3);
        for leg in &mut day.scenario.legs {
            match leg {
                // Every arrival comes another quarter of a second later, within those of the session.
                Leg::Stop(stop) => (stop.seconds, stop.settling_deg) = (60.25, [0.4, 0.1]),
                Leg::Drive(drive) => drive.seconds += 0.013 * (seed % 20) as f64,
            }
        }
        day
    })
    .assert_calibrated("rocking by 0.4° after its arrival", extent, 0.2);
}

#[test]
fn a_latitude_known_badly_is_covered_by_its_sigma() {
    Figures::of(60, |seed| {
        let mut day = quiet(two(seed));
        // Errors of 1σ = 0.5°, the same for every tenth seed.
        let error =
            0.5 * [-1.6, -1.0, -0.7, -0.4, -0.1, 0.1, 0.4, 0.7, 1.0, 1.6][(seed % 10) as usize];
        day.setting.site.latitude = known(52.0 + error, 0.0, None).site.latitude;
        day.setting.site.latitude_sigma = Radians::from_degrees(0.5f64);
        day
    })
    .assert_covered("latitude ± 0.5°");
}

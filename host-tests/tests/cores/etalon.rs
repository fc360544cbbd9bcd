//! Holds the etalon table to the closed form and its search to a brute force.

mod oracle;

use std::f64::consts::{FRAC_PI_2, TAU};

use hal_mock::noise::Generator;
use orientation::alignment::stepwise::etalon::series::CAPACITY;
use orientation::alignment::stepwise::etalon::{
    Acceptance, Accepted, Criterion, Limit, Series, SeriesError, accepted, search,
};
use orientation::math::reference_table::Table;
use orientation::math::reference_table::{CHECKSUM, ENTRIES, QUARTER_COSINE, Quarter};
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

use oracle::{
    CRITERIA, Case, Outcome, TURN, adversarial, compare, long, ordinary, paper, unfolded,
};

const ARCSECOND: f64 = TAU / 1_296_000.0;
const GRID: f64 = TAU / 129_600.0;
const ONE: f64 = 2_147_483_648.0;

/// The horizontal Earth rate at the paper's latitude of 47°35′, °/h.
const PAPER_RATE: f64 = 10.1453;

/// A board's own copy, as one in a flash section of its own would be made.
static COPY: Quarter = QUARTER_COSINE;

/// All entries.
fn entries() -> impl Iterator<Item = u32> {
    (0..ENTRIES).map(|k| QUARTER_COSINE.entry(k).expect("the quarter has so many entries"))
}

#[expect(clippy::unwrap_used, reason = "a helper of tests")]
fn series(case: &Case) -> Series {
    Series::new(case.ratios.iter().copied(), case.step).unwrap()
}

/// Compares `count` cases with the oracle and returns the outcomes.
fn agree(count: usize, case: impl Fn(&mut Generator, usize) -> Case + Sync) -> Vec<[Outcome; 5]> {
    let one = |index: usize| {
        let mut random = Generator::new(1_000_000 + index as u64);
        let case = case(&mut random, index);
        let outcomes = compare(&case, &mut random);
        for (outcome, criterion) in outcomes.iter().zip(CRITERIA) {
            assert!(outcome.agrees, "case {index}, {criterion}: {} {case:?}", outcome.answers);
        }
        outcomes
    };
    (0..count).into_par_iter().map(one).collect()
}

/// The evaluations of one criterion, sorted.
fn evaluations(outcomes: &[[Outcome; 5]], criterion: usize) -> Vec<u32> {
    let mut counts: Vec<u32> = outcomes.iter().map(|row| row[criterion].evaluations).collect();
    counts.sort_unstable();
    counts
}

#[test]
fn every_entry_is_the_nearest_integer_to_the_cosine() {
    for (k, entry) in entries().enumerate() {
        // From the nearer end, where the series of sine and cosine lose nothing.
        let exact = if k <= 16_200 {
            (k as f64 * (FRAC_PI_2 / 32_400.0)).cos()
        } else {
            ((32_400 - k) as f64 * (FRAC_PI_2 / 32_400.0)).sin()
        };
        assert!((f64::from(entry) - exact * ONE).abs() <= 0.5 + 1e-6, "entry {k}");
    }
}

#[test]
fn the_cardinal_points_are_exact() {
    let table = Table::built_in();
    let cosines = [0, 21_600, 32_400, 64_800, 97_200, 129_600].map(|k| table.cos(k));
    let one = 1_i64 << 31;
    assert_eq!(cosines, [one, one / 2, 0, -one, 0, one]);
}

#[test]
fn the_full_circle_unfolds_from_the_quarter() {
    let table = Table::built_in();
    for k in 0..TURN {
        assert_eq!(table.cos(k), unfolded(k));
        assert_eq!(table.cos(k - 3 * TURN), unfolded(k));
        assert_eq!(table.sin(k), unfolded((k + 97_200) % TURN));
    }
}

#[test]
fn the_checksum_is_the_common_crc_32() {
    let crc32 = |bytes: &mut dyn Iterator<Item = u8>| {
        let mut crc = u32::MAX;
        for byte in bytes {
            for bit in 0..8 {
                let differs = (crc ^ u32::from(byte >> bit)) & 1 == 1;
                crc = (crc >> 1) ^ if differs { 0xEDB8_8320 } else { 0 };
            }
        }
        !crc
    };
    assert_eq!(crc32(&mut "123456789".bytes()), 0xCBF4_3926);
    let mut bytes = entries().flat_map(u32::to_le_bytes);
    assert_eq!(crc32(&mut bytes), CHECKSUM);
}

#[test]
fn one_flipped_bit_fails_verification_and_a_copy_passes() {
    assert_eq!(Table::new(&COPY).verify(), Ok(()));
    for k in [0, 17_000, ENTRIES - 1] {
        let mut damaged = Box::new(QUARTER_COSINE);
        damaged.above[k] ^= 1 << (k % 8);
        assert!(Table::new(Box::leak(damaged)).verify().is_err());
        let mut damaged = Box::new(QUARTER_COSINE);
        damaged.chords[k / 16] ^= 1 << (k % 32);
        assert!(Table::new(Box::leak(damaged)).verify().is_err());
    }
}

#[test]
fn a_series_that_cannot_be_matched_says_why() {
    let error = |count: usize, step| Series::new(vec![0.5; count], step).err();
    assert_eq!(error(2, 168), Some(SeriesError::TooFew));
    assert_eq!(error(CAPACITY + 1, 168), Some(SeriesError::TooMany));
    assert_eq!(error(3, 0), Some(SeriesError::ZeroStep));
    assert_eq!(error(3, -259_200), Some(SeriesError::ZeroStep));
    assert_eq!(error(3, 64_800), Some(SeriesError::MirrorTiedStep));
    assert_eq!(error(3, -64_800), Some(SeriesError::MirrorTiedStep));
    assert_eq!(error(CAPACITY, -1), None);
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(Series::new([0.0, bad, 0.0], 168).err(), Some(SeriesError::NotFinite));
    }
}

#[test]
fn rates_are_rounded_and_clamped_as_documented() {
    let series = Series::new([0.5 / ONE, -0.4 / ONE, 1e300, -513.0], 129_599).unwrap();
    assert_eq!(series.values(), [1, 0, 1 << 40, -(1 << 40)]);
    assert_eq!(series.step(), -1);
}

campaigns! {
    ordinary_series_give_the_answer_of_the_brute_force_with_few_evaluations;
    the_papers_settings_give_the_answer_of_the_brute_force_with_few_evaluations;
    adversarial_series_give_the_answer_of_the_brute_force;
}

fn ordinary_series_give_the_answer_of_the_brute_force_with_few_evaluations(extent: Extent) {
    let outcomes = agree(extent.of(400), |random, _| ordinary(random));
    for (criterion, name) in CRITERIA.iter().enumerate() {
        let counts = evaluations(&outcomes, criterion);
        assert!(counts[counts.len() / 2] <= 2, "{name}: median {}", counts[counts.len() / 2]);
        let p99 = counts[counts.len() * 99 / 100];
        assert!(p99 <= 1296, "{name}: p99 {p99} is over a hundredth of the circle");
    }
}

fn the_papers_settings_give_the_answer_of_the_brute_force_with_few_evaluations(extent: Extent) {
    let outcomes = agree(extent.of(150), |random, _| paper(random));
    for (criterion, name) in CRITERIA.iter().enumerate() {
        let counts = evaluations(&outcomes, criterion);
        let p99 = counts[counts.len() * 99 / 100];
        assert!(p99 <= 1296, "{name}: p99 {p99} is over a hundredth of the circle");
    }
}

fn adversarial_series_give_the_answer_of_the_brute_force(extent: Extent) {
    agree(extent.of(400), adversarial);
}

#[test]
fn more_positions_than_short_sums_can_hold_give_the_answer_of_the_brute_force() {
    agree(8, |random, _| long(random));
}

#[test]
fn without_earth_rate_opposite_azimuths_tie_and_the_lower_wins() {
    // All residuals change sign from k to k + 64 800, and no objective notices.
    let flat = Series::new([0.0; 4], 32_400).unwrap();
    for criterion in
        [Criterion::MaximumLikelihood, Criterion::LeastSquares, Criterion::LeastAbsolute]
    {
        assert!(search(Table::built_in(), &flat, criterion).index < 64_800, "{criterion:?}");
    }
}

#[test]
fn a_drift_changes_nothing() {
    let mut random = Generator::new(7);
    let case = ordinary(&mut random);
    let shifted = Case { ratios: case.ratios.iter().map(|z| z + 0.25).collect(), ..case.clone() };
    for criterion in [Criterion::MaximumLikelihood, Criterion::LeastSquares] {
        let one = search(Table::built_in(), &series(&case), criterion);
        let other = search(Table::built_in(), &series(&shifted), criterion);
        assert_eq!(one.index, other.index);
    }
}

#[test]
fn the_azimuth_is_interpolated_below_the_grid_on_the_whole_circle() {
    for (step, count) in [(2160, 60), (-2160, 60), (168, 60), (-5400, 7), (43_200, 3)] {
        for index in 0..2000 {
            let azimuth = (f64::from(index) * 0.5 + 0.137) * (TAU / 1000.0);
            let series = series(&Case::clean(azimuth, count, step));
            for criterion in
                [Criterion::MaximumLikelihood, Criterion::LeastSquares, Criterion::LeastAbsolute]
            {
                let found = search(Table::built_in(), &series, criterion).azimuth;
                let error = (found - azimuth + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
                assert!((0.0..TAU).contains(&found));
                assert!(
                    error.abs() < 0.5 * ARCSECOND,
                    "{criterion:?}, step {step}, azimuth {azimuth}: off by {}″",
                    error / ARCSECOND
                );
            }
        }
    }
}

#[test]
fn the_papers_limit_accepts_its_whole_quarter_as_degrees_and_nothing_as_arcseconds() {
    let mut random = Generator::new(3);
    let clean = Case::clean(28.5_f64.to_radians(), 60, -168);
    let series = series(&clean.disturbed(&mut random, 0.015 / PAPER_RATE, 0.0));
    let units = |limit: f64| (limit / PAPER_RATE * ONE) as u64;
    let within =
        |limit| accepted(Table::built_in(), &series, Limit::WithinAbsolute(limit)).accepted;
    assert_eq!(within(units(5.0 / 3600.0)), Accepted::Nothing);
    // The paper's candidates are one quarter of the circle.
    let Accepted::Arc { first, width, .. } = within(units(5.0)) else { panic!("no arc") };
    assert!(first > 97_200 && first + width - 129_600 > 32_400);
    assert_eq!(within(units(15.0)), Accepted::Everything);
}

#[test]
fn an_arc_across_north_is_one_arc_with_its_middle_at_the_truth() {
    let series = series(&Case::clean(0.0, 60, 2160));
    let table = Table::built_in();
    let limits = [Limit::WithinSquares(1 << 42), Limit::WithinAbsolute(1 << 24)];
    for limit in limits {
        let Acceptance { accepted, .. } = accepted(table, &series, limit);
        let Accepted::Arc { first, middle, width } = accepted else { panic!("{accepted:?}") };
        assert!(first > 64_800 && first + width > 129_600, "{accepted:?}");
        assert!(middle <= 1 || middle >= 129_599, "{accepted:?}");
    }
}

#[test]
fn a_noise_free_series_on_the_grid_is_met_exactly() {
    for k in [0, 1, 16_199, 32_400, 64_800, 100_001, 129_599] {
        let series = series(&Case::clean(f64::from(k) * GRID, 60, 2160));
        let found = search(Table::built_in(), &series, Criterion::LeastAbsolute);
        assert_eq!((found.index, found.objective), (k, 0));
        let accepted = accepted(Table::built_in(), &series, Limit::WithinSquares(0)).accepted;
        assert_eq!(accepted, Accepted::Arc { first: k, middle: k, width: 0 });
    }
}

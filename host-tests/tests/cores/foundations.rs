//! Units, Earth and the numerical pieces, against published values, scipy and closed forms.

use orientation::earth::Latitude;
use orientation::math::quaternion::{Attitude, angles_of, quaternion};
use orientation::math::{chi_square_tail, cholesky, cholesky_solve, median};
use orientation::units::{
    Angle, AngularRate, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, Instant, SpecificForce, TURN,
    Temperature,
};
use orientation::words::{Rounded, Shortened};
use proptest::prelude::*;

#[test]
fn gravity_is_that_of_the_ellipsoid() {
    for (degrees, expected) in
        [(0.0, 9.780_325_3), (47.0 + 35.0 / 60.0, 9.808_533_3), (90.0, 9.832_184_9)]
    {
        let gravity = Latitude::from_degrees(degrees).expect("it is one").gravity();
        assert!((gravity.0 - expected).abs() < 6e-8, "{degrees}: {gravity:?}");
    }
}

#[test]
fn the_earth_turns_fifteen_degrees_an_hour() {
    let equator = Latitude::from_degrees(0.0).expect("it is one");
    assert!((equator.horizontal_rate().degrees_per_hour() - 15.041_067).abs() < 1e-6);
    let south = Latitude::from_degrees(-30.0).expect("it is one");
    assert!((south.vertical_rate().degrees_per_hour() + 7.520_533_5).abs() < 1e-6);
}

#[test]
fn a_latitude_is_within_ninety_degrees() {
    for degrees in [90.000_1, -91.0, f64::NAN, f64::INFINITY] {
        assert_eq!(Latitude::from_degrees(degrees), None);
    }
    assert!(Latitude::from_degrees(85.0).expect("it is one").has_north());
    assert!(!Latitude::from_degrees(-85.01).expect("it is one").has_north());
}

#[test]
fn noise_per_sample_is_the_field_unit_times_sixty_root_rate() {
    // 0.15 °/h at 100 Hz is 0.00025 °/√h.
    let n = 0.000_25 * DEGREE_PER_SQRT_HOUR;
    assert!((n * 10.0 / DEGREE_PER_HOUR - 0.15).abs() < 1e-12);
}

#[test]
fn conversions_round_to_nearest_and_saturate() {
    assert_eq!(AngularRate::from_rad_per_s(1.4e-9).0, 1);
    assert_eq!(AngularRate::from_rad_per_s(-1.6e-9).0, -2);
    assert_eq!(AngularRate::from_rad_per_s(3.0).0, i32::MAX);
    assert!(AngularRate::from_rad_per_s(-3.0).is_saturated());
    assert_eq!(AngularRate::from_rad_per_s(f64::NAN).0, 0);
    assert_eq!(SpecificForce::from_m_per_s2(-9.806_650_4).0, -9_806_650);
    assert_eq!(Temperature::from_celsius(23.979).0, 23_979);
    assert_eq!(Instant::from_seconds(-1.0).0, 0);
    assert_eq!(Angle::from_rad(TURN * (1.0 - 1e-12)).0, 0);
}

/// A number with so many decimal places in the words of a message, and as the standard library writes it.
fn written<const PLACES: usize>(number: f64) -> [String; 2] {
    [Rounded::<PLACES>(number).to_string(), format!("{number:.PLACES$}")]
}

/// Holds every number of decimal places that messages have to the standard library.
fn is_written_as_by_the_standard_library(number: f64) {
    let places =
        [written::<0>, written::<1>, written::<2>, written::<3>, written::<4>, written::<6>];
    for [ours, standard] in places.map(|written| written(number)) {
        assert_eq!(ours, standard);
    }
}

#[test]
fn numbers_in_messages_are_rounded_to_even_from_the_middle_and_exactly_elsewhere() {
    let edges = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, -0.04, 0.999_999_9, 1e38];
    edges.into_iter().for_each(is_written_as_by_the_standard_library);
    for step in 0..4096 {
        // Dyadic fractions, of which some are in the middle; then decimal ones, of which none is.
        is_written_as_by_the_standard_library(f64::from(step) / 64.0);
        is_written_as_by_the_standard_library(f64::from(step) * 0.05);
        is_written_as_by_the_standard_library(f64::from(step) * 5e-7);
    }
}

proptest! {
    #[test]
    fn numbers_in_messages_are_those_of_the_standard_library(bits in any::<u64>()) {
        // All of a float's bits but for exponents over 2¹²⁸.
        let number = f64::from_bits(bits);
        let number = if number.abs() < 3.4e38 { number } else { 1.0 / number };
        is_written_as_by_the_standard_library(number);
    }

    #[test]
    fn numbers_of_daily_size_are_those_of_the_standard_library(number in -1e6..1e6) {
        is_written_as_by_the_standard_library(number);
    }
}

proptest! {
    #[test]
    fn rates_survive_the_way_to_floating_point_and_back(rate in any::<i32>()) {
        let there = AngularRate(rate).rad_per_s();
        prop_assert_eq!(AngularRate::from_rad_per_s(there).0, rate);
    }

    #[test]
    fn angles_wrap_and_keep_their_direction(turns in -1000_i32..1000, angle in 0.0..TURN) {
        let found = Angle::from_rad(angle + f64::from(turns) * TURN).rad();
        let error = (found - angle + 0.5 * TURN).rem_euclid(TURN) - 0.5 * TURN;
        prop_assert!(error.abs() < 3e-9, "{}", error);
    }

    #[test]
    fn forces_survive_the_way_to_floating_point_and_back(force in any::<i32>()) {
        let there = SpecificForce(force).m_per_s2();
        prop_assert_eq!(SpecificForce::from_m_per_s2(there).0, force);
    }

    #[test]
    fn a_factored_matrix_solves_its_equations(values in prop::array::uniform9(-1.0..1.0_f64), x in prop::array::uniform3(-5.0..5.0_f64)) {
        // A = M Mᵀ + I is positive.
        let m = |i: usize, j: usize| values[3 * i + j];
        let a: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| {
            (0..3).map(|k| m(i, k) * m(j, k)).sum::<f64>() + f64::from(u8::from(i == j))
        }));
        let mut b: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| a[i][j] * x[j]).sum());
        let mut factor = a;
        prop_assert!(cholesky(&mut factor, 3));
        cholesky_solve(&factor, 3, &mut b);
        for (found, expected) in b.iter().zip(x) {
            prop_assert!((found - expected).abs() < 1e-9);
        }
    }
}

#[test]
fn dependent_columns_are_noticed() {
    let mut singular = [[1.0, 2.0], [2.0, 4.0]];
    assert!(!cholesky(&mut singular, 2));
    let mut unknown = [[f64::NAN, 0.0], [0.0, 1.0]];
    assert!(!cholesky(&mut unknown, 2));
}

/// `scipy.stats.chi2.sf`.
#[allow(clippy::unreadable_literal, reason = "as scipy prints them")]
#[test]
fn the_chi_square_tail_is_that_of_scipy() {
    let table = [
        (10.83, 1.0, 9.9868637918026e-04),
        (1.0, 1.0, 3.1731050786291e-01),
        (60.0, 57.0, 3.6752529880304e-01),
        (120.5, 57.0, 1.8998489791084e-06),
        (3.0, 8.0, 9.3435754562155e-01),
        (40.0, 8.0, 3.2037197804770e-06),
        (200.0, 22.0, 1.1376879516953e-30),
        (0.5, 14.0, 9.9999999026548e-01),
        (500.0, 500.0, 4.9158937303101e-01),
        (700.0, 500.0, 7.7289921112166e-09),
    ];
    for (value, degrees, expected) in table {
        let found = chi_square_tail(value, degrees);
        assert!((found / expected - 1.0).abs() < 1e-9, "{value}, {degrees}: {found} {expected}");
    }
    assert_eq!(chi_square_tail(-1.0, 3.0), 1.0);
    assert_eq!(chi_square_tail(f64::NAN, 3.0), 1.0);
}

#[test]
fn the_median_is_the_middle() {
    assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
    assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 2.5);
    assert_eq!(median(&mut []), 0.0);
}

proptest! {
    #[test]
    fn angles_in_single_precision_are_right_to_three_microradians(
        course in 0.0..TURN,
        pitch in -80.0..80.0_f64,
        roll in -3.1..3.1_f64,
    ) {
        let truth = [course, pitch.to_radians(), roll];
        let found = angles_of(&Attitude::new(quaternion(truth)).rough_matrix());
        for (found, truth) in found.into_iter().zip(truth) {
            let off = (f64::from(found) - truth).rem_euclid(TURN);
            prop_assert!(off.min(TURN - off) < 3e-6, "{found} is not {truth}");
        }
    }

    #[test]
    fn a_shortened_number_reads_back_to_nine_digits(mantissa in -1.0..1.0_f64, power in -12_i32..17) {
        let number = mantissa * 10_f64.powi(power);
        let text = Shortened(number).to_string();
        let read: f64 = text.parse().expect("a number");
        prop_assert!((read - number).abs() <= 5.1e-9 * number.abs() + 1e-22, "{number} is {text}");
        let digits = text.split('e').next().map_or("", |digits| digits.trim_start_matches(['-', '0', '.']));
        prop_assert!(!text.contains('.') || !digits.ends_with(['0', '.']), "{text}");
    }
}

#[test]
fn shortened_numbers_are_as_people_write_them() {
    let text = |number: f64| Shortened(number).to_string();
    assert_eq!([0.0, 1.0, -0.5, 600.0, 1e9].map(text), ["0", "1", "-0.5", "600", "1000000000"]);
    assert_eq!([0.1 + 0.2, 1.0 / 3.0, 1e-12].map(text), ["0.3", "0.333333333", "1e-12"]);
    assert_eq!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(text), ["NaN", "inf", "-inf"]);
}
